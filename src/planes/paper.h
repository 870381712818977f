// Inside room `planes`: region growing to the letter.
#pragma once

#include <vector>

#include "items.h"
#include "planes.h"
#include "region.h"

namespace colod::regions {

/// CGAL's region growing at the options' distance, angle and count.
std::vector<Region> grow_with_cgal(const Items& items, const PlaneOptions& options);

}  // namespace colod::regions
