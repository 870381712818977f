// Based on: eq. 11 of the paper; evidence.h, min_cut.h.
// Differs: paper rules: inside where more than half of the rays are valid hits, the largest
// component, nothing else. Robust rules smooth by a min-cut and keep substantial other components.
// Notation: none.
#include "label.h"

#include <array>
#include <utility>

#include "components.h"
#include "coverage.h"
#include "min_cut.h"
#include "parameters.h"
#include "told.h"

namespace colod {
namespace {

using namespace parameters::extraction::label;

std::vector<char> forced_outside(const Partition& partition, const CuttingPlan& plan) {
  std::vector<char> is_forced(partition.cells.size(), 0);
  for (std::size_t c = 0; c < is_forced.size(); ++c)
    for (const CuttingPlan::Limit& limit : plan.limits)
      if (limit.normal.dot(partition.cells[c].centroid) > limit.offset) is_forced[c] = 1;
  return is_forced;
}

/// More than half of the rays; no smoothing.
std::vector<char> threshold_cells(const Evidence& evidence,
                                  const std::vector<char>& is_forced_out) {
  std::vector<char> is_inside(evidence.cells.size());
  for (std::size_t c = 0; c < is_inside.size(); ++c)
    is_inside[c] = evidence.cells[c].seen > 0 && !is_forced_out[c];
  return is_inside;
}

/// The best of several min-cuts; empty: none finds an inside.
std::vector<char> best_cut(const Partition& partition, const Evidence& evidence,
                           const std::vector<char>& is_forced, double smoothness, double others,
                           std::vector<std::string>& warnings) {
  std::vector<char> is_inside;
  double best = -1;
  for (const double escape : kEscapes) {
    std::vector<char> trial =
        cut_cells(partition, evidence, is_forced, {.smoothness = smoothness, .escape = escape});
    if (!keep_largest_components(partition, trial, others)) continue;
    const double share = explained_share(partition, evidence, trial);
    if (share > best + kWorthwhile) best = share, is_inside = std::move(trial);
    if (best > kEnough) break;
  }
  if (best < kLittle) warnings.push_back("little of the layer lies on its surface");
  return is_inside;
}

/// All of the box; empty: nothing of it is left.
std::vector<char> whole_box(const Partition& partition, const std::vector<char>& is_forced,
                            double others) {
  std::vector<char> is_inside(partition.cells.size());
  for (std::size_t c = 0; c < is_inside.size(); ++c) is_inside[c] = !is_forced[c];
  return keep_largest_components(partition, is_inside, others) ? is_inside : std::vector<char>();
}

}  // namespace

Labels label_cells(const Partition& partition, const CuttingPlan& plan, const Planes& planes,
                   Sight& sight, const ExtractionOptions& options) {
  Labels labels;
  labels.is_forced_out = forced_outside(partition, plan);
  const RuleSet& rules = options.rules;
  const double others = rules.has(Rule::kComponents) ? kSubstantial : kNoOther;
  labels.evidence =
      gather_evidence(partition, sight, {.is_on_rings = rules.has(Rule::kRings), .nr = options.nr});
  if (!rules.is_none()) measure_coverage(partition, planes, plan.input, labels.evidence);
  tell_cells(partition, plan.elements, labels.evidence);
  if (rules.has(Rule::kMinCut)) {
    labels.is_inside = best_cut(partition, labels.evidence, labels.is_forced_out,
                                options.smoothness, others, labels.warnings);
  } else {
    labels.is_inside = threshold_cells(labels.evidence, labels.is_forced_out);
    if (!keep_largest_components(partition, labels.is_inside, others)) labels.is_inside.clear();
  }
  if (!labels.is_inside.empty() || !rules.has(Rule::kBoxFallback)) return labels;
  labels.warnings.push_back("no ray sees an inside: the layer is the box around its planes");
  labels.is_inside = whole_box(partition, labels.is_forced_out, others);
  return labels;
}

}  // namespace colod
