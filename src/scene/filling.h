// Inside room `scene` only: what of a picture nobody saw.
#pragma once

#include <vector>

#include "image/image.h"

namespace colod {

/// Pixels that nothing covers look like what is around them: a border has no dark rim, and what was
/// not seen no hole. `is_seen` is as long as the raster has pixels. O(pixels).
void fill_unseen(Raster& raster, const std::vector<char>& is_seen);

}  // namespace colod
