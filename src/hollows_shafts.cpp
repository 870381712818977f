// Based on: hollows.cpp.
// Differs: –
// Notation: –
#include <algorithm>
#include <cmath>

#include "hollows_parts.h"

namespace colod::hollows {
namespace {

constexpr double kLeastShaft = 0.25;  // metres between a shaft's walls
constexpr double kMostCorner = 1.3;   // metres of a shaft of which only a corner is seen

}  // namespace

std::optional<Hollow> shaft_between(const std::vector<Panel>& panels, const Panel& a,
                                    const Panel& b) {
  if (a.out.dot(b.out) > -kAlike) return std::nullopt;
  const double apart = a.at(a.out) - b.at(a.out);
  if (apart < kLeastShaft || apart > kMostShaft) return std::nullopt;
  const Vec3 side = beside(a.out);
  Range across = a.along(side);
  const Range other = b.along(side);
  if (overlap(across, other) < 0.6 * std::min(across.length(), other.length()) ||
      std::max(across.length(), other.length()) > kMostShaft)
    return std::nullopt;
  if (overlap(a.height(), b.height()) < 0.4) return std::nullopt;
  across.extend(other);
  Range height = a.height();
  height.extend(b.height());
  const Range thick = {b.at(a.out), a.at(a.out)};
  Hollow shaft{.kind = Hollow::Kind::kShaft, .planes = {a.id, b.id}};
  shaft.solid = {{a.plane->normal, a.plane->offset},
                 {b.plane->normal, b.plane->offset},
                 {side, across.high},
                 {-side, -across.low},
                 {Vec3::UnitZ(), height.high},
                 {-Vec3::UnitZ(), -height.low}};
  Region grown = shaft.solid;
  for (HalfSpace& h : grown) h.offset += 0.2;
  const Panel* top = nullptr;
  bool has_side[2] = {false, false};
  for (const Panel& p : panels) {
    if (!reaches_into(p, grown)) continue;
    if (p.plane->normal.z() > 0.3 && p.box.max.z() > height.high - 0.5) top = &p;
    if (!p.is_wall) continue;
    for (const int k : {0, 1})
      if (p.out.dot(k ? side : Vec3(-side)) > kAlike) has_side[k] = true;
  }
  if (top) {  // one side may lack all the same, but a slope is a dormer's, and a room behind a
              // bay's
    if (!top->is_floor || has_side[0] == has_side[1]) return std::nullopt;
    const double beyond = has_side[1] ? across.low - kReach : across.high + kReach;
    if (is_room(panels, 0.5 * (thick.low + thick.high) * a.out + beyond * side +
                            0.5 * (height.low + height.high) * Vec3::UnitZ()))
      return std::nullopt;
  }
  if (!top) shaft.rims.push_back(level_rim(1, height.high, a.out, thick, side, across));
  shaft.rims.push_back(level_rim(-1, height.low, a.out, thick, side, across));
  for (const int k : {0, 1}) {
    if (has_side[k]) continue;
    const Vec3 out = k ? side : Vec3(-side);
    const Range width = beside(out).dot(a.out) > 0 ? thick : Range{-thick.high, -thick.low};
    shaft.rims.push_back(upright_rim(out, k ? across.high : -across.low, width, height));
  }
  return shaft;
}

/// Two walls around a corner, where the scan shows no more of a shaft: each is as wide as the other
/// side is deep.
std::optional<Hollow> shaft_at_corner(const std::vector<Panel>& panels, const Panel& a,
                                      const Panel& b) {
  if (std::abs(a.out.dot(b.out)) > 0.3) return std::nullopt;
  const Range depth_a = b.along(a.out), depth_b = a.along(b.out);
  for (const Range& r : {depth_a, depth_b})
    if (r.length() < kLeastShaft || r.length() > kMostCorner) return std::nullopt;
  if (std::abs(depth_a.high - a.at(a.out)) > kTouch ||
      std::abs(depth_b.high - b.at(b.out)) > kTouch)
    return std::nullopt;
  const double common = overlap(a.height(), b.height());
  if (common < 0.5 || common < 0.6 * std::min(a.height().length(), b.height().length()))
    return std::nullopt;
  Range height = a.height();
  height.extend(b.height());
  Hollow shaft{.kind = Hollow::Kind::kShaft, .planes = {a.id, b.id}};
  shaft.solid = {{a.plane->normal, a.plane->offset},
                 {b.plane->normal, b.plane->offset},
                 {-a.out, -depth_a.low},
                 {-b.out, -depth_b.low},
                 {Vec3::UnitZ(), height.high},
                 {-Vec3::UnitZ(), -height.low}};
  Region grown = shaft.solid;
  for (HalfSpace& h : grown) h.offset += 0.2;
  for (const Panel& p : panels)
    if (p.id != a.id && p.id != b.id && (p.is_wall || p.plane->normal.z() > 0.3) &&
        p.box.max.z() > height.high - 0.5 && reaches_into(p, grown))
      return std::nullopt;
  shaft.rims.push_back(level_rim(1, height.high, a.out, depth_a, b.out, depth_b));
  shaft.rims.push_back(level_rim(-1, height.low, a.out, depth_a, b.out, depth_b));
  for (const bool is_a : {true, false}) {
    const Vec3 out = is_a ? Vec3(-a.out) : Vec3(-b.out);
    const Range& own = is_a ? depth_a : depth_b;
    const Range& other = is_a ? depth_b : depth_a;
    const bool is_along = beside(out).dot(is_a ? b.out : a.out) > 0;
    shaft.rims.push_back(
        upright_rim(out, -own.low, is_along ? other : Range{-other.high, -other.low}, height));
  }
  return shaft;
}

}  // namespace colod::hollows
