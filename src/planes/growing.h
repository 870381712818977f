// Inside room `planes`: regions grown over neighbouring items.
#pragma once

#include <utility>
#include <vector>

#include "items.h"
#include "region.h"

namespace colod::regions {

struct GrowingOptions {
  double distance;   ///< metres
  double angle_deg;  ///< of the smoothed normals
};

/// Regions by falling area; every used item in one region at most.
std::vector<Region> grow_regions(const Items& items, const std::vector<Vec3>& smooth,
                                 const GrowingOptions& options);
/// Items of no region join a neighbouring region whose plane they lie on within `distance`.
void absorb_rest(const Items& items, double distance, std::vector<Region>& regions);
/// Pairs of regions (a < b) with neighbouring items, rising.
std::vector<std::pair<int, int>> neighboring_regions(const Items& items,
                                                     const std::vector<Region>& regions,
                                                     double gap);

}  // namespace colod::regions
