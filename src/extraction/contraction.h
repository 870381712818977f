// Inside room `extraction`: edges that are too short for a mesh to keep.
#pragma once

#include "core/geometry.h"

namespace colod {

/// Contracts edges shorter than `length` where the surface stays closed and 2-manifold, no triangle
/// turns over and none comes to cut another; returns how many.
int contract_short_edges(PolygonMesh& mesh, double length);

struct FacetSize {
  double area = 0;       ///< m²
  double perimeter = 0;  ///< metres, holes included
  double width() const { return perimeter > 0 ? 2 * area / perimeter : 0; }
};
FacetSize measure_facet(const PolygonMesh& mesh, const PolygonMesh::Facet& facet);

/// The same for edges of facets narrower than `width` metres, and of triangles that contracting has
/// bent away from theirs, up to 16 times as long: shorter ones first, and only while that is so. In
/// the end longer ones, where no triangle's plane moves by more than `width`.
int contract_narrow_facets(PolygonMesh& mesh, double width);

}  // namespace colod
