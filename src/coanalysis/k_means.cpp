// Based on: Arthur, Vassilvitskii, "k-means++: the advantages of careful seeding", 2007; Lloyd,
// "Least squares quantization in PCM", 1982.
// Differs: weighted rows, since segments that must be of one kind are one row.
// Notation: –
#include "k_means.h"

#include <limits>
#include <random>

namespace colod {
namespace {

constexpr int kRestarts = 20, kMaxIterations = 100;

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// k-means++: the next centre with probability proportional to the squared distance to the nearest.
Features first_centres(const Features& x, const Eigen::VectorXd& weights, int k,
                       std::mt19937_64& random) {
  const Eigen::Index n = x.rows();
  Features centres(k, x.cols());
  Eigen::VectorXd nearest = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::max());
  Eigen::Index pick =
      std::min(n - 1, static_cast<Eigen::Index>(unit(random) * static_cast<double>(n)));
  for (int c = 0; c < k; ++c) {
    centres.row(c) = x.row(pick);
    const Eigen::VectorXd squared = (x.rowwise() - x.row(pick)).rowwise().squaredNorm();
    nearest = nearest.cwiseMin(squared.cwiseProduct(weights));
    double left = unit(random) * nearest.sum();
    for (pick = 0; pick < n - 1 && left >= nearest[pick]; ++pick) left -= nearest[pick];
  }
  return centres;
}

struct Partition {
  std::vector<int> cluster;
  double cost = std::numeric_limits<double>::infinity();
};

// Lloyd's iterations; ties go to the lower cluster; an emptied cluster keeps its centre.
Partition lloyd(const Features& x, const Eigen::VectorXd& weights, Features centres) {
  Partition p;
  p.cluster.assign(x.rows(), -1);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    bool is_changed = false;
    p.cost = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      Eigen::Index c = 0;
      p.cost += weights[i] * (centres.rowwise() - x.row(i)).rowwise().squaredNorm().minCoeff(&c);
      is_changed |= p.cluster[i] != static_cast<int>(c);
      p.cluster[i] = static_cast<int>(c);
    }
    if (!is_changed) break;
    Features sum = Features::Zero(centres.rows(), centres.cols());
    Eigen::VectorXd count = Eigen::VectorXd::Zero(centres.rows());
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      sum.row(p.cluster[i]) += weights[i] * x.row(i), count[p.cluster[i]] += weights[i];
    for (Eigen::Index c = 0; c < centres.rows(); ++c)
      if (count[c] > 0) centres.row(c) = sum.row(c) / count[c];
  }
  return p;
}

}  // namespace

std::vector<int> k_means(const Features& x, const Eigen::VectorXd& weights, int k,
                         std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Partition best;
  for (int r = 0; r < kRestarts; ++r) {
    Partition p = lloyd(x, weights, first_centres(x, weights, k, random));
    if (p.cost < best.cost * (1 - 1e-12)) best = std::move(p);
  }
  return best.cluster;
}

}  // namespace colod
