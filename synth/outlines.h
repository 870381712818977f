// Inside the synth room: footprints as polygons, and what stands over them.
#pragma once

#include "solid.h"

namespace colod::synth {

std::vector<Vec3> reversed(std::vector<Vec3> corners);
/// An axis-parallel polygon moved outwards; a clockwise one, a court's, into the court.
std::vector<Vec2> offset(const std::vector<Vec2>& polygon, double by);
std::vector<Vec3> lifted(const std::vector<Vec2>& polygon, double z);
std::vector<Vec2> rectangle(double x0, double y0, double x1, double y1);
/// Unit, to the right of an edge from a to b: out of a counter-clockwise polygon.
Vec2 outward(const Vec2& a, const Vec2& b);

/// Ground that slopes evenly.
struct Ground {
  Vec2 slope = Vec2::Zero();  ///< rise over run
  double height = 0;          ///< at the origin [m]

  double at(const Vec2& p) const { return height + slope.dot(p); }
  Vec3 on(const Vec2& p) const { return {p.x(), p.y(), at(p)}; }
};

/// A footprint with a court or none.
struct Plan {
  std::vector<Vec2> outer;  ///< counter-clockwise
  std::vector<Vec2> court;  ///< clockwise; empty: none

  std::vector<std::vector<Vec2>> rings() const;
  Plan grown(double by) const {
    return {offset(outer, by), court.empty() ? court : offset(court, by)};
  }
  bool has_court() const { return !court.empty(); }
};

/// A horizontal facet over the plan, seen from above or below.
int add_level(Solid& solid, const Plan& plan, double z, bool is_above, int object);
/// What of `outer` lies beyond `inner`.
void add_rim(Solid& solid, const Plan& outer, const Plan& inner, double z, bool is_above,
             int object);

}  // namespace colod::synth
