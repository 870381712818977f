// Inside room `planes`: regions joined and aligned.
#pragma once

#include <vector>

#include "items.h"
#include "region.h"

namespace colod::regions {

/// Metres that aligning may move a region (root mean square over its own surface): as much as it is
/// off its own plane, but within these; and how far parallel planes that become one may be apart.
struct AlignOptions {
  double least_move;
  double most_move;
  double offset_width;
};
/// Joins nearly coplanar neighbours, then aligns directions and offsets where a region's own points
/// allow.
void regularize(const Items& items, double distance, const AlignOptions& align,
                std::vector<Region>& regions);

}  // namespace colod::regions
