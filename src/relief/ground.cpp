// Based on: progressive filters of terrain (Zhang et al., "A progressive morphological filter",
// IEEE TGRS 41(4), 2003). Differs: a building's own piece of ground is a rim around it, from which
// the flood begins. Notation: –
#include "ground.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

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

/// Per cell: the lowest corner of the mesh there.
std::vector<double> lowest_corners(const Field& f, const Mesh& mesh) {
  std::vector<double> lowest(f.size(), std::numeric_limits<double>::infinity());
  for (const Vec3& v : mesh.vertices)
    if (const int i = f.at(v.head<2>()); i >= 0) lowest[i] = std::min(lowest[i], v.z());
  return lowest;
}

/// How low the mesh goes near a place at its rim, if that is well below it: walls hang from there.
std::optional<double> wall_end(const Field& f, const std::vector<double>& lowest, int cell) {
  const int reach = static_cast<int>(std::ceil(kHangReach / f.cell));
  const int column = cell % f.columns, row = cell / f.columns;
  double end = f.height[cell] - kHang;
  bool hangs = false;
  for (int r = std::max(row - reach, 0); r <= std::min(row + reach, f.rows - 1); ++r)
    for (int c = std::max(column - reach, 0); c <= std::min(column + reach, f.columns - 1); ++c)
      if (const double z = lowest[r * f.columns + c]; z < end) end = z, hangs = true;
  return hangs ? std::optional(end) : std::nullopt;
}

/// Cells that are reached from `start` without a step, none of them `high`; marks them.
std::vector<int> reach(const Field& f, int start, double high, std::vector<char>& is_reached) {
  std::vector<int> cells{start};
  is_reached[start] = 1;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const int i = cells[k];
    for (const int j : f.beside(i)) {
      if (j < 0 || is_reached[j] || !f.has(j) || f.height[j] > high) continue;
      if (std::abs(f.height[j] - f.height[i]) > kGroundSlope * f.cell) continue;
      is_reached[j] = 1;
      cells.push_back(j);
    }
  }
  return cells;
}

/// From the low part of the rim, as far as no step is climbed. What walls hang from is a roof.
std::vector<char> flood(const Field& f, const std::vector<int>& rim,
                        const std::vector<double>& lowest, double low, double rise) {
  std::vector<char> is_rim(f.size(), 0), is_reached(f.size(), 0), is_ground(f.size(), 0);
  for (const int i : rim) is_rim[i] = 1;
  for (const int i : rim) {
    if (is_reached[i] || f.height[i] > low + std::min(kRimShare * rise, kRimRise)) continue;
    const std::vector<int> cells = reach(f, i, low + kGroundShare * rise, is_reached);
    int at_rim = 0, hanging = 0;
    for (const int j : cells) at_rim += is_rim[j], hanging += is_rim[j] && wall_end(f, lowest, j);
    if (hanging < kMostHanging * at_rim)
      for (const int j : cells) is_ground[j] = 1;
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
std::vector<double> ground_feet(const Field& f, const std::vector<char>& is_ground) {
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

/// Where walls that hang from the rim end.
std::vector<double> wall_feet(const Field& f, const std::vector<int>& rim,
                              const std::vector<double>& lowest) {
  std::vector<double> heights;
  for (const int i : rim)
    if (const std::optional<double> end = wall_end(f, lowest, i)) heights.push_back(*end);
  return heights;
}

}  // namespace

Ground find_ground(const Field& f, const Mesh& mesh, bool has_ground) {
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
  const std::vector<double> lowest = lowest_corners(f, mesh);
  g.is_ground.assign(f.size(), 0);
  if (has_ground && rise > kLeastRise) g.is_ground = flood(f, rim, lowest, low, rise);
  std::vector<double> feet = ground_feet(f, g.is_ground);
  if (feet.size() * f.cell <= kLeastFeet) {
    g.is_ground.assign(f.size(), 0);
    feet = wall_feet(f, rim, lowest);
  }
  g.foot =
      feet.size() * f.cell > kLeastFeet ? quantile(feet, kLowFoot) : quantile(corners, kLowCorner);
  g.height = spread(f, g.is_ground);
  for (double& h : g.height)
    if (std::isnan(h)) h = g.foot;
  return g;
}

}  // namespace colod::relief
