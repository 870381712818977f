// Based on: Co-LOD section 3.2, eq. 2–5: E_0 = Σ_i f_r(M_i) + β f_s(M_i) + λ f_co(M_i).
//
// Differs. --rules paper: to the letter, f_co(M_i) = Σ_{s∈I_i−M_i} Σ_{j≠i} Sim_co(s, I_j − M_j) and
// f_r > 0.8. With many buildings f_co then outweighs f_r, the bound decides, and 6 of 15 scanned
// houses lost their main roof (measured in November 2026).
// --rules robust: f_co(M_i) = Σ_{s∈I_i−M_i} area(s)/area(I_i) · mean_{j≠i} Sim_co(s, I_j − M_j), of
// the size of f_s; f_r > 0.95; and after the optimum every segment that encloses at least 2 % of
// the valid voxels joins layer 0 (`added`), while lesser ones leave it, smallest first, as long as
// f_r > 0.95 holds (a spire's voxels count four times: the main shape of a church has it;
// `removed`; objective, bound and gap speak of the optimum before). Without the
// latter a building alone, whose f_co is 0, keeps whatever has little area for its voxels: 12 of 12
// segments of an arch, 16 of 36 of a photogrammetric house (measured in November 2026); and in a
// street what is like nothing else stays.
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

#include "core/parallel.h"
#include "parameters.h"
#include "selection_model.h"

namespace colod {

using namespace selection;

namespace {

using namespace parameters::coanalysis;

constexpr double kOptimalGap = 1e-7;  // of the objective: less is rounding
constexpr int kMaxSteps = 400;        // of the bound
constexpr double kStepWork = 4e9;     // items × prototypes looked at by all steps together
constexpr double kStartWork = 5e6;    // by all starts together, but 3 there are
constexpr double kPolishWork = 2e8;   // nodes × items × prototypes in a round
constexpr int kPolishRounds = 8, kMaxBlockNodes = 400, kMinBlockNodes = 20;

std::vector<std::vector<char>> all_kept(const std::vector<SelectionBuilding>& buildings) {
  std::vector<std::vector<char>> kept;
  for (const SelectionBuilding& b : buildings) kept.emplace_back(b.segments.size(), 1);
  return kept;
}

double work(const Model& model) { return std::max(1.0, static_cast<double>(model.sim.size())); }

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
  const int steps = static_cast<int>(std::clamp(kStepWork / work(model), 10.0, double(kMaxSteps)));
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

// lp_solve is asked only where the bound does not meet the ascent's choice, and believed only if
// its choice is no worse.
Solved solve(const Model& model, const SelectionOptions& options, Selection& result) {
  const bool is_small = model.is_exact && model.size() <= options.exact_segments;
  const Solved ascent = solve_within(model, options, is_small ? 0 : options.gap, result.starts);
  const double value = objective(model, ascent.x);
  if (!is_small || ascent.bound - value <= kOptimalGap) return ascent;
  const WholeSolution whole = solve_whole(model);
  if (whole.is_proven && objective(model, whole.x) >= value - kOptimalGap)
    return {whole.x, objective(model, whole.x)};
  result.warnings.push_back(
      "layer 0: the exact program did not end within its work limit; block ascent with a bound");
  return ascent;
}

// Per segment the share of its building's voxels that it encloses; empty when none is enclosed.
std::vector<double> voxel_shares(const SelectionBuilding& building) {
  std::vector<double> share(building.segments.size(), 0.0);
  double sum = 0;
  for (const Coverage& c : building.coverage) {
    if (!(c.share > 0) || !std::isfinite(c.share)) continue;
    sum += c.share;
    for (const int s : c.segments) share[s] += c.share;
  }
  if (!(sum > 0)) return {};
  for (double& s : share) s /= sum;
  return share;
}

// Main segments, those of at least the share `least`, join; how many.
int add_main(const std::vector<double>& share, double least, std::vector<char>& is_layer0) {
  int added = 0;
  for (std::size_t s = 0; s < share.size(); ++s)
    if (!is_layer0[s] && share[s] >= least) is_layer0[s] = 1, ++added;
  return added;
}

// Others leave, smallest first (of equals the last), while the block's bound on f_r holds and one
// segment stays; how many.
int remove_small(const Block& block, const Model& model, const std::vector<double>& share,
                 double least, std::vector<char>& is_layer0) {
  std::vector<int> order;  // items: what is none has to stay
  Choice x(model.items.size(), 0);
  auto kept = std::count(is_layer0.begin(), is_layer0.end(), 1);
  for (int k = block.first; k < block.first + block.count; ++k) {
    const int s = model.items[k].segment;
    x[k] = !is_layer0[s];
    if (is_layer0[s] && share[s] < least) order.push_back(k);
  }
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const double share_a = share[model.items[a].segment], share_b = share[model.items[b].segment];
    return share_a != share_b ? share_a < share_b : a > b;
  });
  int removed = 0;
  for (const int k : order) {
    if (kept == 1) break;
    x[k] = 1;
    if (block_loss(block, x) <= block.capacity)
      is_layer0[model.items[k].segment] = 0, ++removed, --kept;
    else
      x[k] = 0;
  }
  return removed;
}

