// Inside room `measure`: what the two descriptions of light fields share.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/rays.h"
#include "light_field.h"

namespace colod::light_fields {

struct Pixel {
  int x, y;
  bool operator==(const Pixel&) const = default;
};

/// What every view frames: a sphere.
struct Bounds {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

/// Around the finite faces with an area; throws as describe_light_fields.
Bounds bounds_of(const Mesh& mesh);
/// What covers the frame, seen along a unit direction, orthographically.
Silhouette cast_silhouette(const RayScene& scene, const Bounds& bounds, const Vec3& direction);
/// One unit vector of each pair of opposite vertices of the upright dodecahedron.
std::array<Vec3, kViewCount> dodecahedron_axes();

/// All silhouettes of a model, the views of each light field together. Throws as
/// describe_light_fields.
std::vector<Silhouette> cast_silhouettes(const Mesh& mesh);

std::vector<Pixel> covered_pixels(const Silhouette& silhouette);
/// The border pixels of the largest 8-connected part, in order round it from outside.
std::vector<Pixel> outer_contour(const Silhouette& silhouette);

/// A magnitude of 0 … 1 in a byte.
inline std::uint8_t quantized(double value) {
  return static_cast<std::uint8_t>(std::min(255.0, std::floor(256 * value)));
}

/// Onto which view each of the 60 rotations moves each view.
using Permutation = std::array<int, kViewCount>;
std::vector<Permutation> view_permutations();

/// The least sum of differences between views over all pairs of light fields and all rotations.
template <typename Fields, typename Difference>
int least_distance(const Fields& a, const Fields& b, const Difference& difference) {
  const std::vector<Permutation> permutations = view_permutations();
  int best = std::numeric_limits<int>::max();
  for (const auto& field_a : a.views)
    for (const auto& field_b : b.views) {
      std::array<std::array<int, kViewCount>, kViewCount> table;
      for (int i = 0; i < kViewCount; ++i)
        for (int j = 0; j < kViewCount; ++j) table[i][j] = difference(field_a[i], field_b[j]);
      for (const Permutation& to : permutations) {
        int sum = 0;
        for (int i = 0; i < kViewCount; ++i) sum += table[i][to[i]];
        best = std::min(best, sum);
      }
    }
  return best;
}

}  // namespace colod::light_fields
