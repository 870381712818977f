// Inside room `coanalysis`: the smallest eigenvalues of the normalised Laplacian and their vectors.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "similarity.h"

namespace colod {

struct Spectrum {
  std::vector<double> values;  ///< rising, at most 10 or k; at least k unless it did not converge
  Eigen::MatrixXd
      vectors;  ///< [segment][k]: a row a segment; the largest entry of a column is positive
};

/// At least k of them, by segment_similarity or kind_similarity. Exact up to 3,000 segments;
/// beyond, each is tied to its 50 most similar only. Deterministic; uses threads.
Spectrum smallest_spectrum(const std::vector<Descriptor>& segments, int k, double eta,
                           Similarity similarity, std::uint64_t seed);

}  // namespace colod
