// Inside the synth room: houses of many plans and makes for development and testing.
#pragma once

#include "parts.h"

namespace colod::synth {

/// Building number `index` of a varied street; `seed`: the building's own.
House make_varied_house(int index, std::uint64_t seed, const SynthOptions& options);

}  // namespace colod::synth
