// Inside room `relief`: roofs as few planes, by what a plane explains against what it costs.
#pragma once

#include <vector>

#include "core/geometry.h"
#include "field.h"

namespace colod::relief {

/// z = height(p) over a part of the field.
struct Patch {
  Vec2 slope = Vec2::Zero();
  double level = 0;     ///< metres, at the field's origin
  double area = 0;      ///< m² in plan
  double residual = 0;  ///< metres: root mean square of its cells in height
  double height(const Vec2& from_origin) const { return level + slope.dot(from_origin); }
};

struct Patches {
  std::vector<Patch> patches;
  std::vector<int> patch_of_cell;  ///< −1: ground, steep, or nothing is seen
};

/// Parts the cells in `is_roof` into patches, each connected: the cheapest of two neighbours are
/// joined until none pays. `noise` in metres; `span`: metres that bumps are wide.
Patches find_patches(const Field& field, const std::vector<char>& is_roof, double noise,
                     double span);

}  // namespace colod::relief
