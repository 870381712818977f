// Inside room `relief`: which roof each place of the field belongs to.
#pragma once

#include <vector>

#include "field.h"
#include "ground.h"
#include "patches.h"

namespace colod::relief {

constexpr int kOutside = -1;

struct Labels {
  std::vector<int> of_cell;  ///< a patch, or kOutside
  std::vector<Patch> patches;
};

/// What tells a roof from a bump.
struct Scales {
  double noise = 0;      ///< metres, as for find_patches
  double span = 0;       ///< metres, likewise
  double tolerance = 0;  ///< metres that a border may leave its line
  double raster = 0;     ///< metres: side of a raster's cells, as wide as its walls; 0: it is none
};

/// Every cell of the building gets a patch: walls, holes and what is too small or too rough for one
/// of its own go to the neighbour whose height is nearest.
Labels label_field(const Field& field, const Ground& ground, Patches patches, const Scales& scales);

/// The same labels; what no square of twice the tolerance fits into goes to its neighbours.
Labels square_labels(const Field& field, const Ground& ground, Labels labels, const Scales& scales);

}  // namespace colod::relief
