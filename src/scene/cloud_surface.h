// An airborne cloud → a surface seen from above, in tiles like any other scene's.
#pragma once

#include <string>
#include <vector>

#include "read/read.h"
#include "survey.h"

namespace colod {

struct CloudSurface {
  HeightMap map;                      ///< with what classes tell of cells
  std::size_t points = 0;             ///< noise apart
  double density = 0;                 ///< points a m² of what is covered
  std::vector<std::string> warnings;  ///< what was left out or assumed
};

/// The highest points of cells as large as the density allows, at least 0.4 m; of cells with points
/// of class 6 (building) the highest of these, so that crowns do not hide roofs. Ground is where
/// class 2 is, if 2 % of the points have it. Heights are moved to the middles of cells along slopes
/// that the neighbours agree on. Files of one place become one surface. Reads each file three
/// times, in blocks, a table once more; memory follows the cells. Throws Error{kInput} for clouds
/// that are broken, have fewer than about one point in 2 m², are less than 3 m wide (degrees,
/// perhaps), or have points of buildings alone.
CloudSurface surface_of(const std::vector<std::string>& files, const ReadOptions& options);

/// Squares of a map as meshes, neighbours with the same vertices on their common border.
int tile_count(const HeightMap& map);
Source surface_tile(const HeightMap& map, int tile);

}  // namespace colod
