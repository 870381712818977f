// Based on: elements.cpp.
// Differs: –
// Notation: –
#include "loggias.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "parameters.h"

namespace colod::elements {
namespace {

using namespace parameters::elements::loggias;

/// Between two walls that face each other.
struct Gap {
  const Panel *left, *right;
  Vec3 across, forward;  ///< from left to right; out of the loggia
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

/// A wall larger than a loggia's cheeks that looks the same way as the loggia and lies in its
/// mouth.
bool is_behind_facade(const std::vector<Panel>& panels, const Gap& gap, const Vec3& forward,
                      double mouth, double least_area) {
  for (const Panel& p : panels)
    if (p.is_wall && p.out.dot(forward) > kAlike && p.plane->area >= least_area &&
        std::abs(p.at(forward) - mouth) < kReach && overlap(p.along(gap.across), gap.width) > -1 &&
        overlap(p.height(), gap.height) > -1.5)
      return true;
  return false;
}

/// What planes form a loggia.
struct Loggia {
  Vec3 forward;
  double most_area;  ///< of a plane of it
  Range depth;       ///< along forward
  Range height;
  double closed;  ///< share of its back that walls take
  const Panel *back = nullptr, *ceiling = nullptr, *floor = nullptr;  ///< the largest of each

  /// The back's line may lie a little off the cheeks' ends.
  double behind() const { return back ? back->at(forward) : depth.low; }
};

/// The largest ceiling (or floor) over most of a gap.
const Panel* level_of(const std::vector<Panel>& panels, const Gap& gap, double most_area,
                      bool Panel::*is_level, double z) {
  const Panel* largest = nullptr;
  for (const Panel& p : panels) {
    if (!(p.*is_level) || p.plane->area > most_area) continue;
    const Range across = p.along(gap.across);
    if (overlap(across, gap.width) < 0.6 * gap.width.length() ||
        across.length() > 1.3 * gap.width.length())
      continue;
    if (overlap(p.along(gap.forward), gap.depth) < 0.5 * gap.depth.length()) continue;
    if (std::abs(p.plane->centroid.z() - z) > 0.5) continue;
    if (!largest || p.plane->area > largest->plane->area) largest = &p;
  }
  return largest;
}

/// Air in it, and, without a ceiling that is seen, a room above: else walls of noise, or a gap
/// between what stands on a roof.
bool is_open(const std::vector<Panel>& panels, const Gap& gap, const Loggia& loggia) {
  const Vec3 middle = 0.5 * (gap.width.low + gap.width.high) * gap.across +
                      0.5 * (loggia.depth.low + loggia.depth.high) * loggia.forward +
                      0.5 * (gap.height.low + gap.height.high) * Vec3::UnitZ();
  if (is_room(panels, middle)) return false;
  const double above = 0.5 * gap.height.length() + kAbove;
  return loggia.ceiling || is_room(panels, middle + above * Vec3::UnitZ());
}

/// `sign` 1: that opens along gap.forward, −1: against it.
std::optional<Loggia> find_loggia(const std::vector<Panel>& panels, const Gap& gap, double sign,
                                  double largest_area) {
  Loggia loggia{sign * gap.forward, std::min(30.0, 0.3 * largest_area),
                sign > 0 ? gap.depth : Range{-gap.depth.high, -gap.depth.low}, gap.height, 0};
  std::vector<const Panel*> backs;
  loggia.closed =
      back_share(panels, gap, loggia.forward, loggia.depth.low, loggia.most_area, backs);
  loggia.ceiling = level_of(panels, gap, loggia.most_area, &Panel::is_ceiling, gap.height.high);
  if (loggia.closed < 0.5 && !loggia.ceiling) return std::nullopt;
  const double cheeks = std::max(gap.left->plane->area, gap.right->plane->area);
  if (!is_behind_facade(panels, gap, loggia.forward, loggia.depth.high,
                        std::max(2 * cheeks, 10.0)) ||
      !is_open(panels, gap, loggia))
    return std::nullopt;
  loggia.floor = level_of(panels, gap, loggia.most_area, &Panel::is_floor, gap.height.low);
  if (loggia.ceiling) loggia.height.high = loggia.ceiling->plane->centroid.z();
  if (loggia.floor) loggia.height.low = loggia.floor->plane->centroid.z();
  const auto by_area = [](auto* x, auto* y) { return x->plane->area < y->plane->area; };
  if (!backs.empty()) loggia.back = *std::max_element(backs.begin(), backs.end(), by_area);
  return loggia;
}

/// The faces that no plane shows.
std::vector<Element::Rim> rims_of_loggia(const Gap& gap, const Loggia& loggia) {
  std::vector<Element::Rim> rims;
  const Range depth = {loggia.behind(), loggia.depth.high};
  if (!loggia.ceiling)
    rims.push_back(level_rim(-1, loggia.height.high, gap.across, gap.width, loggia.forward, depth));
  if (!loggia.floor)
    rims.push_back(level_rim(1, loggia.height.low, gap.across, gap.width, loggia.forward, depth));
  if (loggia.closed < 0.5) {
    const Range across =
        loggia.forward.dot(gap.forward) > 0 ? Range{-gap.width.high, -gap.width.low} : gap.width;
    rims.push_back(upright_rim(loggia.forward, loggia.behind(), across, loggia.height));
  }
  return rims;
}

/// Small planes that lie in a region or a little around it.
std::vector<int> planes_in(const std::vector<Panel>& panels, Region region, double most_area) {
  for (HalfSpace& h : region) h.offset += 0.25;
  std::vector<int> planes;
  for (const Panel& p : panels) {
    if (p.plane->area > most_area || !contains(region, p.plane->centroid)) continue;
    const std::vector<Vec3>& vertices = p.plane->outline.vertices;
    const auto in = std::count_if(vertices.begin(), vertices.end(),
                                  [&](const Vec3& v) { return contains(region, v); });
    if (static_cast<double>(in) > 0.7 * static_cast<double>(vertices.size()))
      planes.push_back(p.id);
  }
  return planes;
}

Element describe(const std::vector<Panel>& panels, const Gap& gap, const Loggia& loggia) {
  Element element{.kind = ElementKind::kLoggia, .planes = {gap.left->id, gap.right->id}};
  element.air = {{-gap.left->plane->normal, -gap.left->plane->offset},
                 {-gap.right->plane->normal, -gap.right->plane->offset},
                 {-loggia.forward, -loggia.behind() + 0.02},
                 {loggia.forward, loggia.depth.high + 0.15},
                 {Vec3::UnitZ(), loggia.height.high + 0.02},
                 {-Vec3::UnitZ(), -loggia.height.low + 0.02}};
  element.rims = rims_of_loggia(gap, loggia);
  if (loggia.ceiling) element.planes.push_back(loggia.ceiling->id);
  if (loggia.floor) element.planes.push_back(loggia.floor->id);
  element.bounds = element.planes;
  if (loggia.back) element.bounds.push_back(loggia.back->id);
  const std::vector<int> inside = planes_in(panels, element.air, loggia.most_area);
  element.planes.insert(element.planes.end(), inside.begin(), inside.end());
  return element;
}

std::optional<Element> loggia_between(const std::vector<Panel>& panels, const Panel& a,
                                      const Panel& b, double largest_area) {
  const std::optional<Gap> gap = gap_between(a, b);
  if (!gap) return std::nullopt;
  for (const double sign : {1.0, -1.0})
    if (const auto loggia = find_loggia(panels, *gap, sign, largest_area))
      return describe(panels, *gap, *loggia);
  return std::nullopt;
}

}  // namespace

std::vector<Element> find_loggias(const std::vector<Panel>& panels) {
  std::vector<Element> found;
  const double largest = largest_area(panels);
  for (const auto& [a, b] : near_pairs(small_walls(panels), kMostWidth))
    if (auto loggia = loggia_between(panels, *a, *b, largest)) found.push_back(std::move(*loggia));
  return found;
}

}  // namespace colod::elements
