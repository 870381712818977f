// A door of room `rounds`: round shapes of fewer sides.
#pragma once

#include "shape.h"

namespace colod {

/// The same shape of fewer sides: no two neighbours turn by much more than `turn` radians. Closed
/// shapes keep their cross-section's area, open ones their ends. A side has the faces of those that
/// it stands for.
RoundShape reduce_round(const RoundShape& shape, double turn);

/// The largest turn that keeps the surface within `tolerance` metres of the shape's.
double turn_within(const RoundShape& shape, double tolerance);

}  // namespace colod
