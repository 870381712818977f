// *Based on:* nothing published; polygons moved by their own sides.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include "outlines.h"

#include <algorithm>

namespace colod::synth {

std::vector<Vec3> reversed(std::vector<Vec3> corners) {
  std::reverse(corners.begin(), corners.end());
  return corners;
}

std::vector<Vec2> offset(const std::vector<Vec2>& polygon, double by) {
  std::vector<Vec2> moved;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 before = (polygon[i] - polygon[(i + n - 1) % n]).normalized();
    const Vec2 after = (polygon[(i + 1) % n] - polygon[i]).normalized();
    const Vec2 out(before.y() + after.y(), -before.x() - after.x());
    moved.push_back(polygon[i] + by * out);
  }
  return moved;
}

std::vector<Vec3> lifted(const std::vector<Vec2>& polygon, double z) {
  std::vector<Vec3> corners;
  for (const Vec2& p : polygon) corners.emplace_back(p.x(), p.y(), z);
  return corners;
}

std::vector<Vec2> rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

Vec2 outward(const Vec2& a, const Vec2& b) {
  const Vec2 along = (b - a).normalized();
  return {along.y(), -along.x()};
}

std::vector<std::vector<Vec2>> Plan::rings() const {
  if (court.empty()) return {outer};
  return {outer, court};
}

namespace {

/// `ring` becomes a hole of the level, whichever way it turns.
void cut_ring(Solid& solid, int level, const std::vector<Vec2>& ring, double z) {
  Ring hole;
  for (const Vec2& p : ring) hole.push_back(solid.facet(level).project({p.x(), p.y(), z}));
  if (signed_area(hole) < 0) std::reverse(hole.begin(), hole.end());
  solid.cut(level, hole);
}

int add_face(Solid& solid, const std::vector<Vec2>& ring, double z, bool is_above, int object) {
  const auto corners = lifted(ring, z);
  return solid.add(is_above ? corners : reversed(corners), object);
}

}  // namespace

int add_level(Solid& solid, const Plan& plan, double z, bool is_above, int object) {
  const int level = add_face(solid, plan.outer, z, is_above, object);
  if (plan.has_court()) cut_ring(solid, level, plan.court, z);
  return level;
}

void add_rim(Solid& solid, const Plan& outer, const Plan& inner, double z, bool is_above,
             int object) {
  cut_ring(solid, add_face(solid, outer.outer, z, is_above, object), inner.outer, z);
  if (!outer.has_court()) return;
  // The court's ring turns the other way: what is seen from above has its corners reversed.
  const int rim = add_face(solid, inner.court, z, !is_above, object);
  cut_ring(solid, rim, outer.court, z);
}

}  // namespace colod::synth
