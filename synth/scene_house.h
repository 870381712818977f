// Inside the synth room: the buildings of a made-up scene.
#pragma once

#include "town.h"
#include "variety.h"

namespace colod::synth {

struct SceneHouse {
  House house;
  Plan footprint;  ///< of walls and eaves, in the house's frame
};

/// What stands on a plot; the plot alone decides.
SceneHouse make_scene_house(const Plot& plot, const Pool& pool);

/// Its clean model. `is_local`: about the plot's own origin, with the scene's directions.
SynthBuilding place_scene_house(const SceneHouse& made, const Plot& plot, const std::string& name,
                                bool is_local);

}  // namespace colod::synth
