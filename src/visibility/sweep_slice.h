// Inside room `visibility`: the outlines where one slice of voxels cuts them.
#pragma once

#include <vector>

#include "parts.h"

namespace colod::casting {

struct Segment {
  double x0, y0, x1, y1;
  int plane;  ///< of the slice's, from 0
};

/// A segment's end, or where two of them cross; rays that pass within `reach` graze.
struct Corner {
  double x, y, reach;
};

/// The outlines in one slice.
struct Slice {
  std::vector<Segment> segments;
  std::vector<int> planes;  ///< rising: of all planes those that are cut
  std::vector<Corner> corners;
};

/// In the job's coordinates, at height z; what touches it by less than `reach` metres leaves a
/// corner. `diagonal`: metres, of the grid's box.
Slice cut_slice(const Job& job, double z, double reach, double diagonal);

}  // namespace colod::casting
