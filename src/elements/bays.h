// Inside room `elements`: closed bodies before a facade.
#pragma once

#include <vector>

#include "panels.h"

namespace colod::elements {

/// By pairs of sides; a small house's may be large beside its walls.
std::vector<Element> find_bays(const std::vector<Panel>& panels);

}  // namespace colod::elements
