// Inside room `planes`: regions → outlines.
#pragma once

#include <vector>

#include "core/geometry.h"
#include "core/rules.h"
#include "items.h"
#include "region.h"

namespace colod::regions {

/// Per region its outline; small holes are filled (Rule::kHoles), and rings that end near a
/// neighbouring plane are drawn to it (Rule::kBorders).
std::vector<Outline> make_outlines(const Items& items, const std::vector<Region>& regions,
                                   double distance, const RuleSet& rules);
/// m²
double outline_area(const Outline& outline);

}  // namespace colod::regions
