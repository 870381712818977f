// Inside room `relief`: what a mesh knows of its building.
#pragma once

#include "core/geometry.h"

namespace colod::relief {

struct Melting {
  double edge = 0;    ///< metres: the typical one, about the median of even triangles
  double bulge = 0;   ///< metres: residual of a piece of wall or roof as wide as a window
  double lean = 0;    ///< z of the walls' outward normals, their mean: noise leans both ways
  double drawn = 0;   ///< 0..1 of the area: as people draw (core/drawn.h)
  double raster = 0;  ///< metres: side of the cells of a raster (relief.h); 0: it is none

  /// Walls lean outward: drawn from heights, or from pictures that were taken from above.
  bool is_leaning() const;
  /// Even a wall is a few triangles.
  bool is_wide() const;
  /// Windows and dormers are no larger than what the mesh cannot tell.
  bool is_coarse() const;
  bool is_melted() const;
  /// Metres: what is nearer to a plane may lie on it.
  double reach() const;
};

Melting measure_melting(const Mesh& mesh);

}  // namespace colod::relief
