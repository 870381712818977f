// What was cut out along territories → no gap between what is left and the ground that closes it.
#pragma once

#include <vector>

#include "closing.h"
#include "territory.h"

namespace colod {

/// Adds upright strips along each edge of `cut` where territories end, from it to a little below
/// the surface around: what was cut through is closed, as trees are that stand against a wall, and
/// where heights beside a border differ nothing is seen through between them. Serves what is left
/// of a scene and the ground below buildings alike. They look as the edge does. `deeper`: metres
/// that they go on, where edges are still to move. Returns, per vertex, whether an edge that one
/// face alone has ends there without a strip: others may join it.
std::vector<char> add_skirts(const Territories& territories, const ClosingGround& ground,
                             Source& cut, double deeper = 0);

}  // namespace colod
