// Inside room `read` only: sets of triangles as they stand on the ground, to tell what a building
// is.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry.h"

namespace colod::mesh_io {

/// Bodies with a point each that lie nearer than this in plan are near; from kNear and a cell's
/// diagonal on they are not.
constexpr double kNear = 1.0;   // metres: a joint or a gutter between parts of one house
constexpr double kCell = 0.5;   // metres, of the plan's raster
constexpr double kWide = 500;   // metres: what is wider is ground or a scene, no building
constexpr double kLeast = 2.0;  // metres: a building is no narrower and no lower (a small shed)
constexpr double kStep = 2.0;   // metres that the feet of neighbours differ at most, on a slope

/// Some triangles of a mesh.
struct Body {
  Box box;                           ///< empty: no triangle
  double area = 0;                   ///< m²
  std::vector<std::uint64_t> cells;  ///< of the plan that it covers or is near to, rising
  bool is_wide = false;              ///< wider than kWide: it has no cells
  bool has_building_shape = false;   ///< large enough; closed, or with walls on all four sides
};

/// `welded`: point → lowest index of the points with its coordinates. O(n log n) and the plan.
Body describe_body(const std::vector<Vec3>& points, const std::vector<int>& welded,
                   const std::vector<Face>& faces, const std::vector<int>& chosen);

/// Two bodies with cells in common. `a` < `b`.
struct Contact {
  int a, b;
  int cells;
};

/// All contacts, by a and b. In a cell of more than eight bodies each meets the eight that cover
/// most.
std::vector<Contact> find_contacts(const std::vector<Body>& bodies);

}  // namespace colod::mesh_io
