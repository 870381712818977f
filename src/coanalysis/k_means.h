// Inside room `coanalysis`: k-means over weighted rows.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace colod {

using Features = Eigen::MatrixXd;  ///< an item a row

/// 0..k−1 per row: the cheapest of 20 restarts, the first of equals; a cluster may stay empty.
/// `weights` per row, positive. At most 100 iterations each. Deterministic.
std::vector<int> k_means(const Features& x, const Eigen::VectorXd& weights, int k,
                         std::uint64_t seed);

}  // namespace colod
