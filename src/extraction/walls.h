// Inside room `extraction`: walls under roof borders that no plane supports.
#pragma once

#include <vector>

#include "core/rays.h"
#include "plan.h"
#include "planes/planes.h"

namespace colod {

/// Vertical candidates, each for a stretch of border; `limits` are the sides that the plan has.
std::vector<CutPlane> walls_under_borders(const Planes& planes,
                                          const std::vector<int>& layer_planes,
                                          const RayScene& rays, const Box& box,
                                          const std::vector<CuttingPlan::Limit>& limits);

}  // namespace colod
