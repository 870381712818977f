// Inside looks: what can be told of a layer from its facets alone.
#pragma once

#include <vector>

#include "looks.h"

namespace colod {

/// Sets what facets and edges tell: walls, edges, eaves, narrow facets, and their worst places.
/// Returns the number of each face's facet. \pre all faces are finite and have an area.
std::vector<int> look_at_facets(const Mesh& mesh, double least_width, Looks& looks);

}  // namespace colod
