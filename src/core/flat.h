// What several rooms ask of points and outlines in a plane.
#pragma once

#include <array>
#include <vector>

#include "geometry.h"

namespace colod {

/// z of the cross product: twice the area of the triangle, positive when b is to the left of a.
inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Of a closed ring: positive when it runs counter-clockwise.
double signed_area(const std::vector<Vec2>& ring);

/// The corners of the convex hull, counter-clockwise, without points on its sides. Fewer than three
/// different points, or all on one line: fewer than three corners. O(n log n), Andrew's monotone
/// chain.
std::vector<Vec2> convex_hull(std::vector<Vec2> points);

/// Whether the outline covers x, which is on its plane; borders count. `normal` is the plane's.
bool covers(const Outline& outline, const Vec3& normal, const Vec3& x);

/// Likewise for a triangle, whichever way it is wound.
bool covers(const std::array<Vec3, 3>& triangle, const Vec3& normal, const Vec3& x);

/// All outlines' triangles in one soup, in the planes' order; `plane_of_triangle`, when asked for,
/// receives the plane of each.
Mesh outline_soup(const std::vector<Plane>& planes, std::vector<int>* plane_of_triangle = nullptr);

/// The middle value, of an even number the mean of both; of none 0.
double median(std::vector<double> values);

/// The middle value, of an even number the larger one: a value that was measured; of none 0.
double upper_median(std::vector<double> values);

/// Douglas–Peucker: which places between `from` and `to` stay, rising, so that none of those that
/// go is farther than `tolerance` from the line between the kept ones around it. `distance(i, a,
/// b)` is that of place i from the line between a and b: to the line or to its piece between them,
/// in two dimensions or three.
template <typename Distance>
std::vector<int> corners_between(int from, int to, double tolerance, const Distance& distance) {
  std::vector<int> corners;
  std::vector<std::array<int, 2>> open = {{from, to}};  // the last begins where the kept ones end
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    double most = tolerance;
    int farthest = -1;
    for (int i = a + 1; i < b; ++i)
      if (const double d = distance(i, a, b); d > most) most = d, farthest = i;
    if (farthest < 0) {
      if (b != to) corners.push_back(b);
      continue;
    }
    open.push_back({farthest, b});
    open.push_back({a, farthest});
  }
  return corners;
}

}  // namespace colod
