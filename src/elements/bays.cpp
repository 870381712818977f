// Based on: elements.cpp.
// Differs: a bay is closed, but where its back is open to the room behind, rays give one of its
// walls or
//   its top to the body. Two walls that look away from each other, a front between their ends and a
//   facade at their feet tell it.
// Notation: –
#include "bays.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "parameters.h"

namespace colod::elements {
namespace {

using namespace parameters::elements::bays;

/// The sides, and the direction that the bay looks to.
struct Sides {
  const Panel *a, *b;
  Vec3 forward, across;
  Range depth, width, height;
};

std::optional<Sides> sides_of(const Panel& a, const Panel& b) {
  if (a.out.dot(b.out) > kAway) return std::nullopt;
  const Vec3 across = (a.out - b.out).normalized();
  Sides s{&a, &b, beside(across), across, {}, {}, {}};
  if ((a.out + b.out).dot(s.forward) < 0) s.forward = -s.forward;
  s.width = {b.at(across), a.at(across)};
  if (s.width.high - s.width.low < kLeastWidthOfBay || s.width.length() > kMostWidthOfBay)
    return std::nullopt;
  const Range da = a.along(s.forward), db = b.along(s.forward);
  if (overlap(da, db) < 0.7 * std::max(da.length(), db.length()) ||
      overlap(da, db) < kLeastDepthOfBay || std::max(da.length(), db.length()) > kMostDepthOfBay)
    return std::nullopt;
  if (overlap(a.height(), b.height()) < kLeastHeight) return std::nullopt;
  s.depth = da, s.height = a.height();
  s.depth.extend(db), s.height.extend(b.height());
  return s;
}

/// A wall that looks forward at that depth and lies beside the bay, or spans it.
const Panel* wall_at(const std::vector<Panel>& panels, const Sides& s, const Vec3& forward,
                     double depth, double least_area, double most_area) {
  const Panel* best = nullptr;
  for (const Panel& p : panels)
    if (p.is_wall && p.out.dot(forward) > kAlike && p.plane->area >= least_area &&
        p.plane->area <= most_area && std::abs(p.at(forward) - depth) < kReach &&
        overlap(p.along(s.across), s.width) > -0.5 && overlap(p.height(), s.height) > 0.5 &&
        (!best || p.plane->area > best->plane->area))
      best = &p;
  return best;
}

std::optional<Element> bay_between(const std::vector<Panel>& panels, const Panel& a,
                                   const Panel& b) {
  const std::optional<Sides> found = sides_of(a, b);
  if (!found) return std::nullopt;
  const Sides& s = *found;
  for (const double sign : {1.0, -1.0}) {
    const Vec3 forward = sign * s.forward;
    if (std::abs(a.out.dot(forward)) > 0.3 && a.out.dot(forward) < 0) continue;  // splays inward
    const double mouth = sign > 0 ? s.depth.high : -s.depth.low;
    const double foot = sign > 0 ? s.depth.low : -s.depth.high;
    const Panel* front = wall_at(panels, s, forward, mouth, 1, kMostFront);
    if (!front || overlap(front->along(s.across), s.width) < 0.4 * s.width.length() ||
        front->along(s.across).length() > 1.2 * s.width.length())
      continue;
    const double least = 1.5 * std::max(front->plane->area, a.plane->area + b.plane->area);
    if (!wall_at(panels, s, forward, foot, least, std::numeric_limits<double>::infinity()))
      continue;
    Element bay{.kind = ElementKind::kBay, .planes = {a.id, b.id}};
    bay.is_whole = true;
    bay.solid = {{a.plane->normal, a.plane->offset},
                 {b.plane->normal, b.plane->offset},
                 {forward, mouth},
                 {-forward, -foot - 0.1},
                 {Vec3::UnitZ(), s.height.high},
                 {-Vec3::UnitZ(), -s.height.low}};
    Region grown = bay.solid;
    for (HalfSpace& h : grown) h.offset += 0.25;
    grown[3].offset = -foot - 0.15;
    for (const Panel& p : panels) {
      if (p.plane->area > kMostFront) continue;
      const auto in = std::count_if(p.points.begin(), p.points.end(),
                                    [&](const Vec3& x) { return contains(grown, x); });
      if (contains(grown, p.plane->centroid) && 2 * in >= std::ssize(p.points))
        bay.planes.push_back(p.id);
    }
    return bay;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Element> find_bays(const std::vector<Panel>& panels) {
  std::vector<Element> found;
  for (const auto& [a, b] : near_pairs(walls_up_to(panels, kMostCheek), kMostWidth))
    if (auto element = bay_between(panels, *a, *b)) found.push_back(std::move(*element));
  return found;
}

}  // namespace colod::elements
