// Inside the pipeline: the round shapes of a building on its layers.
#pragma once

#include <vector>

#include "planes/planes.h"
#include "rounds/rounds.h"

namespace colod {

/// A layer's planes where round shapes have fewer sides.
struct ReducedLayer {
  Planes planes;  ///< the building's, then the new sides; what these stand for has no outline
  std::vector<int> which;  ///< planes of the layer: old sides are out, new ones in
  std::vector<int> real;   ///< per plane: one of the building's that it stands for; −1: none
};

/// Marks the planes that are sides of a round shape.
void mark_sides(const std::vector<RoundShape>& shapes, Planes& planes);

/// The shapes with no side that turns more than `turn` radians from the next; a new side is on the
/// layer when more than half of what it stands for is.
ReducedLayer reduce_layer(const Planes& planes, const std::vector<int>& layer_planes,
                          const std::vector<RoundShape>& shapes, double turn);

}  // namespace colod
