// Based on: planes within a tolerance of each other as one, as in Salinas, Lafarge & Alliez,
// "Structure-aware mesh decimation", Computer Graphics Forum 34(6), 2015.
// Differs: the paper cuts by every plane. Here (robust rules only) a plane whose whole outline lies
// within the layer's tolerance of a larger one is cut along that one: noise finds a wall twice, and
// on a coarse layer a shallow recess is no detail. No plane is moved, so that the planes of coarser
// layers stay planes of the finer ones.
// Notation: p leader, q the plane that takes its place.
#include "leaders.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::extraction::leaders;

/// The largest distance of the outline from the plane, or `enough` where that is exceeded.
double reach_of(const Outline& outline, const Plane& plane, double enough) {
  double most = 0;
  for (const Vec3& v : outline.vertices) {
    most = std::max(most, std::abs(plane.signed_distance(v)));
    if (most >= enough) return enough;
  }
  return most;
}

}  // namespace

std::vector<int> find_leaders(const Planes& planes, const std::vector<int>& layer_planes,
                              double tolerance) {
  const double alike = std::cos(kAlike_deg * std::numbers::pi / 180);
  std::vector<int> order = layer_planes, leaders;
  std::sort(order.begin(), order.end());  // planes come by falling area
  std::vector<int> leader_of(planes.planes.size(), -1);
  for (const int q : order) {
    const Plane& plane = planes.planes[q];
    double least = tolerance;
    leader_of[q] = q;
    if (planes.has_side(q)) continue;
    for (const int p : leaders) {
      const Plane& leader = planes.planes[p];
      if (leader.normal.dot(plane.normal) < alike) continue;
      const double reach = reach_of(plane.outline, leader, least);
      if (reach < least) least = reach, leader_of[q] = p;
    }
    if (leader_of[q] == q) leaders.push_back(q);
  }
  std::vector<int> result;
  for (const int q : layer_planes) result.push_back(leader_of[q]);
  return result;
}

}  // namespace colod
