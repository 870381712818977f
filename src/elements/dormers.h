// Inside room `elements`: small roofs that stand out of a large one.
#pragma once

#include <vector>

#include "panels.h"

namespace colod::elements {

/// By lowest roofs.
std::vector<Element> find_dormers(const std::vector<Panel>& panels);

}  // namespace colod::elements
