// Inside room `extraction`: where thin parts meet, their planes reach as far as the corner.
#pragma once

#include <optional>

#include "plan.h"
#include "surface.h"

namespace colod {

/// Two parts that meet in an edge alone, as two parapets do in front of their corner, are joined by
/// a cell between them (mend_pinches). Where that cell stands out past both, a post on the corner,
/// the planes that end them have not reached it: the plan with hulls that do. None: there is no
/// such cell.
std::optional<CuttingPlan> plan_corners(const CuttingPlan& plan, const Draft& draft,
                                        const RuleSet& rules);

}  // namespace colod
