// Inside room `segments`: planes → the group of voxels they belong to, and the guard of alcoves.
#pragma once

#include <vector>

#include "aggregation.h"
#include "planes/planes.h"

namespace colod {

/// Per plane the group with most hits on it (ties: the lower group); −1: nobody sees it.
std::vector<int> assign_to_most_hits(std::size_t planes, const VoxelGroups& groups);

enum class Side { kBehind, kFront };

/// What lies next to a plane on one side.
struct PlaneSide {
  int group = -1;    ///< the group next to most of the plane's area; −1: none
  double share = 0;  ///< of the plane's area, next to that group
};

/// From sample points of each plane's outline, 1, 1.7 and 2.4 voxels along the normal (front) or
/// against it (behind), the first voxel that has a group; the majority by area.
std::vector<PlaneSide> look_beside_planes(const Planes& planes, const HitGrid& grid,
                                          const std::vector<int>& group_of_voxel, Side side);

/// Keeps of the planes claimed by alcoves (−1: none) those of real recesses: an alcove has three
/// planes at least, two of them facing each other and two not parallel.
std::vector<int> guard_alcoves(const Planes& planes, std::vector<int> alcove_of_plane, int alcoves);

}  // namespace colod
