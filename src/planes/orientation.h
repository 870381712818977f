// Inside room `planes`: which way planes look.
#pragma once

#include <vector>

#include "core/geometry.h"

namespace colod::regions {

/// Turns planes from whose back clearly more rays escape than from their front; in airborne clouds,
/// where `is_airborne_told`, what looks away from the sky or towards the roof above it. Returns how
/// many.
int repair_orientation(std::vector<Plane>& planes, bool is_airborne_told);

}  // namespace colod::regions
