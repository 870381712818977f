// Inside room `elements`: air between two walls that face each other, behind a facade.
#pragma once

#include <vector>

#include "panels.h"

namespace colod::elements {

/// By pairs of walls.
std::vector<Element> find_loggias(const std::vector<Panel>& panels);

}  // namespace colod::elements
