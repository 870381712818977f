// Based on: Co-LOD section 3.2, eq. 2–5: E_0 = Σ_i f_r(M_i) + β f_s(M_i) + λ f_co(M_i).
//
// Differs. --rules paper: to the letter, f_co(M_i) = Σ_{s∈I_i−M_i} Σ_{j≠i} Sim_co(s, I_j − M_j) and
// f_r > 0.8. With many buildings f_co then outweighs f_r, the bound decides, and 6 of 15 scanned
// houses lost their main roof (measured in November 2026).
// --rules robust: the three terms have one unit, shares of a building: f_r those of its volume and
// outline (segments/fidelity.cpp), f_s those of its area, f_co(M_i) = Σ_{s∈I_i−M_i}
// area(s)/area(I_i) · mean_{j≠i} Sim_co(s, I_j − M_j). A segment goes when the share of the
// building that goes with it is less than (β + λ · its mean similarity) times its share of the
// area; f_r > 0.95.
// Both: Sim_co to an empty set is 0. Block ascent from several starts, each block's program solved,
// and a Lagrangian upper bound; where they do not meet and at most `exact_segments` segments are to
// be decided, lp_solve gets the whole program.
//
// With a prior (the paper's mode for single buildings) I_j − M_j are the prior's segments beyond
// its layer 0: f_co is linear, and each building's program is on its own.
//
// Beyond `exact_similarities` segments to be decided, segments are compared with prototypes: then
// `objective` is proven to be no more than E_0 and the bound no less than the optimum, so that the
// gap counts what the prototypes lose (selection_prototypes.cpp).
//
// Notation: selection_model.h.
#include "selection.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "core/parallel.h"
#include "parameters.h"
#include "selection_model.h"

