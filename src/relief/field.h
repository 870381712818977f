// Inside room `relief`: a mesh seen from above, as heights on a square grid.
#pragma once

#include <array>
#include <vector>

#include "core/geometry.h"
#include "core/rays.h"

namespace colod::relief {

struct Field {
  double cell = 0;  ///< metres
  Vec2 origin = Vec2::Zero();
  int columns = 0, rows = 0;
  std::vector<double> height;  ///< per cell; NaN where nothing is seen
  std::vector<int> face;       ///< per cell: the face seen; −1
  std::vector<char> is_steep;  ///< per cell: a wall, or the side of a melted one

  int size() const { return columns * rows; }
  bool has(int i) const { return face[i] >= 0; }
  Vec2 center(int i) const { return origin + cell * Vec2(i % columns + 0.5, i / columns + 0.5); }
  /// The cell that holds p; −1: out of the grid.
  int at(const Vec2& p) const;
  /// The four cells beside i; −1 beyond the grid.
  std::array<int, 4> beside(int i) const;
};

/// `raster`: metres, the side of its cells; 0: the mesh is none. A wall of a raster is one cell
/// wide, so that what is steep over more of them is a steep roof.
Field make_field(const Mesh& mesh, const RayScene& rays, double edge, double raster);

/// Metres: residual in height of a piece of roof as wide as a room.
double roof_noise(const Field& field);

}  // namespace colod::relief
