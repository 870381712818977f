// A textured mesh → the same with fewer faces.
#pragma once

#include <vector>

#include "core/geometry.h"

namespace colod {

/// No farther from the source than about `error`, and twice that at most where that could be had.
/// Places in images go along: charts keep their seams. Pieces no larger than `error` go.
/// `is_joint`, per vertex: it stays, since others join it. The source comes back where nothing
/// would be left of it. Metres.
Source lighter(const Source& source, const std::vector<char>& is_joint, double error);

}  // namespace colod
