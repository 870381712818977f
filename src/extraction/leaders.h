// Inside room `extraction`: planes that are cut along a larger one.
#pragma once

#include <vector>

#include "planes/planes.h"

namespace colod {

/// Per plane of `layer_planes` the plane whose place it takes, most often itself: a larger one that
/// looks about the same way and that its whole outline is within `tolerance` metres of.
std::vector<int> find_leaders(const Planes& planes, const std::vector<int>& layer_planes,
                              double tolerance);

}  // namespace colod
