// Inside room `job`: what of a scene is no building.
#pragma once

#include <memory>

#include "scene_input.h"

namespace colod {

/// The tiles of the scene without what buildings stand for, and ground that closes them below: on
/// the source's own levels where it has some, else with coarser tiles of the program's own. What is
/// over an unbuilt footprint stays. kGround: the terrain alone. What of a node cannot be read is
/// among its warnings, "file: cause". The scene has a map.
std::shared_ptr<const Context> context_of(const std::shared_ptr<const PartedScene>& scene,
                                          const std::vector<char>& is_unbuilt, ContextMode mode,
                                          const ReadOptions& options, const SceneOutput& output);

}  // namespace colod
