// Based on: Geoffrion, "Lagrangean relaxation for integer programming", 1974; Held, Wolfe, Crowder,
// "Validation of subgradient optimization", 1974 (Polyak's step).
//
// The bound. With w_k the item's high weight, s_tq = sim(t, q) at most, q_k the item's prototype
// and i(k) its block, layer 0 is
//   max Σ_k gain_k x_k − loss(x) + Σ_k w_k Σ_{j≠i(k)} Σ_{t∈j} s_{t q_k} y_kt
//   s.t. y_kt ≤ x_t (1),   Σ_{t∈j} y_kt ≤ x_k for every other block j,   y ≥ 0,
//        loss_i ≤ capacity_i
// (for a given x the best y puts all of x_k on the most similar dropped t: the maximum in f_co).
// For any ν ≥ 0, adding Σ w_k ν_{t q_k} (x_t − y_kt) to the objective and forgetting (1) gives
//   L(ν) = max_x Σ_k p_k x_k − loss(x),
//   p_k = gain_k + w_k Σ_{j≠i(k)} max(0, max_{t∈j} s_{t q_k} − ν_{t q_k})
//         + Σ_q ν_kq Σ_{t: q_t = q, i(t)≠i(k)} w_t.
// Every feasible (x, y) of the program stays feasible and is worth no less, as x_t − y_kt ≥ 0:
// hence E_0 ≤ constants + L(ν). Items of one prototype share their multipliers, which restricts ν
// and therefore can only weaken the bound. L falls apart into one knapsack a block, solved whole
// (not fractionally: the bound may lie below that of the linear program); where a knapsack's node
// limit is hit its own upper bound takes its place, which keeps L's side of the inequality. Each
// step's value is thus a bound, and the least is kept. The derivative of L by ν_tq is
//   x_t Ω_q − [t is taken for q by its block] X_q,   Ω_q = Σ w_k, X_q = Σ w_k x_k
// over the items k of q in other blocks than t's; ν follows it downhill in units of Ω_q. Only what
// has been taken once has a ν that is not 0: the others are not kept.
//
// The knapsacks' sets are feasible choices: every few steps one is improved by the block ascent.
//
// Differs: the same for both rules; the paper reports no bound.
//
// Notation: ν multipliers, L, p, Ω, X as above; `who`: the one t taken for each (block, q), or −1.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/parallel.h"
#include "selection_model.h"

namespace colod::selection {
namespace {

constexpr int kKnapsackNodes = 200;
constexpr int kStepsPerAscent = 40;
constexpr int kPatience = 12;  // steps without a better bound before the step shrinks
// With prototypes the incumbent's low weights put the aim of Polyak's step far below the least L:
// whole steps then swing about it. Of first steps from 0.15 to 1 and patiences from 2 to 12 (10,000
// generated segments, seeds 1 and 3) this gets in 15 steps below what the others get in 60.
constexpr double kCoarseFactor = 0.25;
constexpr int kCoarsePatience = 3;
constexpr double kLeastFactor = 1e-3;  // of the step: below, the bound stands still
constexpr int kProgressSteps = 30;     // in these
constexpr double kProgress = 0.03;  // the gap has to shrink by this share of it, or the bound stays
constexpr double kRounding = 1e-9;

class Relaxation {
 public:
  explicit Relaxation(const Model& model)
      : model_(model),
        n_(model.prototypes),
        nu_(model.items.size()),
        own_take_(model.items.size(), 0.0),
        who_(blocks()),
        all_(n_, 0.0),
        dropped_(n_, 0.0) {
    for (const Item& item : model.items) all_[item.prototype] += item.weight_high;
    for (std::size_t i = 0; i < blocks(); ++i)
      if (model.blocks[i].count > 0) who_[i].assign(n_, -1);
  }

  // L(ν) with the constants; fills x and y.
  double evaluate() {
    const std::vector<double> total = take_all();
    std::vector<BlockSolution> solutions(blocks());
    parallel_for(
        blocks(),
        [&](std::size_t i) {
          solutions[i] = solve_block(model_.blocks[i], profits(i, total), nullptr, kKnapsackNodes);
        },
        4);
    double value = 0;
    x_.assign(model_.items.size(), 0);
    dropped_.assign(n_, 0.0);
    for (std::size_t i = 0; i < blocks(); ++i) {
      value += model_.blocks[i].constant + solutions[i].bound;
      for (const int k : solutions[i].dropped) {
        x_[k] = 1;
        dropped_[model_.items[k].prototype] += model_.items[k].weight_high;
      }
    }
    return value;
  }

