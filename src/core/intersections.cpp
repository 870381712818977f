// Based on: exact predicates chosen by the number of shared vertices, as in CGAL's Polygon Mesh
// Processing, on indexed faces instead of a half-edge mesh so that any soup is accepted.
#include "intersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace colod {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

Point point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

int corner_of(const Face& face, int vertex) {
  for (int k = 0; k < 3; ++k)
    if (face[k] == vertex) return k;
  return -1;
}

Kernel::Triangle_3 triangle(const std::vector<Vec3>& points, const Face& f) {
  return {point(points[f[0]]), point(points[f[1]]), point(points[f[2]])};
}

/// The side of `face` opposite its corner meets the other face.
bool touches_opposite(const std::vector<Vec3>& points, const Face& face, int corner,
                      const Face& other) {
  const Kernel::Segment_3 side(point(points[face[(corner + 1) % 3]]),
                               point(points[face[(corner + 2) % 3]]));
  return CGAL::do_intersect(side, triangle(points, other));
}

/// Coplanar neighbours whose free corners lie on the same side of the common edge.
bool is_folded(const std::vector<Vec3>& points, const Face& f, int free_corner, const Face& g) {
  const int a = f[(free_corner + 1) % 3], b = f[(free_corner + 2) % 3];
  const int d = g[3 - corner_of(g, a) - corner_of(g, b)];
  const Point pa = point(points[a]), pb = point(points[b]), pc = point(points[f[free_corner]]),
              pd = point(points[d]);
  return CGAL::coplanar(pa, pb, pc, pd) &&
         CGAL::coplanar_orientation(pa, pb, pc, pd) == CGAL::POSITIVE;
}

}  // namespace

bool is_degenerate(const std::vector<Vec3>& points, const Face& f) {
  return CGAL::collinear(point(points[f[0]]), point(points[f[1]]), point(points[f[2]]));
}

bool do_intersect(const std::vector<Vec3>& points, const Face& a, const Face& b) {
  int shared[3], n = 0;  // corners of a that b has too
  for (int k = 0; k < 3; ++k)
    if (corner_of(b, a[k]) >= 0) shared[n++] = k;
  if (n == 0) return CGAL::do_intersect(triangle(points, a), triangle(points, b));
  if (n == 1)
    return touches_opposite(points, a, shared[0], b) ||
           touches_opposite(points, b, corner_of(b, a[shared[0]]), a);
  return n == 3 || is_folded(points, a, 3 - shared[0] - shared[1], b);
}

}  // namespace colod
