// Based on: Chen et al. 2003 (light_field.h); Alexa, "Super-Fibonacci spirals: fast,
// low-discrepancy sampling of SO(3)", CVPR 2022 (the candidates from which the ten orientations are
// taken). Differs: no --rules here. Notation: φ golden ratio. An axis is a pair of opposite
// vertices of the dodecahedron; a permutation tells onto which axis a rotation moves each axis.
#include "light_field.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "core/rays.h"
#include "light_field_views.h"

namespace colod {

namespace light_fields {

std::array<Vec3, kViewCount> dodecahedron_axes() {
  const double p = std::numbers::phi, q = 1 / std::numbers::phi;
  std::array<Vec3, kViewCount> axes = {
      Vec3(1, 1, 1),  Vec3(1, 1, -1), Vec3(1, -1, 1), Vec3(-1, 1, 1), Vec3(0, q, p),
      Vec3(0, q, -p), Vec3(q, p, 0),  Vec3(q, -p, 0), Vec3(p, 0, q),  Vec3(p, 0, -q)};
  for (Vec3& a : axes) a.normalize();
  return axes;
}

Bounds bounds_of(const Mesh& mesh) {
  std::vector<Vec3> used;
  for (const Face& f : mesh.faces) {
    const double area = face_area(mesh, f);
    if (area > 0 && std::isfinite(area))
      for (const int v : f) used.push_back(mesh.vertices[v]);
  }
  if (used.empty()) throw Error(Stage::kInput, "mesh", "no finite face with an area to look at");
  Bounds bounds{bounding_box(used).center(), 0};
  for (const Vec3& p : used) bounds.radius = std::max(bounds.radius, (p - bounds.center).norm());
  return bounds;
}

Silhouette cast_silhouette(const RayScene& scene, const Bounds& bounds, const Vec3& direction) {
  constexpr int kSize = kSilhouetteSize;
  const auto [right, up] = plane_basis(direction);
  const double step = 2 * bounds.radius / (kSize - 2);  // a pixel of air all around
  const Vec3 corner =
      bounds.center - 2 * bounds.radius * direction - 0.5 * (kSize - 1) * step * (right + up);
  Silhouette silhouette(std::size_t{kSize} * kSize, 0);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      silhouette[y * kSize + x] =
          scene.is_occluded(corner + step * (x * right + y * up), direction, 0, 4 * bounds.radius);
  return silhouette;
}

}  // namespace light_fields

namespace {

using namespace light_fields;

using Axes = std::array<Vec3, kViewCount>;

constexpr int kCandidates = 2048;  // of orientations
constexpr int kRotations = 60;

/// The frame whose first axis is a and whose second lies in the plane of a and b, towards b.
Eigen::Matrix3d frame_of(const Vec3& a, const Vec3& b) {
  Eigen::Matrix3d frame;
  frame.col(0) = a;
  frame.col(2) = a.cross(b).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

Permutation permutation_of(const Axes& axes, const Eigen::Matrix3d& rotation) {
  Permutation to;
  for (int k = 0; k < kViewCount; ++k) {
    const Vec3 moved = rotation * axes[k];
    double best = 0;
    for (int j = 0; j < kViewCount; ++j)
      if (const double along = std::abs(moved.dot(axes[j])); along > best) best = along, to[k] = j;
  }
  return to;
}

/// Orientations of the dodecahedron far from each other, the upright one first: each next one is
/// the candidate that is farthest from those taken, rotations of the dodecahedron into itself not
/// counting.
std::vector<Eigen::Matrix3d> spread_orientations() {
  std::vector<Eigen::Quaterniond> own;
  for (const Eigen::Matrix3d& r : dodecahedron_rotations()) own.emplace_back(r);
  std::vector<Eigen::Quaterniond> candidates = {Eigen::Quaterniond::Identity()};
  for (int i = 0; i < kCandidates; ++i) {
    constexpr double kPsi = 1.533751168755204288118;  // of the spiral: ψ⁴ = ψ + 4
    const double s = (i + 0.5) / kCandidates, turns = 2 * std::numbers::pi * (i + 0.5);
    const double a = turns / std::numbers::sqrt2, b = turns / kPsi;
    const double r = std::sqrt(s), t = std::sqrt(1 - s);
    candidates.emplace_back(t * std::cos(b), r * std::sin(a), r * std::cos(a), t * std::sin(b));
  }
  std::vector<double> closest(candidates.size(), 0);  // cosine of half the angle to the nearest
  std::vector<Eigen::Matrix3d> taken;
  std::size_t next = 0;
  while (true) {
    taken.push_back(candidates[next].toRotationMatrix());
    if (taken.size() == kLightFieldCount) return taken;
    for (std::size_t c = 0; c < candidates.size(); ++c)
      for (const Eigen::Quaterniond& g : own)
        closest[c] = std::max(closest[c], std::abs((candidates[next] * g).dot(candidates[c])));
    next = std::min_element(closest.begin(), closest.end()) - closest.begin();
  }
}

ViewDescriptor describe(const Silhouette& silhouette) {
  ViewDescriptor descriptor;
  auto next = descriptor.begin();
  for (const double z : zernike_magnitudes(silhouette)) *next++ = quantized(z);
  for (const double f : fourier_magnitudes(silhouette)) *next++ = quantized(2 * f);
  return descriptor;
}

int difference(const ViewDescriptor& a, const ViewDescriptor& b) {
  int sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(int{a[i]} - int{b[i]});
  return sum;
}

}  // namespace

std::vector<Eigen::Matrix3d> dodecahedron_rotations() {
  std::vector<Vec3> vertices;
  for (const Vec3& a : dodecahedron_axes()) vertices.insert(vertices.end(), {a, -a});
  const double edge = std::sqrt(5.0) / 3;  // cosine between neighbouring vertices
  const auto is_edge = [&](const Vec3& a, const Vec3& b) {
    return std::abs(a.dot(b) - edge) < 1e-6;
  };
  // A rotation is known by the edge onto which it moves the first one.
  std::vector<Eigen::Matrix3d> rotations;
  Eigen::Matrix3d first = Eigen::Matrix3d::Zero();
  for (const Vec3& a : vertices)
    for (const Vec3& b : vertices)
      if (is_edge(a, b)) {
        if (rotations.empty()) first = frame_of(a, b);
        rotations.push_back(frame_of(a, b) * first.transpose());
      }
  assert(rotations.size() == kRotations);
  return rotations;
}

namespace light_fields {

std::vector<Silhouette> cast_silhouettes(const Mesh& mesh) {
  const Bounds bounds = bounds_of(mesh);
  const RayScene scene(mesh);
  const Axes axes = dodecahedron_axes();
  const std::vector<Eigen::Matrix3d> orientations = spread_orientations();
  std::vector<Silhouette> silhouettes(std::size_t{kLightFieldCount} * kViewCount);
  parallel_for(silhouettes.size(), [&](std::size_t i) {
    silhouettes[i] =
        cast_silhouette(scene, bounds, orientations[i / kViewCount] * axes[i % kViewCount]);
  });
  return silhouettes;
}

std::vector<Permutation> view_permutations() {
  const Axes axes = dodecahedron_axes();
  std::vector<Permutation> permutations;
  for (const Eigen::Matrix3d& r : dodecahedron_rotations())
    permutations.push_back(permutation_of(axes, r));
  return permutations;
}

}  // namespace light_fields

LightFields describe_light_fields(const Mesh& mesh) {
  const std::vector<Silhouette> silhouettes = cast_silhouettes(mesh);
  LightFields result;
  parallel_for(silhouettes.size(), [&](std::size_t i) {
    result.views[i / kViewCount][i % kViewCount] = describe(silhouettes[i]);
  });
  return result;
}

int light_field_distance(const LightFields& a, const LightFields& b) {
  return least_distance(a, b, difference);
}

}  // namespace colod
