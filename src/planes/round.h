// Inside room `planes`: the sides of round shapes.
#pragma once

#include <vector>

#include "core/rules.h"
#include "items.h"
#include "region.h"

namespace colod::regions {

/// A region for each side of the source's round shapes, on the shape's own planes.
std::vector<Region> round_regions(const Items& items, const RuleSet& rules);

}  // namespace colod::regions
