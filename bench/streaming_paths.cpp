// Based on: what people do with a street on a screen: come nearer, pass along, go round.
// Differs: derived from boxes, so that one rule serves every scene.
#include "streaming_paths.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace colod::bench {
namespace {

constexpr int kDollyStops = 60, kFlightStops = 40, kOrbitStops = 36;
constexpr double kFarthest = 1600, kNearest = 15;  // metres to the house, of the dolly
constexpr double kEyeHeight = 2, kDescent = 0.12;  // metres above the house's foot; a metre ahead
constexpr int kSides = 36;                         // that the dolly may come from
constexpr int kFreeSteps = 20;  // of kNearest each, on which the house is to be seen
constexpr double kFlightHeight = 30, kFlightDown_deg = 10;
constexpr double kOverRoofs = 5, kWing = 10;  // metres above what is so near to the flight
constexpr double kMargin = 60;  // metres: the flight starts and ends so much before the houses
constexpr double kOrbitShare = 1.5, kOrbitUp_deg = 25;

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

Vec3 flat(const Vec3& v) { return {v.x(), v.y(), 0}; }

/// The middle of all buildings and the directions along and across them.
struct Layout {
  Box box;
  Vec3 middle = Vec3::Zero(), along = Vec3::UnitX(), across = Vec3::UnitY();
  double ground = 0;  ///< the median foot
};

Layout layout_of(const std::vector<Place>& buildings) {
  Layout out;
  std::vector<double> feet;
  for (const Place& b : buildings) {
    out.box.extend(b.box);
    out.middle += b.box.center() / static_cast<double>(buildings.size());
    feet.push_back(b.box.min.z());
  }
  std::nth_element(feet.begin(), feet.begin() + static_cast<long>(feet.size() / 2), feet.end());
  out.ground = feet[feet.size() / 2];
  Eigen::Matrix2d spread = Eigen::Matrix2d::Identity();
  for (const Place& b : buildings) {
    const Vec2 off = (b.box.center() - out.middle).head<2>();
    spread += off * off.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(spread);
  Vec2 axis = solver.eigenvectors().col(1);
  if (axis.x() + axis.y() < 0) axis = -axis;
  out.along = {axis.x(), axis.y(), 0};
  out.across = {-axis.y(), axis.x(), 0};
  return out;
}

/// Whether the way from a to b meets the box.
bool is_crossed(const Box& box, const Vec3& a, const Vec3& b) {
  double from = 0, to = 1;
  for (int k = 0; k < 3; ++k) {
    const double step = b[k] - a[k];
    double enter = (box.min[k] - a[k]) / step, leave = (box.max[k] - a[k]) / step;
    if (step == 0) {
      if (a[k] < box.min[k] || a[k] > box.max[k]) return false;
      continue;
    }
    if (enter > leave) std::swap(enter, leave);
    from = std::max(from, enter), to = std::min(to, leave);
  }
  return from <= to;
}

Stop dolly_stop(const Box& house, const Vec3& side, double distance) {
  const double reach = 0.5 * house.size().dot(flat(side.cwiseAbs()));
  Vec3 eye = house.center() + side * (reach + distance);
  eye.z() = house.min.z() + kEyeHeight + kDescent * (distance - kNearest);
  return {eye, house.center()};
}

Path dolly(const std::vector<Place>& buildings, const Layout& layout) {
  const Place& house =
      *std::min_element(buildings.begin(), buildings.end(), [&](const Place& a, const Place& b) {
        return flat(a.box.center() - layout.middle).norm() <
               flat(b.box.center() - layout.middle).norm();
      });
  Path path{"dolly", {}};
  int least = std::numeric_limits<int>::max();
  Vec3 best = layout.across;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    const Vec3 side = std::cos(angle) * layout.across + std::sin(angle) * layout.along;
    int between = 0;
    for (int step = 1; step <= kFreeSteps; ++step)
      for (const Place& b : buildings) {
        const Stop stop = dolly_stop(house.box, side, step * kNearest);
        between += &b != &house && is_crossed(b.box, stop.eye, stop.target);
      }
    if (between < least) least = between, best = side;
  }
  for (int i = 0; i < kDollyStops; ++i)
    path.stops.push_back(
        dolly_stop(house.box, best, kFarthest - (kFarthest - kNearest) * i / (kDollyStops - 1)));
  return path;
}

Path flight(const std::vector<Place>& buildings, const Layout& layout) {
  double from = std::numeric_limits<double>::infinity(), to = -from;
  double height = layout.ground + kFlightHeight;
  for (const Place& b : buildings) {
    const Vec3 off = b.box.center() - layout.middle;
    const double along = off.dot(layout.along);
    const double half = 0.5 * b.box.size().dot(layout.along.cwiseAbs());
    const double aside = 0.5 * b.box.size().dot(layout.across.cwiseAbs());
    from = std::min(from, along - half), to = std::max(to, along + half);
    if (std::abs(off.dot(layout.across)) < aside + kWing)
      height = std::max(height, b.box.max.z() + kOverRoofs);
  }
  from -= kMargin, to = std::max(to - kMargin, from);
  Path path{"flight", {}};
  const Vec3 ahead = layout.along - std::tan(radians(kFlightDown_deg)) * Vec3::UnitZ();
  for (int i = 0; i < kFlightStops; ++i) {
    Vec3 eye = layout.middle + layout.along * (from + (to - from) * i / (kFlightStops - 1));
    eye.z() = height;
    path.stops.push_back({eye, eye + 100 * ahead});
  }
  return path;
}

Path orbit(const Layout& layout) {
  const Vec3 centre = layout.box.center();
  const double radius = kOrbitShare * layout.box.size().head<2>().maxCoeff();
  const double up = radians(kOrbitUp_deg);
  Path path{"orbit", {}};
  for (int i = 0; i < kOrbitStops; ++i) {
    const double angle = 2 * std::numbers::pi * i / kOrbitStops;
    const Vec3 side = std::cos(angle) * layout.across + std::sin(angle) * layout.along;
    path.stops.push_back(
        {centre + radius * (std::cos(up) * side + std::sin(up) * Vec3::UnitZ()), centre});
  }
  return path;
}

}  // namespace

std::vector<Path> plan_paths(const Tileset& tileset) {
  const Layout layout = layout_of(tileset.buildings);
  return {dolly(tileset.buildings, layout), flight(tileset.buildings, layout), orbit(layout)};
}

}  // namespace colod::bench
