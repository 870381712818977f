// Based on: region growing (Rabbani, van den Heuvel, Vosselman 2006), as the paper uses it through
// CGAL (paper.cpp). Differs: under --rules robust the covariance runs along, the plane is
// fitted again when a region has grown by 30 %, and the angle test sees smoothed normals: 0.2–0.8 s
// where CGAL took 1–11 s on 110–265 thousand faces (measured in November 2026).
// Notation: n normal, d offset of a region's plane.
#include "growing.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <tuple>

#include "parameters.h"

namespace colod::regions {
namespace {

using namespace parameters::planes;

/// Flat surroundings first, then large items.
std::vector<int> seed_order(const Items& items, const std::vector<Vec3>& smooth) {
  constexpr double kSteps = 400;  // flatness in steps, so that size decides among equals
  std::vector<int> step(items.size()), order;
  for (int i = 0; i < items.size(); ++i) {
    if (!items.is_used[i]) continue;
    double bend = 0, weight = 0;
    for (int k = items.first[i]; k < items.first[i + 1]; ++k) {
      const int j = items.neighbor[k];
      bend += items.area[j] * (1 - std::abs(smooth[i].dot(smooth[j])));
      weight += items.area[j];
    }
    step[i] = weight > 0 ? static_cast<int>(kSteps * bend / weight) : 0;
    order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::make_tuple(step[a], -items.area[a], a) <
           std::make_tuple(step[b], -items.area[b], b);
  });
  return order;
}

double distance_to(const Items& items, int item, const Vec3& n, double d) {
  std::array<Vec3, 3> corner;
  const int count = items.corners(item, corner);
  double most = 0;
  for (int k = 0; k < count; ++k) most = std::max(most, std::abs(n.dot(corner[k]) - d));
  return most;
}

/// One growth from a seed; accepted items get `label`.
Region grow_one(const Items& items, const std::vector<Vec3>& smooth, const GrowingOptions& options,
                int seed, int label, std::vector<int>& region_of, std::vector<signed char>& sign) {
  const double cosine = std::cos(options.angle_deg * M_PI / 180);
  Region region;
  region.normal = smooth[seed];
  region.offset = region.normal.dot(items.center[seed]);
  region.items.push_back(seed);
  region.moments.add_item(items, seed);
  region_of[seed] = label;
  sign[seed] = 1;
  double fitted_weight = region.moments.weight;
  for (std::size_t at = 0; at < region.items.size(); ++at) {
    const int i = region.items[at];
    for (int k = items.first[i]; k < items.first[i + 1]; ++k) {
      const int j = items.neighbor[k];
      if (!items.is_used[j] || region_of[j] >= 0) continue;
      const double along = smooth[j].dot(region.normal);
      const int way = items.way[k] != 0 ? items.way[k] * sign[i] : along < 0 ? -1 : 1;
      if (way * along < cosine) continue;
      if (distance_to(items, j, region.normal, region.offset) > options.distance) continue;
      region_of[j] = label;
      sign[j] = static_cast<signed char>(way);
      region.items.push_back(j);
      region.moments.add_item(items, j);
      if (region.moments.weight > kRefitGrowth * fitted_weight && region.items.size() > 3)
        region.refit(), fitted_weight = region.moments.weight;
    }
  }
  return region;
}

void sort_by_area(std::vector<Region>& regions) {
  std::stable_sort(regions.begin(), regions.end(),
                   [](const Region& a, const Region& b) { return a.area > b.area; });
}

}  // namespace

std::vector<Region> grow_regions(const Items& items, const std::vector<Vec3>& smooth,
                                 const GrowingOptions& options) {
  std::vector<int> region_of(items.size(), -1);
  std::vector<signed char> sign(items.size(), 1);
  std::vector<Region> regions;
  for (const int seed : seed_order(items, smooth)) {
    if (region_of[seed] >= 0) continue;
    const int label = static_cast<int>(regions.size());
    regions.push_back(grow_one(items, smooth, options, seed, label, region_of, sign));
    Region& r = regions.back();
    r.refit();
    std::sort(r.items.begin(), r.items.end());
    r.area = r.moments.weight;
  }
  sort_by_area(regions);
  return regions;
}

void absorb_rest(const Items& items, double distance, std::vector<Region>& regions) {
  std::vector<int> region_of(items.size(), -1);
  for (std::size_t r = 0; r < regions.size(); ++r)
    for (const int i : regions[r].items) region_of[i] = static_cast<int>(r);
  using Entry = std::tuple<double, int, int>;  // distance, item, region
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto offer = [&](int from) {
    const Region& r = regions[region_of[from]];
    for (int k = items.first[from]; k < items.first[from + 1]; ++k) {
      const int j = items.neighbor[k];
      if (!items.is_used[j] || region_of[j] >= 0) continue;
      const double d = distance_to(items, j, r.normal, r.offset);
      if (d <= distance) queue.emplace(d, j, region_of[from]);
    }
  };
  for (int i = 0; i < items.size(); ++i)
    if (region_of[i] >= 0) offer(i);
  std::vector<char> is_grown(regions.size(), 0);
  while (!queue.empty()) {
    const auto [d, i, r] = queue.top();
    queue.pop();
    if (region_of[i] >= 0) continue;
    region_of[i] = r;
    regions[r].items.push_back(i);
    regions[r].area += items.area[i];
    is_grown[r] = 1;
    offer(i);
  }
  for (std::size_t r = 0; r < regions.size(); ++r)
    if (is_grown[r]) std::sort(regions[r].items.begin(), regions[r].items.end());
}

std::vector<std::pair<int, int>> neighboring_regions(const Items& items,
                                                     const std::vector<Region>& regions,
                                                     double gap) {
  std::vector<int> region_of(items.size(), -1);
  std::vector<Box> boxes(regions.size());
  for (std::size_t r = 0; r < regions.size(); ++r)
    for (const int i : regions[r].items) {
      region_of[i] = static_cast<int>(r);
      std::array<Vec3, 3> corner;
      const int n = items.corners(i, corner);
      for (int k = 0; k < n; ++k) boxes[r].extend(corner[k]);
    }
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < items.size(); ++i)
    for (int k = items.first[i]; region_of[i] >= 0 && k < items.first[i + 1]; ++k)
      if (const int b = region_of[items.neighbor[k]]; b > region_of[i])
        pairs.emplace_back(region_of[i], b);
  // Pieces that share no vertex are neighbours when their boxes are: the caller looks closer.
  for (std::size_t a = 0; a < regions.size(); ++a) {
    const Box grown{boxes[a].min - Vec3::Constant(gap), boxes[a].max + Vec3::Constant(gap)};
    for (std::size_t b = a + 1; b < regions.size(); ++b)
      if ((grown.min.array() <= boxes[b].max.array()).all() &&
          (boxes[b].min.array() <= grown.max.array()).all())
        pairs.emplace_back(a, b);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace colod::regions
