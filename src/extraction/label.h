// Inside room `extraction`, the third verb: which cells are inside.
#pragma once

#include <string>
#include <vector>

#include "evidence.h"
#include "extraction.h"
#include "partition/partition.h"
#include "plan.h"
#include "planes/planes.h"

namespace colod {

struct Labels {
  Evidence evidence;
  std::vector<char> is_forced_out;  ///< per cell: beyond a limit of the plan
  std::vector<char> is_inside;      ///< per cell; empty: nothing is
  std::vector<std::string> warnings;
};

/// Paper: more than half of the rays, no smoothing. Robust: the min-cut; escaping rays count less
/// where that explains clearly more of the outlines (four trials at most), and without any inside
/// the box around the planes is it. What was seen is kept in `sight`.
Labels label_cells(const Partition& partition, const CuttingPlan& plan, const Planes& planes,
                   Sight& sight, const ExtractionOptions& options);

}  // namespace colod
