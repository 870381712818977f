// Inside room `relief`: which cells are ground, and how high it lies.
#pragma once

#include <vector>

#include "field.h"

namespace colod::relief {

struct Ground {
  std::vector<char> is_ground;  ///< per cell
  std::vector<double> height;   ///< per cell: of the nearest ground; everywhere `foot` without any
  double foot = 0;              ///< metres: where the building's walls end
};

/// The skirt around a building: what is low and reached from the rim without a step. There may be
/// none, and is none without `has_ground`.
Ground find_ground(const Field& field, const Mesh& mesh, bool has_ground = true);

}  // namespace colod::relief
