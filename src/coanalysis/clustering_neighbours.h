// Inside room `coanalysis`: which segments are most similar, without comparing all pairs.
#pragma once

#include <vector>

#include "similarity.h"

namespace colod {

struct Neighbour {
  int index = 0;          ///< of the segment
  double similarity = 0;  ///< in (0, 1]
};

/// For each segment up to `count` others that are most similar, most similar first, ties
/// by index. Found in an embedding of the descriptors, so now and then a less similar one stands
/// for another; the similarities are exact. n log n time, n memory. Deterministic; uses threads.
std::vector<std::vector<Neighbour>> nearest_neighbours(const std::vector<Descriptor>& segments,
                                                       int count, double eta,
                                                       Similarity similarity);

}  // namespace colod
