// Small meshes that tests build on.
#pragma once

#include <cmath>

#include "core/geometry.h"

namespace colod::test {

/// An axis-parallel box, 8 vertices and 12 outward faces.
inline Mesh box_mesh(const Vec3& min, const Vec3& max) {
  Mesh m;
  for (int i = 0; i < 8; ++i)
    m.vertices.emplace_back(i & 1 ? max.x() : min.x(), i & 2 ? max.y() : min.y(),
                            i & 4 ? max.z() : min.z());
  m.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
             {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}

/// b appended to a.
inline Mesh join(Mesh a, const Mesh& b) {
  const int base = static_cast<int>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Face& f : b.faces) a.faces.push_back({f[0] + base, f[1] + base, f[2] + base});
  return a;
}

/// A house: a box of w × d × h with a gable roof of height `roof`, ridge along x; closed.
inline Mesh gable_house(double w, double d, double h, double roof) {
  Mesh m;
  m.vertices = {{0, 0, 0},           {w, 0, 0}, {w, d, 0},
                {0, d, 0},           {0, 0, h}, {w, 0, h},
                {w, d, h},           {0, d, h}, {0, d / 2, h + roof},
                {w, d / 2, h + roof}};
  m.faces = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {2, 3, 7}, {2, 7, 6},
             {1, 2, 6}, {1, 6, 5}, {3, 0, 4}, {3, 4, 7}, {4, 5, 9}, {4, 9, 8},
             {6, 7, 8}, {6, 8, 9}, {5, 6, 9}, {7, 4, 8}};
  return m;
}

/// A sphere of unit radius about the origin, subdivided octahedron, outward.
inline Mesh sphere_mesh(int subdivisions) {
  Mesh m;
  m.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  m.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
             {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int s = 0; s < subdivisions; ++s) {
    std::vector<Face> next;
    for (const Face& f : m.faces) {
      int mid[3];
      for (int i = 0; i < 3; ++i) {
        mid[i] = static_cast<int>(m.vertices.size());
        m.vertices.push_back((m.vertices[f[i]] + m.vertices[f[(i + 1) % 3]]).normalized());
      }
      next.insert(next.end(), {{f[0], mid[0], mid[2]},
                               {f[1], mid[1], mid[0]},
                               {f[2], mid[2], mid[1]},
                               {mid[0], mid[1], mid[2]}});
    }
    m.faces = next;
  }
  return m;
}

inline Source as_source(Mesh mesh, std::string name = "building") {
  Source s;
  s.name = s.path = std::move(name);
  s.mesh = std::move(mesh);
  return s;
}

}  // namespace colod::test
