// Layer 0 by CBC, lp_solve and ours, side by side on the same generated programs.
//
//   bench_solvers [--sizes N...] [--per-building N] [--seconds N] [--callbacks N] [--lp-most N]
//   [--paper] [--seed N]
//
// A row a program: segments that layer 0 could do without, columns and rows of the whole program,
// and per solver seconds, objective and what it proved. CBC gets `seconds` of wall clock, lp_solve
// `callbacks` (and nothing beyond `lp-most` segments). Built where CBC is installed.
#include <Cbc_C_Interface.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>

#include "coanalysis/selection_model.h"
#include "generated_scene.h"

using namespace colod;
using namespace colod::selection;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::max();  // as CBC understands it

struct Settings {
  std::vector<int> sizes{50, 100, 220, 450};
  int per_building = 12, lp_most = 120;
  double seconds = 120;
  long callbacks = 400000;
  bool is_paper = false;
  std::uint64_t seed = 1;
};

struct Answer {
  double seconds = 0, objective = 0, bound = 0;
  bool is_proven = false, has_solution = true;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double constants(const Model& model) {
  double sum = 0;
  for (const Block& b : model.blocks) sum += b.constant;
  return sum;
}

void load(const LinearProgram& program, Cbc_Model* cbc) {
  std::vector<int> starts, rows;  // column by column
  std::vector<double> values;
  const std::size_t columns = program.objective.size();
  std::vector<std::vector<std::pair<int, double>>> entries(columns);
  for (std::size_t r = 0; r < program.rows.size(); ++r)
    for (std::size_t e = 0; e < program.rows[r].columns.size(); ++e)
      entries[program.rows[r].columns[e]].push_back(
          {static_cast<int>(r), program.rows[r].values[e]});
  for (const auto& column : entries) {
    starts.push_back(static_cast<int>(rows.size()));
    for (const auto& [row, value] : column) rows.push_back(row), values.push_back(value);
  }
  starts.push_back(static_cast<int>(rows.size()));
  std::vector<double> low(columns, 0.0), high(columns, kInfinity);
  for (int k = 0; k < program.binaries; ++k) high[k] = 1;
  std::vector<double> row_low(program.rows.size(), -kInfinity), row_high;
  for (const LinearProgram::Row& row : program.rows) row_high.push_back(row.most);
  Cbc_loadProblem(cbc, static_cast<int>(columns), static_cast<int>(program.rows.size()),
                  starts.data(), rows.data(), values.data(), low.data(), high.data(),
                  program.objective.data(), row_low.data(), row_high.data());
  Cbc_setObjSense(cbc, -1);
  for (int k = 0; k < program.binaries; ++k) Cbc_setInteger(cbc, k);
}

Answer by_cbc(const Model& model, const LinearProgram& program, double limit) {
  Cbc_Model* cbc = Cbc_newModel();
  load(program, cbc);
  Cbc_setParameter(cbc, "logLevel", "0");
  Cbc_setParameter(cbc, "ratioGap", "0");
  Cbc_setParameter(cbc, "seconds", std::to_string(limit).c_str());
  const auto start = std::chrono::steady_clock::now();
  Cbc_solve(cbc);
  Answer a{seconds_since(start), 0, Cbc_getBestPossibleObjValue(cbc) + constants(model),
           Cbc_isProvenOptimal(cbc) != 0};
  Choice x(model.items.size(), 0);
  const double* solution = Cbc_bestSolution(cbc);
  a.has_solution = solution != nullptr;
  for (int k = 0; solution && k < model.size(); ++k) x[k] = solution[k] > 0.5;
  a.objective = objective(model, x);
  Cbc_deleteModel(cbc);
  return a;
}

Answer by_lp_solve(const Model& model, long callbacks) {
  const auto start = std::chrono::steady_clock::now();
  const WholeSolution whole = solve_whole(model, callbacks);
  return {seconds_since(start), objective(model, whole.x), 0, whole.is_proven};
}

Answer by_ours(const std::vector<SelectionBuilding>& scene, const SelectionOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const Selection s = select_layer0(scene, options);
  return {seconds_since(start), s.objective, s.bound, s.status == SelectionStatus::kOptimal};
}

/// A scene with this many segments to be decided, or one more.
std::vector<SelectionBuilding> scene_of(int size, const Settings& s,
                                        const SelectionOptions& options) {
  for (int count = size;; ++count) {
    const int buildings = std::max(2, count / s.per_building);
    const auto scene = bench::generated_scene(buildings, count, s.seed);
    if (build_model(scene, options).size() >= size) return scene;
  }
}

void print_cbc(const Answer& cbc) {
  std::printf("| %.2f s, ", cbc.seconds);
  if (cbc.has_solution)
    std::printf("%.5f", cbc.objective);
  else
    std::printf("no solution");
  std::printf(cbc.is_proven ? ", proven " : ", bound %.5f ", cbc.bound);
}

void run(int size, const Settings& s) {
  SelectionOptions options;
  options.rules = s.is_paper ? RuleSet::none() : RuleSet::all(), options.gap = 0;
  const auto scene = scene_of(size, s, options);
  const Model model = build_model(scene, options);
  const LinearProgram program = write_program(model);
  const Answer ours = by_ours(scene, options);
  std::printf("| %d | %zu | %zu × %zu | %.2f s, %.5f, gap %.3f %%%s ", model.size(), scene.size(),
              program.objective.size(), program.rows.size(), ours.seconds, ours.objective,
              100 * (ours.bound - ours.objective) / std::abs(ours.objective),
              ours.is_proven ? ", proven" : "");
  std::fflush(stdout);  // the others may take hours
  const Answer cbc = by_cbc(model, program, s.seconds);
  print_cbc(cbc);
  if (model.size() <= s.lp_most) {
    const Answer lp = by_lp_solve(model, s.callbacks);
    std::printf("| %.2f s%s ", lp.seconds,
                lp.is_proven ? (", " + std::to_string(lp.objective) + ", proven").c_str()
                             : ", nothing proven");
  } else {
    std::printf("| not tried ");
  }
  if (cbc.has_solution)
    std::printf("| %.4f %% | %s |\n",
                100 * (cbc.objective - ours.objective) / std::abs(cbc.objective),
                ours.bound >= cbc.objective - 1e-6 ? "above" : "BELOW");
  else
    std::printf("| – | – |\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Settings s;
  CLI::App app("layer 0 by CBC, lp_solve and ours");
  app.add_option("--sizes", s.sizes, "segments to be decided");
  app.add_option("--per-building", s.per_building);
  app.add_option("--seconds", s.seconds, "for CBC");
  app.add_option("--callbacks", s.callbacks, "for lp_solve");
  app.add_option("--lp-most", s.lp_most, "lp_solve gets no more segments than these");
  app.add_option("--seed", s.seed);
  app.add_flag("--paper", s.is_paper);
  CLI11_PARSE(app, argc, argv);
  std::printf(
      "| segments | buildings | columns × rows | ours | CBC | lp_solve | below CBC by | our bound "
      "|\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (const int size : s.sizes) run(size, s);
}
