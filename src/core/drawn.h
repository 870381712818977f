// Whether a surface was drawn by people or measured by machines.
#pragma once

#include "geometry.h"

namespace colod {

/// 0..1 of the area (z up): faces that are upright or level to the last digit. People draw so;
/// what was measured has hardly any. 0 of an empty mesh.
double drawn_share(const Mesh& mesh);

/// Of the area, in such faces: a mesh with more of it is drawn.
constexpr double kLeastDrawn = 0.3;

}  // namespace colod
