// Based on: Co-LOD section 3.2 ("a binary linear programming problem"), solved by lp_solve 5.5.
//
// Differs: the same for both rules.
//
// The objective is one free column bounded by a row: with the coefficients in the objective itself
// lp_solve 5.5.2.5 derives a least improvement from them and was seen to cut off the optimum (4.353
// instead of 4.361 on 8 items). A claim of its is therefore also held against the ascent's choice.
//
// lp_solve's time limit is a wall clock; instead its abort callback counts its own calls, which
// follow the simplex and so fall at the same place on every machine. lp_solve keeps static state:
// one program at a time in the whole process, which is what `door` is for.
#include <lpsolve/lp_lib.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "selection_model.h"

namespace colod::selection {
namespace {

struct DeleteProgram {
  void operator()(lprec* lp) const { delete_lp(lp); }
};
using Program = std::unique_ptr<lprec, DeleteProgram>;

struct Patience {
  long left;
};

int __WINAPI count_callback(lprec*, void* handle) {
  return --static_cast<Patience*>(handle)->left < 0;
}
void __WINAPI drop_message(lprec*, void*, char*) {}

void constrain(lprec* lp, LinearProgram::Row row, int kind) {
  for (int& c : row.columns) ++c;  // its columns count from 1
  add_constraintex(lp, static_cast<int>(row.columns.size()), row.values.data(), row.columns.data(),
                   kind, row.most);
}

// The objective is the last column, bounded by the row "it is at most what the others are worth".
Program load(const LinearProgram& program) {
  const int columns = static_cast<int>(program.objective.size()) + 1;
  Program lp(make_lp(0, columns));
  if (!lp) return lp;
  set_verbose(lp.get(), NEUTRAL);
  put_logfunc(lp.get(), drop_message, nullptr);
  set_add_rowmode(lp.get(), TRUE);
  for (const LinearProgram::Row& row : program.rows) constrain(lp.get(), row, LE);
  LinearProgram::Row goal;
  for (int c = 0; c + 1 < columns; ++c)
    if (program.objective[c] != 0) goal.add(c, program.objective[c]);
  goal.add(columns - 1, -1);
  constrain(lp.get(), goal, GE);
  set_add_rowmode(lp.get(), FALSE);
  set_obj(lp.get(), columns, 1);
  set_unbounded(lp.get(), columns);
  set_maxim(lp.get());
  for (int k = 1; k <= program.binaries; ++k) set_binary(lp.get(), k, TRUE);
  set_mip_gap(lp.get(), TRUE, 1e-9);
  set_mip_gap(lp.get(), FALSE, 1e-9);
  return lp;
}

}  // namespace

WholeSolution solve_whole(const Model& model, long max_callbacks) {
  WholeSolution whole{Choice(model.items.size(), 0), false};
  if (model.items.empty()) return {{}, true};
  static std::mutex door;
  const std::lock_guard lock(door);
  const Program lp = load(write_program(model));
  if (!lp) return whole;
  Patience patience{max_callbacks};
  put_abortfunc(lp.get(), count_callback, &patience);
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
