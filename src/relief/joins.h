// Inside room `relief`: roofs that nothing parts are one.
#pragma once

#include "field.h"
#include "labels.h"

namespace colod::relief {

/// Metres between two roofs that have a wall between them.
double least_step(double noise);

/// A roof that along most of its border with a larger one neither steps nor bends, and whose plane
/// is no farther from that one's than the least step, is of it: no wall and no crease would say
/// where it ends.
void join_borderless(const Field& field, const Scales& scales, Labels& labels);

}  // namespace colod::relief
