// Based on: Hoppe et al., Surface reconstruction from unorganized points, 1992: a plane through the
// nearest 18 points, by CGAL.
// Differs: Hoppe's spanning tree carries one wrong turn at a sharp edge over whole façades (on
// photogrammetry of closed buildings 68 to 97 % of the normals came out right, measured in November
// 2026). Here each point looks out from its voxel in 41 directions at or above the horizon, and its
// normal turns to where the sky is seen. A missing floor does no harm; where neither side sees
// more, the normal turns up or away from the middle.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/pca_estimate_normals.h>

#include <algorithm>
#include <cmath>

#include "formats.h"

namespace colod::mesh_io {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Item = std::pair<Kernel::Point_3, Kernel::Vector_3>;
constexpr unsigned kNeighbours = 18;
constexpr int kFinestGrid = 256, kCoarsestGrid = 8;  // voxels along the longest side
constexpr double kPointsPerVoxel = 4;                // so that a surface's voxels leave no gaps
constexpr double kUndecided = 0.5;                   // of the sum of cosines

/// 41 directions at elevations 0 to 90 degrees.
std::vector<Vec3> sky_directions() {
  std::vector<Vec3> directions = {Vec3::UnitZ()};
  for (const double elevation : {0.05, 0.4, 0.8, 1.2})
    for (int i = 0; i < 10; ++i) {
      const double azimuth = (i + 0.5 * elevation) * M_PI / 5;
      directions.emplace_back(std::cos(elevation) * std::cos(azimuth),
                              std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    }
  return directions;
}

/// The voxels that hold a point.
struct Voxels {
  Vec3 origin;
  double size = 1;
  Eigen::Vector3i count;
  std::vector<char> is_full;

  Voxels(const std::vector<Vec3>& points, const Box& box, int along) : origin(box.min) {
    size = std::max(box.size().maxCoeff() / along, 1e-9);
    count = (box.size() / size).cast<int>().array() + 1;
    is_full.assign(static_cast<std::size_t>(count.x()) * count.y() * count.z(), 0);
    for (const Vec3& p : points) is_full[index(cell(p))] = 1;
  }
  Eigen::Vector3i cell(const Vec3& p) const {
    return ((p - origin) / size)
        .cast<int>()
        .cwiseMin(count.array().matrix() - Eigen::Vector3i::Ones());
  }
  std::size_t index(const Eigen::Vector3i& c) const {
    return (static_cast<std::size_t>(c.z()) * count.y() + c.y()) * count.x() + c.x();
  }
  /// Does a walk of half a voxel a step from the middle of c leave the box through empty voxels?
  /// The first two voxels are passed over: they hold the surface itself.
  bool sees_sky(const Eigen::Vector3i& c, const Vec3& direction) const {
    for (int step = 4;; ++step) {
      const Vec3 at = c.cast<double>() + Vec3::Constant(0.5) + 0.5 * step * direction;
      if ((at.array() < 0).any()) return true;
      const Eigen::Vector3i next = at.cast<int>();
      if ((next.array() >= count.array()).any()) return true;
      if (is_full[index(next)]) return false;
    }
  }
};

/// The finest grid whose full voxels hold enough points each.
Voxels fit_voxels(const std::vector<Vec3>& points) {
  const Box box = bounding_box(points);
  int along = kFinestGrid;
  for (;; along = along * 3 / 4) {
    Voxels voxels(points, box, along);
    const auto full = std::count(voxels.is_full.begin(), voxels.is_full.end(), 1);
    if (along <= kCoarsestGrid || static_cast<double>(points.size()) >= kPointsPerVoxel * full)
      return voxels;
  }
}

/// Sum of the directions in which the sky is seen from each point's voxel.
std::vector<Vec3> look_out(const std::vector<Vec3>& points) {
  const Voxels voxels = fit_voxels(points);
  const std::vector<Vec3> directions = sky_directions();
  std::vector<int> number(voxels.is_full.size(), -1);
  std::vector<Vec3> seen, out;
  for (const Vec3& p : points) {
    const Eigen::Vector3i c = voxels.cell(p);
    int& n = number[voxels.index(c)];
    if (n < 0) {
      n = static_cast<int>(seen.size());
      seen.emplace_back(Vec3::Zero());
      for (const Vec3& d : directions)
        if (voxels.sees_sky(c, d)) seen.back() += d;
    }
    out.push_back(seen[n]);
  }
  return out;
}

/// Does n point up or, where it is level, away from the middle?
bool is_outward(const Vec3& p, const Vec3& n, const Vec3& middle) {
  if (std::abs(n.z()) > 0.3) return n.z() > 0;
  return n.x() * (p.x() - middle.x()) + n.y() * (p.y() - middle.y()) >= 0;
}

}  // namespace

std::string estimate_normals(PointCloud& cloud) {
  const std::size_t n = cloud.points.size();
  cloud.normals.assign(n, Vec3::UnitZ());
  const std::string warning = "no normals in the file: estimated and turned outward";
  if (n <= kNeighbours) return warning + " (too few points: all up)";
  const Vec3 middle = bounding_box(cloud.points).center();
  std::vector<Item> items;
  for (const Vec3& q : cloud.points) {
    const Vec3 p = q - middle;
    items.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), Kernel::Vector_3(0, 0, 1));
  }
  CGAL::pca_estimate_normals<CGAL::Sequential_tag>(
      items, kNeighbours,
      CGAL::parameters::point_map(CGAL::First_of_pair_property_map<Item>())
          .normal_map(CGAL::Second_of_pair_property_map<Item>()));
  const std::vector<Vec3> sky = look_out(cloud.points);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 normal(items[i].second.x(), items[i].second.y(), items[i].second.z());
    if (!(normal.norm() > 0)) continue;
    Vec3& out = cloud.normals[i];
    out = normal.normalized();
    const double vote = out.dot(sky[i]);
    const bool is_out =
        std::abs(vote) > kUndecided ? vote > 0 : is_outward(cloud.points[i], out, middle);
    if (!is_out) out = -out;
  }
  return warning;
}

}  // namespace colod::mesh_io
