// Points spread evenly and without chance.
#pragma once

#include <cmath>

#include "geometry.h"

namespace colod {

/// The k-th point of the R2 sequence (M. Roberts, "The unreasonable effectiveness of quasirandom
/// sequences", 2018) from (start, start): any stretch of it fills the unit square evenly.
/// \pre k ≥ 0, start ≥ 0.
inline Vec2 spread_in_square(double k, double start = 0) {
  return {std::fmod(start + k * 0.7548776662466927, 1.0),
          std::fmod(start + k * 0.5698402909980532, 1.0)};
}

/// The same on a triangle: the square's upper half is folded onto its lower one.
inline Vec3 spread_on_triangle(const Vec3& a, const Vec3& b, const Vec3& c, double k,
                               double start = 0) {
  Vec2 s = spread_in_square(k, start);
  if (s.x() + s.y() > 1) s = Vec2::Ones() - s;
  return a + s.x() * (b - a) + s.y() * (c - a);
}

}  // namespace colod
