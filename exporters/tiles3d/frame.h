// The frames that tiles live in: one for the tileset, one for every cell.
#pragma once

#include <array>

#include "exporters/exporter.h"

namespace colod {

/// Local axes are the world's (x, y, z up, metres), about `origin`. With a place on Earth the map
/// to ECEF is taken to first order at the origin for the tile's transform, and exactly for
/// positions, so that no point is off by more than rounding, however far from the origin.
class TileFrame {
 public:
  /// `placement` must outlive the frame.
  TileFrame(const Placement& placement, const Vec3& origin);

  Vec3 local(const Vec3& world) const;
  const Vec3& origin() const { return origin_; }
  bool is_on_earth() const { return static_cast<bool>(placement_.to_ecef); }

  /// Tile transforms, 4 × 4 by columns: local → ECEF, and local → the parent's frame.
  std::array<double, 16> to_ecef() const;
  std::array<double, 16> to_parent(const TileFrame& parent) const;

 private:
  const Placement& placement_;
  Vec3 origin_, centre_;  // world; ECEF or, nowhere on Earth, the world's
  Eigen::Matrix3d axes_, inverse_;
};

/// The box about a box moved by a transform.
Box moved(const Box& box, const std::array<double, 16>& transform);

}  // namespace colod
