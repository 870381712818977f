// Based on: block coordinate ascent with add, drop and exchange moves, as for facility location
// (Kuehn, Hamburger, "A heuristic program for locating warehouses", 1963); several starts.
//
// E_0 couples buildings through the best and second-best similarity of every prototype to every
// building's dropped items. Those of the building that is visited are kept up to date, so that a
// move costs one pass over the prototypes; of the others only the sum of the best is.
//
// Differs: the same for both rules; the paper hands the whole program to a solver, which does not
// end beyond some 50 segments (measured in November 2026).
//
// Notation: i block, k item of i, q prototype; x_k = 1 dropped from layer 0.
#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

#include "selection_model.h"

namespace colod::selection {
namespace {

constexpr double kImprovement = 1e-9;  // less is rounding
constexpr int kMaxRounds = 60;
constexpr int kMaxMovesPerVisit = 200;

class Ascent {
 public:
  Ascent(const Model& model, Choice x)
      : model_(model), x_(std::move(x)), n_(model.prototypes), demand_(n_, 0.0) {
    best_.assign(n_, 0.0f);
    second_ = best_;
    who_.assign(n_, -1);
    total_.assign(n_, 0.0);
    wanted_.assign(n_, 0.0);
    for (std::size_t k = 0; k < x_.size(); ++k)
      if (x_[k]) wanted_[model.items[k].prototype] += model.items[k].weight;
    for (const Block& block : model.blocks) {
      visited_ = &block;
      look();
      for (std::size_t q = 0; q < n_; ++q) total_[q] += best_[q];
    }
  }

  // Whether block i improved.
  bool improve_by_moves(int i) {
    visit(i);
    bool is_improved = false;
    for (int moves = 0; moves < kMaxMovesPerVisit; ++moves) {
      const Move move = best_move();
      if (move.gain < kImprovement) break;
      apply(move);
      is_improved = true;
    }
    return is_improved;
  }

  bool improve_exactly(int i, int nodes) {
    const Block& block = model_.blocks[i];
    if (block.count == 0) return false;
    visit(i);
    const Offer offer{rows_, block.first, demand_};
    std::vector<int> current;
    double value = -block_loss(block, x_);
    for (int k = block.first; k < block.first + block.count; ++k)
      if (x_[k]) current.push_back(k), value += own_profit(k);
    value += offer.value(current);
    const BlockSolution solution = solve_block(block, profit_, &offer, nodes);
    if (solution.value < value + kImprovement) return false;
    for (int k = block.first; k < block.first + block.count; ++k) set(k, 0);
    for (const int k : solution.dropped) set(k, 1);
    refresh();
    return true;
  }

  const Choice& choice() const { return x_; }

 private:
  struct Move {
    double gain = 0;
    int add = -1, remove = -1;
  };

  // What the other blocks want and offer, which no move within block i changes.
  void visit(int i) {
    const Block& block = model_.blocks[i];
    visited_ = &block;
    look();
    demand_ = wanted_;
    profit_.assign(block.count, 0.0);
    for (int k = block.first; k < block.first + block.count; ++k) {
      const Item& item = model_.items[k];
      if (x_[k]) demand_[item.prototype] -= item.weight;
      const double others = total_[item.prototype] - best_[item.prototype];
      profit_[k - block.first] = item.gain + item.weight * std::max(0.0, others);
    }
    for (int k = block.first; k < block.first + block.count; ++k) {
      double& d = demand_[model_.items[k].prototype];
      d = std::max(0.0, d);
    }
  }

  double own_profit(int k) const { return profit_[k - visited_->first]; }

  void set(int k, char value) {
    const Item& item = model_.items[k];
    wanted_[item.prototype] += (value - x_[k]) * item.weight;
    x_[k] = value;
  }

  const float* row(int k) const { return rows_ + (k - visited_->first) * n_; }

  // What the visited block has, and what its dropped items offer to all others.
  void look() {
    rows_ = model_.rows(*visited_, room_);
    look_at_offer();
  }
  void look_at_offer() {
    const Block& block = *visited_;
    std::fill(best_.begin(), best_.end(), 0.0f);
    std::fill(second_.begin(), second_.end(), 0.0f);
    std::fill(who_.begin(), who_.end(), -1);
    for (int k = block.first; k < block.first + block.count; ++k) {
      if (!x_[k]) continue;
      const float* sim = row(k);
      for (std::size_t q = 0; q < n_; ++q) {
        if (sim[q] > best_[q])
          second_[q] = best_[q], best_[q] = sim[q], who_[q] = k;
        else
          second_[q] = std::max(second_[q], sim[q]);
      }
    }
  }

  // The same of the visited block, whose items have changed.
  void refresh() {
    for (std::size_t q = 0; q < n_; ++q) total_[q] -= best_[q];
    look_at_offer();
    for (std::size_t q = 0; q < n_; ++q) total_[q] += best_[q];
  }

