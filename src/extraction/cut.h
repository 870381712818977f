// Inside room `extraction`, the second verb: space cut by a plan.
#pragma once

#include "extraction.h"
#include "partition/partition.h"
#include "plan.h"
#include "planes/planes.h"

namespace colod {

/// Where planes are known to the millimetre, what reaches a millimetre into a cell cuts it.
Partition cut_space(const CuttingPlan& plan, const Planes& planes,
                    const ExtractionOptions& options);

}  // namespace colod
