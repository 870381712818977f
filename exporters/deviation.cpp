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
  std::vector<Mesh> meshes;
  std::vector<RayScene> scenes;
  for (const ExportLayer& layer : building.layers) {
    meshes.push_back(layer.mesh.mesh());
    scenes.emplace_back(meshes.back());
  }
  const std::size_t finest = meshes.size() - 1;
  const double spacing =
      std::max(kFinestStep, bounding_box(meshes[finest].vertices).diagonal() / kSteps);
  double least = building.layers[finest].geometric_error;
  for (std::size_t i = finest; i-- > 0;) {
    double& error = building.layers[i].geometric_error;
    error = std::max(error, least);
    for (const std::size_t other : {i + 1, finest}) {
      if (meshes[i].faces.empty() || meshes[other].faces.empty()) continue;
      error = std::max({error, one_sided_deviation(meshes[i], scenes[other], spacing),
                        one_sided_deviation(meshes[other], scenes[i], spacing)});
    }
    least = error;
  }
}

}  // namespace colod
