// Based on: elements/elements.h.
// Differs: robust rules only. The faces that a balcony, a loggia or a chimney lacks cut the space,
// and
//   cells within them are told what rays cannot tell: a ray from a balcony's air meets the thin
//   walls from their back and takes the air for an inside.
// Notation: –
#include <algorithm>

#include "candidates.h"
#include "labels.h"

namespace colod {

void find_elements(const Planes& planes, std::vector<int> layer_planes, CuttingPlan& plan) {
  std::sort(layer_planes.begin(), layer_planes.end());
  plan.elements = find_elements(planes, layer_planes);
}

void keep_bounds(const std::vector<int>& layer_planes, const CuttingPlan& plan,
                 std::vector<int>& leaders) {
  for (const Element& element : plan.elements)
    for (std::size_t i = 0; i < layer_planes.size(); ++i)
      if (std::binary_search(element.bounds.begin(), element.bounds.end(), layer_planes[i]))
        leaders[i] = layer_planes[i];
}

void add_rims(const Element& element, CuttingPlan& plan) {
  for (const Element::Rim& rim : element.rims) {
    plan.planes.push_back({rim.normal, rim.offset, rim.hull, -1});
    plan.input.push_back(rim.like);
  }
}

void ask_elements(const Partition& partition, const std::vector<Element>& elements,
                  Evidence& evidence) {
  const auto is_in_recess = [&](const Vec3& x) {
    return std::any_of(elements.begin(), elements.end(), [&](const Element& element) {
      return element.kind == ElementKind::kWindow && contains(element.air, x);
    });
  };
  evidence.is_told.assign(partition.cells.size(), 0);
  for (std::size_t c = 0; c < partition.cells.size(); ++c) {
    const Vec3& x = partition.cells[c].centroid;
    if (is_in_recess(x)) continue;  // a dormer's window is no part of the dormer's body
    for (const Element& element : elements) {
      if (element.is_whole) continue;  // rays see it all
      const bool is_sheet = std::any_of(element.sheets.begin(), element.sheets.end(),
                                        [&](const Region& sheet) { return contains(sheet, x); });
      const bool is_solid = is_sheet || (!element.solid.empty() && contains(element.solid, x));
      const bool is_air = !element.air.empty() && contains(element.air, x);
      if (!is_solid && !is_air) continue;
      evidence.cells[c] = {is_solid ? 1.0 : -1.0, 0, 0};
      evidence.is_told[c] = 1;
    }
  }
}

}  // namespace colod
