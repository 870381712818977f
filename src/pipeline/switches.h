// When the layers of a scene's buildings switch (measure/switching.h), once all are there.
#pragma once

#include "pipeline.h"

namespace colod {

/// After the last building: sets own_gsd and gsd of all layers, and the scene's switching. With a
/// prior that has sights, its buildings decide the scene's g. Layers are numbered below `layers`.
void decide_switches(Scene& scene, int layers, const SwitchOptions& options,
                     const std::vector<BuildingSights>& prior = {});
/// The same in two steps, for buildings that are not all in memory: what the scene's buildings
/// bring decides, in any order, and then for each building.
Switching plan_switches(const std::vector<BuildingSights>& own, int layers,
                        const SwitchOptions& options,
                        const std::vector<BuildingSights>& prior = {});
void apply_switches(const Switching& switching, Building& building);

}  // namespace colod
