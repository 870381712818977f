// Inside the synth room: roofs of equal slope over any axis-parallel plan.
#pragma once

#include "outlines.h"
#include "parts.h"

namespace colod::synth {

struct HippedRoof {
  double slope = 0.9;         ///< rise over run
  double gable_share = 0;     ///< of the ends that can be gables
  double steep_share = 0;     ///< of the others: hips steeper than the roof
  double step_thickness = 0;  ///< metres of wall that rises over gables in steps; 0: none. Only
                              ///< where the eaves lie on the walls
  int steps = 4;              ///< on either side of a gable
  int gable_object = 1;       ///< kRoof where gables stand on the eaves' edge
};

struct RoofFacets {
  std::vector<int> slopes, gables;
};

/// Over the plan from height z on. Ends that are as the roof's own slope makes them are hips.
RoofFacets add_hipped_roof(House& house, const Plan& eaves, double z, const HippedRoof& roof);

/// Heights over a rectangle [0, width] × [0, depth]: a profile from front to back, with a wave
/// along x for corrugated sheets.
struct ProfileRoof {
  std::vector<Vec2> profile;  ///< (y, z), y rising from 0 to the depth
  double wave_length = 0;     ///< metres; 0: smooth
  double wave_height = 0;     ///< metres from trough to crest
};

/// A closed hall: floor on the ground, four walls, the roof. Parts go on what it returns.
struct ProfileBody {
  int front = -1, right = -1, back = -1, left = -1;
  std::vector<int> roofs;  ///< of a smooth roof only
};
ProfileBody add_profile_body(House& house, const ProfileRoof& roof);

}  // namespace colod::synth
