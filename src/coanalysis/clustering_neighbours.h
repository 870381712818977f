// Inside room `coanalysis`: which segments are most similar, without comparing all pairs.
#pragma once

#include <vector>

#include "similarity.h"

namespace colod {

/// For each segment the indices of up to `count` others that are most similar, rising. Found in an
/// embedding of the descriptors, so now and then a less similar one stands for another. n log n
/// time, 4 · count bytes a segment. Deterministic; uses threads.
std::vector<std::vector<int>> nearest_neighbours(const std::vector<Descriptor>& segments, int count,
                                                 double eta, Similarity similarity);

}  // namespace colod
