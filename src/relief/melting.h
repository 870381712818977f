// Inside room `relief`: what a mesh knows of its building.
#pragma once

#include "core/geometry.h"

namespace colod::relief {

struct Melting {
  double edge = 0;        ///< metres: median edge
  double bulge = 0;       ///< metres: residual of a piece of wall or roof as wide as a window
  double looks_down = 0;  ///< 0..1 of the area of walls: of a height field nothing does

  /// Walls lean outward everywhere: drawn from heights, or from pictures taken from above.
  bool is_height_field() const;
  /// Windows and dormers are no larger than what the mesh cannot tell.
  bool is_coarse() const;
  bool is_melted() const;
  /// Metres: what is nearer to a plane may lie on it.
  double reach() const;
};

Melting measure_melting(const Mesh& mesh);

}  // namespace colod::relief
