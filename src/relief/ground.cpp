// Based on: progressive filters of terrain (Zhang et al., "A progressive morphological filter",
// IEEE TGRS 41(4), 2003). Differs: a building's own piece of ground is a rim around it, from which
// the flood begins. Notation: –
#include "ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parameters.h"

namespace colod::relief {
namespace {

using namespace parameters::relief;

double quantile(std::vector<double> values, double share) {
  const std::size_t k = static_cast<std::size_t>(share * (values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(k), values.end());
  return values[k];
}

/// Cells at the edge of what is seen, from outside: holes inside do not count.
std::vector<int> outer_rim(const Field& f) {
  std::vector<char> is_outside(f.size(), 0);
  std::vector<int> open, rim;
  const auto visit = [&](int i) {
    if (is_outside[i]) return;
    is_outside[i] = 1;
    (f.has(i) ? rim : open).push_back(i);
  };
  for (int i = 0; i < f.size(); ++i) {
    const auto around = f.beside(i);
    if (std::any_of(around.begin(), around.end(), [](int j) { return j < 0; })) visit(i);
  }
  while (!open.empty()) {
    const int i = open.back();
    open.pop_back();
    for (const int j : f.beside(i))
      if (j >= 0) visit(j);
  }
  return rim;
}

/// From the low part of the rim, as far as no step is climbed.
std::vector<char> flood(const Field& f, const std::vector<int>& rim, double low, double rise) {
  std::vector<char> is_ground(f.size(), 0);
  std::vector<int> open;
  for (const int i : rim)
    if (f.height[i] < low + std::min(kRimShare * rise, kRimRise))
      is_ground[i] = 1, open.push_back(i);
  while (!open.empty()) {
    const int i = open.back();
    open.pop_back();
    for (const int j : f.beside(i)) {
      if (j < 0 || is_ground[j] || !f.has(j) || f.height[j] > low + kGroundShare * rise) continue;
      if (std::abs(f.height[j] - f.height[i]) > kGroundSlope * f.cell) continue;
      is_ground[j] = 1;
      open.push_back(j);
    }
  }
  return is_ground;
}

/// The height of the nearest ground cell, everywhere, by a flood from all of them.
std::vector<double> spread(const Field& f, const std::vector<char>& is_ground) {
  std::vector<double> height(f.size(), std::numeric_limits<double>::quiet_NaN());
  std::vector<int> queue;
  for (int i = 0; i < f.size(); ++i)
    if (is_ground[i]) height[i] = f.height[i], queue.push_back(i);
  for (std::size_t k = 0; k < queue.size(); ++k)
    for (const int j : f.beside(queue[k]))
      if (j >= 0 && std::isnan(height[j])) height[j] = height[queue[k]], queue.push_back(j);
  return height;
}

/// Where walls come down to the ground: heights of ground cells beside others.
std::vector<double> feet(const Field& f, const std::vector<char>& is_ground) {
  std::vector<double> heights;
  for (int i = 0; i < f.size(); ++i)
    if (is_ground[i])
      for (const int j : f.beside(i))
        if (j >= 0 && f.has(j) && !is_ground[j]) {
          heights.push_back(f.height[i]);
          break;
        }
  return heights;
}

}  // namespace

Ground find_ground(const Field& f, const Mesh& mesh) {
  std::vector<double> seen, rim_heights, corners;
  for (int i = 0; i < f.size(); ++i)
    if (f.has(i)) seen.push_back(f.height[i]);
  const std::vector<int> rim = outer_rim(f);
  for (const int i : rim) rim_heights.push_back(f.height[i]);
  for (const Vec3& v : mesh.vertices) corners.push_back(v.z());
  // Roofs between higher neighbours have walls that hang from their rim: the ground is below.
  const double low = std::min(quantile(rim_heights, kLowRim), quantile(corners, kLowCorner));
  const double rise = quantile(seen, kHighRoof) - low;
  Ground g;
  g.is_ground.assign(f.size(), 0);
  if (rise > kLeastRise) g.is_ground = flood(f, rim, low, rise);
  const std::vector<double> heights = feet(f, g.is_ground);
  const bool is_seen = heights.size() * f.cell > kLeastFeet;
  if (!is_seen) g.is_ground.assign(f.size(), 0);
  g.foot = is_seen ? quantile(heights, kLowFoot) : quantile(corners, kLowCorner);
  g.height = spread(f, g.is_ground);
  for (double& h : g.height)
    if (std::isnan(h)) h = g.foot;
  return g;
}

}  // namespace colod::relief