  // Σ h² over the entries that a step may change, h being the derivative in units of Ω_q: where ν
  // and y are 0 a step down changes nothing.
  double squared_subgradient() {
    std::vector<double> sums(blocks(), 0.0);
    parallel_for(
        blocks(),
        [&](std::size_t i) {
          const Derivative d = derivative(i, 1);
          const std::vector<int>& who = who_[i];
          std::vector<float> nu(n_, 0.0f);
          for (int t = first(i); t < end(i); ++t) {
            const float own = x_[t] ? 1.0f : 0.0f;
            unpack(t, nu);
            std::array<double, 4> sum{};  // four chains of additions instead of one
            for (std::size_t q = 0; q < n_; ++q) {
              const float taken = who[q] == t ? 1.0f : 0.0f;
              const float h = nu[q] > 0 || taken > 0 ? own * d.rise[q] - taken * d.fall[q] : 0.0f;
              sum[q % 4] += h * h;
            }
            sums[i] += (sum[0] + sum[1]) + (sum[2] + sum[3]);
            clear(t, nu);
          }
        },
        4);
    double sum = 0;
    for (const double s : sums) sum += s;
    return sum;
  }

  void step(double length) {
    parallel_for(
        blocks(),
        [&](std::size_t i) {
          const Derivative d = derivative(i, length);
          const std::vector<int>& who = who_[i];
          std::vector<float> nu(n_, 0.0f);
          for (int t = first(i); t < end(i); ++t) {
            const float own = x_[t] ? 1.0f : 0.0f;
            unpack(t, nu);
            for (std::size_t q = 0; q < n_; ++q) {
              const float taken = who[q] == t ? 1.0f : 0.0f;
              nu[q] = std::max(0.0f, nu[q] - (own * d.rise[q] - taken * d.fall[q]));
            }
            pack(t, nu);
          }
        },
        4);
  }

  const Choice& choice() const { return x_; }

 private:
  struct Multiplier {
    std::uint32_t prototype;
    float value;
  };

  // An item's multipliers into `nu`, which is 0, and away from there.
  void unpack(int t, std::vector<float>& nu) const {
    for (const Multiplier& m : nu_[t]) nu[m.prototype] = m.value;
  }
  void clear(int t, std::vector<float>& nu) const {
    for (const Multiplier& m : nu_[t]) nu[m.prototype] = 0;
  }
  // Keeps them; `nu` is 0 again.
  void pack(int t, std::vector<float>& nu) {
    const auto count = n_ - static_cast<std::size_t>(std::count(nu.begin(), nu.end(), 0.0f));
    std::vector<Multiplier> kept;
    kept.reserve(count);
    for (std::size_t q = 0; q < n_ && kept.size() < count; ++q)
      if (nu[q] != 0) kept.push_back({static_cast<std::uint32_t>(q), nu[q]});
    nu_[t].swap(kept);
    std::fill(nu.begin(), nu.end(), 0.0f);
  }

  // By ν_tq: `rise` where t is dropped, less `fall` where it is taken.
  struct Derivative {
    std::vector<float> rise, fall;
  };

  std::size_t blocks() const { return model_.blocks.size(); }
  int first(std::size_t i) const { return model_.blocks[i].first; }
  int end(std::size_t i) const { return model_.blocks[i].first + model_.blocks[i].count; }

  // In units of Ω_q, or with a length the step itself.
  Derivative derivative(std::size_t i, double length) const {
    const std::vector<double> all = of_others(i, all_, false);
    const std::vector<double> dropped = of_others(i, dropped_, true);
    Derivative d{std::vector<float>(n_, 0.0f), std::vector<float>(n_, 0.0f)};
    for (std::size_t q = 0; q < n_; ++q) {
      if (!(all[q] > 0)) continue;
      const double unit = length == 1 ? 1 / all_[q] : length / (all_[q] * all_[q]);
      d.rise[q] = static_cast<float>(all[q] * unit);
      d.fall[q] = static_cast<float>(dropped[q] * unit);
    }
    return d;
  }

