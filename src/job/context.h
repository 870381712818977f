// Inside room `job`: what of a scene is no building.
#pragma once

#include <memory>

#include "scene_input.h"

namespace colod {

/// The tree of the scene's own tiles, each without what buildings stand for, and beside it one tile
/// of ground that closes it below them. The scene has a map.
std::shared_ptr<const Context> context_of(const std::shared_ptr<const PartedScene>& scene,
                                          const ReadOptions& options);

}  // namespace colod