  // What the others gain when the visited block's items change by this move.
  double offer_change(int add, int remove) const {
    const float *best = best_.data(), *second = second_.data();
    const int* who = who_.data();
    double change = 0;
    if (remove < 0) {
      const float* sim = row(add);
      for (std::size_t q = 0; q < n_; ++q) change += demand_[q] * std::max(0.0f, sim[q] - best[q]);
    } else if (add < 0) {
      for (std::size_t q = 0; q < n_; ++q)
        change += who[q] == remove ? demand_[q] * (second[q] - best[q]) : 0;
    } else {
      const float* sim = row(add);
      for (std::size_t q = 0; q < n_; ++q) {
        const float left = who[q] == remove ? second[q] : best[q];
        change += demand_[q] * (std::max(left, sim[q]) - best[q]);
      }
    }
    return change;
  }

  // −infinity when infeasible.
  double gain_of(double loss, int add, int remove) {
    const Block& block = *visited_;
    if (add >= 0) x_[add] = 1;
    if (remove >= 0) x_[remove] = 0;
    const double new_loss = block_loss(block, x_);
    if (add >= 0) x_[add] = 0;
    if (remove >= 0) x_[remove] = 1;
    if (new_loss > block.capacity) return -std::numeric_limits<double>::infinity();
    return loss - new_loss + (add >= 0 ? own_profit(add) : 0) -
           (remove >= 0 ? own_profit(remove) : 0) + offer_change(add, remove);
  }

  Move best_move() {
    const Block& block = *visited_;
    const double loss = block_loss(block, x_);
    Move best;
    const auto consider = [&](int add, int remove) {
      const double gain = gain_of(loss, add, remove);
      if (gain > best.gain + kImprovement) best = {gain, add, remove};
    };
    const int end = block.first + block.count;
    for (int k = block.first; k < end; ++k) x_[k] ? consider(-1, k) : consider(k, -1);
    if (best.gain > 0) return best;
    for (int add = block.first; add < end; ++add)
      for (int remove = block.first; remove < end; ++remove)
        if (!x_[add] && x_[remove]) consider(add, remove);
    return best;
  }

  void apply(const Move& move) {
    if (move.add >= 0) set(move.add, 1);
    if (move.remove >= 0) set(move.remove, 0);
    refresh();
  }

  const Model& model_;
  Choice x_;
  std::size_t n_;               // prototypes
  std::vector<double> total_;   // Σ over blocks of their best_
  std::vector<double> wanted_;  // per prototype: weights of the dropped items
  // Of the visited block:
  const Block* visited_ = nullptr;
  const float* rows_ = nullptr;       // its items' similarities
  std::vector<float> room_;           // for them
  std::vector<float> best_, second_;  // per prototype: similarity to the block's dropped items
  std::vector<int> who_;              // per prototype: which of them is the best, −1 none
  std::vector<double> demand_;        // per prototype: weights of the other blocks' dropped items
  std::vector<double> profit_;        // per item of the block: of dropping it, loss and offer apart
};

std::vector<int> block_order(const Model& model, const Block& block, int start,
                             std::mt19937_64& random) {
  std::vector<int> order(block.count);
  std::iota(order.begin(), order.end(), block.first);
  if (start <= 2) {  // by the share of voxels of which the item is a part
    std::vector<double> part(block.count, 0.0);
    for (const Term& t : block.terms)
      for (const int k : t.items)
        part[k - block.first] += t.share / static_cast<double>(t.items.size());
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      const double part_a = part[a - block.first], part_b = part[b - block.first];
      if (start == 1) return part_a < part_b;
      return model.items[a].gain * part_b > model.items[b].gain * part_a;
    });
    return order;
  }
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[((random() >> 32) * i) >> 32]);
  return order;
}

}  // namespace

Choice ascend(const Model& model, Choice x) {
  Ascent ascent(model, std::move(x));
  const int blocks = static_cast<int>(model.blocks.size());
  for (int round = 0; round < kMaxRounds; ++round) {
    bool is_improved = false;
    for (int i = 0; i < blocks; ++i) is_improved |= ascent.improve_by_moves(i);
    if (!is_improved) break;
  }
  return ascent.choice();
}

Choice polish(const Model& model, Choice x, int rounds, int nodes) {
  Ascent ascent(model, std::move(x));
  const int blocks = static_cast<int>(model.blocks.size());
  for (int round = 0; round < rounds; ++round) {
    bool is_improved = false;
    for (int i = 0; i < blocks; ++i) is_improved |= ascent.improve_exactly(i, nodes);
    if (!is_improved) break;
  }
  return ascent.choice();
}

Choice first_choice(const Model& model, int start, std::uint64_t seed) {
  Choice x(model.items.size(), 0);
  if (start == 0) return x;
  std::mt19937_64 random(seed * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(start));
  for (const Block& block : model.blocks)
    for (const int k : block_order(model, block, start, random)) {
      x[k] = 1;
      if (block_loss(block, x) > block.capacity) x[k] = 0;
    }
  return x;
}

}  // namespace colod::selection
