// A height map → ground, buildings, plants and the rest.
#pragma once

#include <vector>

#include "place/footprints.h"
#include "survey.h"

namespace colod {

struct SceneClasses {
  std::vector<SceneClass> of_cell;  ///< as long as the map
  std::vector<int> building;        ///< per cell: its number; −1: none
  std::vector<float> ground;        ///< per cell: metres, also where something stands
  int buildings = 0;
};

/// By height over the ground, by how well the surface fits a plane about each cell, and by how
/// green it is where there are colours; where the map's source tells ground, buildings or plants,
/// it is believed. Blocks are parted where roofs lie at different heights. O(cells · log cells).
/// Deterministic.
SceneClasses classify(const HeightMap& map);

/// Houses that share walls → each a building of its own, along straight lines across their block at
/// which roofs step or change their colour. O(cells). Deterministic.
void part_rows(const HeightMap& map, SceneClasses& classes);

/// What is narrow, small beside the building that it touches most, and touches it along a quarter
/// of its rim is no building: at half that one's height and more (the foot of a melted wall,
/// stairs) it becomes part of it, lower (goods, hedges, canopies) it is the rest. What a
/// source tells is believed: nothing changes. O(cells). Deterministic.
void settle_annexes(const HeightMap& map, SceneClasses& classes);

/// The plan of each building: its cells' border, straightened along the building's own directions.
/// Attributes: height over the ground and area.
std::vector<Footprint> outline_buildings(const HeightMap& map, const SceneClasses& classes);

}  // namespace colod
