// Inside room `relief`: roofs as a person would draw them.
#pragma once

#include <vector>

#include "field.h"
#include "labels.h"

namespace colod::relief {

/// The labels' patches fitted to what lies on them; then level, square to the building's
/// `direction` (radians) and alike in tilt where the noise excuses it, so that eaves and ridges are
/// level.
std::vector<Patch> regular_roofs(const Field& field, const Labels& labels, double direction,
                                 double noise);

}  // namespace colod::relief
