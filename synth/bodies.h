// Inside the synth room: bodies with their roofs, and the styles of houses made of them.
#pragma once

#include <vector>

#include "parts.h"

namespace colod::synth {

/// Facets that parts go on. The ground floor's level is the facets' foot.
struct Body {
  int front = -1, right = -1, back = -1, left = -1;
  std::vector<int> roofs;  ///< front side first
};

struct RoofShape {
  double eaves = 6;    ///< height of the walls
  double slope = 0.9;  ///< rise over run
  double overhang = 0.3;
  double verge = 0;  ///< overhang at gables
  double thickness = 0.2;
};

/// Ridge along x over [0, width] × [0, depth].
Body add_gable_body(House& house, const RoofShape& shape);
/// Hipped; a pyramid when as deep as wide. Boxed eaves. `corner`: where the footprint begins.
Body add_hip_body(House& house, const RoofShape& shape);
/// Flat with a parapet of 0.4 m around it.
Body add_flat_body(House& house, double height);
/// A steep roof all around a flat top.
Body add_mansard_body(House& house, const RoofShape& shape, double run);
/// A gabled wing of `wing_width` from x = wing_x, `wing_depth` towards the street; `wing_front`
/// and the gable over it receive their facets. Front windows go on `front` and `front_right`.
struct WingedBody {
  Body main;
  int front_right = -1, wing_front = -1, wing_gable = -1, wing_left = -1, wing_right = -1;
};
WingedBody add_winged_body(House& house, const RoofShape& shape, double wing_x, double wing_width,
                           double wing_depth);
/// A nave with its ridge along y and a tower before its gable towards the street.
struct ChurchBody {
  Body main;  ///< front: left and right of the tower there is no facet for parts
  Body tower;
};
ChurchBody add_church_body(House& house, const RoofShape& shape, double tower_width,
                           double tower_height);

/// How many styles there are.
int style_count();
/// Builds style number `style` with everything on it.
House make_house(int style, std::uint64_t seed, const Catalogue& catalogue);

}  // namespace colod::synth
