// Inside room `planes`: regions joined and aligned.
#pragma once

#include <vector>

#include "core/rules.h"
#include "items.h"
#include "region.h"

namespace colod::regions {

/// Metres that aligning may move a region (root mean square over its own surface): as much as it is
/// off its own plane, but within these; and how far parallel planes that become one may be apart.
struct AlignOptions {
  double least_move;
  double most_move;
  double offset_width;
  bool is_strip_turned;  ///< whether narrow strips may turn farther than others
};
/// Joins nearly coplanar neighbours, then aligns directions and offsets where a region's own points
/// allow, as far as the rules for each are on.
void regularize(const Items& items, double distance, const AlignOptions& align,
                const RuleSet& rules, std::vector<Region>& regions);

}  // namespace colod::regions
