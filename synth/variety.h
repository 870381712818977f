// Inside the synth room: houses of many plans and makes for development and testing.
#pragma once

#include "fittings.h"
#include "plans.h"
#include "pool.h"

namespace colod::synth {

// What houses are made with, drawn from the widest ranges.
Fitting draw_fitting(Random& r, const Pool& pool, int floors, double floor_height);
ShapedRoof draw_roof(Random& r, const DrawnPlan& drawn);
/// (y, z) from front to back: pitched, with teeth of glass, or a barrel.
std::vector<Vec2> draw_profile(Random& r, double depth, double eaves);

/// Building number `index` of a varied street; `seed`: the building's own.
House make_varied_house(int index, std::uint64_t seed, const SynthOptions& options);

}  // namespace colod::synth
