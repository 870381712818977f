// Based on: 3D Tiles 1.1, tile transforms.
// Differs: the transform's columns are the derivatives of the map to ECEF at the origin, so that
// grid convergence and the scale of the projection are in it, instead of east, north and up.
#include "frame.h"

#include <Eigen/LU>

namespace colod {

namespace {

constexpr double kStep = 10;  // metres, of the central differences

std::array<double, 16> columns(const Eigen::Matrix3d& axes, const Vec3& centre) {
  std::array<double, 16> out{};
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) out[4 * c + r] = axes(r, c);
  for (int r = 0; r < 3; ++r) out[12 + r] = centre[r];
  out[15] = 1;
  return out;
}

}  // namespace

TileFrame::TileFrame(const Placement& placement, const Vec3& origin)
    : placement_(placement),
      origin_(origin),
      centre_(origin),
      axes_(Eigen::Matrix3d::Identity()),
      inverse_(axes_) {
  if (!is_on_earth()) return;
  centre_ = placement_.to_ecef(origin);
  for (int k = 0; k < 3; ++k) {
    const Vec3 step = kStep * Vec3::Unit(k);
    axes_.col(k) =
        (placement_.to_ecef(origin + step) - placement_.to_ecef(origin - step)) / (2 * kStep);
  }
  inverse_ = axes_.inverse();
}

Vec3 TileFrame::local(const Vec3& world) const {
  if (!is_on_earth()) return world - origin_;
  return inverse_ * (placement_.to_ecef(world) - centre_);
}

std::array<double, 16> TileFrame::to_ecef() const { return columns(axes_, centre_); }

std::array<double, 16> TileFrame::to_parent(const TileFrame& parent) const {
  return columns(parent.inverse_ * axes_, parent.inverse_ * (centre_ - parent.centre_));
}

Box moved(const Box& box, const std::array<double, 16>& t) {
  Box out;
  for (int c = 0; c < 8; ++c) {
    const Vec3 p(c & 1 ? box.max.x() : box.min.x(), c & 2 ? box.max.y() : box.min.y(),
                 c & 4 ? box.max.z() : box.min.z());
    Vec3 q;
    for (int r = 0; r < 3; ++r)
      q[r] = t[r] * p.x() + t[4 + r] * p.y() + t[8 + r] * p.z() + t[12 + r];
    out.extend(q);
  }
  return out;
}

}  // namespace colod
