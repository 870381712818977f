// Inside room `segments`: which planes elements own.
#pragma once

#include "planes/planes.h"
#include "rules.h"
#include "visibility/visibility.h"

namespace colod {

/// The planes of each balcony, and of each loggia all of whose planes are smaller than
/// `alcove_area`, become one segment (Rule::kElementSegments), and segments that are chimneys get
/// their name; what was known of the coverage is void.
void give_to_elements(const Planes& planes, const HitGrid& grid, const SegmentOptions& options,
                      SegmentDraft& draft);

}  // namespace colod
