// Inside room `scene` only: straight lines across a block along which two houses meet.
#pragma once

#include <vector>

#include "classes.h"

namespace colod {

struct PartyWall {
  Vec2 from, to;  ///< across the block, a cell and a half beyond both ends
  double score;   ///< 1: just believed
};

/// Of one building: the strongest first; those beside each other are one. `cells`: of the map, its
/// own. `direction`: radians, along one of its facades.
std::vector<PartyWall> find_party_walls(const HeightMap& map, const std::vector<int>& building,
                                        const std::vector<std::size_t>& cells, double direction);

}  // namespace colod
