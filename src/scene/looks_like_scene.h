// Whether what is given as a building is a whole place.
#pragma once

#include <string>

#include "core/geometry.h"
#include "survey.h"

namespace colod {

/// For a message: `why` is empty where nothing tells against one building.
struct PlaceDoubt {
  std::string why;
  bool is_certain = false;  ///< several buildings, parts of them, or none: no single one
  std::string place;        ///< of several whole buildings on terrain: how many; else empty
};

/// What tells that a mesh is a place with terrain and several buildings, or a piece of one. Nothing
/// does of what is drawn, less than 5 m wide, or no mesh. O(faces log faces + cells of its plan).
PlaceDoubt looks_like_scene(const Source& source);

/// The same of the surface of a cloud; a doubt where it is 50 m wide and shows much terrain, yet
/// not several buildings that stand apart.
PlaceDoubt looks_like_scene(const HeightMap& map);

/// Whether its plan is 50 m long: few buildings are.
bool is_wide(const Source& source);

}  // namespace colod
