// Based on: plane hygiene as measured in November 2026: an exact partition keeps its topology
// whatever the planes are, but only merged and aligned planes give clean cells.
// Differs: --rules robust only; the paper regularises nothing. A region is aligned only as far as
// it is off its own plane or the building's noise excuses: exact models keep their walls, which had
// moved by up to 4 mm. What noise tilts by some degrees and a much larger region passes through the
// middle of joins that one: it bent a facade on all layers. What looks opposite ways on one plane
// is one plane only where it is two sides of a sheet: a tower's wall above the gable that it stands
// before is not, and a plane that looks the wrong way hid gables and balconies of whole houses.
// Notation: n normal, d offset; family = wall directions that are parallel or orthogonal; azimuth =
// angle of a horizontal direction from x; tilt = angle of a normal from z. "Canonical" = the one of
// ±(n, d) whose first non-zero of (z, x, y) is positive.
#include "regularize.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "core/flat.h"
#include "growing.h"
#include "parameters.h"

namespace colod::regions {
namespace {

using namespace parameters::planes;

constexpr std::size_t kSheetSamples = 64;  // items at least that tell it, where there are so many

// --- merging -------------------------------------------------------------------------------------

Region joined(const Region& a, const Region& b) {
  Region r = a.area >= b.area ? a : b;
  const Region& other = a.area >= b.area ? b : a;
  r.items.insert(r.items.end(), other.items.begin(), other.items.end());
  r.moments.add(other.moments);
  r.area += other.area;
  return r;
}

/// Two regions that look opposite ways are sides of one sheet when they lie over each other. What
/// points of a cloud look away from is not known so well: there they always are.
bool is_sheet(const Items& items, const Region& a, const Region& b) {
  if (!items.is_mesh()) return true;
  const Region &large = a.area >= b.area ? a : b, &small = a.area >= b.area ? b : a;
  const auto is_covered = [&](const Vec3& x) {
    return std::any_of(large.items.begin(), large.items.end(), [&](int i) {
      std::array<Vec3, 3> corner;
      items.corners(i, corner);
      return covers(corner, large.normal, x);
    });
  };
  double covered = 0, total = 0;
  const std::size_t step = std::max<std::size_t>(1, small.items.size() / kSheetSamples);
  for (std::size_t k = 0; k < small.items.size(); k += step) {
    const int i = small.items[k];
    total += items.area[i];
    if (is_covered(items.center[i])) covered += items.area[i];
  }
  return covered >= kSheetShare * total;
}

/// What joining would cost (RMS over the limit, ≤ 1 is allowed); infinite when out of question.
double merge_cost(const Items& items, const Region& a, const Region& b, double distance,
                  const RuleSet& rules) {
  const double none = std::numeric_limits<double>::infinity();
  const double along = a.normal.dot(b.normal);
  if (std::abs(along) < kMergeAngleCosine) return none;
  const double limit =
      along < 0 ? std::min(kOppositeRms, kMergeRms * distance) : kMergeRms * distance;
  Moments both = a.moments;
  both.add(b.moments);
  const Vec3 n = both.fit(a.area >= b.area ? a.normal : b.normal);
  const double d = n.dot(both.mean());
  const double cost = std::max(a.moments.rms(n, d), b.moments.rms(n, d)) / limit;
  if (along > 0) return cost;
  return cost <= 1 && (!rules.has(Rule::kSheetSides) || is_sheet(items, a, b)) ? cost : none;
}

/// Leader of every region after joining; pairs are (cost, a, b), cheapest first, each region joins
/// once a round.
void join_pairs(std::vector<Region>& regions, std::vector<int>& leader,
                std::vector<std::tuple<double, int, int>>& pairs, bool is_refit) {
  std::sort(pairs.begin(), pairs.end());
  std::vector<char> is_touched(regions.size(), 0);
  for (const auto& [cost, a, b] : pairs) {
    if (is_touched[a] || is_touched[b]) continue;
    is_touched[a] = is_touched[b] = 1;
    Region r = joined(regions[a], regions[b]);
    if (is_refit) r.refit();
    regions[a] = std::move(r);
    regions[b] = Region{};
    leader[b] = a;
  }
}

void drop_empty(std::vector<Region>& regions) {
  std::erase_if(regions, [](const Region& r) { return r.items.empty(); });
  for (Region& r : regions) std::sort(r.items.begin(), r.items.end());
  std::stable_sort(regions.begin(), regions.end(),
                   [](const Region& a, const Region& b) { return a.area > b.area; });
}

template <class Cost>
void merge_neighbors(const Items& items, double gap, bool is_refit, std::vector<Region>& regions,
                     const Cost& cost) {
  constexpr int kRounds = 40;
  auto neighbors = neighboring_regions(items, regions, gap);
  std::vector<int> leader(regions.size());
  for (int round = 0; round < kRounds; ++round) {
    std::iota(leader.begin(), leader.end(), 0);
    std::vector<std::tuple<double, int, int>> pairs;
    for (const auto& [a, b] : neighbors)
      if (const double c = cost(regions[a], regions[b]); c <= 1) pairs.emplace_back(c, a, b);
    if (pairs.empty()) break;
    join_pairs(regions, leader, pairs, is_refit);
    for (auto& [a, b] : neighbors) {
      a = leader[a], b = leader[b];
      if (a > b) std::swap(a, b);
    }
    std::sort(neighbors.begin(), neighbors.end());
    neighbors.erase(std::unique(neighbors.begin(), neighbors.end()), neighbors.end());
    std::erase_if(neighbors, [](const auto& p) { return p.first == p.second; });
  }
  drop_empty(regions);
}

// --- directions ----------------------------------------------------------------------------------

/// Takes the direction `n` (turned like the region's own) about the region's centroid if that moves
/// the region's own surface little enough.
bool try_direction(Region& r, Vec3 n, const AlignOptions& options) {
  if (n.dot(r.normal) < 0) n = -n;
  const double cosine = n.dot(r.normal);
  if (cosine < std::cos(kMostTurn)) return false;
  const Eigen::Matrix3d covariance = r.moments.covariance();
  if (cosine < std::cos(r.area < kSmallArea ? kTurnSmall : kTurn)) {
    if (!options.is_strip_turned) return false;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
    if (solver.eigenvalues()[1] > kNarrow * kNarrow) return false;
  }
  const Vec3 fitted = r.moments.fit(r.normal);
  const Vec3 turn = n - fitted;
  const double moved2 = turn.dot(covariance * turn);
  const double rms = r.moments.rms(fitted, fitted.dot(r.moments.mean()));
  if (moved2 > std::pow(std::clamp(rms, options.least_move, options.most_move), 2)) return false;
  r.normal = n;
  r.offset = n.dot(r.moments.mean());
  return true;
}

/// Walls' directions: `azimuth` and its three quarter turns.
struct Family {
  double azimuth, c, s;
  double weight = 0, lean = 0;  // area, and area-weighted deviation of the members

