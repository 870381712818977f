// Inside room `extraction`: a boundary written as polygons.
#pragma once

#include "boundary.h"
#include "core/geometry.h"
#include "partition/partition.h"

namespace colod {

/// Facets merged by plane and side, vertices only where three facets meet, exact constrained
/// Delaunay triangles, doubles at the very end. \pre find_pinches(boundary) is empty. Facets are
/// sorted by plane id; `plane` is the source plane of the partition's.
PolygonMesh build_polygons(const Partition& partition, const Boundary& boundary);

}  // namespace colod
