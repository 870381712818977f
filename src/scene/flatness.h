// Inside room `scene` only: how well a height map fits a plane about each cell.
#pragma once

#include <vector>

#include "survey.h"

namespace colod {

struct Flatness {
  std::vector<float> roughness;         ///< metres: root of the mean square off the best plane, at
                                        ///< right angles to it: steep roofs are no rougher
  std::vector<float> slope_x, slope_y;  ///< of that plane
};

/// Of all square windows of 2 · radius + 1 cells that hold a cell the one that fits best, so that
/// edges of roofs are as smooth as their middles. A window with a gap fits nothing: infinite.
/// O(cells · radius).
Flatness measure_flatness(const HeightMap& map, int radius);

}  // namespace colod
