// Based on: elements/elements.h.
// Differs: robust rules only. Cells within an element are told what rays cannot tell: a ray from a
//   balcony's air meets the thin walls from their back and takes the air for an inside.
// Notation: –
#include "told.h"

#include <algorithm>

namespace colod {

void tell_cells(const Partition& partition, const std::vector<Element>& elements,
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
