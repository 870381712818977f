// Inside room `extraction`, the sixth verb: what is drawn without thickness becomes a thin body.
#pragma once

#include <vector>

#include "extraction.h"
#include "plan.h"
#include "planes/planes.h"
#include "surface.h"

namespace colod {

/// The draft by `plan` with the sheets that its surface lacks as thin bodies on it, or as it was.
Draft thicken(Draft draft, CuttingPlan plan, const Planes& planes,
              const std::vector<int>& layer_planes, const RayScene& rays,
              const ExtractionOptions& options);

}  // namespace colod
