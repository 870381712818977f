// Layers that show a finer one's mesh, since their own would not do.
#pragma once

#include "measure/solid.h"
#include "pipeline.h"

namespace colod {

/// What happened to a layer whose mesh is another's, as a clause without its name.
const char* describe(StandIn reason);

/// Detail rises along the chain, and (Rule::kVolume) all layers enclose about the same building.
void keep_chain_sound(Building& building, const Options& options);

/// Measures how much of each layer is invented; where it is too much (measure/scene_part.h) and
/// `is_replaced`, the next finer layer's mesh stands in.
void replace_invented(const Surface& source, bool is_replaced, Building& building);

}  // namespace colod
