// Inside the synth room: what a laser sees of a piece of a town from above.
#pragma once

#include "scene.h"
#include "scene_surface.h"

namespace colod::synth {

/// The tile's own points; what neighbours have does not hang on where the border is.
std::vector<SynthPoint> scan_from_above(const Town& town, const std::map<int, Standing>& standing,
                                        const SkyView& view, const TilePlace& place, double density,
                                        std::uint64_t seed);

}  // namespace colod::synth
