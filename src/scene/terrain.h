// Inside room `scene` only: the ground below what stands on it.
#pragma once

#include <vector>

#include "survey.h"

namespace colod {

/// Per cell of the map the height of the ground, also under buildings and trees. Hills and terraces
/// are ground; a level that is mostly bounded by steps downward is a roof, however large. Where the
/// map's source knows the ground, this alone is it, with what lies between. O(cells).
std::vector<float> find_terrain(const HeightMap& map);

}  // namespace colod
