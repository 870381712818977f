// Based on: stb_rect_pack (Jylänki's skyline, bottom left first), tried at several widths.
#include "packing.h"

#include <algorithm>
#include <cmath>

#define STB_RECT_PACK_IMPLEMENTATION
#define STBRP_STATIC
#include <stb/stb_rect_pack.h>

namespace colod {

namespace {

constexpr int kBlock = 4;

/// Places rectangles in an image so wide; the height they take, or 0: beyond `most_height`.
int pack(std::vector<PackedRect>& rects, int width, int most_height) {
  std::vector<stbrp_node> nodes(static_cast<std::size_t>(width / kBlock));
  stbrp_context context;
  stbrp_init_target(&context, width / kBlock, most_height / kBlock, nodes.data(),
                    static_cast<int>(nodes.size()));
  std::vector<stbrp_rect> blocks;
  for (const PackedRect& r : rects)
    blocks.push_back(
        {static_cast<int>(blocks.size()), r.width / kBlock, r.height / kBlock, 0, 0, 0});
  if (!stbrp_pack_rects(&context, blocks.data(), static_cast<int>(blocks.size()))) return 0;
  int height = 0;
  for (const stbrp_rect& b : blocks) {
    PackedRect& r = rects[static_cast<std::size_t>(b.id)];
    r.x = b.x * kBlock, r.y = b.y * kBlock;
    height = std::max(height, r.y + r.height);
  }
  return height;
}

}  // namespace

std::array<int, 2> pack_rects(std::vector<PackedRect>& rects, int largest) {
  double area = 0;
  int widest = kBlock;
  for (const PackedRect& r : rects)
    area += static_cast<double>(r.width) * r.height, widest = std::max(widest, r.width);
  std::vector<PackedRect> best;
  std::array<int, 2> size = {0, 0};
  for (const double share : {0.8, 0.9, 1.0, 1.05, 1.1, 1.2, 1.35, 1.5}) {
    const int wanted = static_cast<int>(std::ceil(share * std::sqrt(area) / kBlock)) * kBlock;
    const int width = std::min(largest, std::max(widest, wanted));
    const int height = width < widest ? 0 : pack(rects, width, largest);
    if (height == 0) continue;
    if (!best.empty() &&
        static_cast<double>(width) * height >= static_cast<double>(size[0]) * size[1])
      continue;
    best = rects, size = {width, height};
  }
  if (size[0] > 0) rects = std::move(best);
  return size;
}

}  // namespace colod
