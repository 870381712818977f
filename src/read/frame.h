// Between `read` and `planes`: a building's own frame, so that where it stands and how it is turned
// changes nothing.
//
// The local frame has its origin at the box's centre on the building's foot and its x axis along
// the main horizontal direction of the walls, which of the four by where the mass lies. Local
// coordinates are rounded to a 2^-16 m grid, equal vertices merged and items sorted, so that a
// permuted, moved or quarter-turned input gives the same numbers.
#pragma once

#include "core/geometry.h"

namespace colod {

/// local = R(-yaw) (world − origin); world = R(yaw) local + origin. Rotation about z.
struct Frame {
  Vec3 origin = Vec3::Zero();
  double yaw = 0;  ///< radians, [0, 2π)

  Vec3 to_local(const Vec3& world) const;
  Vec3 to_world(const Vec3& local) const;
};

/// The frame of a source in world coordinates (z up). Never fails: no walls gives yaw 0.
Frame main_frame(const Source& source);

/// The source in its frame, in canonical order: vertices rounded, merged and sorted; degenerate and
/// duplicate faces (equal up to rotation) dropped with a warning; faces and points sorted.
/// `face_object` follows. `original_item[i]`, when asked for, receives the index in `source` of
/// item i.
Source localize(const Source& source, const Frame& frame,
                std::vector<int>* original_item = nullptr);

}  // namespace colod
