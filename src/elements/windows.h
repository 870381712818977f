// Inside room `elements`: panes behind a facade, with their reveals; doors, too.
#pragma once

#include <vector>

#include "panels.h"

namespace colod::elements {

/// By panes.
std::vector<Element> find_windows(const std::vector<Panel>& panels);

}  // namespace colod::elements
