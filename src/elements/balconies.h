// Inside room `elements`: floors with thin walls around them.
#pragma once

#include <vector>

#include "panels.h"

namespace colod::elements {

/// Over floors that are seen, by lowest planes.
std::vector<Element> find_balconies(const std::vector<Panel>& panels);
/// Over undersides, where the floor is not seen; closed on all sides.
std::vector<Element> find_balconies_from_below(const std::vector<Panel>& panels);

}  // namespace colod::elements
