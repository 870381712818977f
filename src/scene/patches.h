// Inside room `scene` only: regions of a height map, and their patches, that hang together by more
// than a narrow neck, or have one colour.
#pragma once

#include <map>
#include <vector>

#include "survey.h"

namespace colod {

/// Neighbours along rows and columns.
template <typename Body>
void for_each_neighbour(const HeightMap& map, std::size_t i, Body body) {
  const auto w = static_cast<std::size_t>(map.width);
  const std::size_t x = i % w, y = i / w;
  if (x > 0) body(i - 1);
  if (x + 1 < w) body(i + 1);
  if (y > 0) body(i - w);
  if (y + 1 < static_cast<std::size_t>(map.height)) body(i + w);
}

/// Cells that are in, and connected by pairs of neighbours that are one: per cell the number of its
/// region, from 0 on in the order of first cells; −1: not in. O(cells).
template <typename IsOne>
std::vector<int> connect(const HeightMap& map, const std::vector<char>& is_in, IsOne is_one) {
  std::vector<int> region(map.size(), -1);
  int regions = 0;
  std::vector<std::size_t> open;
  for (std::size_t start = 0; start < map.size(); ++start) {
    if (!is_in[start] || region[start] >= 0) continue;
    region[start] = regions, open.push_back(start);
    while (!open.empty()) {
      const std::size_t i = open.back();
      open.pop_back();
      for_each_neighbour(map, i, [&](std::size_t j) {
        if (is_in[j] && region[j] < 0 && is_one(i, j)) region[j] = regions, open.push_back(j);
      });
    }
    ++regions;
  }
  return region;
}

/// Per region the sides of cells along which it meets each other one; with −1 all that is in none.
using Rims = std::vector<std::map<int, int>>;
Rims rims_of(const HeightMap& map, const std::vector<int>& region);

/// Per cell the number of its patch, from 0 on; −1 where it is of no region. Two patches of one
/// region are parted where no square of kNeck metres passes from one to the other; each holds the
/// middles of such squares over kLeastCore m². `region`: per cell its number; −1: none. O(cells).
std::vector<int> part_at_necks(const HeightMap& map, const std::vector<int>& region);

/// Likewise, parted where the colour changes within kTintStep metres to either side and the surface
/// does not bend, as it does at a ridge, whose sides have different light. Regions of less than
/// kLeastTinted m² stay whole, those that change their colour on more than a fifth of their
/// cells, and all where there are no colours or those of single points. O(cells).
std::vector<int> part_at_tints(const HeightMap& map, const std::vector<int>& region);

/// Per region, numbered from 0 on, its cells.
std::vector<double> cells_of(const std::vector<int>& region);

/// Numbers regions from 0 on, in the order of their first cells; how many there are.
int renumber(std::vector<int>& region);

}  // namespace colod
