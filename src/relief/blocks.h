// Inside room `relief`: roof houses, dormers, chimneys and terraces as upright blocks on the roofs.
#pragma once

#include "field.h"
#include "labels.h"

namespace colod::relief {

/// Rectangles along the grid over which the heights stand off their roof, up or down, by more than
/// the noise, and that explain what a plane costs, get a patch each: level, or as the roof slopes.
void raise_blocks(const Field& field, const Scales& scales, Labels& labels);

}  // namespace colod::relief
