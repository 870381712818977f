// What the tests of room `extraction` build on: planes from clean meshes, partitions into cubes,
// and an own check of what closed means.
#pragma once

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "extraction/extraction.h"
#include "meshes.h"
#include "partition/partition.h"

namespace colod::test {

/// One plane per set of coplanar faces with equal normals, largest first, faces as the outline
/// (each a ring of its own).
inline Planes planes_of_mesh(const Mesh& mesh) {
  Planes planes;
  std::map<std::array<long, 4>, std::vector<Face>> groups;
  for (const Face& f : mesh.faces) {
    const Vec3 n = face_cross(mesh, f).normalized();
    const double d = n.dot(mesh.vertices[f[0]]);
    groups[{std::lround(n.x() * 1e4), std::lround(n.y() * 1e4), std::lround(n.z() * 1e4),
            std::lround(d * 1e4)}]
        .push_back(f);
  }
  for (const auto& [key, faces] : groups) {
    Plane plane;
    plane.normal = face_cross(mesh, faces[0]).normalized();
    plane.offset = plane.normal.dot(mesh.vertices[faces[0][0]]);
    for (const Face& f : faces) {
      const int first = static_cast<int>(plane.outline.vertices.size());
      Vec3 sum = Vec3::Zero();
      for (const int v : f) {
        plane.outline.vertices.push_back(mesh.vertices[v]);
        sum += mesh.vertices[v] / 3;
      }
      plane.outline.triangles.push_back({first, first + 1, first + 2});
      plane.area += face_area(mesh, f);
      plane.centroid += face_area(mesh, f) * sum;
    }
    plane.centroid /= plane.area;
    for (const Face& f : plane.outline.triangles)
      plane.outline.rings.emplace_back(f.begin(), f.end());
    planes.total_area += plane.area;
    planes.planes.push_back(plane);
  }
  std::stable_sort(planes.planes.begin(), planes.planes.end(),
                   [](const Plane& a, const Plane& b) { return a.area > b.area; });
  planes.box = bounding_box(mesh.vertices);
  return planes;
}

inline std::vector<int> all_planes(const Planes& planes) {
  std::vector<int> all;
  for (std::size_t i = 0; i < planes.planes.size(); ++i) all.push_back(static_cast<int>(i));
  return all;
}

inline Extraction extract(const Mesh& mesh, const ExtractionOptions& options = {}) {
  const Planes planes = planes_of_mesh(mesh);
  Sight sight(planes);
  return extract_layer(planes, all_planes(planes), sight, options);
}

/// Closed, 2-manifold and outward after welding equal coordinates; no diagonal used twice, no
/// degenerate triangle; rings bound the same area as the triangles.
struct Check {
  bool is_closed = true, is_fan = true, is_degenerate = false, rings_match = true;
  int components = 0, euler = 0;
};

inline Check check(const PolygonMesh& mesh) {
  Check result;
  const auto less = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::map<Vec3, int, decltype(less)> ids(less);
  std::vector<Face> faces;
  for (const Face& f : mesh.triangles) {
    Face g;
    for (int i = 0; i < 3; ++i)
      g[i] = ids.try_emplace(mesh.vertices[f[i]], static_cast<int>(ids.size())).first->second;
    faces.push_back(g);
    result.is_degenerate |=
        face_area(mesh.mesh(), f) <= 0 || g[0] == g[1] || g[1] == g[2] || g[2] == g[0];
  }
  std::map<std::pair<int, int>, int> used;
  for (const Face& f : faces)
    for (int i = 0; i < 3; ++i) ++used[{f[i], f[(i + 1) % 3]}];
  for (const auto& [edge, n] : used)
    result.is_closed &= n == 1 && used.count({edge.second, edge.first});
  // Around each vertex the opposite edges form one closed chain.
  std::map<int, std::map<int, int>> next;
  for (const Face& f : faces)
    for (int i = 0; i < 3; ++i) next[f[i]][f[(i + 1) % 3]] = f[(i + 2) % 3];
  for (const auto& [vertex, chain] : next) {
    std::size_t steps = 0;
    int at = chain.begin()->first;
    do {
      const auto found = chain.find(at);
      at = found == chain.end() ? -1 : found->second;
    } while (++steps <= chain.size() && at >= 0 && at != chain.begin()->first);
    result.is_fan &= steps == chain.size();
  }
  std::map<int, int> root;
  const std::function<int(int)> find = [&](int v) {
    root.try_emplace(v, v);
    return root[v] == v ? v : root[v] = find(root[v]);
  };
  for (const Face& f : faces) root[find(f[0])] = find(f[1]), root[find(f[1])] = find(f[2]);
  for (const auto& [v, r] : root) result.components += find(v) == v;
  result.euler = static_cast<int>(next.size()) - static_cast<int>(used.size() / 2) +
                 static_cast<int>(faces.size());

  std::vector<double> by_triangles(mesh.facets.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    by_triangles[mesh.facet_of_triangle[t]] += face_area(mesh.mesh(), mesh.triangles[t]);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    Vec3 sum = Vec3::Zero();
    for (const std::vector<int>& ring : mesh.facets[f].rings)
      for (std::size_t i = 0; i < ring.size(); ++i)
        sum += 0.5 * mesh.vertices[ring[i]].cross(mesh.vertices[ring[(i + 1) % ring.size()]]);
    result.rings_match &= std::abs(sum.dot(mesh.facets[f].normal) - by_triangles[f]) < 1e-6;
  }
  return result;
}

inline void expect_solid(const PolygonMesh& mesh, double volume, double tolerance = 1e-3) {
  const Check c = check(mesh);
  CHECK(c.is_closed);
  CHECK(c.is_fan);
  CHECK_FALSE(c.is_degenerate);
  CHECK(c.rings_match);
  CHECK(c.components == 1);
  CHECK(signed_volume(mesh.mesh()) == Approx(volume).margin(tolerance));
}

inline void expect_counts(const PolygonMesh& mesh, std::size_t vertices, std::size_t facets,
                          std::size_t triangles) {
  CHECK(mesh.vertices.size() == vertices);
  CHECK(mesh.facets.size() == facets);
  CHECK(mesh.triangles.size() == triangles);
}

/// A grid of unit cubes as a partition, x fastest.
inline Partition cubes(int nx, int ny, int nz) {
  std::vector<CutPlane> planes;
  for (int i = 1; i < nx; ++i) planes.push_back({Vec3::UnitX(), 1.0 * i, {}, -1});
  for (int i = 1; i < ny; ++i) planes.push_back({Vec3::UnitY(), 1.0 * i, {}, -1});
  for (int i = 1; i < nz; ++i) planes.push_back({Vec3::UnitZ(), 1.0 * i, {}, -1});
  Box box;
  box.extend(Vec3::Zero());
  box.extend(Vec3(nx, ny, nz));
  return partition_space(planes, box);
}

/// The cells whose cubes (by the floor of their centroids) are listed.
inline std::vector<char> choose_cubes(const Partition& partition,
                                      const std::set<std::array<int, 3>>& chosen) {
  std::vector<char> is_inside;
  for (const Partition::Cell& c : partition.cells)
    is_inside.push_back(chosen.count({static_cast<int>(std::floor(c.centroid.x())),
                                      static_cast<int>(std::floor(c.centroid.y())),
                                      static_cast<int>(std::floor(c.centroid.z()))}) > 0);
  return is_inside;
}

}  // namespace colod::test
