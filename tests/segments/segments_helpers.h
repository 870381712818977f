// Buildings made of planes, and hit grids filled in by hand: what room `segments` is tested on.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>

#include "segments/segments.h"
#include "visibility/visibility_helpers.h"

namespace colod::test {

/// Planes with names, so that tests need no indices.
struct NamedPlanes {
  std::vector<Plane> planes;
  std::vector<std::string> names;

  void add(const std::string& name, Plane plane) {
    planes.push_back(std::move(plane));
    names.push_back(name);
  }
  /// Coplanar parts as one plane.
  void add(const std::string& name, const std::vector<Plane>& parts) {
    Plane whole = parts.front();
    for (std::size_t i = 1; i < parts.size(); ++i) {
      const int base = static_cast<int>(whole.outline.vertices.size());
      const Outline& more = parts[i].outline;
      whole.outline.vertices.insert(whole.outline.vertices.end(), more.vertices.begin(),
                                    more.vertices.end());
      for (const Face& f : more.triangles)
        whole.outline.triangles.push_back({f[0] + base, f[1] + base, f[2] + base});
      for (auto ring : more.rings) {
        for (int& v : ring) v += base;
        whole.outline.rings.push_back(ring);
      }
      whole.centroid = (whole.area * whole.centroid + parts[i].area * parts[i].centroid) /
                       (whole.area + parts[i].area);
      whole.area += parts[i].area;
    }
    add(name, whole);
  }
  int index(const std::string& name) const {
    return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
  }
};

/// Names of the planes that share a segment with `name`.
inline std::set<std::string> mates(const NamedPlanes& scene, const Segments& segments,
                                   const std::string& name) {
  std::set<std::string> out;
  const int s = segments.segment_of_plane[scene.index(name)];
  if (s >= 0)
    for (int p : segments.segments[s].planes) out.insert(scene.names[p]);
  return out;
}

/// A wall in the plane y = at between x0 and x1 and heights z0 and z1, seen from −y (or +y).
inline Plane wall_y(double x0, double x1, double z0, double z1, double at, bool is_front = true) {
  const Vec3 w(x1 - x0, 0, 0), h(0, 0, z1 - z0);
  return is_front ? rectangle_plane({x0, at, z0}, w, h) : rectangle_plane({x0, at, z0}, h, w);
}
/// A wall in the plane x = at, seen from −x (or +x).
inline Plane wall_x(double y0, double y1, double z0, double z1, double at, bool is_left = true) {
  const Vec3 w(0, y1 - y0, 0), h(0, 0, z1 - z0);
  return is_left ? rectangle_plane({at, y0, z0}, h, w) : rectangle_plane({at, y0, z0}, w, h);
}
/// A horizontal plane seen from above (or below).
inline Plane slab(double x0, double x1, double y0, double y1, double z, bool is_up = true) {
  const Vec3 a(x1 - x0, 0, 0), b(0, y1 - y0, 0);
  return is_up ? rectangle_plane({x0, y0, z}, a, b) : rectangle_plane({x0, y0, z}, b, a);
}

/// 20 × 16 m, 9 m to the eaves, 15 m to the ridge. In front a recess (4 m wide, 2 m deep) and a
/// bay (4 m wide, 2 m out), both open towards what they belong to; on the front roof a chimney that
/// the roof is open under.
inline NamedPlanes detailed_house() {
  NamedPlanes s;
  s.add("front", {wall_y(0, 20, 0, 3, 0), wall_y(0, 4, 3, 6, 0), wall_y(8, 12, 3, 6, 0),
                  wall_y(16, 20, 3, 6, 0), wall_y(0, 20, 6, 9, 0)});
  s.add("back", wall_y(0, 20, 0, 9, 16, false));
  s.add("left", polygon_plane({{0, 0, 0}, {0, 0, 9}, {0, 8, 15}, {0, 16, 9}, {0, 16, 0}}));
  s.add("right", polygon_plane({{20, 0, 0}, {20, 16, 0}, {20, 16, 9}, {20, 8, 15}, {20, 0, 9}}));
  s.add("floor", slab(0, 20, 0, 16, 0, false));
  const auto roof = [](double x0, double x1, double y0, double y1) {
    return polygon_plane({{x0, y0, 9 + 0.75 * y0},
                          {x1, y0, 9 + 0.75 * y0},
                          {x1, y1, 9 + 0.75 * y1},
                          {x0, y1, 9 + 0.75 * y1}});
  };
  s.add("roof front",
        {roof(0, 20, 0, 3), roof(0, 13, 3, 5), roof(15, 20, 3, 5), roof(0, 20, 5, 8)});
  s.add("roof back", polygon_plane({{0, 8, 15}, {20, 8, 15}, {20, 16, 9}, {0, 16, 9}}));

  s.add("chimney front", wall_y(13, 15, 11.25, 16, 3));
  s.add("chimney back", wall_y(13, 15, 12.75, 16, 5, false));
  s.add("chimney left", polygon_plane({{13, 3, 11.25}, {13, 3, 16}, {13, 5, 16}, {13, 5, 12.75}}));
  s.add("chimney right", polygon_plane({{15, 3, 11.25}, {15, 5, 12.75}, {15, 5, 16}, {15, 3, 16}}));
  s.add("chimney top", slab(13, 15, 3, 5, 16));

  s.add("recess left", wall_x(0, 2, 3, 6, 4, false));
  s.add("recess right", wall_x(0, 2, 3, 6, 8));
  s.add("recess back", wall_y(4, 8, 3, 6, 2));
  s.add("recess floor", slab(4, 8, 0, 2, 3));
  s.add("recess ceiling", slab(4, 8, 0, 2, 6, false));

  s.add("bay left", wall_x(-2, 0, 3, 6, 12));
  s.add("bay right", wall_x(-2, 0, 3, 6, 16, false));
  s.add("bay front", wall_y(12, 16, 3, 6, -2));
  s.add("bay floor", slab(12, 16, -2, 0, 3, false));
  s.add("bay roof", slab(12, 16, -2, 0, 6));
  return s;
}

/// The scene in another order of planes.
inline NamedPlanes permuted(const NamedPlanes& scene, const std::vector<int>& order) {
  NamedPlanes out;
  for (int p : order) out.add(scene.names[p], scene.planes[p]);
  return out;
}

/// The scene seen in a mirror at x = 0.
inline NamedPlanes mirrored(NamedPlanes scene) {
  for (Plane& p : scene.planes) {
    p.normal.x() = -p.normal.x(), p.centroid.x() = -p.centroid.x();
    for (Vec3& v : p.outline.vertices) v.x() = -v.x();
    for (Face& f : p.outline.triangles) std::swap(f[1], f[2]);
    for (auto& ring : p.outline.rings) ring = {ring.rbegin(), ring.rend()};
  }
  return scene;
}

/// The partition of the planes, as sets of names.
inline std::set<std::set<std::string>> partition_of(const NamedPlanes& scene,
                                                    const Segments& segments) {
  std::set<std::set<std::string>> out;
  for (const Segment& s : segments.segments) {
    std::set<std::string> names;
    for (int p : s.planes) names.insert(scene.names[p]);
    out.insert(names);
  }
  return out;
}

using VoxelHits = std::map<int, int>;  ///< plane → inside hits

/// A grid of ns³ unit voxels of which the first row (rising x) sees `row`; a voxel with no hits is
/// invalid. Everything else is invalid.
inline HitGrid row_grid(int ns, const std::vector<VoxelHits>& row) {
  HitGrid grid;
  grid.ns = ns, grid.nr = 100;
  grid.box.extend(Vec3(0, 0, 0)), grid.box.extend(Vec3(ns, ns, ns));
  grid.first.push_back(0);
  for (std::size_t v = 0; v < static_cast<std::size_t>(ns) * ns * ns; ++v) {
    if (v < row.size())
      for (const auto& [plane, hits] : row[v])
        grid.hits.push_back(
            {static_cast<std::uint32_t>(plane), static_cast<std::uint16_t>(hits), 0});
    grid.first.push_back(grid.hits.size());
    grid.is_valid.push_back(grid.first[v + 1] > grid.first[v]);
  }
  return grid;
}

}  // namespace colod::test
