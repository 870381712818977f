// Based on: region growing at three times the residual of the building's largest planes (measured
// in November 2026). Differs: --rules robust only; the paper grows at a fixed 0.2 m on raw normals.
// Notation: none.
#include "noise.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "parameters.h"
#include "region.h"

namespace colod::regions {
namespace {

using namespace parameters::planes;

/// Items around the start that look about the same way: all within `radius`, and a few at least.
std::vector<int> neighborhood(const Items& items, int start, double radius,
                              std::vector<int>& mark) {
  constexpr std::size_t kLeast = 16, kMost = 4000;
  std::vector<int> list{start};
  mark[start] = start;
  for (std::size_t at = 0; at < list.size() && list.size() < kMost; ++at)
    for (int k = items.first[list[at]]; k < items.first[list[at] + 1]; ++k) {
      const int j = items.neighbor[k];
      if (mark[j] == start || std::abs(items.normal[j].dot(items.normal[start])) < 0.5) continue;
      if (list.size() >= kLeast && (items.center[j] - items.center[start]).norm() > radius)
        continue;
      mark[j] = start;
      list.push_back(j);
    }
  return list;
}

}  // namespace

double estimate_noise(const Items& items) {
  constexpr int kSamples = 600;
  double total = 0;
  for (int i = 0; i < items.size(); ++i) total += items.is_used[i] ? items.area[i] : 0;
  std::vector<double> residuals;
  std::vector<int> mark(items.size(), -1);
  double passed = 0;
  for (int i = 0; i < items.size(); ++i) {
    if (!items.is_used[i]) continue;
    const double before = std::floor(passed / total * kSamples);
    passed += items.area[i];
    if (std::floor(passed / total * kSamples) == before) continue;
    Moments m;
    for (const int j : neighborhood(items, i, kNoiseRadius, mark)) m.add_item(items, j);
    const Vec3 n = m.fit(items.normal[i]);
    residuals.push_back(m.rms(n, n.dot(m.mean())));
  }
  if (residuals.empty()) return 0;
  // The flattest tenth: the others also measure edges and recesses.
  std::sort(residuals.begin(), residuals.end());
  return residuals[residuals.size() / 10];
}

Planes::Surface judge_surface(double noise, double distance) {
  return kNoiseFactor * noise <= kPlainDistance ? Planes::Surface::kExact : surface_at(distance);
}

std::vector<Vec3> smooth_normals(const Items& items, int rounds) {
  std::vector<Vec3> now = items.normal, next(now.size());
  for (int round = 0; round < rounds; ++round) {
    parallel_ranges(now.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Vec3 sum = items.area[i] * now[i];
        for (int k = items.first[i]; k < items.first[i + 1]; ++k) {
          const int j = items.neighbor[k];
          const double way = items.way[k] != 0 ? items.way[k] : now[i].dot(now[j]) < 0 ? -1 : 1;
          sum += way * items.area[j] * now[j];
        }
        const double length = sum.norm();
        next[i] = length > 1e-12 ? Vec3(sum / length) : now[i];
      }
    });
    now.swap(next);
  }
  return now;
}

}  // namespace colod::regions
