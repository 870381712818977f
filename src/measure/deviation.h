// How far one surface lies from another, for errors that a viewer can see.
#pragma once

#include "core/rays.h"

namespace colod {

/// Largest distance from `from` to the scene's surface, over the vertices and a lattice on every
/// triangle that is no wider than `spacing` (metres; at most 128 steps an edge). 0 for no triangle.
/// What is no farther than `known` need not be found: the result is at least that.
double one_sided_deviation(const Mesh& from, const RayScene& to, double spacing, double known = 0);

/// The two-sided Hausdorff distance of two meshes, at least `known`. `scene_a` and `scene_b` hold
/// the same meshes. The lattice is as fine as 0.1 m or a 64th of b's diagonal, whichever is more.
double two_sided_deviation(const Mesh& a, const RayScene& scene_a, const Mesh& b,
                           const RayScene& scene_b, double known = 0);

}  // namespace colod