  explicit Family(double a) : azimuth(a), c(std::cos(a)), s(std::sin(a)) {
    if (a == 0) c = 1, s = 0;
  }
  /// The quarter turn nearest to the horizontal direction (x, y).
  Vec2 nearest(double x, double y) const {
    const double along = c * x + s * y, across = c * y - s * x;
    if (std::abs(along) >= std::abs(across)) return along > 0 ? Vec2(c, s) : Vec2(-c, -s);
    return across > 0 ? Vec2(-s, c) : Vec2(s, -c);
  }
};

double quarter_deviation(double azimuth, double from) {
  return std::remainder(azimuth - from, M_PI / 2);
}

bool try_family(Region& r, const Family& f, const AlignOptions& options) {
  const double h = std::hypot(r.normal.x(), r.normal.y());
  const Vec2 to = f.nearest(r.normal.x(), r.normal.y());
  return try_direction(r, Vec3(h * to.x(), h * to.y(), r.normal.z()), options);
}

enum class Kind : char { kLevel, kWall, kSlope };

std::vector<Kind> snap_to_upright(std::vector<Region>& regions, const AlignOptions& options,
                                  bool is_snapped) {
  const auto snap = [&](Region& r, const Vec3& n) {
    return !is_snapped || try_direction(r, n, options);
  };
  std::vector<Kind> kinds;
  for (Region& r : regions) {
    const double h = std::hypot(r.normal.x(), r.normal.y());
    Kind kind = Kind::kSlope;
    if (h < kUpright && snap(r, Vec3::UnitZ()))
      kind = Kind::kLevel;
    else if (std::abs(r.normal.z()) < kUpright &&
             snap(r, Vec3(r.normal.x() / h, r.normal.y() / h, 0)))
      kind = Kind::kWall;
    kinds.push_back(kind);
  }
  return kinds;
}

/// Families of wall directions, the frame's own axes first. Walls that fit none found one.
std::vector<Family> wall_families(const std::vector<Region>& regions,
                                  const std::vector<Kind>& kinds, const AlignOptions& options) {
  std::vector<Family> families{Family(0)};
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (kinds[i] != Kind::kWall) continue;
    const double azimuth = std::atan2(regions[i].normal.y(), regions[i].normal.x());
    bool is_in = false;
    for (Family& f : families) {
      Region trial;
      trial.normal = regions[i].normal;
      trial.moments = regions[i].moments;
      trial.area = regions[i].area;
      if (!try_family(trial, f, options)) continue;
      f.weight += regions[i].area;
      f.lean += regions[i].area * quarter_deviation(azimuth, f.azimuth);
      is_in = true;
      break;
    }
    if (is_in) continue;
    families.emplace_back(azimuth);
    families.back().weight = regions[i].area;
  }
  for (std::size_t k = 1; k < families.size(); ++k) {
    Family refined(families[k].azimuth + families[k].lean / families[k].weight);
    refined.weight = families[k].weight;
    families[k] = refined;
  }
  return families;
}

/// Gives a slope the tilt of an earlier one; returns whether it took one.
bool try_tilts(Region& r, const std::vector<double>& tilts, const AlignOptions& options) {
  const double h = std::hypot(r.normal.x(), r.normal.y());
  if (h < 1e-9) return false;
  const double own = std::atan2(h, std::abs(r.normal.z()));
  for (const double tilt : tilts) {
    if (std::abs(tilt - own) > kSameTilt) continue;
    const double sign = r.normal.z() < 0 ? -1 : 1;
    const Vec3 n(std::sin(tilt) * (r.normal.x() / h), std::sin(tilt) * (r.normal.y() / h),
                 sign * std::cos(tilt));
    if (try_direction(r, n, options)) return true;
  }
  return false;
}

Vec3 canonical(const Vec3& n) {
  const double lead = n.z() != 0 ? n.z() : n.x() != 0 ? n.x() : n.y();
  return lead < 0 ? Vec3(-n) : n;
}

/// Slopes that point the same way within rounding become one direction, bit for bit.
struct DirectionTable {
  std::vector<Vec3> known;  // canonical

