// Surfaces and checks for the tests of planes.
#pragma once

#include <algorithm>
#include <numeric>
#include <random>

#include "meshes.h"
#include "planes/planes.h"

namespace colod::test {

inline double unit_random(std::mt19937_64& rng) {
  return static_cast<double>(rng() >> 11) / 9007199254740992.0;
}

/// A level square of side `size` about the origin with a square hole of side `hole`.
inline Mesh sheet_with_hole(double size, double hole) {
  Mesh m;
  for (const double s : {size / 2, hole / 2})
    m.vertices.insert(m.vertices.end(), {{-s, -s, 3}, {s, -s, 3}, {s, s, 3}, {-s, s, 3}});
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    m.faces.push_back({k, next, 4 + next});
    m.faces.push_back({k, 4 + next, 4 + k});
  }
  return m;
}

/// An upright rectangle over a–b, `height` high.
inline Mesh sheet(const Vec3& a, const Vec3& b, double height) {
  const Vec3 up(0, 0, height);
  return {{a, b, b + up, a + up}, {{0, 1, 2}, {0, 2, 3}}};
}

/// Two walls of length × height that meet at the z axis, in 0.2 m squares, displaced at random.
inline Mesh noisy_corner(double length, double height, double noise) {
  const double step = 0.2;
  const int half = static_cast<int>(std::lround(length / step));
  const int rows = static_cast<int>(std::lround(height / step));
  std::mt19937_64 rng(7);
  Mesh m;
  for (int i = -half; i <= half; ++i)
    for (int j = 0; j <= rows; ++j) {
      const Vec3 at(i > 0 ? i * step : 0, i < 0 ? -i * step : 0, j * step);
      const Vec3 shift(unit_random(rng) - 0.5, unit_random(rng) - 0.5, 0);
      m.vertices.push_back(at + 2 * noise * shift);
    }
  for (int i = 0; i < 2 * half; ++i)
    for (int j = 0; j < rows; ++j) {
      const int a = i * (rows + 1) + j, b = a + rows + 1;
      m.faces.push_back({a, b + 1, b});
      m.faces.push_back({a, a + 1, b + 1});
    }
  return m;
}

/// The same mesh in another order of vertices, faces and corners.
inline Mesh shuffled(const Mesh& mesh) {
  std::mt19937_64 rng(3);
  std::vector<int> to(mesh.vertices.size());
  std::iota(to.begin(), to.end(), 0);
  for (std::size_t i = to.size(); i > 1; --i) std::swap(to[i - 1], to[rng() % i]);
  Mesh m;
  m.vertices.resize(to.size());
  for (std::size_t i = 0; i < to.size(); ++i) m.vertices[to[i]] = mesh.vertices[i];
  for (const Face& f : mesh.faces) m.faces.push_back({to[f[1]], to[f[2]], to[f[0]]});
  std::reverse(m.faces.begin(), m.faces.end());
  return m;
}

/// Points about `step` apart on the sides of a box at the origin, normals outward.
inline Source box_cloud(const Vec3& size, double step) {
  Source s;
  s.name = s.path = "cloud";
  std::mt19937_64 rng(5);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {0.0, 1.0}) {
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      for (double x = step / 2; x < size[a]; x += step)
        for (double y = step / 2; y < size[b]; y += step) {
          Vec3 p;
          p[axis] = side * size[axis] + 0.01 * (unit_random(rng) - 0.5);
          p[a] = x + 0.4 * step * (unit_random(rng) - 0.5);
          p[b] = y + 0.4 * step * (unit_random(rng) - 0.5);
          s.cloud.points.push_back(p);
          s.cloud.normals.push_back((2 * side - 1) * Vec3::Unit(axis));
        }
    }
  return s;
}

inline double outline_area(const Plane& plane) {
  double sum = 0;
  for (const Face& t : plane.outline.triangles) {
    const auto& v = plane.outline.vertices;
    sum += 0.5 * (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).dot(plane.normal);
  }
  return sum;
}

/// On the plane, rings and triangles about the normal and of the same area.
inline bool outline_is_sound(const Plane& plane) {
  const Outline& o = plane.outline;
  double rings = 0;
  for (const auto& ring : o.rings)
    for (std::size_t i = 0; i < ring.size(); ++i)
      rings += 0.5 *
               o.vertices[ring[i]].cross(o.vertices[ring[(i + 1) % ring.size()]]).dot(plane.normal);
  for (const Vec3& v : o.vertices)
    if (!(std::abs(plane.signed_distance(v)) < 1e-9)) return false;
  for (const Face& t : o.triangles)
    if ((o.vertices[t[1]] - o.vertices[t[0]])
            .cross(o.vertices[t[2]] - o.vertices[t[0]])
            .dot(plane.normal) < 0)
      return false;
  return rings > 0 && std::abs(rings - outline_area(plane)) < 1e-6 * rings;
}

/// Equal bit for bit.
inline bool same_planes(const Planes& a, const Planes& b) {
  if (a.planes.size() != b.planes.size() || a.plane_of_item != b.plane_of_item) return false;
  for (std::size_t i = 0; i < a.planes.size(); ++i) {
    const Plane &p = a.planes[i], &q = b.planes[i];
    if (p.normal != q.normal || p.offset != q.offset || p.area != q.area || p.items != q.items ||
        p.outline.vertices != q.outline.vertices || p.outline.triangles != q.outline.triangles)
      return false;
  }
  return true;
}

}  // namespace colod::test
