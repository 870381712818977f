// Inside room `coanalysis`: kinds of segments, and layers of whole kinds.
#pragma once

#include <cstdint>
#include <vector>

#include "similarity.h"

namespace colod {

struct Kinds {
  std::vector<int> kind;            ///< per segment, from 0 on without a gap; empty: not told
  std::vector<double> eigenvalues;  ///< the smallest of L_norm, rising
  bool has_converged = true;
};

/// At most `count` kinds of segments that are alike by kind_similarity: the spectrum's first
/// `count` eigenvectors, rows of unit length, k-means. Elements of one kind are never parted. Fewer
/// kinds where fewer differ. Deterministic; uses threads.
Kinds find_kinds(const std::vector<Descriptor>& segments, int count, double eta,
                 std::uint64_t seed);

/// Per segment 0..k−1, coarse to fine: kinds by falling median extent, parted where its logarithm
/// passes equal steps of the range of the segments' sizes, so that what each layer lacks is smaller
/// than what the one before lacks by about one factor. Empty: fewer than k kinds.
std::vector<int> classes_of_kinds(const std::vector<Descriptor>& segments,
                                  const std::vector<int>& kind, int k);

}  // namespace colod
