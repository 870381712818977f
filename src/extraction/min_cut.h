// Inside room `extraction`: inside and outside as the labelling of least cost.
#pragma once

#include <vector>

#include "evidence.h"
#include "partition/partition.h"

namespace colod {

struct CutOptions {
  double smoothness = 0.4;  ///< weight of facet area
  double escape = 1.0;      ///< what an exposed ray counts against the inside
};

/// The labelling of least cost: votes against weight, and smoothness × facet area, less where an
/// outline covers the facet. Of several minima the smallest inside.
std::vector<char> cut_cells(const Partition& partition, const Evidence& evidence,
                            const std::vector<char>& is_forced_out, const CutOptions& options = {});

}  // namespace colod
