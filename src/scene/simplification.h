// Inside room `scene` only: meshes → the same with fewer faces, as far off as they may be.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry.h"

namespace colod {

/// What a coarser tile is made of, and has become.
struct Work {
  Mesh mesh;
  std::vector<char> is_joint;         ///< per vertex: it stays
  std::vector<std::uint32_t> origin;  ///< per vertex, whose it was; empty: nobody asks
  double deviation = 0;               ///< metres from what it was made of
};

/// Without pieces that are no larger than `size`, in metres, unless nothing else is there or a
/// joint is theirs: whoever does not see them misses no more than their size, however far they are
/// from all else. Left to the simplification, they would collapse and count with that distance.
Work without_small(const Work& from, double size);

/// Edges collapse while quadrics tell of no more than `error`, in metres. What is then farther off
/// than kFarthest times that is kept, in kMostKept rounds: quadrics tell of means, and a tip of
/// little area goes however high it is.
Work collapsed(const Work& from, double error);

}  // namespace colod
