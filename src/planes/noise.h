// Inside room `planes`: how rough a surface is.
#pragma once

#include <vector>

#include "core/geometry.h"
#include "items.h"
#include "planes.h"

namespace colod::regions {

/// Three residuals of a whole wall, which on scans is 2.3 times that of 1.5 m of it (0.012 m
/// against 0.027 m on simulated photogrammetry).
constexpr double kNoiseFactor = 7;
/// Metres: an exact model needs no more, and its planes grow by no more where it has few.
constexpr double kPlainDistance = 0.003;
/// Metres of noise above which normals need smoothing: 5 mm, where kClean ends at 4.3
/// (kLeastDistance / kNoiseFactor).
constexpr double kSmoothedNoise = 0.005;
/// `distance`: metres that planes grow by.
Planes::Surface judge_surface(double noise, double distance);
/// Root mean square distance of neighbourhoods of 1.5 m from their own planes, metres: the flattest
/// tenth of them.
double estimate_noise(const Items& items);
/// Normals averaged over neighbours, for the angle test only.
std::vector<Vec3> smooth_normals(const Items& items, int rounds);

}  // namespace colod::regions
