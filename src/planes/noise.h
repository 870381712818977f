// Inside room `planes`: how rough a surface is.
#pragma once

#include <vector>

#include "core/geometry.h"
#include "items.h"
#include "planes.h"

namespace colod::regions {

/// `distance`: metres that planes grow by.
Planes::Surface judge_surface(double noise, double distance);
/// Root mean square distance of neighbourhoods of 1.5 m from their own planes, metres: the flattest
/// tenth of them.
double estimate_noise(const Items& items);
/// Normals averaged over neighbours, for the angle test only.
std::vector<Vec3> smooth_normals(const Items& items, int rounds);

}  // namespace colod::regions
