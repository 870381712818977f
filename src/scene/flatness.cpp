// Based on: least squares over windows; sums by rows and columns.
#include "flatness.h"

#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace colod {

namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// The plane of the window about a cell.
struct Fit {
  float roughness = kFar, slope_x = 0, slope_y = 0;
};

Fit fit(const HeightMap& map, int x, int y, int radius) {
  if (x < radius || y < radius || x + radius >= map.width || y + radius >= map.height) return {};
  const double base = map.top[map.at(x, y)];
  double sum = 0, squares = 0, along_x = 0, along_y = 0;
  for (int v = -radius; v <= radius; ++v)
    for (int u = -radius; u <= radius; ++u) {
      const double z = map.top[map.at(x + u, y + v)] - base;
      sum += z, squares += z * z, along_x += u * z, along_y += v * z;
    }
  const double side = 2 * radius + 1, count = side * side;
  const double spread = count * radius * (radius + 1) / 3;  // of u², and of v²
  const double a = along_x / spread, b = along_y / spread;
  const double rest = squares - sum * sum / count - (a * a + b * b) * spread;
  if (std::isnan(rest)) return {};
  const double slope_x = a / map.cell, slope_y = b / map.cell;
  const double upright = 1 + slope_x * slope_x + slope_y * slope_y;
  return {static_cast<float>(std::sqrt(std::max(0.0, rest) / count / upright)),
          static_cast<float>(slope_x), static_cast<float>(slope_y)};
}

}  // namespace

Flatness measure_flatness(const HeightMap& map, int radius) {
  std::vector<Fit> own(map.size()), row(map.size());
  const auto height = static_cast<std::size_t>(map.height);
  parallel_for(height, [&](std::size_t y) {
    for (int x = 0; x < map.width; ++x)
      own[map.at(x, static_cast<int>(y))] = fit(map, x, static_cast<int>(y), radius);
  });
  // The best along rows, then the best of these along columns.
  parallel_for(height, [&](std::size_t y) {
    for (int x = 0; x < map.width; ++x)
      for (int u = std::max(0, x - radius); u <= std::min(map.width - 1, x + radius); ++u) {
        const Fit& other = own[map.at(u, static_cast<int>(y))];
        Fit& best = row[map.at(x, static_cast<int>(y))];
        if (other.roughness < best.roughness) best = other;
      }
  });
  Flatness out;
  out.roughness.assign(map.size(), kFar);
  out.slope_x.assign(map.size(), 0), out.slope_y.assign(map.size(), 0);
  parallel_for(height, [&](std::size_t row_y) {
    const int y = static_cast<int>(row_y);
    for (int x = 0; x < map.width; ++x)
      for (int v = std::max(0, y - radius); v <= std::min(map.height - 1, y + radius); ++v) {
        const Fit& other = row[map.at(x, v)];
        const std::size_t i = map.at(x, y);
        if (!(other.roughness < out.roughness[i])) continue;
        out.roughness[i] = other.roughness;
        out.slope_x[i] = other.slope_x, out.slope_y[i] = other.slope_y;
      }
  });
  return out;
}

}  // namespace colod