  Vec3 same(const Vec3& n) {
    const Vec3 c = canonical(n);
    const double sign = c.dot(n) < 0 ? -1 : 1;
    for (const Vec3& k : known)
      if ((k - c).squaredNorm() < 1e-20) return sign * k;
    known.push_back(c);
    return sign * c;
  }
};

void align_directions(std::vector<Region>& regions, const AlignOptions& options,
                      const RuleSet& rules) {
  const bool has_families = rules.has(Rule::kFamilies);
  const std::vector<Kind> kinds = snap_to_upright(regions, options, rules.has(Rule::kUpright));
  const std::vector<Family> families =
      has_families ? wall_families(regions, kinds, options) : std::vector<Family>();
  std::vector<double> tilts;
  DirectionTable table;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    Region& r = regions[i];
    bool is_aligned = kinds[i] == Kind::kLevel;
    for (std::size_t k = 0; k < families.size() && !is_aligned; ++k)
      is_aligned = try_family(r, families[k], options);
    if (rules.has(Rule::kTilts) && kinds[i] == Kind::kSlope && !try_tilts(r, tilts, options)) {
      tilts.push_back(std::atan2(std::hypot(r.normal.x(), r.normal.y()), std::abs(r.normal.z())));
      try_tilts(r, {tilts.back()}, options);  // the same arithmetic as for those that follow it
    }
    for (std::size_t k = 0; has_families && k < table.known.size() && !is_aligned; ++k)
      is_aligned = try_direction(r, table.known[k], options);
    r.normal = table.same(r.normal.normalized());
    r.offset = r.normal.dot(r.moments.mean());
  }
}

