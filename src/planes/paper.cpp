// Based on: the paper, section 4 ("plane detection"): CGAL's region growing at 0.2 m, 30° and 20
// items, on a mesh's faces or on a cloud's 12 nearest points. Differs: this file is --rules paper
// only. Faces that would make the mesh non-manifold get vertices of their own, since CGAL's mesh
// cannot hold them.
// Notation: as CGAL's manual.
#include "paper.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Point_set_3.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing_on_point_set.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing_on_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>

namespace colod::regions {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace sd = CGAL::Shape_detection;

Kernel::Point_3 to_cgal(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

Region as_region(const Items& items, std::vector<int> members) {
  Region r;
  std::sort(members.begin(), members.end());
  for (const int i : members) r.moments.add_item(items, i), r.area += items.area[i];
  r.items = std::move(members);
  r.normal = items.normal[r.items.front()];
  r.refit();
  return r;
}

std::vector<Region> grow_on_mesh(const Items& items, const PlaneOptions& options) {
  const Mesh& source = items.source->mesh;
  SurfaceMesh mesh;
  std::vector<int> item_of;
  for (const Vec3& p : source.vertices)
    mesh.add_vertex(p.allFinite() ? to_cgal(p) : to_cgal(Vec3::Zero()));
  for (int i = 0; i < items.size(); ++i) {
    if (!items.is_used[i]) continue;
    std::array<SurfaceMesh::Vertex_index, 3> v;
    for (int k = 0; k < 3; ++k) v[k] = SurfaceMesh::Vertex_index(source.faces[i][k]);
    if (mesh.add_face(v[0], v[1], v[2]) == SurfaceMesh::null_face()) {
      for (SurfaceMesh::Vertex_index& corner : v) {
        const Kernel::Point_3 place = mesh.point(corner);  // a copy: adding may move all points
        corner = mesh.add_vertex(place);
      }
      mesh.add_face(v[0], v[1], v[2]);
    }
    item_of.push_back(i);
  }
  using Neighbors = sd::Polygon_mesh::One_ring_neighbor_query<SurfaceMesh>;
  using Type = sd::Polygon_mesh::Least_squares_plane_fit_region<Kernel, SurfaceMesh>;
  Neighbors neighbors(mesh);
  Type type(mesh, options.distance, options.angle_deg, options.min_points, mesh.points());
  const auto faces = mesh.faces();
  sd::Region_growing<SurfaceMesh::Face_range, Neighbors, Type> growing(faces, neighbors, type);
  std::vector<Region> regions;
  growing.detect(boost::make_function_output_iterator([&](const std::vector<std::size_t>& found) {
    std::vector<int> members;
    for (const std::size_t f : found) members.push_back(item_of[f]);
    regions.push_back(as_region(items, std::move(members)));
  }));
  return regions;
}

std::vector<Region> grow_on_points(const Items& items, const PlaneOptions& options) {
  CGAL::Point_set_3<Kernel::Point_3> points;
  points.add_normal_map();
  std::vector<int> item_of;
  for (int i = 0; i < items.size(); ++i) {
    if (!items.is_used[i]) continue;
    const Vec3& n = items.normal[i];
    points.insert(to_cgal(items.center[i]), Kernel::Vector_3(n.x(), n.y(), n.z()));
    item_of.push_back(i);
  }
  using Set = CGAL::Point_set_3<Kernel::Point_3>;
  using Neighbors = sd::Point_set::K_neighbor_query<Kernel, Set, Set::Point_map>;
  using Type =
      sd::Point_set::Least_squares_plane_fit_region<Kernel, Set, Set::Point_map, Set::Vector_map>;
  Neighbors neighbors(points, 12, points.point_map());
  Type type(points, options.distance, options.angle_deg, options.min_points, points.point_map(),
            points.normal_map());
  sd::Region_growing<Set, Neighbors, Type> growing(points, neighbors, type);
  std::vector<Region> regions;
  growing.detect(boost::make_function_output_iterator([&](const std::vector<std::size_t>& found) {
    std::vector<int> members;
    for (const std::size_t p : found) members.push_back(item_of[p]);
    regions.push_back(as_region(items, std::move(members)));
  }));
  return regions;
}

}  // namespace

std::vector<Region> grow_with_cgal(const Items& items, const PlaneOptions& options) {
  if (std::find(items.is_used.begin(), items.is_used.end(), 1) == items.is_used.end()) return {};
  std::vector<Region> regions =
      items.is_mesh() ? grow_on_mesh(items, options) : grow_on_points(items, options);
  std::stable_sort(regions.begin(), regions.end(),
                   [](const Region& a, const Region& b) { return a.area > b.area; });
  return regions;
}

}  // namespace colod::regions
