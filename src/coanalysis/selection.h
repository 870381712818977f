// All buildings' segments → layer 0 (paper section 3.2, eq. 2–5). The only file that names
// the solver.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/rules.h"
#include "parameters.h"
#include "segments/segments.h"
#include "similarity.h"

namespace colod {

/// What the selection needs to know of one building.
struct SelectionBuilding {
  std::vector<Descriptor> segments;  ///< area, d2 and eigenvalues are used
  std::vector<Coverage> coverage;    ///< shares sum to 1 (or empty when there is no segment)
};

struct SelectionOptions {
  RuleSet rules = RuleSet::all();  ///< none: f_co summed and f_r > 0.8, to the letter
  double beta = 0.3, lambda = 0.4, eta = 4.0;
  int starts = 8;  ///< of the block ascent
  std::uint64_t seed = 1;
  int exact_segments = 40;  ///< up to this many segments that layer 0 could do without, in all, the
                            ///< whole program goes to lp_solve
  double gap = 0.001;       ///< good enough: stop as soon as the gap is proven to be no more; up to
                            ///< exact_segments the optimum is proven whatever this is
  double gap_warning = 0.05;      ///< a greater gap is warned of
  int exact_similarities = 1500;  ///< up to this many segments that layer 0 could do without, all
                                  ///< pairs are compared; beyond, segments and prototypes
  int prototypes = 256;           ///< more: a smaller gap, for time and memory in proportion
  const Prior* prior = nullptr;   ///< f_co compares with what its buildings have beyond layer 0
                                  ///< instead of with each other: a program of its own a building
};

enum class SelectionStatus {
  kOptimal,
  kGap,
  kEmpty
};  ///< proven optimal (to 1e-7); best found with a bound; no segments at all
const char* to_string(SelectionStatus status);

/// A segment that the program kept and a rule took away.
struct Overruled {
  int building = 0, segment = 0;
};

struct Selection {
  std::vector<std::vector<char>> is_layer0;  ///< [building][segment]
  /// Robust: elements of a kind of which most left layer 0, and which leave it, too, where the
  /// bound on f_r holds. Objective, bound and gap speak of the program's choice, before.
  std::vector<Overruled> overruled;
  int starts = 0;        ///< of the ascent
  bool is_exact = true;  ///< all pairs compared: `objective` is E_0 and not a lower bound on it
  double objective = 0;  ///< E_0 of the result of the optimisation, or proven to be no more
  double bound = 0;      ///< proven upper bound on E_0
  double gap = 0;        ///< (bound − objective) / max(1, |objective|)
  SelectionStatus status = SelectionStatus::kEmpty;
  bool is_lp_solve = false;  ///< lp_solve solved the whole program to proof; else block ascent
                             ///< found the choice and our own bound says how good it is
  double seconds = 0;
  std::vector<std::string> warnings;
};

/// Every building keeps at least one segment (if it has any). Deterministic; uses threads. Memory
/// grows with the square of the segments that layer 0 could do without up to `exact_similarities`
/// (8 bytes a pair), from there with their number. Not for concurrent calls (lp_solve).
Selection select_layer0(const std::vector<SelectionBuilding>& buildings,
                        const SelectionOptions& options = {});

/// E_0 of a given choice, for tests and reports. −infinity when a building violates its bound on
/// f_r.
double selection_objective(const std::vector<SelectionBuilding>& buildings,
                           const std::vector<std::vector<char>>& is_layer0,
                           const SelectionOptions& options = {});

}  // namespace colod
