// *Based on:* Portaneri et al., "Alpha wrapping with an offset", SIGGRAPH 2022, as CGAL has it.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include "drone.h"

namespace colod::synth {

Mesh wrap_soup(const Mesh& soup, double alpha, double offset) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
  std::vector<Kernel::Point_3> points;
  for (const Vec3& p : soup.vertices) points.emplace_back(p.x(), p.y(), p.z());
  SurfaceMesh wrapped;
  CGAL::alpha_wrap_3(points, soup.faces, alpha, offset, wrapped);
  Mesh mesh;
  for (const auto v : wrapped.vertices()) {
    const auto& p = wrapped.point(v);
    mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : wrapped.faces()) {
    Face face;
    int k = 0;
    for (const auto v : CGAL::vertices_around_face(wrapped.halfedge(f), wrapped))
      face[k++] = static_cast<int>(v);
    mesh.faces.push_back(face);
  }
  return mesh;
}

}  // namespace colod::synth
