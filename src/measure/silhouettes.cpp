#include "silhouettes.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/parallel.h"
#include "light_field_views.h"

namespace colod {
namespace {

using namespace light_fields;

double overlap(const Silhouette& a, const Silhouette& b) {
  int both = 0, either = 0;
  for (std::size_t i = 0; i < a.size(); ++i) both += a[i] && b[i], either += a[i] || b[i];
  return either > 0 ? static_cast<double>(both) / either : 0;
}

/// A sphere around two.
Bounds around(const Bounds& a, const Bounds& b) {
  const double apart = (a.center - b.center).norm();
  if (apart + b.radius <= a.radius) return a;
  if (apart + a.radius <= b.radius) return b;
  const double radius = (apart + a.radius + b.radius) / 2;
  return {a.center + (radius - a.radius) / apart * (b.center - a.center), radius};
}

}  // namespace

SilhouetteOverlap overlap_silhouettes(const Mesh& a, const Mesh& b) {
  const Bounds bounds = around(bounds_of(a), bounds_of(b));
  const RayScene scene_a(a), scene_b(b);
  const auto axes = dodecahedron_axes();
  std::vector<Vec3> directions(axes.begin(), axes.end());
  directions.emplace_back(0, 0, -1);
  std::vector<double> overlaps(directions.size());
  parallel_for(directions.size(), [&](std::size_t i) {
    overlaps[i] = overlap(cast_silhouette(scene_a, bounds, directions[i]),
                          cast_silhouette(scene_b, bounds, directions[i]));
  });
  return {std::accumulate(overlaps.begin(), overlaps.end(), 0.0) / overlaps.size(),
          *std::min_element(overlaps.begin(), overlaps.end())};
}

}  // namespace colod
