// How far one surface lies from another, for errors that a viewer can see.
#pragma once

#include "../src/rays.h"
#include "exporter.h"

namespace colod {

/// Largest distance from `from` to the scene's surface, over the vertices and a lattice on every
/// triangle that is no wider than `spacing` (metres; at most 128 steps an edge). 0 for no triangle.
/// What is no farther than `known` need not be found: the result is at least that.
double one_sided_deviation(const Mesh& from, const RayScene& to, double spacing, double known = 0);

/// Raises each layer's geometric_error to its distance, both ways, to the next finer layer and to
/// the finest one: where a client switches, what a layer adds shows as much as what it lacks.
void measure_visible_errors(ExportBuilding& building);

}  // namespace colod
