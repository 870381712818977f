// Based on: Hoppe et al., Surface reconstruction from unorganized points, 1992, in CGAL: normals by
// a plane through the nearest 18 points, turned alike along a minimum spanning tree.
// Differs: what the tree leaves undecided, and whole pieces it turned inward, are turned up or away
// from the cloud's middle axis: airborne and street scans see roofs from above and walls from
// outside.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/mst_orient_normals.h>
#include <CGAL/pca_estimate_normals.h>

#include "mesh_io_formats.h"

namespace colod::mesh_io {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
struct Item {
  Kernel::Point_3 point;
  Kernel::Vector_3 normal;
  int index;
  bool operator==(const Item& other) const { return index == other.index; }
};
struct PointMap {
  using value_type = Kernel::Point_3;
  using reference = const value_type&;
  using key_type = Item;
  using category = boost::lvalue_property_map_tag;
  friend reference get(const PointMap&, const Item& i) { return i.point; }
};
struct NormalMap {
  using value_type = Kernel::Vector_3;
  using reference = const value_type&;
  using key_type = Item;
  using category = boost::read_write_property_map_tag;
  friend reference get(const NormalMap&, const Item& i) { return i.normal; }
  friend void put(const NormalMap&, Item& i, const value_type& n) { i.normal = n; }
};
constexpr unsigned kNeighbours = 18;

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
  std::vector<Item> items(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 p = cloud.points[i] - middle;
    items[i] = {Kernel::Point_3(p.x(), p.y(), p.z()), Kernel::Vector_3(0, 0, 1),
                static_cast<int>(i)};
  }
  const auto maps = CGAL::parameters::point_map(PointMap()).normal_map(NormalMap());
  CGAL::pca_estimate_normals<CGAL::Sequential_tag>(items, kNeighbours, maps);
  const auto undecided = CGAL::mst_orient_normals(items, kNeighbours, maps);
  double votes = 0;
  for (auto it = items.begin(); it != items.end(); ++it) {
    const Vec3 normal(it->normal.x(), it->normal.y(), it->normal.z());
    if (!(normal.norm() > 0)) continue;
    Vec3& out = cloud.normals[it->index];
    out = normal.normalized();
    const bool is_out = is_outward(cloud.points[it->index], out, middle);
    if (it >= undecided && !is_out) out = -out;
    if (it < undecided) votes += is_out ? 1 : -1;
  }
  if (votes < 0)
    for (auto it = items.begin(); it != undecided; ++it)
      cloud.normals[it->index] = -cloud.normals[it->index];
  return warning;
}

}  // namespace colod::mesh_io
