// Based on: branch and bound for the knapsack problem with the fractional relaxation as bound
// (Dantzig, "Discrete-variable extremum problems", 1957).
//
// One building's program, all others fixed: max Σ_{k∈X} profit_k − loss(X) + offer(X), loss(X) ≤
// capacity. Losses overlap: loss(X) is supermodular, so what an item x adds to the loss only grows
// with the set it joins, and loss(D ∪ X) ≥ loss(D) + Σ_{x∈X} m_x with m_x = loss(D + x) − loss(D).
// At a node with D dropped, K kept and U undecided, hence
//   value ≤ Σ_D profit − loss(D) + offer(D ∪ U)
//           + max { Σ_{X⊆U} (profit_x − m_x) : Σ_X m_x ≤ capacity − loss(D) },
// since offer grows with the set, and the last term is at most its fractional knapsack.
//
// Differs: the same for both rules.
//
// Notation: D, K, U as above; m marginal loss; q prototype.
#include <algorithm>
#include <cstdint>
#include <numeric>

#include "selection_model.h"

namespace colod::selection {

double Offer::value(const std::vector<int>& set) const {
  const std::size_t n = weights.size();
  std::vector<float> best(n, 0.0f);
  for (const int k : set) {
    const float* row = rows + static_cast<std::size_t>(k - first) * n;
    for (std::size_t q = 0; q < n; ++q) best[q] = std::max(best[q], row[q]);
  }
  double sum = 0;
  for (std::size_t q = 0; q < n; ++q) sum += weights[q] * best[q];
  return sum;
}

namespace {

enum class Fate : char { kUndecided, kDropped, kKept };

// An improvement below this is rounding.
constexpr double kTolerance = 1e-10;

class BlockSearch {
 public:
  BlockSearch(const Block& block, std::span<const double> profit, const Offer* offer, int max_nodes)
      : block_(block),
        profit_(profit),
        offer_(offer),
        nodes_left_(max_nodes),
        fate_(block.count, Fate::kUndecided),
        marginal_(block.count) {}

  BlockSolution run() {
    best_.value = offer_ ? offer_->value({}) : 0;  // nothing dropped is feasible
    best_.bound = best_.value;
    descend();
    best_.bound = std::max(best_.bound, best_.value);
    std::sort(best_.dropped.begin(), best_.dropped.end());
    return best_;
  }

 private:
  struct Relaxation {
    double bound = 0;
    std::vector<int> taken;  // in the order of the knapsack, whole
    int branch = -1;         // the fractional item, or the first undecided one
  };

  // Loss of D; marginal_ of the undecided items.
  double losses() {
    std::fill(marginal_.begin(), marginal_.end(), 0.0);
    double loss = 0;
    for (const Term& term : block_.terms) {
      int undecided = -1, missing = 0;
      bool is_kept = false;
      for (const int k : term.items) {
        const Fate f = fate_[k - block_.first];
        is_kept |= f == Fate::kKept;
        if (f == Fate::kUndecided) ++missing, undecided = k - block_.first;
      }
      if (is_kept) continue;
      if (missing == 0) loss += term.share;
      if (missing == 1) marginal_[undecided] += term.share;
    }
    return loss;
  }

  double profit(int local) const { return profit_[local]; }
  double worth(int local) const { return profit(local) - marginal_[local]; }

  std::vector<int> with_fate(bool is_undecided_too) const {
    std::vector<int> items;
    for (int i = 0; i < block_.count; ++i)
      if (fate_[i] == Fate::kDropped || (is_undecided_too && fate_[i] == Fate::kUndecided))
        items.push_back(block_.first + i);
    return items;
  }

  // Undecided items that could still go, best worth per loss first, ties by index.
  std::vector<int> candidates(double room) const {
    std::vector<int> order;
    for (int i = 0; i < block_.count; ++i)
      if (fate_[i] == Fate::kUndecided && marginal_[i] <= room) order.push_back(i);
    std::vector<double> ratio(block_.count, 0.0);
    for (const int i : order)
      if (profit(i) > 0) ratio[i] = profit(i) / marginal_[i];  // ∞ when nothing is lost
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return ratio[a] > ratio[b]; });
    return order;
  }

  Relaxation relax(double loss) const {
    Relaxation r;
    double room = block_.capacity - loss;
    r.bound = -loss;
    for (int i = 0; i < block_.count; ++i)
      if (fate_[i] == Fate::kDropped) r.bound += profit(i);
    for (const int i : candidates(room)) {
      if (worth(i) <= 0 && !offer_) continue;  // its marginal loss only grows
      if (r.branch < 0) r.branch = i;
      if (worth(i) <= 0) continue;  // only of use as an offer
      if (marginal_[i] <= room) {
        r.bound += worth(i), room -= marginal_[i], r.taken.push_back(i);
      } else {
        r.bound += worth(i) * room / marginal_[i], r.branch = i;
        break;
      }
    }
    if (offer_) r.bound += offer_->value(with_fate(true));
    return r;
  }

  // D and the taken items as far as they fit together; with an offer, also all that fit.
  void try_greedy(const std::vector<int>& order) {
    const std::vector<Fate> saved = fate_;
    for (const int i : order) fate_[i] = Fate::kDropped;
    double loss = losses();
    if (loss > block_.capacity) {  // overlaps: one after the other, each at its loss by then
      fate_ = saved;
      loss = losses();
      for (const int i : order) {
        if (loss + marginal_[i] > block_.capacity) continue;
        fate_[i] = Fate::kDropped;
        loss = losses();
      }
    }
    double value = -loss;
    for (int i = 0; i < block_.count; ++i)
      if (fate_[i] == Fate::kDropped) value += profit(i);
    const std::vector<int> dropped = with_fate(false);
    if (loss <= block_.capacity) {
      if (offer_) value += offer_->value(dropped);
      if (value > best_.value) best_.value = value, best_.dropped = dropped;
    }
    fate_ = saved;
    losses();
  }

  void descend() {
    const double loss = losses();
    if (loss > block_.capacity) return;
    const Relaxation r = relax(loss);
    if (r.bound <= best_.value + kTolerance) {
      best_.bound = std::max(best_.bound, r.bound);
      return;
    }
    try_greedy(r.taken);
    if (offer_) try_greedy(candidates(block_.capacity - loss));
    if (r.branch < 0 || r.bound <= best_.value + kTolerance || nodes_left_ <= 0) {
      best_.bound = std::max(best_.bound, r.branch < 0 ? best_.value : r.bound);
      return;
    }
    --nodes_left_;
    for (const Fate f : {Fate::kDropped, Fate::kKept}) {
      fate_[r.branch] = f;
      descend();
    }
    fate_[r.branch] = Fate::kUndecided;
  }

  const Block& block_;
  std::span<const double> profit_;
  const Offer* offer_;
  int nodes_left_;
  std::vector<Fate> fate_;
  std::vector<double> marginal_;
  BlockSolution best_;
};

}  // namespace

BlockSolution solve_block(const Block& block, std::span<const double> profit, const Offer* offer,
                          int max_nodes) {
  return BlockSearch(block, profit, offer, max_nodes).run();
}

}  // namespace colod::selection
