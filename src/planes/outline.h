// Inside room `planes`: regions → outlines.
#pragma once

#include <vector>

#include "core/geometry.h"
#include "items.h"
#include "region.h"

namespace colod::regions {

/// Per region its outline; small holes are filled, and rings that end near a neighbouring plane are
/// drawn to it, when `is_robust`.
std::vector<Outline> make_outlines(const Items& items, const std::vector<Region>& regions,
                                   double distance, bool is_robust);
/// m²
double outline_area(const Outline& outline);

}  // namespace colod::regions
