// Based on: Jensen, "Sur les fonctions convexes", 1906, and the proof of selection_prototypes.cpp.
//
// With prototypes `objective` takes the worst of every pair: it divides each weight by its item's
// spread. What a choice is worth at least is told much better for the items of a prototype
// together. With dropped items k ∈ G of one prototype, their weights w, W = Σ w, and t any dropped
// item of another block j,
//   Σ_k w_k max_{t∈j} sim(k, t) ≥ max_t Σ_k w_k sim(k, t) ≥ max_t W exp(−Σ_k w_k dis(k, t) / W),
// since exp is convex. Of the mean of dis = η ‖h_k − h_t‖₂ + B(k, t):
// - the root is concave: Σ w ‖h_k − h_t‖ / W ≤ √(Σ w ‖h_k − h_t‖² / W) = √(‖m − h_t‖² + v), m being
//   the mean histogram and v the variance about it;
// - G is cut into bins of like eigenvalues. With r_k = J(k, c) for a bin's centre c, J(k, t) ≤
//   J(c, t) + r_k, and B = J / (2 − J) is convex and rises: the mean of B over a bin whose r_k have
//   the mean r and the maximum R is at most B(J) + r/R (B(J + R) − B(J)), and at most 1.
// Items of block j itself are taken out of the sum by their own similarities to t. Elements of a
// kind are groups of their own: their dis to t of that kind is 0.
//
// Notation: k, t items, j block, G group, h histogram, m, v, c, r, R as above.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/parallel.h"
#include "selection_model.h"

namespace colod::selection {
namespace {

constexpr int kCuts = 4;              // of a group, each in halves: at most 16 bins
constexpr std::size_t kLeastCut = 4;  // items
constexpr double kLeastWidth = 1e-9;  // m², for logarithms
constexpr double kLargestJ = 1.5;     // J / (2 − J) is far above 1 by then
constexpr double kProofRounding = 1e-9;

double difference_of(const Vec3& a, const Vec3& b) {
  const double sum = a.lpNorm<1>() + b.lpNorm<1>();
  const double share = sum > 0 ? (a - b).lpNorm<1>() / sum : 0;
  return 2 * share / (1 + share);  // J
}

/// Items of like eigenvalues.
struct Bin {
  Vec3 centre = Vec3::Zero();
  double share = 0;  ///< of the group's weight
  double mean_r = 0, largest_r = 0;

  /// Mean B to t, at most.
  double mean_scale(const Vec3& t) const {
    const auto scale = [](double j) { return j / (2 - j); };
    const double j = difference_of(centre, t);
    if (j + largest_r > kLargestJ) return 1;
    const double rise = largest_r > 0 ? mean_r / largest_r : 0;
    return std::min(1.0, scale(j) + rise * (scale(j + largest_r) - scale(j)));
  }
};

struct Group {
  std::vector<int> items;
  Descriptor mean;  ///< histogram and kind
  double weight = 0, variance = 0;
  std::vector<Bin> bins;
};

class Proof {
 public:
  Proof(const std::vector<SelectionBuilding>& buildings, double eta, const Model& model,
        const Choice& x)
      : buildings_(buildings), eta_(eta), model_(model), x_(x), group_of_(model.items.size(), -1) {
    sort_in();
    parallel_for(groups_.size(), [&](std::size_t g) { describe(groups_[g]); });
  }

  /// What the dropped items of all blocks have of each other, at least.
  double similarity() const {
    std::vector<double> of_block(model_.blocks.size(), 0.0);
    parallel_for(
        of_block.size(), [&](std::size_t j) { of_block[j] = offered(model_.blocks[j]); }, 4);
    double sum = 0;
    for (const double s : of_block) sum += s;
    return sum;
  }

 private:
  const Descriptor& descriptor(int k) const {
    const Item& item = model_.items[k];
    return buildings_[item.building].segments[item.segment];
  }
  /// λ's share, which both weights hold times or by the spread; what is not finite has none.
  double weight(int k) const {
    return std::sqrt(model_.items[k].weight * model_.items[k].weight_high);
  }

  void sort_in() {
    std::map<std::pair<int, ElementKind>, int> numbers;
    for (int k = 0; k < model_.size(); ++k) {
      if (!x_[k] || !(weight(k) > 0)) continue;
      const auto [at, is_new] = numbers.try_emplace({model_.items[k].prototype, descriptor(k).kind},
                                                    static_cast<int>(groups_.size()));
      if (is_new) groups_.emplace_back();
      group_of_[k] = at->second;
      groups_[at->second].items.push_back(k);
    }
  }

