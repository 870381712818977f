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
#include "polygons.h"

namespace colod {
namespace {

constexpr double kShortest = 3e-3;       // metres: shorter edges are contracted …
constexpr double kShortestPaper = 1e-3;  // … under the paper's rules
constexpr double kNarrowest = 2.5e-3;    // metres: edges of narrower facets likewise
constexpr double kMostLost = 0.03;       // of a body's volume

}  // namespace

bool keeps_volume(const PolygonMesh& before, const PolygonMesh& after) {
  const double volume = signed_volume(before.mesh());
  return !(std::abs(signed_volume(after.mesh()) - volume) > kMostLost * volume);
}

Shell make_surface(const Partition& partition, std::vector<char> is_inside, bool is_paper) {
  assert(is_inside.size() == partition.cells.size());
  if (!is_paper) fill_cavities(partition, is_inside);
  Shell shell{{}, mend_pinches(partition, is_inside)};
  if (!keep_largest_components(partition, is_inside, is_paper ? kNoOther : kSubstantial))
    return shell;
  if (!is_paper) fill_cavities(partition, is_inside);
  shell.mesh = build_polygons(partition, BoundaryFinder(partition).find(is_inside));
  contract_short_edges(shell.mesh, is_paper ? kShortestPaper : kShortest);
  if (!is_paper) contract_narrow_facets(shell.mesh, kNarrowest);
  return shell;
}

}  // namespace colod
