// Inside the synth room: what walls, roofs, glass and doors look like.
#pragma once

#include <cmath>

#include "core/element_kind.h"
#include "core/geometry.h"

namespace colod::synth {

using Light = Eigen::Vector3d;  ///< linear, 0..1

/// 0..1, by whole numbers.
double noise(long a, long b, long c);
/// 0..1, as `noise` at whole numbers and smooth between them.
double smooth_noise(const Vec3& p, long seed);
inline long cell(double v) { return static_cast<long>(std::floor(v)); }

/// A place that a texel shows.
struct Spot {
  Vec3 place, normal;
  ElementKind kind;
  bool is_green = false;  // about the house, none of it
};

/// What places of one house look like.
class Paint {
 public:
  Paint(double foot, long seed) : foot_(foot), seed_(seed) {}

  Light at(const Spot& spot, const Vec3& p) const;

 private:
  Light surface(const Vec3& p, const Vec3& normal, ElementKind kind) const;
  Light glass(double up) const;
  Light wood(const Vec3& p, const Vec3& normal) const;
  Light roof(const Vec3& p, const Vec3& normal) const;

  double foot_;
  long seed_;
};

}  // namespace colod::synth
