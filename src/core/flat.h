// What several rooms ask of points and outlines in a plane.
#pragma once

#include <vector>

#include "geometry.h"

namespace colod {

/// z of the cross product: twice the area of the triangle, positive when b is to the left of a.
inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The corners of the convex hull, counter-clockwise, without points on its sides. Fewer than three
/// different points, or all on one line: fewer than three corners. O(n log n), Andrew's monotone
/// chain.
std::vector<Vec2> convex_hull(std::vector<Vec2> points);

/// Whether the outline covers x, which is on its plane; borders count. `normal` is the plane's.
bool covers(const Outline& outline, const Vec3& normal, const Vec3& x);

/// All outlines' triangles in one soup, in the planes' order; `plane_of_triangle`, when asked for,
/// receives the plane of each.
Mesh outline_soup(const std::vector<Plane>& planes, std::vector<int>* plane_of_triangle = nullptr);

/// The middle value, of an even number the mean of both; of none 0.
double median(std::vector<double> values);

}  // namespace colod