// A segment whose share is near the threshold.
struct Doubtful {
  const Descriptor* segment;
  int building;
  double share;
  double* verdict;  ///< the share that counts
};

// Segments near the threshold that are alike in several buildings decide together, by the median of
// their shares: a stairhead with 2.1 % of one block's voxels and another with 1.9 % are one kind.
void decide_together(const std::vector<SelectionBuilding>& buildings, double least, double eta,
                     std::vector<std::vector<double>>& shares) {
  std::vector<Doubtful> doubtful;
  for (std::size_t i = 0; i < buildings.size(); ++i)
    for (std::size_t s = 0; s < shares[i].size(); ++s)
      if (shares[i][s] >= least / kDoubt && shares[i][s] <= least * kDoubt)
        doubtful.push_back(
            {&buildings[i].segments[s], static_cast<int>(i), shares[i][s], &shares[i][s]});
  std::stable_sort(doubtful.begin(), doubtful.end(), [](const Doubtful& a, const Doubtful& b) {
    return a.segment->extent < b.segment->extent;
  });
  const auto n = static_cast<std::ptrdiff_t>(doubtful.size());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    std::vector<double> alike = {doubtful[i].share};
    for (const int step : {-1, 1})
      for (std::ptrdiff_t j = i + step; j >= 0 && j < n && std::abs(j - i) <= kMostAlike; j += step)
        if (doubtful[j].building != doubtful[i].building &&
            segment_similarity(*doubtful[i].segment, *doubtful[j].segment, eta) >= kAlike)
          alike.push_back(doubtful[j].share);
    std::sort(alike.begin(), alike.end());
    *doubtful[i].verdict = 0.5 * (alike[(alike.size() - 1) / 2] + alike[alike.size() / 2]);
  }
}

// Layer 0 by shares of voxels, after the optimum, as far as the rules for it are on. One block a
// building that has segments, in order.
void tidy(const std::vector<SelectionBuilding>& buildings, const Model& model,
          const SelectionOptions& options, Selection& result) {
  const double least = options.main_share;
  std::vector<std::vector<double>> shares;
  for (const SelectionBuilding& b : buildings) shares.push_back(voxel_shares(b));
  if (options.rules.has(Rule::kAlike)) decide_together(buildings, least, options.eta, shares);
  for (std::size_t i = 0; i < buildings.size(); ++i)
    for (std::size_t s = 0; s < shares[i].size(); ++s)
      if (buildings[i].segments[s].kind == ElementKind::kSpire) shares[i][s] *= kSpireWeight;
  std::size_t next = 0;
  for (std::size_t i = 0; i < buildings.size(); ++i) {
    if (buildings[i].segments.empty()) continue;
    const Block& block = model.blocks[next++];
    const std::vector<double>& share = shares[i];
    if (share.empty()) continue;
    if (options.rules.has(Rule::kMainSegments))
      result.added += add_main(share, least, result.is_layer0[i]);
    if (options.rules.has(Rule::kLesserSegments))
      result.removed += remove_small(block, model, share, least, result.is_layer0[i]);
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
  result.objective = objective(model, solved.x);
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
  if (options.main_share > 0) tidy(buildings, model, options, result);
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
