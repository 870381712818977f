// Based on: sheets.h.
// Differs: robust rules only, on the finest layer of a clean model.
// Notation: none.
#include "thicken.h"

#include <utility>

#include "boundary.h"
#include "cut.h"
#include "sheets.h"

namespace colod {

Draft thicken(Draft draft, CuttingPlan plan, const Planes& planes,
              const std::vector<int>& layer_planes, const RayScene& rays,
              const ExtractionOptions& options) {
  const SheetScene scene{planes, draft.shell.mesh, rays, options.tolerance};
  const std::vector<Sheet> sheets = find_sheets(scene, layer_planes);
  if (sheets.empty()) return draft;
  const std::size_t first = plan.planes.size();
  add_slabs(planes, sheets, plan);
  Partition partition = cut_space(plan, planes, options);
  if (partition.warnings.size() > draft.partition.warnings.size()) return draft;
  std::vector<char> is_inside = fill_slabs(scene, partition, sheets, first, draft.labels.is_inside);
  Shell shell = make_surface(partition, is_inside, options.rules);
  if (!is_closed_manifold(shell.mesh.triangles) || !keeps_volume(draft.shell.mesh, shell.mesh))
    return draft;
  draft.partition = std::move(partition);
  draft.labels.is_inside = std::move(is_inside);
  draft.shell = std::move(shell);
  return draft;
}

}  // namespace colod
