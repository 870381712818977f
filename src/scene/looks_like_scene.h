// Whether what is given as a building is a whole place.
#pragma once

#include <string>

#include "core/geometry.h"

namespace colod {

/// What tells that a mesh is a place with terrain and several buildings, or a piece of one, for a
/// message; empty: it is a building, drawn, too small to tell, or no mesh. O(cells of its plan).
std::string looks_like_scene(const Source& source);

/// Whether its plan is 50 m long: few buildings are.
bool is_wide(const Source& source);

}  // namespace colod
