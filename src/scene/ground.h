// Between the frame and room `planes`: the terrain that a raw mesh carries, and what stands about
// on it, out of the building's mesh.
#pragma once

#include "core/geometry.h"

namespace colod {

/// The building of a mesh that stands on its own piece of ground: faces of the ground, and of cars,
/// bushes and other small or low things on it, are left out, with a warning that says how much.
/// Unchanged where no ground is found for certain: clouds, buildings alone, roofs alone. A ground
/// is a surface seen from above that holds most of the model's rim, has no storey below it there,
/// within 2 m of the rim, so that it is no flat roof, and from which walls rise at least 2 m.
/// `source` is in its local frame (z up); the result keeps its order. Deterministic; O(faces + m²
/// of their surface).
Source separate_ground(Source source);

}  // namespace colod
