// What was cut out along territories → no gap between what is left and the ground that closes it.
#pragma once

#include "closing.h"
#include "territory.h"

namespace colod {

/// Adds upright strips along each edge of `cut` where territories end, from it to a little below
/// the surface around: what was cut through is closed, as trees are that stand against a wall, and
/// where heights beside a border differ nothing is seen through between them. Serves what is left
/// of a scene and the ground below buildings alike. They look as the edge does.
void add_skirts(const Territories& territories, const ClosingGround& ground, Source& cut);

}  // namespace colod
