// Inside room `extraction`: what is drawn as one sheet without thickness, as a thin body.
#pragma once

#include <vector>

#include "core/rays.h"
#include "plan.h"
#include "planes/planes.h"

namespace colod {

/// A layer's surface that may lack sheets.
struct SheetScene {
  const Planes& planes;
  const PolygonMesh& mesh;
  const RayScene& rays;  ///< of all outlines
  double tolerance;      ///< metres: the layer's
};

/// A part of a plane that the surface lacks and that lies outside on both sides: an eave, a canopy,
/// a fin, a parapet.
struct Sheet {
  int plane;
  Vec3 normal;                 ///< unit; the slab lies behind it
  double offset;               ///< metres
  double area;                 ///< m²
  std::vector<Vec3> points;    ///< spread over it
  std::vector<CutPlane> ends;  ///< along its border, where the surface does not end it
};

/// Those of `layer_planes` that are worth a body, in that order.
std::vector<Sheet> find_sheets(const SheetScene& scene, const std::vector<int>& layer_planes);

/// Appends both sides of each, two planes a sheet, then all ends.
void add_slabs(const Planes& planes, const std::vector<Sheet>& sheets, CuttingPlan& plan);

/// What is inside in a partition by a plan with slabs: what was inside without them (`was_inside`,
/// a cell each), and the slabs' cells. `first_cut` is the place of the first sheet in the plan.
std::vector<char> fill_slabs(const SheetScene& scene, const Partition& partition,
                             const std::vector<Sheet>& sheets, std::size_t first_cut,
                             const std::vector<char>& was_inside);

}  // namespace colod
