// Inside room 6: the binary program of layer 0 in the form that its solvers share. Public face:
// selection.h.
//
// An item is a segment that layer 0 could do without; a segment whose loss alone breaks the bound
// on f_r stays, and is no item. x_k = 1: item k is dropped from layer 0. Then
//   E_0 = Σ_blocks constant + Σ_k gain_k x_k − Σ_terms share [all of the term's items dropped]
//         + Σ_k weight_k x_k Σ_{other blocks j} max_{t∈j, x_t=1} sim(k, t)      (empty max = 0)
// subject to, per block, loss = Σ_terms share [all dropped] ≤ capacity.
#pragma once

#include <vector>

#include "selection.h"

namespace colod::selection {

/// Voxels that are lost when all these items are dropped.
struct Term {
  std::vector<int> items;  ///< rising, of one block
  double share = 0;        ///< of the building's enclosed voxels, > 0
};

/// A building with at least one segment.
struct Block {
  int first = 0, count = 0;  ///< its items
  std::vector<Term> terms;
  double capacity = 0;  ///< the most that may be lost
  double constant = 0;  ///< f_r + β f_s of the whole building
};

struct Item {
  int block, building, segment;
  double gain;    ///< β area share, ≥ 0
  double weight;  ///< λ times what a similarity counts in f_co, ≥ 0
};

/// One entry an item: 1 dropped.
using Choice = std::vector<char>;

struct Model {
  std::vector<Block> blocks;  ///< items of a block are consecutive
  std::vector<Item> items;
  std::vector<float> sim;  ///< items² row by row, symmetric, 0 within a block

  int size() const { return static_cast<int>(items.size()); }
  const float* row(int k) const { return sim.data() + static_cast<std::size_t>(k) * items.size(); }
};

Model build_model(const std::vector<SelectionBuilding>& buildings, const SelectionOptions& options);

double block_loss(const Block& block, const Choice& x);
bool is_feasible(const Model& model, const Choice& x);
/// E_0, −infinity when infeasible.
double objective(const Model& model, const Choice& x);

/// What the other blocks gain when this one offers a set: Σ_t weights[t] max_{k∈set} sim(k, t).
struct Offer {
  const Model* model = nullptr;
  std::vector<double> weights;  ///< per item of the model; 0 within the block

  double value(const std::vector<int>& set) const;
};

struct BlockSolution {
  std::vector<int> dropped;  ///< items, rising
  double value = 0;          ///< of `dropped`
  double bound = 0;          ///< no set of the block is worth more; = value when proven
};

/// max over feasible sets X of the block: Σ_{k∈X} profit_k − loss(X) + offer(X), by branch and
/// bound in at most `max_nodes` nodes. `profit` per item of the model, ≥ 0; `offer` may be null.
BlockSolution solve_block(const Block& block, const std::vector<double>& profit, const Offer* offer,
                          int max_nodes);

/// Block ascent from `x` (feasible): the best single change or exchange in each block in turn,
/// until none helps.
Choice ascend(const Model& model, Choice x);
/// The same, each block's whole program solved; at most `rounds` times over all blocks.
Choice polish(const Model& model, Choice x, int rounds);
/// Start number `start` of the ascent: all kept, biggest kept, least loss dropped, then at random.
Choice first_choice(const Model& model, int start, std::uint64_t seed);

struct Bound {
  double value = 0;  ///< no feasible choice is worth more
  Choice best;       ///< the best choice met on the way
};

/// Upper bound by Lagrangian relaxation, starting from the feasible `incumbent`.
Bound lagrangian_bound(const Model& model, const Choice& incumbent, int steps);

struct WholeSolution {
  Choice x;
  bool is_proven = false;  ///< else: stopped at its work limit, or nothing usable came back
};

/// The whole program by lp_solve. Deterministic work limit. Not for concurrent calls.
WholeSolution solve_whole(const Model& model);

}  // namespace colod::selection
