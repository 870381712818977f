// Based on: Co-LOD section 3.2 ("a binary linear programming problem"), solved by lp_solve 5.5.
//
// Columns: x_k binary; ℓ_c ≥ 0 for each term of several items, ℓ_c ≥ Σ_{k∈c} x_k − (|c| − 1); y_kt
// ≥ 0 for items of different buildings, y_kt ≤ x_t and Σ_{t∈j} y_kt ≤ x_k. ℓ and y are continuous
// and yet exact: for a given x the objective pushes ℓ down to 0 or 1 and each y sum onto its most
// similar t.
//
// Differs: the same for both rules.
//
// The objective is one free column bounded by a row: with the coefficients in the objective itself
// lp_solve 5.5.2.5 derives a least improvement from them and was seen to cut off the optimum (4.353
// instead of 4.361 on 8 items). A claim of its is therefore also held against the ascent's choice.
//
// lp_solve's time limit is a wall clock; instead its abort callback counts its own calls, which
// follow the simplex and so fall at the same place on every machine. lp_solve keeps static state:
// one call at a time.
#include <lpsolve/lp_lib.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "selection_model.h"

namespace colod::selection {
namespace {

constexpr long kMaxCallbacks = 60000;  // a few seconds at 40 items

struct DeleteProgram {
  void operator()(lprec* lp) const { delete_lp(lp); }
};
using Program = std::unique_ptr<lprec, DeleteProgram>;

int __WINAPI count_callback(lprec*, void* handle) {
  return ++*static_cast<long*>(handle) > kMaxCallbacks;
}
void __WINAPI drop_message(lprec*, void*, char*) {}

struct Row {
  std::vector<int> columns;
  std::vector<double> values;

  void add(int column, double value) { columns.push_back(column), values.push_back(value); }
};

// Lays out the columns and writes the rows. Columns count from 1.
class Writer {
 public:
  explicit Writer(const Model& model) : model_(model) {
    columns_ = model.size();
    for (const Block& b : model.blocks)
      for (const Term& t : b.terms)
        if (t.items.size() > 1) ++columns_;
    first_y_ = columns_ + 1;
    for (int k = 0; k < model.size(); ++k)
      for (int t = 0; t < model.size(); ++t) columns_ += has_y(k, t);
    ++columns_;
  }

  Program write() {
    Program lp(make_lp(0, columns_));
    if (!lp) return lp;
    set_verbose(lp.get(), NEUTRAL);
    put_logfunc(lp.get(), drop_message, nullptr);
    set_add_rowmode(lp.get(), TRUE);
    Row goal;
    write_blocks(lp.get(), goal);
    write_similarities(lp.get(), goal);
    for (int k = 0; k < model_.size(); ++k) goal.add(k + 1, model_.items[k].gain - lone_loss(k));
    goal.add(columns_, -1);
    constrain(lp.get(), goal, GE, 0);
    set_add_rowmode(lp.get(), FALSE);
    set_obj(lp.get(), columns_, 1);
    set_unbounded(lp.get(), columns_);
    set_maxim(lp.get());
    for (int k = 1; k <= model_.size(); ++k) set_binary(lp.get(), k, TRUE);
    set_mip_gap(lp.get(), TRUE, 1e-9);
    set_mip_gap(lp.get(), FALSE, 1e-9);
    return lp;
  }

 private:
  bool has_y(int k, int t) const { return model_.row(k)[t] > 0 && model_.items[k].weight > 0; }

  double lone_loss(int k) const {
    double loss = 0;
    for (const Term& t : model_.blocks[model_.items[k].block].terms)
      if (t.items.size() == 1 && t.items.front() == k) loss += t.share;
    return loss;
  }

  static void constrain(lprec* lp, Row& row, int kind, double right) {
    add_constraintex(lp, static_cast<int>(row.columns.size()), row.values.data(),
                     row.columns.data(), kind, right);
  }

  void write_blocks(lprec* lp, Row& goal) const {
    int column = model_.size();
    for (const Block& block : model_.blocks) {
      Row loss;
      for (int k = block.first; k < block.first + block.count; ++k)
        if (lone_loss(k) > 0) loss.add(k + 1, lone_loss(k));
      for (const Term& t : block.terms) {
        if (t.items.size() == 1) continue;
        Row all_dropped;
        for (const int k : t.items) all_dropped.add(k + 1, 1);
        all_dropped.add(++column, -1);
        constrain(lp, all_dropped, LE, static_cast<double>(t.items.size()) - 1);
        loss.add(column, t.share);
        goal.add(column, -t.share);
      }
      if (!loss.columns.empty()) constrain(lp, loss, LE, block.capacity);
    }
  }

  void write_similarities(lprec* lp, Row& goal) const {
    int column = first_y_ - 1;
    for (int k = 0; k < model_.size(); ++k)
      for (const Block& block : model_.blocks) {
        Row sum;
        for (int t = block.first; t < block.first + block.count; ++t) {
          if (!has_y(k, t)) continue;
          ++column;
          goal.add(column, model_.items[k].weight * model_.row(k)[t]);
          sum.add(column, 1);
          Row offered;
          offered.add(t + 1, -1), offered.add(column, 1);
          constrain(lp, offered, LE, 0);
        }
        if (sum.columns.empty()) continue;
        sum.add(k + 1, -1);
        constrain(lp, sum, LE, 0);
      }
  }

  const Model& model_;
  int columns_ = 0, first_y_ = 0;
};

}  // namespace

WholeSolution solve_whole(const Model& model) {
  WholeSolution whole{Choice(model.items.size(), 0), false};
  if (model.items.empty()) return {{}, true};
  const Program lp = Writer(model).write();
  if (!lp) return whole;
  long callbacks = 0;
  put_abortfunc(lp.get(), count_callback, &callbacks);
  const int status = solve(lp.get());
  if (status != OPTIMAL) return whole;
  double* values = nullptr;
  get_ptr_variables(lp.get(), &values);
  for (int k = 0; k < model.size(); ++k) whole.x[k] = values[k] > 0.5;
  // Its tolerances may let through what ours do not: then the proof is not of our program.
  const double reported = get_objective(lp.get());
  double constants = 0;
  for (const Block& b : model.blocks) constants += b.constant;
  whole.is_proven = is_feasible(model, whole.x) &&
                    std::abs(objective(model, whole.x) - constants - reported) < 1e-6;
  return whole;
}

}  // namespace colod::selection
