// Where a camera goes over a tileset.
#pragma once

#include <string>
#include <vector>

#include "streaming_tileset.h"

namespace colod::bench {

struct Path {
  std::string name;
  std::vector<Stop> stops;
};

/// By the boxes of the finest buildings, in the tileset's frame; the tileset shows a building.
///   dolly   towards the house in the middle, from 1600 m to 15 m before its box in 60 even steps,
///           from the side with the fewest houses in between, descending to eye height
///   flight  along the longer axis of the scene, 40 stops 30 m above the ground, ahead and 10° down
///   orbit   36 stops around the middle, 25° above, at 1.5 times the scene's longer side
std::vector<Path> plan_paths(const Tileset& tileset);

}  // namespace colod::bench
