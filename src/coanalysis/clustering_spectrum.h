// Inside room `coanalysis`: the smallest eigenvalues of the normalised Laplacian and their vectors.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "similarity.h"

namespace colod {

struct Spectrum {
  std::vector<double> values;  ///< rising, at most 10; at least k unless it did not converge
  Eigen::MatrixXd vectors;  ///< [id][k]: a row a segment; the largest entry of a column is positive
};

/// Of segments[ids], at least k of them. Exact up to 3,000 segments; beyond, each is tied to its 50
/// most similar only. Deterministic; uses threads.
Spectrum smallest_spectrum(const std::vector<Descriptor>& segments, const std::vector<int>& ids,
                           int k, double eta, std::uint64_t seed);

}  // namespace colod
