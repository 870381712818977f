// Inside room `bake` only: what no sample gave a colour.
#pragma once

#include <vector>

#include "image/image.h"
#include "image/look_sampler.h"

namespace colod::bake {

/// Part of a raster.
struct Window {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Gives every pixel of a window that is not known a colour from the known ones about it, near ones
/// first; in linear light. Pixels farther than about `reach` from any known one get `far`, so that
/// a rim is not smeared over what nobody saw. `is_known` is as long as the raster has pixels.
/// O(pixels).
void push_pull(Raster& raster, const std::vector<std::uint8_t>& is_known, const Window& window,
               double reach, const Light& far);

/// Gives all of a window one colour.
void fill_evenly(Raster& raster, const Window& window, const Light& light);

}  // namespace colod::bake
