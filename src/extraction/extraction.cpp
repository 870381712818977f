// Based on: Co-LOD, section 3.3 (eq. 11): binary space partition, rays, the largest interior
// component.
// Differs: paper rules take the largest component of the cells that more than half of nr rays see
// from inside. Robust rules add candidate planes, a min-cut and several trials before giving up
// (plan.h, label.h), cut anew without the planes that carry only slivers or uncovered facets
// (prune.h), cut planes near a larger one along that one (leaders.h), drop facets that hardly
// matter (simplify.h) and give what is drawn as a sheet some thickness (thicken.h). Both mend the
// boundary to a 2-manifold (components.h) and write it in the same way (surface.h).
// Notation: a cell is a convex piece of space between the layer's planes.
#include "extraction.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "boundary.h"
#include "core/error.h"
#include "corners.h"
#include "coverage.h"
#include "cut.h"
#include "label.h"
#include "plan.h"
#include "prune.h"
#include "simplify.h"
#include "spares.h"
#include "surface.h"
#include "thicken.h"

namespace colod {
namespace {

constexpr int kPruningRounds = 2;
constexpr int kTrials = 4;              // of spares, for a layer
constexpr double kMuchMended = 0.02;    // share of the volume turned round that asks for a warning
constexpr double kCornerShare = 0.002;  // of the outlines, which corners may cover

/// cut → label → surface
Draft make_draft(const CuttingPlan& plan, const Planes& planes, Sight& sight,
                 const ExtractionOptions& options) {
  Draft draft;
  draft.partition = cut_space(plan, planes, options);
  sight.count(static_cast<std::int64_t>(draft.partition.cells.size()));
  draft.labels = label_cells(draft.partition, plan, planes, sight, options);
  if (!draft.labels.is_inside.empty())
    draft.shell = make_surface(draft.partition, draft.labels.is_inside, options.rules);
  draft.warnings = draft.partition.warnings;
  draft.warnings.insert(draft.warnings.end(), draft.labels.warnings.begin(),
                        draft.labels.warnings.end());
  return draft;
}

Extraction finish(Draft draft, const Sight& sight, const ExtractionOptions& options) {
  Extraction result;
  result.mesh = std::move(draft.shell.mesh);
  result.cells = static_cast<std::int64_t>(draft.partition.cells.size());
  result.warnings = std::move(draft.warnings);
  result.is_manifold = is_closed_manifold(result.mesh.triangles);
  if (is_spent(sight) && !options.rules.is_none())
    result.warnings.push_back(
        "its planes make too many cells (" + std::to_string(sight.cells) +
        " in all attempts so far) to look for a leaner surface: small facets "
        "may be left; a larger --distance or --min-points makes fewer planes");
  const double share = draft.shell.mended / std::max(1e-9, signed_volume(result.mesh.mesh()));
  if (share > kMuchMended)
    result.warnings.push_back(std::to_string(std::lround(100 * share)) +
                              " % of the volume was turned round to make the surface a 2-manifold");
  return result;
}

/// Of the outlines, 0..1: what lies on a draft's surface.
double explained(const Draft& draft) {
  return explained_share(draft.partition, draft.labels.evidence, draft.labels.is_inside);
}

/// The layer's planes, then those of a set that it does not have.
std::vector<int> with_spares(std::vector<int> layer, const std::vector<int>& set) {
  const std::vector<int> before = layer;
  for (const int p : set)
    if (std::find(before.begin(), before.end(), p) == before.end()) layer.push_back(p);
  return layer;
}

}  // namespace

Extraction extract_layer(const Planes& planes, const std::vector<int>& layer_planes, Sight& sight,
                         const ExtractionOptions& options) {
  CuttingPlan plan = plan_cuts(planes, layer_planes, sight.rays, options);
  Draft draft = make_draft(plan, planes, sight, options);
  if (draft.labels.is_inside.empty())
    throw Error(Stage::kProcess, "extraction", "no cell is seen from inside by most rays");
  const int rounds = options.rules.has(Rule::kPruning) ? kPruningRounds : 0;
  for (int round = 0; round < rounds && !is_spent(sight); ++round) {
    std::optional<Pruning> pruning = prune(plan, draft, planes);
    if (!pruning) break;
    Draft next = make_draft(pruning->plan, planes, sight, options);
    if (!keeps_surface(draft, next, *pruning)) break;
    draft = std::move(next), plan = std::move(pruning->plan);
  }
  if (std::optional<CuttingPlan> corners = plan_corners(plan, draft, options.rules);
      corners && !is_spent(sight)) {
    Draft next = make_draft(*corners, planes, sight, options);
    if (!next.labels.is_inside.empty() && next.shell.mended < draft.shell.mended &&
        explained(next) >= explained(draft) - kCornerShare)
      draft = std::move(next), plan = std::move(*corners);
  }
  if (options.rules.has(Rule::kFacetPrice) && options.tolerance > 0 && !is_spent(sight))
    draft = simplify(std::move(draft), planes, options);
  if (options.is_finest && options.rules.has(Rule::kSheets) && planes.is_clean())
    draft = thicken(std::move(draft), std::move(plan), planes, layer_planes, sight.rays, options);
  return finish(std::move(draft), sight, options);
}

Extraction extract_layer(const Planes& planes, const std::vector<int>& layer_planes,
                         const std::vector<std::vector<int>>& spares, Sight& sight,
                         const ExtractionOptions& options) {
  Extraction best = extract_layer(planes, layer_planes, sight, options);
  if (spares.empty()) return best;
  const SpareGauge gauge(planes, spares, sight.rays);
  std::vector<int> layer = layer_planes;
  std::vector<char> is_joined(spares.size(), 0), is_out = is_joined;  // out: joined, or tried since
  std::optional<double> distance;
  for (int trial = 0; trial < kTrials && !is_spent(sight); ++trial) {
    const int chosen = gauge.most_missed(best.mesh, is_out);
    if (chosen < 0) break;
    is_out[chosen] = 1;
    if (!distance) distance = gauge.mean_distance(best.mesh);
    std::vector<int> more = with_spares(layer, spares[chosen]);
    Extraction next = extract_layer(planes, more, sight, options);
    const double next_distance = gauge.mean_distance(next.mesh);
    if (!gauge.pays(chosen, best.mesh, next.mesh, *distance - next_distance) ||
        next.warnings.size() > best.warnings.size())
      continue;
    best = std::move(next), layer = std::move(more), distance = next_distance;
    is_joined[chosen] = 1, is_out = is_joined;  // what did not pay alone may pay now
  }
  best.joined.assign(layer.begin() + static_cast<std::ptrdiff_t>(layer_planes.size()), layer.end());
  return best;
}

}  // namespace colod
