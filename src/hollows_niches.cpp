// Based on: hollows.cpp.
// Differs: –
// Notation: –
#include <algorithm>
#include <cmath>

#include "hollows_parts.h"

namespace colod::hollows {
namespace {

constexpr double kLeastDepth = 0.5, kMostDepth = 4;  // metres of a niche
constexpr double kLeastWidth = 0.8;
constexpr double kAbove = 0.5;  // metres above a niche: where a room must be

/// Between two walls that face each other.
struct Gap {
  const Panel *left, *right;
  Vec3 across, forward;  ///< from left to right; out of the niche
  Range width, depth, height;
};

std::optional<Gap> gap_between(const Panel& a, const Panel& b) {
  if (a.out.dot(b.out) > -kAlike) return std::nullopt;
  Gap gap{&a, &b, a.out, beside(a.out), {a.at(a.out), b.at(a.out)}, {}, {}};
  if (gap.width.high - gap.width.low < kLeastWidth || gap.width.length() > kMostWidth)
    return std::nullopt;
  const Range da = a.along(gap.forward), db = b.along(gap.forward);
  const double common = overlap(da, db);
  if (common < 0.6 * std::min(da.length(), db.length()) || common < kLeastDepth ||
      std::max(da.length(), db.length()) > kMostDepth)
    return std::nullopt;
  const double rise = overlap(a.height(), b.height());
  if (rise < 0.8 || rise < 0.5 * std::min(a.height().length(), b.height().length()))
    return std::nullopt;
  gap.depth = {0.5 * (da.low + db.low), 0.5 * (da.high + db.high)};
  gap.height = {0.5 * (a.height().low + b.height().low), 0.5 * (a.height().high + b.height().high)};
  return gap;
}

/// Share of the gap's width that walls at its back take, which look out of it.
double back_share(const std::vector<Panel>& panels, const Gap& gap, const Vec3& forward,
                  double back, double most_area, std::vector<const Panel*>& found) {
  double sum = 0;
  for (const Panel& p : panels) {
    if (!p.is_wall || p.out.dot(forward) < kAlike || p.plane->area > most_area) continue;
    if (std::abs(p.at(forward) - back) > kReach) continue;
    const double rise = overlap(p.height(), gap.height);
    if (rise < 0.4 * gap.height.length()) continue;
    const double share = overlap(p.along(gap.across), gap.width) / gap.width.length();
    if (share <= 0.05) continue;
    sum += share, found.push_back(&p);
  }
  return sum;
}

/// A wall larger than a niche's cheeks that looks the same way as the niche and lies in its mouth.
bool is_behind_facade(const std::vector<Panel>& panels, const Gap& gap, const Vec3& forward,
                      double mouth, double least_area) {
  for (const Panel& p : panels)
    if (p.is_wall && p.out.dot(forward) > kAlike && p.plane->area >= least_area &&
        std::abs(p.at(forward) - mouth) < kReach && overlap(p.along(gap.across), gap.width) > -1 &&
        overlap(p.height(), gap.height) > -1.5)
      return true;
  return false;
}

std::optional<Hollow> niche_in(const std::vector<Panel>& panels, const Gap& gap, double largest) {
  const double most_back = std::min(30.0, 0.3 * largest);
  for (const double sign : {1.0, -1.0}) {
    const Vec3 forward = sign * gap.forward;
    const double back = sign > 0 ? gap.depth.low : -gap.depth.high;
    const double mouth = sign > 0 ? gap.depth.high : -gap.depth.low;
    std::vector<const Panel*> backs;
    const double closed = back_share(panels, gap, forward, back, most_back, backs);
    const Panel* ceiling = nullptr;
    const Panel* floor = nullptr;
    for (const Panel& p : panels) {
      if (!p.is_ceiling && !p.is_floor) continue;
      if (p.plane->area > most_back) continue;
      if (overlap(p.along(gap.across), gap.width) < 0.6 * gap.width.length() ||
          p.along(gap.across).length() > 1.3 * gap.width.length())
        continue;
      if (overlap(p.along(gap.forward), gap.depth) < 0.5 * gap.depth.length()) continue;
      const double at = p.is_ceiling ? gap.height.high : gap.height.low;
      if (std::abs(p.plane->centroid.z() - at) > 0.5) continue;
      const Panel*& kept = p.is_ceiling ? ceiling : floor;
      if (!kept || p.plane->area > kept->plane->area) kept = &p;
    }
    if (closed < 0.5 && !ceiling) continue;
    const double cheeks = std::max(gap.left->plane->area, gap.right->plane->area);
    if (!is_behind_facade(panels, gap, forward, mouth, std::max(2 * cheeks, 10.0))) continue;

    Range height = gap.height;
    if (ceiling) height.high = ceiling->plane->centroid.z();
    if (floor) height.low = floor->plane->centroid.z();
    const Vec3 middle = 0.5 * (gap.width.low + gap.width.high) * gap.across +
                        0.5 * (back + mouth) * forward +
                        0.5 * (gap.height.low + gap.height.high) * Vec3::UnitZ();
    const double above = 0.5 * gap.height.length() + kAbove;
    if (is_room(panels, middle)) continue;  // walls of noise
    // Without a ceiling that is seen it may be a gap between what stands on a roof.
    if (!ceiling && !is_room(panels, middle + above * Vec3::UnitZ())) continue;
    const auto largest_back = std::max_element(backs.begin(), backs.end(), [](auto* x, auto* y) {
      return x->plane->area < y->plane->area;
    });
    const Panel* closing = backs.empty() ? nullptr : *largest_back;
    const double behind = closing ? closing->at(forward) : back;
    Hollow niche{.kind = Hollow::Kind::kNiche, .planes = {gap.left->id, gap.right->id}};
    niche.air = {{-gap.left->plane->normal, -gap.left->plane->offset},
                 {-gap.right->plane->normal, -gap.right->plane->offset},
                 {-forward, -behind + 0.02},
                 {forward, mouth + 0.15},
                 {Vec3::UnitZ(), height.high + 0.02},
                 {-Vec3::UnitZ(), -height.low + 0.02}};
    const Range depth = {behind, mouth};
    if (!ceiling)
      niche.rims.push_back(level_rim(-1, height.high, gap.across, gap.width, forward, depth));
    if (!floor)
      niche.rims.push_back(level_rim(1, height.low, gap.across, gap.width, forward, depth));
    if (closed < 0.5) {
      const Range across =
          forward.dot(gap.forward) > 0 ? Range{-gap.width.high, -gap.width.low} : gap.width;
      niche.rims.push_back(upright_rim(forward, behind, across, height));
    }
    if (ceiling) niche.planes.push_back(ceiling->id);
    if (floor) niche.planes.push_back(floor->id);
    niche.bounds = niche.planes;
    if (closing) niche.bounds.push_back(closing->id);
    Region grown = niche.air;
    for (HalfSpace& h : grown) h.offset += 0.25;
    for (const Panel& p : panels) {
      if (p.plane->area > most_back) continue;
      std::size_t in = 0;
      for (const Vec3& v : p.plane->outline.vertices) in += contains(grown, v);
      if (contains(grown, p.plane->centroid) &&
          static_cast<double>(in) > 0.7 * static_cast<double>(p.plane->outline.vertices.size()))
        niche.planes.push_back(p.id);
    }
    return niche;
  }
  return std::nullopt;
}
}  // namespace

std::optional<Hollow> niche_between(const std::vector<Panel>& panels, const Panel& a,
                                    const Panel& b, double largest_area) {
  const auto gap = gap_between(a, b);
  return gap ? niche_in(panels, *gap, largest_area) : std::nullopt;
}

}  // namespace colod::hollows
