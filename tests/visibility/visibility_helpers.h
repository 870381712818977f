// Planes made by hand: what `visibility` and `segments` are tested on.
#pragma once

#include <random>
#include <vector>

#include "planes/planes.h"

namespace colod::test {

/// A plane whose outline is one convex polygon, counter-clockwise seen from outside.
inline Plane polygon_plane(const std::vector<Vec3>& corners) {
  Plane p;
  Vec3 twice_area = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Vec3 cross = (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
    twice_area += cross;
    p.area += 0.5 * cross.norm();
    p.centroid += 0.5 * cross.norm() * (corners[0] + corners[i] + corners[i + 1]) / 3;
    p.outline.triangles.push_back({0, static_cast<int>(i), static_cast<int>(i + 1)});
  }
  p.normal = twice_area.normalized();
  p.centroid /= p.area;
  p.offset = p.normal.dot(p.centroid);
  p.outline.vertices = corners;
  p.outline.rings.emplace_back();
  for (std::size_t i = 0; i < corners.size(); ++i)
    p.outline.rings[0].push_back(static_cast<int>(i));
  return p;
}

/// The parallelogram corner, corner + a, corner + a + b, corner + b; outside is where a × b points.
inline Plane rectangle_plane(const Vec3& corner, const Vec3& a, const Vec3& b) {
  return polygon_plane({corner, corner + a, corner + a + b, corner + b});
}

/// The sides of a box in the order −x, +x, −y, +y, −z, +z, normals outward.
inline std::vector<Plane> box_planes(const Vec3& min, const Vec3& max) {
  const Vec3 size = max - min;
  const Vec3 x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  return {rectangle_plane(min, z, y), rectangle_plane(min + x, y, z),
          rectangle_plane(min, x, z), rectangle_plane(min + y, z, x),
          rectangle_plane(min, y, x), rectangle_plane(min + z, x, y)};
}

/// The same planes seen from the other side: normals and outlines turned.
inline std::vector<Plane> turned_planes(std::vector<Plane> planes) {
  for (Plane& p : planes) {
    p.normal = -p.normal, p.offset = -p.offset;
    for (Face& f : p.outline.triangles) std::swap(f[1], f[2]);
    for (auto& ring : p.outline.rings) ring = {ring.rbegin(), ring.rend()};
  }
  return planes;
}

/// Planes as room `planes` returns them, except for their order, which stays as given.
inline Planes as_planes(std::vector<Plane> list) {
  Planes planes;
  planes.planes = std::move(list);
  for (const Plane& p : planes.planes) {
    planes.total_area += p.area;
    planes.box.extend(bounding_box(p.outline.vertices));
  }
  return planes;
}

/// `count` parallelograms about the origin, some 10 m across.
inline std::vector<Plane> random_planes(int count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto uniform = [&](double r) {
    return r * (2 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1);
  };
  std::vector<Plane> list;
  for (int i = 0; i < count; ++i)
    list.push_back(rectangle_plane({uniform(5), uniform(5), uniform(5)},
                                   {uniform(4), uniform(4), uniform(4)},
                                   {uniform(4), uniform(4), uniform(4)}));
  return list;
}

/// b's planes after a's.
inline std::vector<Plane> join(std::vector<Plane> a, const std::vector<Plane>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace colod::test