  // Σ_j of what is taken from block j, per prototype; some blocks at a time, to save memory.
  std::vector<double> take_all() {
    constexpr std::size_t kTogether = 256;
    std::vector<double> total(n_, 0.0), taken(std::min(kTogether, blocks()) * n_);
    for (std::size_t begin = 0; begin < blocks(); begin += kTogether) {
      const std::size_t count = std::min(kTogether, blocks() - begin);
      parallel_for(
          count, [&](std::size_t j) { take(begin + j, taken.data() + j * n_); }, 4);
      parallel_ranges(n_, 64, [&](std::size_t from, std::size_t to) {
        for (std::size_t j = 0; j < count; ++j)
          for (std::size_t q = from; q < to; ++q) total[q] += taken[j * n_ + q];
      });
    }
    return total;
  }

  // What block j gives to each prototype, and which of its items does.
  void take(std::size_t j, double* best) {
    std::vector<int>& who = who_[j];
    std::fill(best, best + n_, 0.0);
    std::fill(who.begin(), who.end(), -1);
    std::vector<float> room, nu(n_, 0.0f);
    const float* sim = model_.rows_high(model_.blocks[j], room);
    for (int t = first(j); t < end(j); ++t, sim += n_) {
      unpack(t, nu);
      for (std::size_t q = 0; q < n_; ++q) {
        const double left = static_cast<double>(sim[q]) - nu[q];
        who[q] = left > best[q] ? t : who[q];
        best[q] = std::max(best[q], left);
      }
      clear(t, nu);
    }
    for (int k = first(j); k < end(j); ++k) own_take_[k] = best[model_.items[k].prototype];
  }

  // Sums over the prototypes without block i's own items.
  std::vector<double> of_others(std::size_t i, const std::vector<double>& sums,
                                bool is_dropped_only) const {
    std::vector<double> others = sums;
    const Block& block = model_.blocks[i];
    for (int k = block.first; k < block.first + block.count; ++k) {
      const Item& item = model_.items[k];
      if (is_dropped_only && !x_[k]) continue;
      others[item.prototype] = std::max(0.0, others[item.prototype] - item.weight_high);
    }
    return others;
  }

  std::vector<double> profits(std::size_t i, const std::vector<double>& total) const {
    const Block& block = model_.blocks[i];
    const std::vector<double> all = of_others(i, all_, false);
    std::vector<double> profit(block.count);
    for (int k = block.first; k < block.first + block.count; ++k) {
      const Item& item = model_.items[k];
      const double others = total[item.prototype] - own_take_[k];
      double sum = item.gain + item.weight_high * std::max(0.0, others);
      for (const Multiplier& m : nu_[k]) sum += m.value * all[m.prototype];
      profit[k - block.first] = sum;
    }
    return profit;
  }

  const Model& model_;
  std::size_t n_;                            // prototypes
  std::vector<std::vector<Multiplier>> nu_;  // per item those that are not 0, by prototype
  std::vector<double> own_take_;             // per item: what its own block gives to its prototype
  std::vector<std::vector<int>> who_;        // [block][prototype]; of a block without items empty
  std::vector<double> all_;                  // per prototype: weights of its items
  std::vector<double> dropped_;              // of those that are dropped
  Choice x_;
};

}  // namespace

Bound lagrangian_bound(const Model& model, const Choice& incumbent, int steps, double gap) {
  Bound bound{std::numeric_limits<double>::infinity(), incumbent};
  double value = objective(model, incumbent), factor = model.is_exact ? 1.0 : kCoarseFactor;
  const int patience = model.is_exact ? kPatience : kCoarsePatience;
  Relaxation relaxation(model);
  double last = std::numeric_limits<double>::infinity();  // bound at the last look at its progress
  int since_better = 0;
  for (int s = 0; s < steps; ++s) {
    const double l = relaxation.evaluate();
    if (l < bound.value - kRounding) {
      bound.value = l, since_better = 0;
    } else if (++since_better >= patience) {
      factor *= 0.7, since_better = 0;
    }
    if (s % kStepsPerAscent == 0 && is_feasible(model, relaxation.choice())) {
      const Choice x = ascend(model, relaxation.choice());
      const double e = objective(model, x);
      if (e > value) value = e, bound.best = x;
    }
    if (bound.value <= value + std::max(gap, kRounding) * std::max(1.0, std::abs(value))) break;
    if (s % kProgressSteps == kProgressSteps - 1) {
      if (last - bound.value < kProgress * (bound.value - value)) break;
      last = bound.value;
    }
    const double squared = relaxation.squared_subgradient();
    if (squared == 0 || factor < kLeastFactor) break;
    relaxation.step(factor * (l - value) / squared);
  }
  bound.value += kRounding * std::max(1.0, std::abs(bound.value));
  bound.value = std::max(bound.value, value);
  return bound;
}

}  // namespace colod::selection
