// Based on: sampled Hausdorff distance (Cignoni, Rocchini, Scopigno: Metro, 1998).
// Differs: a lattice instead of random samples, so that the same meshes give the same figure and
// flat triangles have their corners, edges and middle looked at.
#include "deviation.h"

#include <algorithm>
#include <cmath>

namespace colod {

namespace {

constexpr int kMostSteps = 128;      // along a triangle's edge
constexpr double kSteps = 64;        // along a building's diagonal
constexpr double kFinestStep = 0.1;  // metres

}  // namespace

double one_sided_deviation(const Mesh& from, const RayScene& to, double spacing) {
  double worst = 0;
  for (const Face& f : from.faces) {
    const Vec3 &a = from.vertices[f[0]], u = from.vertices[f[1]] - a, v = from.vertices[f[2]] - a;
    const double longest = std::max({u.norm(), v.norm(), (u - v).norm()});
    const int n = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, kMostSteps);
    const double share = 1.0 / n;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n - i; ++j) {
        const Vec3 p = a + (share * i) * u + (share * j) * v;
        worst = std::max(worst, to.nearest(p).distance);
      }
  }
  return worst;
}

void measure_visible_errors(ExportBuilding& building) {
  if (building.layers.empty()) return;
  const Mesh finest = building.layers.back().mesh.mesh();
  if (finest.faces.empty()) return;
  const RayScene scene(finest);
  const double spacing = std::max(kFinestStep, bounding_box(finest.vertices).diagonal() / kSteps);
  double least = building.layers.back().geometric_error;
  for (std::size_t i = building.layers.size() - 1; i-- > 0;) {
    ExportLayer& layer = building.layers[i];
    const double added = one_sided_deviation(layer.mesh.mesh(), scene, spacing);
    least = layer.geometric_error = std::max({layer.geometric_error, added, least});
  }
}

}  // namespace colod
