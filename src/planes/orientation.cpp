// Based on: votes of rays, measured in November 2026: 10 % of planes turned inward do no harm, 30 %
// break every later room. Differs: --rules robust only; the paper takes the normals as they are.
// Airborne clouds hold next to no walls that could stop rays; there roofs are turned to the sky and
// walls away from the roof above them.
// Notation: front = the side the normal points to.
#include "orientation.h"

#include <algorithm>
#include <cmath>

#include "core/flat.h"
#include "core/parallel.h"
#include "core/rays.h"
#include "core/spread.h"
#include "outline.h"
#include "parameters.h"

namespace colod::regions {
namespace {

using namespace parameters::planes;

constexpr int kSamples = 24;    // places on a plane
constexpr double kLift = 0.02;  // metres off the plane

/// Places spread evenly over the outline's area, the same at every call.
std::vector<Vec3> spread_samples(const Outline& outline, int count) {
  const double total = outline_area(outline);
  std::vector<Vec3> samples;
  double passed = 0;
  for (const Face& t : outline.triangles) {
    const Vec3 &a = outline.vertices[t[0]], &b = outline.vertices[t[1]],
               &c = outline.vertices[t[2]];
    const double area = 0.5 * (b - a).cross(c - a).norm();
    while (total > 0 && static_cast<int>(samples.size()) < count &&
           (samples.size() + 0.5) / count * total <= passed + area) {
      samples.push_back(spread_on_triangle(a, b, c, static_cast<double>(samples.size()) + 1));
    }
    passed += area;
  }
  return samples;
}

/// Rays that a side is judged by: level and upward; slightly downward only for a side that looks
/// down, because floors are often missing.
std::vector<Vec3> side_directions(const Vec3& side, const std::vector<Vec3>& up,
                                  const std::vector<Vec3>& down) {
  std::vector<Vec3> result;
  for (const Vec3& d : up)
    if (d.dot(side) > 0.05) result.push_back(d);
  for (const Vec3& d : down)
    if (side.z() < -0.5 && d.dot(side) > 0.05) result.push_back(d);
  return result;
}

double escaping_share(const RayScene& scene, const std::vector<Vec3>& samples, const Vec3& side,
                      const std::vector<Vec3>& directions) {
  int escaped = 0, count = 0;
  for (const Vec3& p : samples)
    for (const Vec3& d : directions) {
      escaped +=
          !scene.is_occluded(p + kLift * side, d, 1e-4, std::numeric_limits<double>::infinity());
      ++count;
    }
  return count > 0 ? static_cast<double>(escaped) / count : 0;
}

/// Mostly roofs: scanned from above.
bool is_airborne(const std::vector<Plane>& planes) {
  double roof = 0, total = 0;
  for (const Plane& p : planes) {
    total += p.area;
    if (std::abs(p.normal.z()) > kRoofTilt) roof += p.area;
  }
  return roof > kAirborneShare * total;
}

/// Share of `steep` rays from `lift` metres off the samples that meet something.
double sheltered_share(const RayScene& scene, const std::vector<Vec3>& samples, const Vec3& side,
                       double lift, const std::vector<Vec3>& steep) {
  int met = 0, count = 0;
  for (const Vec3& p : samples)
    for (const Vec3& d : steep) {
      met += scene.is_occluded(p + lift * side, d, 1e-4, std::numeric_limits<double>::infinity());
      ++count;
    }
  return count > 0 ? static_cast<double>(met) / count : 0;
}

/// An airborne plane that looks the wrong way: a roof that looks down under the open sky, or a wall
/// with the roof in front of it.
bool looks_inward_from_air(const RayScene& scene, const Plane& p,
                           const std::vector<Vec3>& samples) {
  static const std::vector<Vec3> steep = ring_directions(12, std::array<double, 2>{70, 85});
  if (p.normal.z() < -kRoofTilt)
    return sheltered_share(scene, samples, -p.normal, kLift, steep) < 1 - kOpenSky;
  if (p.normal.z() > kRoofTilt) return false;
  return sheltered_share(scene, samples, p.normal, kBesideWall, steep) > kSheltered &&
         sheltered_share(scene, samples, -p.normal, kBesideWall, steep) < kUnsheltered;
}

void flip(Plane& plane) {
  plane.normal = -plane.normal;
  plane.offset = -plane.offset;
  for (auto& ring : plane.outline.rings) std::reverse(ring.begin(), ring.end());
  for (Face& t : plane.outline.triangles) std::swap(t[1], t[2]);
}

}  // namespace

int repair_orientation(std::vector<Plane>& planes, bool is_airborne_told) {
  const Mesh soup = outline_soup(planes);
  if (soup.faces.empty()) return 0;
  const RayScene scene(soup);
  const std::vector<Vec3> up = ring_directions(64, std::array<double, 4>{1, 20, 45, 70});
  const std::vector<Vec3> down = ring_directions(32, std::array<double, 2>{-5, -15});
  const bool is_from_air = is_airborne_told && is_airborne(planes);
  std::vector<char> is_inward(planes.size(), 0);
  parallel_for(planes.size(), [&](std::size_t i) {
    const Plane& p = planes[i];
    const std::vector<Vec3> samples = spread_samples(p.outline, kSamples);
    const double front =
        escaping_share(scene, samples, p.normal, side_directions(p.normal, up, down));
    const double back =
        escaping_share(scene, samples, -p.normal, side_directions(-p.normal, up, down));
    // What looks up was seen from above; only a floor shut in on all sides is turned down.
    const double most_front = p.normal.z() > 0.5 ? kMostFrontOfFloor : kMostFront;
    is_inward[i] = back >= kLeastBack && front <= most_front && back - front >= kClearMajority;
    if (is_from_air) is_inward[i] = looks_inward_from_air(scene, p, samples);
  });
  int flipped = 0;
  for (std::size_t i = 0; i < planes.size(); ++i)
    if (is_inward[i]) flip(planes[i]), ++flipped;
  return flipped;
}

}  // namespace colod::regions
