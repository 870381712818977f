// Inside room `segments`: which planes elements own.
#pragma once

#include "planes/planes.h"
#include "rules.h"
#include "visibility/visibility.h"

namespace colod {

/// The planes of each balcony, and of each loggia all of whose planes are smaller than
/// `alcove_area`, become one segment, and the walls of a chimney that its segment has little of;
/// before the coverage is known.
void give_to_elements(const Planes& planes, const HitGrid& grid, double alcove_area,
                      SegmentDraft& draft);

}  // namespace colod