// --- offsets -------------------------------------------------------------------------------------

struct OffsetCluster {
  double low, high, weight, sum;
  std::vector<int> members;
};

/// Joins the closest neighbours on the line of offsets while a cluster stays narrow.
void cluster_offsets(std::vector<OffsetCluster>& clusters, double width) {
  while (clusters.size() > 1) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k + 1 < clusters.size(); ++k)
      if (const double w = clusters[k + 1].high - clusters[k].low; w < least) least = w, best = k;
    if (least > width) return;
    OffsetCluster &a = clusters[best], &b = clusters[best + 1];
    a.high = b.high, a.weight += b.weight, a.sum += b.sum;
    a.members.insert(a.members.end(), b.members.begin(), b.members.end());
    clusters.erase(clusters.begin() + best + 1);
  }
}

/// `width`: metres, the most that the offsets of one plane may differ.
void align_offsets(std::vector<Region>& regions, double width) {
  std::map<std::array<double, 3>, std::vector<int>> parallel;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const Vec3 c = canonical(regions[i].normal);
    parallel[{c.x() + 0.0, c.y() + 0.0, c.z() + 0.0}].push_back(static_cast<int>(i));
  }
  for (auto& [key, group] : parallel) {
    const Vec3 n(key[0], key[1], key[2]);
    std::vector<OffsetCluster> clusters;
    for (const int i : group) {
      const double d = n.dot(regions[i].moments.mean()), w = std::max(regions[i].area, 1e-12);
      clusters.push_back({d, d, w, w * d, {i}});
    }
    std::stable_sort(clusters.begin(), clusters.end(),
                     [](const OffsetCluster& a, const OffsetCluster& b) { return a.low < b.low; });
    cluster_offsets(clusters, width);
    for (const OffsetCluster& c : clusters)
      for (const int i : c.members) {
        const double sign = n.dot(regions[i].normal) < 0 ? -1 : 1;
        regions[i].normal = sign * n;
        regions[i].offset = sign * (c.sum / c.weight);
      }
  }
}

}  // namespace

void regularize(const Items& items, double distance, const AlignOptions& align,
                const RuleSet& rules, std::vector<Region>& regions) {
  if (rules.has(Rule::kCoplanar))
    merge_neighbors(items, distance, true, regions, [&](const Region& a, const Region& b) {
      return merge_cost(items, a, b, distance, rules);
    });
  if (rules.has(Rule::kUpright) || rules.has(Rule::kFamilies) || rules.has(Rule::kTilts))
    align_directions(regions, align, rules);
  if (!rules.has(Rule::kOffsets)) return;
  align_offsets(regions, align.offset_width);
  merge_neighbors(items, distance, false, regions, [&](const Region& a, const Region& b) {
    const double sign = a.normal.dot(b.normal) < 0 ? -1 : 1;
    if (a.normal != sign * b.normal || a.offset != sign * b.offset) return 2.0;
    return sign > 0 || !rules.has(Rule::kSheetSides) || is_sheet(items, a, b) ? 0.0 : 2.0;
  });
}

}  // namespace colod::regions
