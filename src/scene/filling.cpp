// Based on: push and pull over a pyramid of means.
#include "filling.h"

#include <algorithm>
#include <array>

namespace colod {

namespace {

/// Half as wide and high: means of what is seen.
Raster halved(const Raster& from, const std::vector<char>& is_seen, std::vector<char>& is_known) {
  Raster out((from.width + 1) / 2, (from.height + 1) / 2);
  is_known.assign(static_cast<std::size_t>(out.width) * out.height, 0);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      std::array<int, 3> sum{};
      int count = 0;
      for (int i = 0; i < 4; ++i) {
        const int u = 2 * x + i % 2, v = 2 * y + i / 2;
        if (u >= from.width || v >= from.height) continue;
        if (!is_seen[static_cast<std::size_t>(v) * from.width + u]) continue;
        for (std::size_t k = 0; k < 3; ++k) sum[k] += from.at(u, v)[k];
        ++count;
      }
      if (count == 0) continue;
      is_known[static_cast<std::size_t>(y) * out.width + x] = 1;
      for (std::size_t k = 0; k < 3; ++k)
        out.at(x, y)[k] = static_cast<std::uint8_t>(sum[k] / count);
    }
  return out;
}

/// Between the four nearest pixels of a picture half as wide and high.
void take_between(const Raster& coarse, int x, int y, std::uint8_t* rgb) {
  const int u[2] = {std::clamp(x / 2, 0, coarse.width - 1),
                    std::clamp(x / 2 + (x % 2 ? 1 : -1), 0, coarse.width - 1)};
  const int v[2] = {std::clamp(y / 2, 0, coarse.height - 1),
                    std::clamp(y / 2 + (y % 2 ? 1 : -1), 0, coarse.height - 1)};
  constexpr int kShare[2] = {3, 1};  // quarters
  for (std::size_t k = 0; k < 3; ++k) {
    int sum = 8;
    for (int i = 0; i < 4; ++i)
      sum += kShare[i % 2] * kShare[i / 2] * coarse.at(u[i % 2], v[i / 2])[k];
    rgb[k] = static_cast<std::uint8_t>(sum / 16);
  }
}

}  // namespace

void fill_unseen(Raster& raster, const std::vector<char>& is_seen) {
  if (std::all_of(is_seen.begin(), is_seen.end(), [](char c) { return c != 0; })) return;
  if (raster.width <= 1 && raster.height <= 1) return;
  std::vector<char> is_known;
  Raster coarse = halved(raster, is_seen, is_known);
  fill_unseen(coarse, is_known);
  for (int y = 0; y < raster.height; ++y)
    for (int x = 0; x < raster.width; ++x)
      if (!is_seen[static_cast<std::size_t>(y) * raster.width + x])
        take_between(coarse, x, y, raster.at(x, y));
}

}  // namespace colod
