// Inside room `extraction`: what speaks for and against each cell.
#pragma once

#include <vector>

#include "partition/partition.h"
#include "sight.h"

namespace colod {

struct Evidence {
  std::vector<Vote> cells;
  std::vector<double> weight;  ///< per cell, m²: its surface, less for thin cells
  std::vector<double> area;    ///< per piece, m²
  std::vector<double>
      coverage;  ///< per piece, 0..1: share under outlines that look along its plane
  std::vector<double> reversed;  ///< per piece, 0..1: under outlines that look against it
  std::vector<char> is_told;     ///< per cell: it lies in an element, and has to stay what it is
};

struct VoteOptions {
  bool is_on_rings = true;  ///< Rule::kRings; else level, from the centroid alone
  int nr = 100;
};

/// Rays from the cells' centroids (and further points of large cells). Parallel over cells.
Evidence gather_evidence(const Partition& partition, Sight& sight, const VoteOptions& options);

/// What speaks for the inside, less what speaks against it; an exposed ray counts `escape`.
double inside_vote(const Vote& vote, double escape = 1);

}  // namespace colod
