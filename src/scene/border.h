// Where a surface ends: whether as a tiler cut it off, and whether through what stands there.
#pragma once

#include <array>
#include <vector>

#include "core/geometry.h"
#include "survey.h"

namespace colod {

using Edge = std::array<int, 2>;

/// Edges of one face, lower vertex first. O(faces log faces).
std::vector<Edge> open_edges(const Mesh& mesh);

/// How many sides of its plan the surface ends at straight, as tilers cut, whichever way they run:
/// where open edges lie in the upright plane of a long side of the plan's hull, and span it.
/// O(vertices log vertices + edges).
int straight_sides(const Mesh& mesh, const std::vector<Edge>& open);

/// Per cell: whether the surface ends there at its top, and not at the foot of a wall.
std::vector<char> ends_at_top(const Mesh& mesh, const std::vector<Edge>& open,
                              const HeightMap& map);

}  // namespace colod
