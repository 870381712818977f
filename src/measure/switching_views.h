// Inside switching: pictures of a building from far away.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry.h"
#include "picture_difference.h"

namespace colod {

/// An orthographic camera over a frame of samples.
struct FarView {
  Vec3 right, up, forward;  ///< unit
  Vec3 light;               ///< unit, to the light: over the viewer's left shoulder
  Vec3 corner;              ///< the middle of the upper left sample, at no particular depth
  double sample = 0;        ///< metres
  int width = 0, height = 0;
};

/// A view along −`direction` (towards the viewer, unit, not vertical) that frames the box with a
/// margin of sky.
FarView far_view(const Box& box, const Vec3& direction, double sample);

/// One mesh in one view, ready to be averaged to any pixel of n × n samples.
class FarPicture {
 public:
  /// Front faces only: the mesh is closed.
  FarPicture(const Mesh& mesh, const FarView& view);
  GreyPicture at(int samples_a_pixel) const;

 private:
  int width_, height_;
  std::vector<std::uint32_t> luminance_, coverage_;  ///< sums from the upper left corner
};

}  // namespace colod
