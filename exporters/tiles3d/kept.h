// Which tiles an earlier run has made already.
#pragma once

#include "frame.h"
#include "tiles3d.h"
#include "tree.h"

namespace colod {

/// What a tile's file is made from, as a hash. \pre options.kept is not null
std::string tile_key(const PlannedTile& tile, const TileFrame& frame, const TilesOptions& options);

}  // namespace colod
