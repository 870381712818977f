// Based on: boundary.h, polygons.h, contraction.h, components.h.
// Differs: paper rules keep one component, its cavities and every edge of a millimetre.
// Notation: none.
#include "surface.h"

#include <cassert>
#include <cmath>
#include <utility>

#include "boundary.h"
#include "components.h"
#include "contraction.h"
#include "parameters.h"
#include "polygons.h"

namespace colod {
namespace {

using namespace parameters::extraction::surface;

}  // namespace

bool keeps_volume(const PolygonMesh& before, const PolygonMesh& after) {
  const double volume = signed_volume(before.mesh());
  return !(std::abs(signed_volume(after.mesh()) - volume) > kMostLost * volume);
}

Shell make_surface(const Partition& partition, std::vector<char> is_inside, const RuleSet& rules) {
  assert(is_inside.size() == partition.cells.size());
  if (rules.has(Rule::kCavities)) fill_cavities(partition, is_inside);
  Shell shell{{}, mend_pinches(partition, is_inside)};
  if (!keep_largest_components(partition, is_inside,
                               rules.has(Rule::kComponents) ? kSubstantial : kNoOther))
    return shell;
  if (rules.has(Rule::kCavities)) fill_cavities(partition, is_inside);
  shell.mesh = build_polygons(partition, BoundaryFinder(partition).find(is_inside));
  contract_short_edges(shell.mesh, rules.has(Rule::kShortEdges) ? kShortest : kShortestPaper);
  if (rules.has(Rule::kNarrowFacets)) contract_narrow_facets(shell.mesh, kNarrowest);
  return shell;
}

}  // namespace colod
