// Based on: Co-LOD, section 3.3: binary space partition (partition/partition.h).
// Differs: robust rules cut as finely as the planes are known.
// Notation: none.
#include "cut.h"

#include <algorithm>

namespace colod {
namespace {

constexpr double kClipShare = 1.0 / 3;  // of the growing distance: what a cut must reach into

}  // namespace

Partition cut_space(const CuttingPlan& plan, const Planes& planes,
                    const ExtractionOptions& options) {
  PartitionOptions cutting{.max_cells = options.max_cells};
  if (!options.is_paper)
    cutting.clip_tolerance = std::min(cutting.clip_tolerance, kClipShare * planes.distance);
  return partition_space(plan.planes, plan.box, cutting);
}

}  // namespace colod
