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

/// How many sides of its plan's box the surface ends at straight, as tilers cut: where open edges
/// lie in the side's upright plane and span it.
int straight_sides(const Mesh& mesh, const std::vector<Edge>& open, const Box& box);

/// Per cell: whether the surface ends there at its top, and not at the foot of a wall.
std::vector<char> ends_at_top(const Mesh& mesh, const std::vector<Edge>& open,
                              const HeightMap& map);

}  // namespace colod
