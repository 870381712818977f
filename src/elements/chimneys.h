// Inside room `elements`: solids of which a scan shows walls, but not all of the rest.
#pragma once

#include <vector>

#include "panels.h"

namespace colod::elements {

/// Between walls that look away from each other, by pairs.
std::vector<Element> find_chimneys(const std::vector<Panel>& panels);
/// Behind two walls around a corner, where no more is seen, by pairs.
std::vector<Element> find_chimney_corners(const std::vector<Panel>& panels);

}  // namespace colod::elements
