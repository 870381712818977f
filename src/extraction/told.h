// Inside room `extraction`: what elements say of cells.
#pragma once

#include <vector>

#include "elements/elements.h"
#include "evidence.h"
#include "partition/partition.h"

namespace colod {

/// What rays cannot say: air in balconies and loggias is outside, a chimney is solid, thin walls
/// are left to their outlines.
void tell_cells(const Partition& partition, const std::vector<Element>& elements,
                Evidence& evidence);

}  // namespace colod
