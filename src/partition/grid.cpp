// Based on: extended from the integer planes of exact BSP Booleans (see predicates.cpp).
// Differs: the paper cuts with real planes. Here a plane's normal is rounded to 24 bits and its
// offset
//   is that of a grid point near the middle of its outline, so that the rounded plane leaves the
//   real one by at most a few grid units over the outline: the turn of the normal, below 2^-23,
//   times the outline's radius. Planes that differ by rounding alone become one.
// Notation: h half the box's sides in grid units; c the grid point that a plane is hung up on.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "core/error.h"
#include "predicates.h"

namespace colod {
namespace {

using IntPlane = Partition::IntPlane;
using HalfSides = std::array<std::int64_t, 3>;

/// Two roundings of one plane, hung up on opposite ends of the box, differ by up to 7 grid units.
constexpr std::int64_t kSamePlane = std::int64_t{8} << kNormalBits;

/// Sides of no length get a thousandth of the longest one.
Box grown_box(Box box) {
  if (box.is_empty() || !box.min.allFinite() || !box.max.allFinite())
    throw Error(Stage::kProcess, "partition", "the box to cut is empty or not finite");
  const double longest = std::max(box.size().maxCoeff(), 1e-3);
  for (int k = 0; k < 3; ++k) {
    const double missing = 1e-3 * longest - (box.max[k] - box.min[k]);
    if (missing > 0) box.min[k] -= missing / 2, box.max[k] += missing / 2;
  }
  return box;
}

/// Sets grid, origin and box. A grid of a power of two, with its origin on the grid, holds whole
/// and half metres exactly.
HalfSides lay_grid(const Box& input, Partition& partition) {
  const Box box = grown_box(input);
  int exponent = 0;
  // one part in 2^20 is kept free for the rounding of origin and sides
  std::frexp(box.size().maxCoeff() * (1 + 0x1p-20), &exponent);
  partition.grid = std::ldexp(1.0, exponent - 1 - kCoordinateBits);
  HalfSides half;
  for (int k = 0; k < 3; ++k) {
    partition.origin[k] = std::round(box.center()[k] / partition.grid) * partition.grid;
    const double reach =
        std::max(box.max[k] - partition.origin[k], partition.origin[k] - box.min[k]);
    half[k] = static_cast<std::int64_t>(std::ceil(reach / partition.grid));
    partition.box.min[k] = partition.origin[k] - half[k] * partition.grid;
    partition.box.max[k] = partition.origin[k] + half[k] * partition.grid;
  }
  return half;
}

/// The grid point, among those around `near`, that lies closest to the plane.
std::array<std::int64_t, 3> closest_grid_point(const Vec3& normal, double offset,
                                               const Vec3& near) {
  const Vec3 base = near.array().round();
  Vec3 best = base;
  double least = std::abs(normal.dot(base) - offset);
  for (int i = 0; i < 27; ++i) {
    const Vec3 c = base + Vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    const double distance = std::abs(normal.dot(c) - offset);
    if (distance < least) least = distance, best = c;
  }
  return {std::llround(best[0]), std::llround(best[1]), std::llround(best[2])};
}

/// None for a plane that is not finite or passes the box at a distance.
std::optional<IntPlane> round_plane(const CutPlane& cut, const Partition& partition,
                                    const HalfSides& half) {
  const double length = cut.normal.norm();
  const bool is_finite =
      cut.normal.allFinite() && std::isfinite(cut.offset) && length > 1e-12 &&
      std::all_of(cut.hull.begin(), cut.hull.end(), [](const Vec3& p) { return p.allFinite(); });
  if (!is_finite) return {};
  const Vec3 normal = cut.normal / length;
  const double offset = (cut.offset / length - normal.dot(partition.origin)) / partition.grid;
  const Vec3 corner(half[0], half[1], half[2]);
  if (std::abs(offset) > 2 * corner.norm()) return {};
  Vec3 middle = Vec3::Zero();
  if (!cut.hull.empty())
    middle = (bounding_box(cut.hull).center() - partition.origin) / partition.grid;
  middle = middle.cwiseMin(corner).cwiseMax(-corner);
  middle -= (normal.dot(middle) - offset) * normal;
  const auto c = closest_grid_point(normal, offset, middle);
  IntPlane plane{{}, 0, cut.source_plane};
  for (int k = 0; k < 3; ++k) {
    plane.normal[k] = static_cast<std::int32_t>(std::lround(std::ldexp(normal[k], kNormalBits)));
    plane.d -= plane.normal[k] * c[k];
  }
  return plane;
}

/// 1 where both planes are the same up to rounding all over the box, −1 the same and reversed, else
/// 0.
int same_up_to_rounding(const IntPlane& a, const IntPlane& b, const HalfSides& half) {
  for (const int sign : {1, -1}) {
    std::int64_t most = std::llabs(a.d - sign * b.d);
    for (int k = 0; k < 3; ++k)
      most += std::llabs(std::int64_t{a.normal[k]} - std::int64_t{sign} * b.normal[k]) * half[k];
    if (most <= kSamePlane) return sign;
  }
  return 0;
}

bool crosses_box(const IntPlane& plane, const HalfSides& half) {
  std::int64_t reach = 0;
  for (int k = 0; k < 3; ++k) reach += std::llabs(plane.normal[k]) * half[k];
  return std::llabs(plane.d) < reach;
}

void add_box_sides(const HalfSides& half, Partition& partition) {
  for (int k = 0; k < 3; ++k) {
    for (const int sign : {-1, 1}) {
      IntPlane plane{{}, -(half[k] << kNormalBits), -1};
      plane.normal[k] = sign * (1 << kNormalBits);
      partition.planes.push_back(plane);
    }
  }
}

/// The plane's id, old or new; −1 where it misses the box.
Partition::Cut add_plane(const IntPlane& plane, const HalfSides& half, Partition& partition) {
  for (std::size_t p = 0; p < partition.planes.size(); ++p) {
    IntPlane& old = partition.planes[p];
    const int same = same_up_to_rounding(old, plane, half);
    if (same == 0) continue;
    if (p < 6 && same > 0 && old.source_plane < 0) old.source_plane = plane.source_plane;
    return {static_cast<int>(p), same < 0};
  }
  if (!crosses_box(plane, half)) return {};
  partition.planes.push_back(plane);
  return {static_cast<int>(partition.planes.size()) - 1, false};
}

}  // namespace

void round_to_grid(const std::vector<CutPlane>& cut_planes, const Box& box, Partition& partition) {
  const HalfSides half = lay_grid(box, partition);
  add_box_sides(half, partition);
  std::size_t missed = 0;
  for (const CutPlane& cut : cut_planes) {
    const std::optional<IntPlane> plane = round_plane(cut, partition, half);
    partition.cuts.push_back(plane ? add_plane(*plane, half, partition) : Partition::Cut{});
    if (partition.cuts.back().plane < 0) ++missed;
  }
  if (missed > 0)
    partition.warnings.push_back(std::to_string(missed) +
                                 " planes are not finite or miss the box and cut nothing");
}

}  // namespace colod
