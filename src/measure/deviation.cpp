// Based on: sampled Hausdorff distance (Cignoni, Rocchini, Scopigno: Metro, 1998).
// Differs: a lattice instead of random samples, so that the same meshes give the same figure and
// flat triangles have their corners, edges and middle looked at; points that cannot be worse than
// what was found are not asked for.
#include "deviation.h"

#include <algorithm>
#include <cmath>

namespace colod {

namespace {

constexpr int kMostSteps = 128;      // along a triangle's edge
constexpr double kStepsAcross = 64;  // along a mesh's diagonal
constexpr double kFinestStep = 0.1;  // metres

constexpr double kSlack = 1e-6;  // metres: more than distances are rounded by

/// Worst of `known` and the distances of a triangle's lattice, n steps an edge. Distances change no
/// faster than places do: a near point settles its neighbours, and bounds the search for the next.
double worst_of(const Vec3& a, const Vec3& u, const Vec3& v, int n, const RayScene& to,
                double known) {
  const Vec3 middle = (u + v) / 3;
  const double radius = std::max({middle.norm(), (u - middle).norm(), (v - middle).norm()});
  const double centre = to.nearest(a + middle).distance;
  if (centre + radius + kSlack <= known) return known;
  const double share = 1.0 / n, row = share * u.norm(), step = std::max(share * v.norm(), kSlack);
  double worst = known, first = centre + middle.norm();
  for (int i = 0; i <= n; ++i) {
    double within = first;
    for (int j = 0; j <= n - i;) {
      const Vec3 p = a + (share * i) * u + (share * j) * v;
      const double d = to.nearest(p, within + kSlack).distance;
      worst = std::max(worst, d);
      if (j == 0) first = d + row;
      const int jump = 1 + static_cast<int>(std::min<double>(n, (worst - d) / step));
      within = d + jump * step;
      j += jump;
    }
  }
  return worst;
}

}  // namespace

double one_sided_deviation(const Mesh& from, const RayScene& to, double spacing, double known) {
  double worst = known;
  for (const Face& f : from.faces) {
    const Vec3 &a = from.vertices[f[0]], u = from.vertices[f[1]] - a, v = from.vertices[f[2]] - a;
    const double longest = std::max({u.norm(), v.norm(), (u - v).norm()});
    const int n = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, kMostSteps);
    worst = worst_of(a, u, v, n, to, worst);
  }
  return worst;
}

double two_sided_deviation(const Mesh& a, const RayScene& scene_a, const Mesh& b,
                           const RayScene& scene_b, double known) {
  const double spacing = std::max(kFinestStep, bounding_box(b.vertices).diagonal() / kStepsAcross);
  return one_sided_deviation(b, scene_a, spacing, one_sided_deviation(a, scene_b, spacing, known));
}

}  // namespace colod
