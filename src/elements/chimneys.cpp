// Based on: elements.cpp.
// Differs: –
// Notation: –
#include "chimneys.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "parameters.h"

namespace colod::elements {
namespace {

using namespace parameters::elements::chimneys;

/// Two walls that look away from each other, and what else of a chimney is seen.
struct Pair {
  const Panel *a, *b;
  Vec3 side;            ///< along both
  Range thick, across;  ///< along a->out; along side
  Range height;
  const Panel* top = nullptr;
  bool has_low_side = false, has_high_side = false;  ///< walls across, where `across` ends
};

std::optional<Pair> pair_of(const Panel& a, const Panel& b) {
  if (a.out.dot(b.out) > -kAlike) return std::nullopt;
  const double apart = a.at(a.out) - b.at(a.out);
  if (apart < kLeastChimney || apart > kMostChimney) return std::nullopt;
  const Vec3 side = beside(a.out);
  Pair pair{&a, &b, side, {b.at(a.out), a.at(a.out)}, a.along(side), a.height()};
  const Range other = b.along(side);
  if (overlap(pair.across, other) < 0.6 * std::min(pair.across.length(), other.length()) ||
      std::max(pair.across.length(), other.length()) > kMostChimney ||
      overlap(a.height(), b.height()) < 0.4)
    return std::nullopt;
  pair.across.extend(other);
  pair.height.extend(b.height());
  return pair;
}

Region box_of(const Pair& pair) {
  return {{pair.a->plane->normal, pair.a->plane->offset},
          {pair.b->plane->normal, pair.b->plane->offset},
          {pair.side, pair.across.high},
          {-pair.side, -pair.across.low},
          {Vec3::UnitZ(), pair.height.high},
          {-Vec3::UnitZ(), -pair.height.low}};
}

void look_around(const std::vector<Panel>& panels, Pair& pair) {
  Region grown = box_of(pair);
  for (HalfSpace& h : grown) h.offset += 0.2;
  for (const Panel& p : panels) {
    if (!reaches_into(p, grown)) continue;
    if (p.plane->normal.z() > 0.3 && p.box.max.z() > pair.height.high - 0.5) pair.top = &p;
    if (!p.is_wall) continue;
    pair.has_low_side |= p.out.dot(-pair.side) > kAlike;
    pair.has_high_side |= p.out.dot(pair.side) > kAlike;
  }
}

/// Without a top. With a level one, a side may lack all the same: a slope is a dormer's, and behind
/// a bay's and a dormer's open side is a room.
bool is_chimney(const std::vector<Panel>& panels, const Pair& pair) {
  if (!pair.top) return true;
  if (!pair.top->is_floor || pair.has_low_side == pair.has_high_side) return false;
  const double beyond = pair.has_high_side ? pair.across.low - kReach : pair.across.high + kReach;
  return !is_room(panels, 0.5 * (pair.thick.low + pair.thick.high) * pair.a->out +
                              beyond * pair.side +
                              0.5 * (pair.height.low + pair.height.high) * Vec3::UnitZ());
}

Element describe(const Pair& pair) {
  const Vec3 &out = pair.a->out, &side = pair.side;
  const auto& [low, high] = pair.height;
  Element chimney{.kind = ElementKind::kChimney, .planes = {pair.a->id, pair.b->id}};
  chimney.solid = box_of(pair);
  if (!pair.top) chimney.rims.push_back(level_rim(1, high, out, pair.thick, side, pair.across));
  chimney.rims.push_back(level_rim(-1, low, out, pair.thick, side, pair.across));
  for (const bool is_high : {false, true}) {
    if (is_high ? pair.has_high_side : pair.has_low_side) continue;
    const Vec3 to = is_high ? side : Vec3(-side);
    const Range width =
        beside(to).dot(out) > 0 ? pair.thick : Range{-pair.thick.high, -pair.thick.low};
    chimney.rims.push_back(
        upright_rim(to, is_high ? pair.across.high : -pair.across.low, width, pair.height));
  }
  return chimney;
}

std::optional<Element> chimney_between(const std::vector<Panel>& panels, const Panel& a,
                                       const Panel& b) {
  std::optional<Pair> pair = pair_of(a, b);
  if (!pair) return std::nullopt;
  look_around(panels, *pair);
  return is_chimney(panels, *pair) ? std::optional(describe(*pair)) : std::nullopt;
}

/// Two walls around a corner, where the scan shows no more of a chimney: each is as wide as the
/// other side is deep.
std::optional<Element> chimney_at_corner(const std::vector<Panel>& panels, const Panel& a,
                                         const Panel& b) {
  if (std::abs(a.out.dot(b.out)) > 0.3) return std::nullopt;
  const Range depth_a = b.along(a.out), depth_b = a.along(b.out);
  for (const Range& r : {depth_a, depth_b})
    if (r.length() < kLeastChimney || r.length() > kMostCorner) return std::nullopt;
  if (std::abs(depth_a.high - a.at(a.out)) > kTouch ||
      std::abs(depth_b.high - b.at(b.out)) > kTouch)
    return std::nullopt;
  const double common = overlap(a.height(), b.height());
  if (common < 0.5 || common < 0.6 * std::min(a.height().length(), b.height().length()))
    return std::nullopt;
  Range height = a.height();
  height.extend(b.height());
  Element chimney{.kind = ElementKind::kChimney, .planes = {a.id, b.id}};
  chimney.solid = {{a.plane->normal, a.plane->offset},
                   {b.plane->normal, b.plane->offset},
                   {-a.out, -depth_a.low},
                   {-b.out, -depth_b.low},
                   {Vec3::UnitZ(), height.high},
                   {-Vec3::UnitZ(), -height.low}};
  Region grown = chimney.solid;
  for (HalfSpace& h : grown) h.offset += 0.2;
  for (const Panel& p : panels)
    if (p.id != a.id && p.id != b.id && (p.is_wall || p.plane->normal.z() > 0.3) &&
        p.box.max.z() > height.high - 0.5 && reaches_into(p, grown))
      return std::nullopt;
  chimney.rims.push_back(level_rim(1, height.high, a.out, depth_a, b.out, depth_b));
  chimney.rims.push_back(level_rim(-1, height.low, a.out, depth_a, b.out, depth_b));
  for (const bool is_a : {true, false}) {
    const Vec3 out = is_a ? Vec3(-a.out) : Vec3(-b.out);
    const Range& own = is_a ? depth_a : depth_b;
    const Range& other = is_a ? depth_b : depth_a;
    const bool is_along = beside(out).dot(is_a ? b.out : a.out) > 0;
    chimney.rims.push_back(
        upright_rim(out, -own.low, is_along ? other : Range{-other.high, -other.low}, height));
  }
  return chimney;
}

}  // namespace

std::vector<Element> find_chimneys(const std::vector<Panel>& panels) {
  std::vector<Element> found;
  for (const auto& [a, b] : near_pairs(small_walls(panels), kMostChimney))
    if (auto element = chimney_between(panels, *a, *b)) found.push_back(std::move(*element));
  return found;
}

std::vector<Element> find_chimney_corners(const std::vector<Panel>& panels) {
  std::vector<Element> found;
  for (const auto& [a, b] : near_pairs(small_walls(panels), kTouch))
    if (auto element = chimney_at_corner(panels, *a, *b)) found.push_back(std::move(*element));
  return found;
}

}  // namespace colod::elements

namespace colod {

bool is_whole_chimney(const Planes& planes, const std::vector<int>& which) {
  using namespace elements;
  const std::vector<Panel> panels = panels_of(planes, which);
  std::map<int, double> paired;  // area of walls that have an opposite one
  std::vector<Vec3> ways;
  double area = 0;
  for (const Panel& p : panels) {
    area += p.plane->area;
    if (p.box.min.z() < planes.box.min.z() + kLeastFoot) return false;
  }
  for (const auto& [a, b] : near_pairs(walls_up_to(panels, kMostCheek), kMostChimney)) {
    if (!pair_of(*a, *b)) continue;
    paired[a->id] = a->plane->area, paired[b->id] = b->plane->area;
    ways.push_back(a->out);
  }
  const bool is_around = std::any_of(ways.begin(), ways.end(), [&](const Vec3& way) {
    return std::abs(way.dot(ways.front())) < kAcross;
  });
  double walls = 0;
  for (const auto& [id, its] : paired) walls += its;
  return is_around && walls >= kLeastWalls * area;
}

}  // namespace colod
