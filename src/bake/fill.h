// Inside room `bake` only: what no sample gave a colour.
#pragma once

#include <vector>

#include "image/image.h"

namespace colod::bake {

/// Part of a raster.
struct Window {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Gives every pixel of a window that is not known a colour from the known ones about it, near ones
/// first; in linear light. `is_known` is as long as the raster has pixels. Without a known one all
/// stays as it is. O(pixels).
void push_pull(Raster& raster, const std::vector<std::uint8_t>& is_known, const Window& window);

}  // namespace colod::bake
