// Inside the synth room: footprints drawn at random.
#pragma once

#include "parts.h"

namespace colod::synth {

struct DrawnPlan {
  std::string name;  ///< rectangle, l, t, u, z, court
  Plan plan;         ///< in [0, width] × [0, depth], the street before y = 0
  double width = 0, depth = 0;
  double wing = 0;  ///< of its narrowest wing [m]
};

/// `scale` stretches lengths; wings keep to what floors span.
DrawnPlan draw_plan(Random& random, double scale);
DrawnPlan draw_rectangle(Random& random, double least_width, double most_width, double least_depth,
                         double most_depth);

}  // namespace colod::synth
