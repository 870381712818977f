// Inside room `relief`: borders between labels, cell by cell.
#pragma once

#include <vector>

#include "field.h"
#include "labels.h"

namespace colod::relief {

/// A border between two labels from one junction to the next, or a loop (its last point is its
/// first).
struct Chain {
  int left = kOutside, right = kOutside;
  std::vector<Vec2> points;
  int first = -1, last = -1;  ///< corners of the grid where it ends
};

std::vector<Chain> trace_chains(const Field& field, const std::vector<int>& label);

}  // namespace colod::relief