  void describe(Group& g) const {
    g.mean.kind = descriptor(g.items.front()).kind;
    for (const int k : g.items) {
      g.weight += weight(k);
      for (std::size_t b = 0; b < g.mean.d2.size(); ++b)
        g.mean.d2[b] += weight(k) * descriptor(k).d2[b];
    }
    for (double& share : g.mean.d2) share /= g.weight;
    for (const int k : g.items) {
      const double d = shape_distance(descriptor(k), g.mean);
      g.variance += weight(k) / g.weight * d * d;
    }
    cut(g, g.items, kCuts);
  }

  /// Halves of about the same number along the axis of the eigenvalues that varies most.
  void cut(Group& g, std::vector<int> items, int cuts) const {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const int k : items) low = low.cwiseMin(logs(k)), high = high.cwiseMax(logs(k));
    Eigen::Index axis = 0;
    if (cuts == 0 || items.size() < kLeastCut || !((high - low).maxCoeff(&axis) > 0))
      return g.bins.push_back(bin_of(g, items));
    std::sort(items.begin(), items.end(), [&](int a, int b) {
      return std::pair(logs(a)[axis], a) < std::pair(logs(b)[axis], b);
    });
    const auto middle = items.begin() + static_cast<std::ptrdiff_t>(items.size() / 2);
    cut(g, {items.begin(), middle}, cuts - 1);
    cut(g, {middle, items.end()}, cuts - 1);
  }

  Vec3 logs(int k) const {
    return descriptor(k).eigenvalues.cwiseMax(kLeastWidth).array().log().matrix();
  }

  Bin bin_of(const Group& g, const std::vector<int>& items) const {
    Bin bin;
    Vec3 sum = Vec3::Zero();
    for (const int k : items) bin.share += weight(k), sum += weight(k) * logs(k);
    bin.centre = (sum / bin.share).array().exp();
    for (const int k : items) {
      const double r = difference_of(descriptor(k).eigenvalues, bin.centre);
      bin.mean_r += weight(k) / bin.share * r;
      bin.largest_r = std::max(bin.largest_r, r);
    }
    bin.share /= g.weight;
    return bin;
  }

  /// Σ w sim(k, t) over a group, at least.
  double worth(const Group& g, const Descriptor& t) const {
    if (is_one_kind(g.mean, t)) return g.weight;
    const double shape = shape_distance(g.mean, t);
    double distance = eta_ * std::sqrt(shape * shape + g.variance);
    for (const Bin& bin : g.bins) distance += bin.share * bin.mean_scale(t.eigenvalues);
    return g.weight * std::exp(-distance);
  }

  /// What all other blocks have of this one's dropped items, at least.
  double offered(const Block& block) const {
    std::vector<double> best(groups_.size(), 0.0), own(groups_.size());
    for (int t = block.first; t < block.first + block.count; ++t) {
      if (group_of_[t] < 0) continue;
      const Descriptor& d = descriptor(t);
      std::fill(own.begin(), own.end(), 0.0);
      for (int k = block.first; k < block.first + block.count; ++k)
        if (group_of_[k] >= 0)
          own[group_of_[k]] += weight(k) * segment_similarity(descriptor(k), d, eta_);
      for (std::size_t g = 0; g < groups_.size(); ++g)
        best[g] = std::max(best[g], worth(groups_[g], d) - own[g]);
    }
    double sum = 0;
    for (const double b : best) sum += b;
    return sum;
  }

  const std::vector<SelectionBuilding>& buildings_;
  const double eta_;
  const Model& model_;
  const Choice& x_;
  std::vector<int> group_of_;  // per item, −1: kept, or like nothing
  std::vector<Group> groups_;
};

}  // namespace

double proven_objective(const std::vector<SelectionBuilding>& buildings, double eta,
                        const Model& model, const Choice& x) {
  const double plain = objective(model, x);
  if (model.is_exact || !std::isfinite(plain)) return plain;
  double e = Proof(buildings, eta, model, x).similarity();
  for (const Block& b : model.blocks) e += b.constant - block_loss(b, x);
  for (int k = 0; k < model.size(); ++k)
    if (x[k]) e += model.items[k].gain;
  return std::max(plain, e - kProofRounding * std::max(1.0, std::abs(e)));
}

}  // namespace colod::selection
