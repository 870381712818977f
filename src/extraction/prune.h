// Inside room `extraction`, the fourth verb: planes that the surface does not need are left out.
#pragma once

#include <optional>
#include <vector>

#include "plan.h"
#include "planes/planes.h"
#include "surface.h"

namespace colod {

struct Pruning {
  CuttingPlan plan;
  std::vector<char> is_worthwhile;  ///< per plane: it has to keep its surface
};

/// The plan without the planes that only slivers or uncovered facets of the draft lie on; none:
/// there is no such plane.
std::optional<Pruning> prune(const CuttingPlan& plan, const Draft& draft, const Planes& planes);

/// A draft by the pruned plan may stand for that by the plan before: the worthwhile planes keep
/// their surface, the body its volume, and there is no new warning.
bool keeps_surface(const Draft& before, const Draft& after, const Pruning& pruning);

}  // namespace colod
