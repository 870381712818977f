// Based on: Co-LOD, section 3.3: binary space partition (partition/partition.h).
// Differs: robust rules cut as finely as the planes are known.
// Notation: none.
#include "cut.h"

#include <algorithm>

#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::extraction::cut;

}  // namespace

Partition cut_space(const CuttingPlan& plan, const Planes& planes,
                    const ExtractionOptions& options) {
  PartitionOptions cutting{.max_cells = options.max_cells};
  if (options.rules.has(Rule::kFineCuts))
    cutting.clip_tolerance = std::min(cutting.clip_tolerance, kClipShare * planes.distance);
  return partition_space(plan.planes, plan.box, cutting);
}

}  // namespace colod