namespace colod {

using namespace selection;

namespace {

using namespace parameters::coanalysis;

constexpr double kOptimalGap = 1e-7;  // of the objective: less is rounding
constexpr int kMaxSteps = 400;        // of the bound
constexpr int kMinSteps = 30;         // what more bring is under 0.1 % of E_0
constexpr double kStepWork = 4e9;     // items × prototypes looked at by all steps together
constexpr double kStartWork = 5e6;    // by all starts together, but 3 there are
constexpr double kPolishWork = 2e8;   // nodes × items × prototypes in a round
constexpr int kPolishRounds = 8, kMaxBlockNodes = 400, kMinBlockNodes = 20;

std::vector<std::vector<char>> all_kept(const std::vector<SelectionBuilding>& buildings) {
  std::vector<std::vector<char>> kept;
  for (const SelectionBuilding& b : buildings) kept.emplace_back(b.segments.size(), 1);
  return kept;
}

double work(const Model& model) {
  return std::max(1.0, static_cast<double>(model.items.size() * model.prototypes));
}

int block_nodes(const Model& model) {
  return static_cast<int>(
      std::clamp(kPolishWork / work(model), double(kMinBlockNodes), double(kMaxBlockNodes)));
}

int start_count(const Model& model, const SelectionOptions& options) {
  const int most = static_cast<int>(std::min(1e6, kStartWork / work(model)));
  return std::clamp(options.starts, 1, std::max(3, most));
}

// The best of the starts, each improved; the first of equals.
Choice best_ascent(const Model& model, const SelectionOptions& options, int starts) {
  std::vector<Choice> found(starts);
  std::vector<double> value(starts);
  parallel_for(starts, [&](std::size_t i) {
    found[i] = ascend(model, first_choice(model, static_cast<int>(i), options.seed));
    value[i] = objective(model, found[i]);
  });
  const auto best = std::max_element(value.begin(), value.end()) - value.begin();
  return polish(model, found[best], kPolishRounds, block_nodes(model));
}

struct Solved {
  Choice x;
  double bound;
};

double relative_gap(double bound, double value) {
  return (bound - value) / std::max(1.0, std::abs(value));
}

Solved solve_by_ascent(const Model& model, const SelectionOptions& options, double gap,
                       int starts) {
  const int steps =
      static_cast<int>(std::clamp(kStepWork / work(model), double(kMinSteps), double(kMaxSteps)));
  Choice x = best_ascent(model, options, starts);
  Bound bound = lagrangian_bound(model, x, steps, gap);
  if (bound.best != x) {
    const Choice polished = polish(model, bound.best, kPolishRounds, block_nodes(model));
    x = objective(model, polished) > objective(model, x) ? polished : x;
  }
  return {x, std::max(bound.value, objective(model, x))};
}

// Where a gap is good enough, one start may reach it. With prototypes more starts would not: what
// they lose stays.
Solved solve_within(const Model& model, const SelectionOptions& options, double gap, int& starts) {
  starts = gap > 0 && model.is_exact ? 1 : start_count(model, options);
  const Solved first = solve_by_ascent(model, options, gap, starts);
  const double value = objective(model, first.x);
  if (!(gap > 0) || !model.is_exact || relative_gap(first.bound, value) <= gap) return first;
  starts = start_count(model, options);
  Choice x = best_ascent(model, options, starts);
  if (objective(model, x) < value) x = first.x;
  return {x, std::max(first.bound, objective(model, x))};
}

// A small program is lp_solve's as a whole, and believed if its choice is no worse than the
// ascent's and within our own bound.
Solved solve(const Model& model, const SelectionOptions& options, Selection& result) {
  const bool is_small =
      model.is_exact && model.size() > 0 && model.size() <= options.exact_segments;
  const Solved ascent = solve_within(model, options, is_small ? 0 : options.gap, result.starts);
  if (!is_small) return ascent;
  const double value = objective(model, ascent.x);
  const WholeSolution whole = solve_whole(model);
  const double found = whole.is_proven ? objective(model, whole.x) : 0;
  if (whole.is_proven && found >= value - kOptimalGap &&
      found <= ascent.bound + kOptimalGap * std::max(1.0, std::abs(found))) {
    result.is_lp_solve = true;
    return {found > value + kOptimalGap ? whole.x : ascent.x, std::max(found, value)};
  }
  if (ascent.bound - value > kOptimalGap)
    result.warnings.push_back(
        "layer 0: the exact program did not end within its work limit; block ascent with a bound");
  return ascent;
}

// Where most elements of a kind have left layer 0 the others leave it, too, as far as the bound on
// f_r lets them: one balcony of a street is no main shape.
void keep_kinds_whole(const std::vector<SelectionBuilding>& buildings, const Model& model, Choice x,
                      Selection& result) {
  const auto kind_of = [&](int k) {
    return buildings[model.items[k].building].segments[model.items[k].segment].kind;
  };
  std::map<ElementKind, int> balance;  // those that left less those that stay
  for (int k = 0; k < model.size(); ++k) balance[kind_of(k)] += x[k] ? 1 : -1;
  balance[ElementKind::kPlain] = 0;
  for (int k = 0; k < model.size(); ++k) {
    if (x[k] || balance[kind_of(k)] <= 0) continue;
    const Item& item = model.items[k];
    std::vector<char>& is_layer0 = result.is_layer0[item.building];
    if (std::count(is_layer0.begin(), is_layer0.end(), 1) == 1) continue;
    x[k] = 1;
    const Block& block = model.blocks[item.block];
    if (block_loss(block, x) <= block.capacity) {
      is_layer0[item.segment] = 0;
      result.overruled.push_back({item.building, item.segment});
    } else {
      x[k] = 0;
    }
  }
}

double since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

const char* to_string(SelectionStatus status) {
  switch (status) {
    case SelectionStatus::kOptimal:
      return "optimal";
    case SelectionStatus::kGap:
      return "gap";
    case SelectionStatus::kEmpty:
      return "empty";
  }
  return "empty";
}

Selection select_layer0(const std::vector<SelectionBuilding>& buildings,
                        const SelectionOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Selection result;
  result.is_layer0 = all_kept(buildings);
  const Model model = build_model(buildings, options);
  if (model.blocks.empty()) return result;

  const Solved solved = solve(model, options, result);
  for (int k = 0; k < model.size(); ++k)
    result.is_layer0[model.items[k].building][model.items[k].segment] = !solved.x[k];
  result.objective = proven_objective(buildings, options.eta, model, solved.x);
  result.bound = solved.bound;
  result.is_exact = model.is_exact;
  result.gap = relative_gap(result.bound, result.objective);
  result.status = result.gap <= kOptimalGap ? SelectionStatus::kOptimal : SelectionStatus::kGap;
  if (result.gap > options.gap_warning) {
    char text[120];
    std::snprintf(text, sizeof text, "layer 0: the best found is proven only within %.1f %%",
                  100 * result.gap);
    result.warnings.push_back(text);
  }
  if (options.rules.has(Rule::kWholeKinds)) keep_kinds_whole(buildings, model, solved.x, result);
  result.seconds = since(start);
  return result;
}

double selection_objective(const std::vector<SelectionBuilding>& buildings,
                           const std::vector<std::vector<char>>& is_layer0,
                           const SelectionOptions& options) {
  const Model model = build_model(buildings, options);
  Choice x(model.items.size());
  std::vector<std::vector<char>> is_item = is_layer0;  // what stays by itself must be there
  for (auto& b : is_item) std::fill(b.begin(), b.end(), 0);
  for (int k = 0; k < model.size(); ++k) {
    const Item& item = model.items[k];
    x[k] = !is_layer0[item.building][item.segment];
    is_item[item.building][item.segment] = 1;
  }
  for (std::size_t i = 0; i < is_layer0.size(); ++i)
    for (std::size_t s = 0; s < is_layer0[i].size(); ++s)
      if (!is_item[i][s] && !is_layer0[i][s]) return -std::numeric_limits<double>::infinity();
  return objective(model, x);
}

}  // namespace colod
