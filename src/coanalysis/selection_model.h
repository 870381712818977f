// Inside room `coanalysis`: the binary program of layer 0 in the form that its solvers share.
// Public face: selection.h.
//
// An item is a segment that layer 0 could do without; a segment whose loss alone breaks the bound
// on f_r stays, and is no item. x_k = 1: item k is dropped from layer 0. Then
//   E_0 = Σ_blocks constant + Σ_k gain_k x_k − Σ_terms share [all of the term's items dropped]
//         + Σ_k weight_k x_k Σ_{other blocks j} max_{t∈j, x_t=1} sim(t, q_k)    (empty max = 0)
// subject to, per block, loss = Σ_terms share [all dropped] ≤ capacity.
//
// q_k is the item's prototype. Up to some 1,500 items every item is its own prototype, and the
// program is exact. Beyond, items share a few hundred prototypes, so that time and memory grow with
// the number of items instead of its square; sim(t, q_k) then differs from the true similarity of k
// and t by a factor between 1/spread_k and spread_k (proved in selection_prototypes.cpp). Item::
// weight holds λ's share divided by the spread, weight_high multiplied by it: with the former E_0
// is never more than the true value, with the latter never less.
#pragma once

#include <cstdint>
#include <span>
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
  double gain;         ///< β area share, ≥ 0
  double weight;       ///< λ times what a similarity counts in f_co, ≥ 0, at least
  double weight_high;  ///< the same, at most
  int prototype;       ///< in 0..Model::prototypes − 1
};

/// One entry an item: 1 dropped.
using Choice = std::vector<char>;

struct Model {
  std::vector<Block> blocks;  ///< items of a block are consecutive
  std::vector<Item> items;
  std::size_t prototypes = 0;
  bool is_exact = true;    ///< item k is prototype k; a block's similarities to itself are 0
  std::vector<float> sim;  ///< exact: an item a row, a prototype a column
  std::vector<std::uint16_t> coarse_sim;  ///< else: the same in units of kSimUnit, rounded down

  int size() const { return static_cast<int>(items.size()); }
  /// Similarities of a block's items to all prototypes, an item a row, at least and at most; `room`
  /// holds them if need be.
  const float* rows(const Block& block, std::vector<float>& room) const;
  const float* rows_high(const Block& block, std::vector<float>& room) const;
};

constexpr float kSimUnit = 1.0f / 65536;

Model build_model(const std::vector<SelectionBuilding>& buildings, const SelectionOptions& options);

/// Gives the items prototypes, at most `most` of them, and fills Model::coarse_sim; divides and
/// multiplies the weights by the spreads.
void share_prototypes(const std::vector<SelectionBuilding>& buildings, double eta, int most,
                      Model& model);

double block_loss(const Block& block, const Choice& x);
bool is_feasible(const Model& model, const Choice& x);
/// E_0 (with the low weights, that is, never more than the true value); −infinity when infeasible.
double objective(const Model& model, const Choice& x);
/// The same, told better where items share prototypes: by what is known of all items of one
/// together.
double proven_objective(const std::vector<SelectionBuilding>& buildings, double eta,
                        const Model& model, const Choice& x);

/// What the other blocks gain when this one offers a set: Σ_q weights[q] max_{k∈set} sim(k, q).
struct Offer {
  const float* rows = nullptr;  ///< Model::rows of the block
  int first = 0;                ///< its first item
  std::vector<double> weights;  ///< per prototype: of the other blocks' dropped items

  double value(const std::vector<int>& set) const;
};

struct BlockSolution {
  std::vector<int> dropped;  ///< items, rising
  double value = 0;          ///< of `dropped`
  double bound = 0;          ///< no set of the block is worth more; = value when proven
};

/// max over feasible sets X of the block: Σ_{k∈X} profit_k − loss(X) + offer(X), by branch and
/// bound in at most `max_nodes` nodes. `profit` per item of the block, ≥ 0; `offer` may be null.
BlockSolution solve_block(const Block& block, std::span<const double> profit, const Offer* offer,
                          int max_nodes);

/// Block ascent from `x` (feasible): the best single change or exchange in each block in turn,
/// until none helps.
Choice ascend(const Model& model, Choice x);
/// The same, each block's whole program solved within `nodes` nodes; at most `rounds` times over
/// all blocks.
Choice polish(const Model& model, Choice x, int rounds, int nodes);
/// Start number `start` of the ascent: all kept, biggest kept, least loss dropped, then at random.
Choice first_choice(const Model& model, int start, std::uint64_t seed);

struct Bound {
  double value = 0;  ///< no feasible choice is worth more
  Choice best;       ///< the best choice met on the way
};

/// Upper bound by Lagrangian relaxation, starting from the feasible `incumbent`; stops early when
/// the best choice is known to lie within `gap` of it, relative to max(1, |E_0|).
Bound lagrangian_bound(const Model& model, const Choice& incumbent, int steps, double gap);

/// The whole program: max objective · x, rows, x ≥ 0, the first `binaries` columns 0 or 1.
struct LinearProgram {
  struct Row {
    std::vector<int> columns;
    std::vector<double> values;
    double most = 0;  ///< Σ values x ≤ most

    void add(int column, double value) { columns.push_back(column), values.push_back(value); }
  };
  int binaries = 0;
  std::vector<double> objective;  ///< per column; the blocks' constants left out
  std::vector<Row> rows;
};

/// The model is exact. A column an item, one a term of several items, one a similarity.
LinearProgram write_program(const Model& model);

struct WholeSolution {
  Choice x;
  bool is_proven = false;  ///< else: stopped at its work limit, or nothing usable came back
};

/// The whole program by lp_solve; the model is exact. Deterministic work limit: callbacks of
/// lp_solve, by default a few seconds at 40 items. Not for concurrent calls.
WholeSolution solve_whole(const Model& model, long max_callbacks = 60000);

}  // namespace colod::selection
