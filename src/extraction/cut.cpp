// Based on: Co-LOD, section 3.3: binary space partition (partition/partition.h).
// Differs: robust rules let a plane cut where its outline's hull reaches, and as finely as the
// planes are known. Paper rules let it cut the whole box; n planes in general position make n³ / 6
// cells, so that beyond the cap they, too, let each cut where its outline reaches, as the polygons
// of a BSP tree do (Fuchs, Kedem, Naylor, "On visible surface generation by a priori tree
// structures", SIGGRAPH 1980), and a warning says so. Notation: none.
#include "cut.h"

#include <algorithm>

#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::extraction::cut;

std::vector<CutPlane> whole_planes(std::vector<CutPlane> planes) {
  for (CutPlane& p : planes) p.hull.clear();
  return planes;
}

}  // namespace

Partition cut_space(const CuttingPlan& plan, const Planes& planes,
                    const ExtractionOptions& options) {
  PartitionOptions cutting{.max_cells = options.max_cells};
  if (options.rules.has(Rule::kFineCuts))
    cutting.clip_tolerance = std::min(cutting.clip_tolerance, kClipShare * planes.distance);
  if (options.rules.has(Rule::kReach)) return partition_space(plan.planes, plan.box, cutting);
  Partition whole = partition_space(whole_planes(plan.planes), plan.box, cutting);
  if (whole.warnings.empty()) return whole;
  Partition reached = partition_space(plan.planes, plan.box, cutting);
  reached.warnings.push_back(
      std::to_string(plan.planes.size()) + " planes that cut the whole box make more than " +
      std::to_string(cutting.max_cells) + " cells: each cuts only where its outline reaches");
  return reached;
}

}  // namespace colod
