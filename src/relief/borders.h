// Inside room `relief`: borders between labels as straight pieces on few lines.
#pragma once

#include <vector>

#include "core/geometry.h"
#include "field.h"
#include "labels.h"

namespace colod::relief {

/// A straight piece of a border; `left` and `right` are labels as seen from `from` towards `to`.
struct Piece {
  int left = kOutside, right = kOutside;
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();  ///< corners, shared with the pieces around
  int line = -1;                                ///< on which it lies
  double length() const { return (to - from).norm(); }
};

struct Line {
  Vec2 normal;  ///< unit
  double offset = 0;
};

struct Borders {
  std::vector<Piece> pieces;
  std::vector<Line> lines;
};

/// Radians, [0, π/2): of most border, square to it included. `tolerance`: metres that a border may
/// leave its line.
double find_direction(const Field& field, const Labels& labels, double tolerance);

/// A steep face, in plan.
struct WallSample {
  Vec2 place, normal;  ///< unit normal
  double area = 0;     ///< m²
};

/// Pieces around each label are closed. `walls` say where lines lie. `direction` as above.
Borders find_borders(const Field& field, const Labels& labels, const std::vector<WallSample>& walls,
                     double direction, double tolerance);

}  // namespace colod::relief
