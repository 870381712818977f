// Based on: Co-LOD section 3.2 ("a binary linear programming problem").
//
// Columns: x_k binary; ℓ_c ≥ 0 for each term of several items, ℓ_c ≥ Σ_{k∈c} x_k − (|c| − 1); y_kt
// ≥ 0 for items of different buildings, y_kt ≤ x_t and Σ_{t∈j} y_kt ≤ x_k. ℓ and y are continuous
// and yet exact: for a given x the objective pushes ℓ down to 0 or 1 and each y sum onto its most
// similar t.
//
// Differs: the same for both rules.
//
// Notation: k, t items, c term, j block.
#include <cassert>

#include "selection_model.h"

namespace colod::selection {
namespace {

class Writer {
 public:
  explicit Writer(const Model& model) : model_(model) {
    assert(model.is_exact);
    program_.binaries = model.size();
    for (const Item& item : model.items) program_.objective.push_back(item.gain);
  }

  LinearProgram write() {
    for (const Block& block : model_.blocks) write_block(block);
    for (int k = 0; k < model_.size(); ++k)
      for (const Block& block : model_.blocks) write_similarities(k, block);
    return std::move(program_);
  }

 private:
  using Row = LinearProgram::Row;

  int new_column(double worth) {
    program_.objective.push_back(worth);
    return static_cast<int>(program_.objective.size()) - 1;
  }

  void write_block(const Block& block) {
    Row loss;
    loss.most = block.capacity;
    for (const Term& t : block.terms) {
      if (t.items.size() == 1) {
        program_.objective[t.items[0]] -= t.share;
        loss.add(t.items[0], t.share);
        continue;
      }
      const int column = new_column(-t.share);
      loss.add(column, t.share);
      Row all_dropped;
      all_dropped.most = static_cast<double>(t.items.size()) - 1;
      for (const int k : t.items) all_dropped.add(k, 1);
      all_dropped.add(column, -1);
      program_.rows.push_back(std::move(all_dropped));
    }
    if (!loss.columns.empty()) program_.rows.push_back(std::move(loss));
  }

  void write_similarities(int k, const Block& block) {
    const double weight = model_.items[k].weight;
    if (weight == 0) return;
    Row sum;
    for (int t = block.first; t < block.first + block.count; ++t) {
      const double worth = weight * model_.sim[t * model_.prototypes + k];
      if (!(worth > 0)) continue;
      const int column = new_column(worth);
      sum.add(column, 1);
      Row offered;
      offered.add(column, 1), offered.add(t, -1);
      program_.rows.push_back(std::move(offered));
    }
    if (sum.columns.empty()) return;
    sum.add(k, -1);
    program_.rows.push_back(std::move(sum));
  }

  const Model& model_;
  LinearProgram program_;
};

}  // namespace

LinearProgram write_program(const Model& model) { return Writer(model).write(); }

}  // namespace colod::selection
