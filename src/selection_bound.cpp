// Based on: Geoffrion, "Lagrangean relaxation for integer programming", 1974; Held, Wolfe, Crowder,
// "Validation of subgradient optimization", 1974 (Polyak's step).
//
// The bound. With c_kt = weight_k sim(k, t), layer 0 is
//   max Σ_k gain_k x_k − loss(x) + Σ_{k,t} c_kt y_kt
//   s.t. y_kt ≤ x_t (1),   Σ_{t∈j} y_kt ≤ x_k for every other block j,   y ≥ 0,   loss_i ≤
//   capacity_i
// (for a given x the best y puts all of x_k on the most similar dropped t: the maximum in f_co).
// For any μ ≥ 0, adding Σ μ_kt (x_t − y_kt) to the objective and forgetting (1) gives
//   L(μ) = max_x Σ_k p_k x_k − loss(x),
//   p_k = gain_k + Σ_{j≠i} max(0, max_{t∈j} c_kt − μ_kt) + Σ_{t∉i} μ_tk.
// Every feasible (x, y) of the program stays feasible and is worth no less, as x_t − y_kt ≥ 0:
// hence E_0 ≤ constants + L(μ). L falls apart into one knapsack a block, solved whole (not
// fractionally: the bound may lie below that of the linear program); where a knapsack's node limit
// is hit its own upper bound takes its place, which keeps L's side of the inequality. Each step's
// value is thus a bound, and the least is kept. x_t − y_kt is a subgradient of L; μ follows it
// downhill.
//
// The knapsacks' sets are feasible choices: every few steps one is improved by the block ascent.
//
// Differs: the same for both rules; the paper reports no bound.
//
// Notation: μ multipliers, c, p, L as above; y is kept as the one t taken in each (k, j), or −1.
#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel.h"
#include "selection_model.h"

namespace colod::selection {
namespace {

constexpr int kKnapsackNodes = 200;
constexpr int kStepsPerAscent = 40;
constexpr int kPatience = 12;          // steps without a better bound before the step shrinks
constexpr double kLeastFactor = 1e-3;  // of the step: below, the bound stands still
constexpr double kRounding = 1e-9;

class Relaxation {
 public:
  explicit Relaxation(const Model& model)
      : model_(model), n_(model.items.size()), mu_(n_ * n_, 0.0f), taken_(n_ * blocks(), -1) {}

  // L(μ) with the constants; fills x and y.
  double evaluate() {
    std::vector<double> profit = column_sums();
    parallel_for(
        n_, [&](std::size_t k) { profit[k] += model_.items[k].gain + take(k); }, 16);
    std::vector<BlockSolution> solutions(blocks());
    parallel_for(blocks(), [&](std::size_t i) {
      solutions[i] = solve_block(model_.blocks[i], profit, nullptr, kKnapsackNodes);
    });
    double value = 0;
    x_.assign(n_, 0);
    for (std::size_t i = 0; i < blocks(); ++i) {
      value += model_.blocks[i].constant + solutions[i].bound;
      for (const int k : solutions[i].dropped) x_[k] = 1;
    }
    return value;
  }

  // Σ g² over the entries that a step may change.
  double squared_subgradient() {
    std::vector<double> rows(n_, 0.0);
    parallel_for(
        n_, [&](std::size_t k) { rows[k] = squared_row(k); }, 16);
    double sum = 0;
    for (const double r : rows) sum += r;
    return sum;
  }

  void step(double length) {
    parallel_for(
        n_, [&](std::size_t k) { step_row(k, static_cast<float>(length)); }, 16);
  }

  const Choice& choice() const { return x_; }

 private:
  std::size_t blocks() const { return model_.blocks.size(); }
  float* mu(std::size_t k) { return mu_.data() + k * n_; }

  std::vector<double> column_sums() {
    std::vector<double> sums(n_, 0.0);
    parallel_ranges(n_, 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = 0; k < n_; ++k) {
        const float* row = mu(k);
        for (std::size_t t = begin; t < end; ++t) sums[t] += row[t];
      }
    });
    return sums;
  }

  // The best y of item k were it dropped: its worth, and which t in taken_. None of its own block,
  // where similarities are 0.
  double take(std::size_t k) {
    const float* sim = model_.row(static_cast<int>(k));
    const float* multiplier = mu(k);
    const double weight = model_.items[k].weight;
    double sum = 0;
    for (std::size_t j = 0; j < blocks(); ++j) {
      const Block& block = model_.blocks[j];
      double best = 0;
      int who = -1;
      for (int t = block.first; t < block.first + block.count; ++t) {
        const double left = weight * sim[t] - multiplier[t];
        if (left > best) best = left, who = t;
      }
      taken_[k * blocks() + j] = who;
      sum += best;
    }
    return sum;
  }

  // g_kt = x_t − y_kt, y_kt = 1 where k is dropped and takes t. Where μ and y are 0 a step down
  // changes nothing.
  template <class Visit>
  void for_each_entry(std::size_t k, const Visit& visit) {
    const float* multiplier = mu(k);
    for (std::size_t j = 0; j < blocks(); ++j) {
      const Block& block = model_.blocks[j];
      const int who = x_[k] ? taken_[k * blocks() + j] : -1;
      for (int t = block.first; t < block.first + block.count; ++t) {
        if (multiplier[t] == 0 && t != who) continue;
        const int g = (x_[t] ? 1 : 0) - (t == who ? 1 : 0);
        if (g != 0) visit(t, g);
      }
    }
  }

  double squared_row(std::size_t k) {
    double sum = 0;
    for_each_entry(k, [&](int, int) { sum += 1; });
    return sum;
  }

  void step_row(std::size_t k, float length) {
    float* multiplier = mu(k);
    for_each_entry(k, [&](int t, int g) {
      multiplier[t] = std::max(0.0f, multiplier[t] - length * static_cast<float>(g));
    });
  }

  const Model& model_;
  std::size_t n_;
  std::vector<float> mu_;   // [k][t]
  std::vector<int> taken_;  // [k][block]
  Choice x_;
};

}  // namespace

Bound lagrangian_bound(const Model& model, const Choice& incumbent, int steps) {
  Bound bound{std::numeric_limits<double>::infinity(), incumbent};
  double value = objective(model, incumbent), factor = 1.0;
  Relaxation relaxation(model);
  int since_better = 0;
  for (int s = 0; s < steps; ++s) {
    const double l = relaxation.evaluate();
    if (l < bound.value - kRounding) {
      bound.value = l, since_better = 0;
    } else if (++since_better >= kPatience) {
      factor *= 0.7, since_better = 0;
    }
    if (s % kStepsPerAscent == 0 && is_feasible(model, relaxation.choice())) {
      const Choice x = ascend(model, relaxation.choice());
      const double e = objective(model, x);
      if (e > value) value = e, bound.best = x;
    }
    if (bound.value <= value + kRounding * std::max(1.0, std::abs(value))) break;
    const double squared = relaxation.squared_subgradient();
    if (squared == 0 || factor < kLeastFactor) break;
    relaxation.step(factor * (l - value) / squared);
  }
  bound.value += kRounding * std::max(1.0, std::abs(bound.value));
  bound.value = std::max(bound.value, value);
  return bound;
}

}  // namespace colod::selection
