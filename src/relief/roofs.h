// Inside room `relief`: roofs as a person would draw them.
#pragma once

#include <vector>

#include "field.h"
#include "labels.h"

namespace colod::relief {

/// The labels' patches fitted to what lies on them; then level, square to the building's
/// `direction` (radians) and alike in tilt where the noise excuses it, so that eaves and ridges are
/// level. Roofs that lie in a larger one's plane are of it.
void regular_roofs(const Field& field, double direction, double noise, Labels& labels);

}  // namespace colod::relief
