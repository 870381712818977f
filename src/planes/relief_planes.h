// Inside room `planes`: what relief_planes and detect_planes share.
#pragma once

#include <vector>

#include "core/geometry.h"

namespace colod::regions {

constexpr const char* kNoPlane = "no plane found: the surface is empty or too small";

/// Largest area first, ties by centroid.
void sort_planes(std::vector<Plane>& planes);

}  // namespace colod::regions
