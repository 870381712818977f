// Exact tests between faces of a mesh.
#pragma once

#include <vector>

#include "geometry.h"

namespace colod {

/// The corners lie on a line. Exact. \pre indices in range, points finite.
bool is_degenerate(const std::vector<Vec3>& points, const Face& face);

/// Whether two faces meet elsewhere than in the vertices and edges that they share by index. Exact,
/// as the self-intersection tests of CGAL's Polygon Mesh Processing. Faces with the same three
/// vertices do. \pre neither is degenerate.
bool do_intersect(const std::vector<Vec3>& points, const Face& a, const Face& b);

}  // namespace colod
