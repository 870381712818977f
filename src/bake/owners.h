// Inside room `bake` only: which triangle of a chart a texel belongs to.
#pragma once

#include <array>
#include <vector>

#include "core/flat.h"
#include "core/geometry.h"
#include "fill.h"
#include "parameters.h"

namespace colod::bake {

/// A triangle of a chart on the chart's plane, counter-clockwise, in texels of the atlas.
struct Corners {
  std::array<Vec2, 3> at;

  /// Makes it counter-clockwise.
  void orient() {
    if (cross(at[1] - at[0], at[2] - at[0]) < 0) std::swap(at[1], at[2]);
  }
  bool holds(const Vec2& q) const;
  Vec2 nearest(const Vec2& q) const;
};

/// Of a texel, the nearest of some triangles.
struct Owner {
  int triangle = -1;                            ///< −1: none within the border
  double distance = parameters::bake::kBorder;  ///< texels, from the middle; 0: it holds it
};

/// Per texel of a window, row by row. O(texels in the triangles' boxes).
std::vector<Owner> owners(const Window& w, const std::vector<Corners>& triangles);

}  // namespace colod::bake
