// Based on: block coordinate ascent with add, drop and exchange moves, as for facility location
// (Kuehn, Hamburger, "A heuristic program for locating warehouses", 1963); several starts.
//
// E_0 couples buildings through the best and second-best similarity of every prototype to every
// building's dropped items. Both are kept up to date, so that a move costs one pass over the
// prototypes.
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
    best_.assign(model.blocks.size() * n_, 0.0f);
    second_ = best_;
    who_.assign(best_.size(), -1);
    total_.assign(n_, 0.0);
    wanted_.assign(n_, 0.0);
    for (std::size_t k = 0; k < x_.size(); ++k)
      if (x_[k]) wanted_[model.items[k].prototype] += model.items[k].weight;
    for (std::size_t i = 0; i < model.blocks.size(); ++i) refresh(static_cast<int>(i));
  }

  // Whether block i improved.
  bool improve_by_moves(int i) {
    visit(i);
    bool is_improved = false;
    for (int moves = 0; moves < kMaxMovesPerVisit; ++moves) {
      const Move move = best_move(i);
      if (move.gain < kImprovement) break;
      apply(i, move);
      is_improved = true;
    }
    return is_improved;
  }

  bool improve_exactly(int i, int nodes) {
    const Block& block = model_.blocks[i];
    if (block.count == 0) return false;
    visit(i);
    const Offer offer{&model_, demand_};
    std::vector<int> current;
    double value = -block_loss(block, x_);
    for (int k = block.first; k < block.first + block.count; ++k)
      if (x_[k]) current.push_back(k), value += own_profit(k);
    value += offer.value(current);
    const BlockSolution solution = solve_block(block, profit_, &offer, nodes);
    if (solution.value < value + kImprovement) return false;
    for (int k = block.first; k < block.first + block.count; ++k) set(k, 0);
    for (const int k : solution.dropped) set(k, 1);
    refresh(i);
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
    demand_ = wanted_;
    profit_.assign(block.count, 0.0);
    for (int k = block.first; k < block.first + block.count; ++k) {
      const Item& item = model_.items[k];
      if (x_[k]) demand_[item.prototype] -= item.weight;
      const double others = total_[item.prototype] - best_[i * n_ + item.prototype];
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

  // Recomputes what block i's dropped items offer to all others.
  void refresh(int i) {
    const Block& block = model_.blocks[i];
    float* best = best_.data() + i * n_;
    float* second = second_.data() + i * n_;
    int* who = who_.data() + i * n_;
    for (std::size_t q = 0; q < n_; ++q) total_[q] -= best[q];
    std::fill(best, best + n_, 0.0f);
    std::fill(second, second + n_, 0.0f);
    std::fill(who, who + n_, -1);
    for (int k = block.first; k < block.first + block.count; ++k) {
      if (!x_[k]) continue;
      const float* row = model_.row(k);
      for (std::size_t q = 0; q < n_; ++q) {
        if (row[q] > best[q])
          second[q] = best[q], best[q] = row[q], who[q] = k;
        else
          second[q] = std::max(second[q], row[q]);
      }
    }
    for (std::size_t q = 0; q < n_; ++q) total_[q] += best[q];
  }

  // What the others gain when the block's items change by this move.
  double offer_change(int i, int add, int remove) const {
    const float* best = best_.data() + i * n_;
    const float* second = second_.data() + i * n_;
    const int* who = who_.data() + i * n_;
    double change = 0;
    if (remove < 0) {
      const float* row = model_.row(add);
      for (std::size_t q = 0; q < n_; ++q) change += demand_[q] * std::max(0.0f, row[q] - best[q]);
    } else if (add < 0) {
      for (std::size_t q = 0; q < n_; ++q)
        change += who[q] == remove ? demand_[q] * (second[q] - best[q]) : 0;
    } else {
      const float* row = model_.row(add);
      for (std::size_t q = 0; q < n_; ++q) {
        const float left = who[q] == remove ? second[q] : best[q];
        change += demand_[q] * (std::max(left, row[q]) - best[q]);
      }
    }
    return change;
  }

  // −infinity when infeasible.
  double gain_of(int i, double loss, int add, int remove) {
    const Block& block = model_.blocks[i];
    if (add >= 0) x_[add] = 1;
    if (remove >= 0) x_[remove] = 0;
    const double new_loss = block_loss(block, x_);
    if (add >= 0) x_[add] = 0;
    if (remove >= 0) x_[remove] = 1;
    if (new_loss > block.capacity) return -std::numeric_limits<double>::infinity();
    return loss - new_loss + (add >= 0 ? own_profit(add) : 0) -
           (remove >= 0 ? own_profit(remove) : 0) + offer_change(i, add, remove);
  }

  Move best_move(int i) {
    const Block& block = model_.blocks[i];
    const double loss = block_loss(block, x_);
    Move best;
    const auto consider = [&](int add, int remove) {
      const double gain = gain_of(i, loss, add, remove);
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

  void apply(int i, const Move& move) {
    if (move.add >= 0) set(move.add, 1);
    if (move.remove >= 0) set(move.remove, 0);
    refresh(i);
  }

  const Model& model_;
  Choice x_;
  std::size_t n_;                     // prototypes
  std::vector<float> best_, second_;  // [block][prototype]: similarity to the block's dropped items
  std::vector<int> who_;              // [block][prototype]: which of them is the best, −1 none
  std::vector<double> total_;         // Σ over blocks of best_
  std::vector<double> wanted_;        // per prototype: weights of the dropped items
  // Of the visited block:
  const Block* visited_ = nullptr;
  std::vector<double> demand_;  // per prototype: weights of the other blocks' dropped items
  std::vector<double> profit_;  // per item of the block: of dropping it, loss and offer apart
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
