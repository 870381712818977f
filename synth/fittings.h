// Inside the synth room: what a varied house's walls and roofs are fitted with.
#pragma once

#include "pool.h"
#include "shaped.h"

namespace colod::synth {

/// How a house is divided, and what it has of each.
struct Fitting {
  Makes makes;
  std::vector<double> floors;  ///< heights [m]
  double floor_height = 2.8;
  double spacing = 2.8;   ///< of windows along street and back
  double side_share = 1;  ///< of the other walls that have windows
  double sill = 0.9;
  bool has_arcade = false, has_shop = false, has_bay = false, has_loggias = false;
  bool is_arched = false, is_ribbon = false;
  double balcony_share = 0;   ///< of the places for them
  double cornice_share = 0;   ///< of the floors
  double recess_depth = 1.5;  ///< most metres into the house
};

/// Doors, recesses, balconies, bays, cornices and windows, on the building and its blocks.
void fit_walls(House& house, const ShapedBody& body, const Fitting& fitting);
void fit_wall_windows(House& house, int facet, double top, const Fitting& fitting);
/// A door on the ground about the share of the wall.
bool fit_door(House& house, int facet, double share, const DoorModel& door);
/// Dormers, chimneys, roof windows and rooms on flat roofs.
void fit_roofs(House& house, const ShapedBody& body, const Fitting& fitting);

}  // namespace colod::synth
