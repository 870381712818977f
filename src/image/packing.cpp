// Based on: Jylänki, A thousand ways to pack the bin, 2010 (skyline, lowest position first).
#include "packing.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace colod {

namespace {

/// The upper border of what is placed: from `x` on at this height.
struct Node {
  int x, y;
};

/// Places rectangles, given in `order`, one by one as low as it goes. False: beyond `most_height`.
bool pack(std::vector<PackedRect>& rects, const std::vector<int>& order, int width, int most_height,
          int& height) {
  std::vector<Node> skyline = {{0, 0}};
  height = 0;
  for (const int r : order) {
    PackedRect& rect = rects[static_cast<std::size_t>(r)];
    int best_y = most_height + 1, best = -1;
    for (std::size_t i = 0; i < skyline.size() && skyline[i].x + rect.width <= width; ++i) {
      int y = 0;
      for (std::size_t j = i; j < skyline.size() && skyline[j].x < skyline[i].x + rect.width; ++j)
        y = std::max(y, skyline[j].y);
      if (y < best_y) best_y = y, best = static_cast<int>(i);
    }
    if (best < 0 || best_y + rect.height > most_height) return false;
    rect.x = skyline[static_cast<std::size_t>(best)].x, rect.y = best_y;
    height = std::max(height, best_y + rect.height);
    const int end = rect.x + rect.width;
    std::vector<Node> next(skyline.begin(), skyline.begin() + best);
    next.push_back({rect.x, best_y + rect.height});
    int last = skyline[static_cast<std::size_t>(best)].y;
    bool is_cut = false;
    for (std::size_t i = static_cast<std::size_t>(best); i < skyline.size(); ++i) {
      if (skyline[i].x <= end) last = skyline[i].y;
      if (skyline[i].x < end) continue;
      if (!is_cut && skyline[i].x > end) next.push_back({end, last});
      is_cut = true;
      next.push_back(skyline[i]);
    }
    if (!is_cut && end < width) next.push_back({end, last});
    skyline = std::move(next);
  }
  return true;
}

}  // namespace

std::array<int, 2> pack_rects(std::vector<PackedRect>& rects, int largest) {
  std::vector<int> order(rects.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return std::pair(rects[a].height, rects[a].width) > std::pair(rects[b].height, rects[b].width);
  });
  double area = 0;
  int widest = 4;
  for (const PackedRect& r : rects)
    area += static_cast<double>(r.width) * r.height, widest = std::max(widest, r.width);
  std::vector<PackedRect> best;
  std::array<int, 2> size = {0, 0};
  for (const double share : {0.8, 0.9, 1.0, 1.05, 1.1, 1.2, 1.35, 1.5}) {
    const int wanted = static_cast<int>(std::ceil(share * std::sqrt(area) / 4)) * 4;
    const int width = std::min(largest, std::max(widest, wanted));
    int height = 0;
    if (width < widest || !pack(rects, order, width, largest, height)) continue;
    if (!best.empty() &&
        static_cast<double>(width) * height >= static_cast<double>(size[0]) * size[1])
      continue;
    best = rects, size = {width, height};
  }
  if (size[0] > 0) rects = std::move(best);
  return size;
}

}  // namespace colod
