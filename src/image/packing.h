// Rectangles side by side in one image.
#pragma once

#include <array>
#include <vector>

namespace colod {

/// A rectangle with its place, in pixels.
struct PackedRect {
  int width = 0, height = 0, x = 0, y = 0;
};

/// Places rectangles whose sides are multiples of 4 at multiples of 4 so that none overlap; returns
/// width and height of the smallest image found, sides at most `largest`. {0, 0}: they do not fit.
/// Deterministic; O(n²) at worst.
std::array<int, 2> pack_rects(std::vector<PackedRect>& rects, int largest);

}  // namespace colod
