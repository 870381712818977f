// Inside room `publish`: what of a scene is no building, for the tileset.
#pragma once

#include <optional>

#include "exporters/tiles3d/context.h"
#include "outputs.h"

namespace colod {

/// Per node: tiles and images that could not be read when it was encoded.
using ContextFailures = std::vector<std::vector<ReadFailure>>;

/// Nothing where the scene has no context. It points into `scene` and fills `failures`.
std::optional<ContextTiles> context_tiles(const Scene& scene, const TextureOptions& options,
                                          ContextFailures& failures);

/// Each once: of the finest tiles as failures of the scene, of coarser ones as warnings.
void tell_failures(const ContextFailures& failures, Scene& scene);

}  // namespace colod
