// Inside the synth room: streets in which the size of a part does not tell its kind.
#pragma once

#include "bodies.h"

namespace colod::synth {

/// Building number `index` of the street: one of the styles, a cottage or a hall, with parts of all
/// sizes from the street's pool. `street` and `seed`: the street's seed and the building's.
House make_mixed_house(int index, int style, std::uint64_t street, std::uint64_t seed);

/// Whether a part of the kind belongs on layer 1 where sizes are mixed.
bool is_large_kind(ElementKind kind);

}  // namespace colod::synth
