// Inside room `extraction`: how much of the cells' faces outlines cover.
#pragma once

#include <vector>

#include "evidence.h"
#include "partition/partition.h"
#include "planes/planes.h"

namespace colod {

/// Per piece the share that the outlines of `planes` cover; `input[i]` is the plane of
/// partition.cuts[i], −1 none.
void measure_coverage(const Partition& partition, const Planes& planes,
                      const std::vector<int>& input, Evidence& evidence);

/// Share of the outlines' area that lies on the surface of the inside, looking outward.
double explained_share(const Partition& partition, const Evidence& evidence,
                       const std::vector<char>& is_inside);

}  // namespace colod
