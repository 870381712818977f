// Inside room `publish`: what of a scene is no building, for the tileset.
#pragma once

#include <optional>

#include "exporters/tiles3d/context.h"
#include "outputs.h"

namespace colod {

/// Nothing where the scene has no context. It points into `scene`.
std::optional<ContextTiles> context_tiles(const Scene& scene, const TextureOptions& options);

}  // namespace colod
