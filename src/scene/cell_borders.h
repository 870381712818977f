// Inside room `scene` only: the borders of numbered cells of a map as rings.
#pragma once

#include <array>
#include <numbers>
#include <vector>

#include "survey.h"

namespace colod {

using Ring = std::vector<Vec2>;
constexpr double kQuarterTurn = std::numbers::pi / 2;
using CellCorner = std::array<int, 2>;

/// Per number the rings around its cells, what is inside to their left; `number` is as long as the
/// map, −1: none. Where two rings meet in a corner each turns to its own side.
std::vector<std::vector<std::vector<CellCorner>>> borders_of(const HeightMap& map,
                                                             const std::vector<int>& number,
                                                             int numbers);

/// A ring in metres, without the corners that its sides pass within a cell and a half of.
Ring with_fewer_corners(const HeightMap& map, const std::vector<CellCorner>& corners);

/// Radians from x, modulo a quarter turn: that of most of a ring's length.
double main_direction(const Ring& ring);

}  // namespace colod
