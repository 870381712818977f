// Inside the door of room `extraction`: what was seen of a building so far.
#pragma once

#include <cstdint>
#include <unordered_map>

#include "core/rays.h"
#include "planes/planes.h"

namespace colod {

/// Shares of the rays of a point or a cell.
struct Vote {
  double seen = 0;  ///< valid hits minus others, −1..1; paper: 2 × share of valid hits − 1
  double sheltered = 0;  ///< that meet nothing although a roof stands above, 0..1
  double exposed = 0;    ///< that meet nothing, with nothing above, 0..1
};

/// What a building's outlines look like from within: the scene of all of them, and what was seen
/// from points so far. The layers of a building and the trials of a layer have most cells in
/// common: 60 to 75 % of the points are asked again (measured in November 2026 on photogrammetry
/// meshes and airborne clouds). One for each building and set of options.
struct Sight {
  explicit Sight(const Planes& planes);

  struct Hash {
    std::size_t operator()(const Vec3& p) const;
  };
  RayScene rays;
  std::unordered_map<Vec3, Vote, Hash> votes;
  void count(std::int64_t cells_of_partition);

  std::int64_t cells = 0, most_cells = 0;  ///< of all partitions so far, and of the largest one:
                                           ///< what work the building makes
};

/// The building has made so much work that no further attempt on a layer is due.
bool is_spent(const Sight& sight);

}  // namespace colod
