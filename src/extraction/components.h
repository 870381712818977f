// Inside room `extraction`: what of the inside hangs together, and how it touches itself.
#pragma once

#include <vector>

#include "parameters.h"
#include "partition/partition.h"

namespace colod {

using namespace parameters::extraction::components;

/// Keeps the largest face-connected set of inside cells by volume, and besides those of at least
/// `least_share` of its volume that stand in the lower third of its height (> 1: no others); false:
/// there is none.
bool keep_largest_components(const Partition& partition, std::vector<char>& is_inside,
                             double least_share);
/// Turns outside cells that no path of outside cells joins with the space beyond the box.
void fill_cavities(const Partition& partition, std::vector<char>& is_inside);

/// Turns cells round until the boundary is a closed 2-manifold, smallest first, each at most once,
/// then only by adding cells, which always ends. Returns the volume turned, m³.
double mend_pinches(const Partition& partition, std::vector<char>& is_inside);

}  // namespace colod
