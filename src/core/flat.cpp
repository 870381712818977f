// Based on: A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions",
// Information Processing Letters 9(5), 1979; D. Douglas, T. Peucker, "Algorithms for the reduction
// of the number of points required to represent a digitized line or its caricature", Cartographica
// 10(2), 1973.
// Differs: the same under both rules.
// Notation: none.
#include "flat.h"

#include <algorithm>

namespace colod {

double signed_area(const std::vector<Vec2>& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i)
    twice += cross(ring[i], ring[(i + 1) % ring.size()]);
  return twice / 2;
}

std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<Vec2> hull;
  if (points.empty()) return hull;
  for (const int pass : {0, 1}) {  // the lower side, then the upper one
    const std::size_t start = hull.size() + 1;
    for (const Vec2& p : points) {
      while (hull.size() > start &&
             !(cross(hull.back() - hull[hull.size() - 2], p - hull.back()) > 0))
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    if (pass == 0) std::reverse(points.begin(), points.end());
  }
  return hull;
}

bool covers(const Outline& outline, const Vec3& normal, const Vec3& x) {
  const std::vector<Vec3>& v = outline.vertices;
  return std::any_of(outline.triangles.begin(), outline.triangles.end(), [&](const Face& f) {
    for (int c = 0; c < 3; ++c)
      if ((v[f[(c + 1) % 3]] - v[f[c]]).cross(x - v[f[c]]).dot(normal) < 0) return false;
    return true;
  });
}

bool covers(const std::array<Vec3, 3>& triangle, const Vec3& normal, const Vec3& x) {
  int left = 0, right = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec3& from = triangle[k];
    const double side = (triangle[(k + 1) % 3] - from).cross(x - from).dot(normal);
    left += side >= 0, right += side <= 0;
  }
  return left == 3 || right == 3;
}

Mesh outline_soup(const std::vector<Plane>& planes, std::vector<int>* plane_of_triangle) {
  Mesh soup;
  if (plane_of_triangle) plane_of_triangle->clear();
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const Outline& outline = planes[p].outline;
    const int first = static_cast<int>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), outline.vertices.begin(), outline.vertices.end());
    for (const Face& f : outline.triangles) {
      soup.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
      if (plane_of_triangle) plane_of_triangle->push_back(static_cast<int>(p));
    }
  }
  return soup;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

double upper_median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace colod
