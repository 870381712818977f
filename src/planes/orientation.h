// Inside room `planes`: which way planes look.
#pragma once

#include <vector>

#include "core/geometry.h"

namespace colod::regions {

/// Turns planes from whose back clearly more rays escape than from their front; in airborne clouds
/// what looks away from the sky or towards the roof above it. Returns how many.
int repair_orientation(std::vector<Plane>& planes, bool is_cloud);

}  // namespace colod::regions
