// Rows of houses → each house, along the party walls that the surface shows.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "cell_borders.h"
#include "classes.h"
#include "parameters.h"
#include "party_walls.h"
#include "patches.h"

namespace colod {

namespace {

using namespace parameters::party_walls;

/// Which sides of cells a wall closes, those to the right and those above.
struct ClosedSides {
  std::vector<char> right, above;
};

double side_of(const Vec2& a, const Vec2& b, const Vec2& p) {
  return (b - a).x() * (p - a).y() - (b - a).y() * (p - a).x();
}

bool crosses(const PartyWall& wall, const Vec2& p, const Vec2& q) {
  return (side_of(wall.from, wall.to, p) > 0) != (side_of(wall.from, wall.to, q) > 0) &&
         (side_of(p, q, wall.from) > 0) != (side_of(p, q, wall.to) > 0);
}

void shut(const HeightMap& map, const PartyWall& wall, ClosedSides& closed) {
  const Vec2 low = (wall.from.cwiseMin(wall.to) - map.origin) / map.cell;
  const Vec2 high = (wall.from.cwiseMax(wall.to) - map.origin) / map.cell;
  const int x1 = std::min(map.width - 2, static_cast<int>(high.x()) + 1);
  const int y1 = std::min(map.height - 2, static_cast<int>(high.y()) + 1);
  for (int y = std::max(0, static_cast<int>(low.y()) - 1); y <= y1; ++y)
    for (int x = std::max(0, static_cast<int>(low.x()) - 1); x <= x1; ++x) {
      const Vec2 p = map.middle(x, y);
      if (crosses(wall, p, map.middle(x + 1, y))) closed.right[map.at(x, y)] = 1;
      if (crosses(wall, p, map.middle(x, y + 1))) closed.above[map.at(x, y)] = 1;
    }
}

/// Parts of patches between closed sides, numbered from 0 on; −1: none.
std::vector<int> parts_of(const HeightMap& map, const std::vector<int>& patch,
                          const ClosedSides& closed, std::vector<int>& cells) {
  std::vector<int> part(map.size(), -1);
  const auto w = static_cast<std::size_t>(map.width);
  for (std::size_t start = 0; start < map.size(); ++start) {
    if (patch[start] < 0 || part[start] >= 0) continue;
    const int number = static_cast<int>(cells.size());
    std::vector<std::size_t> open = {start};
    part[start] = number;
    const auto reach = [&](std::size_t j, bool is_closed) {
      if (is_closed || part[j] >= 0 || patch[j] != patch[start]) return;
      part[j] = number, open.push_back(j);
    };
    for (std::size_t n = 0; n < open.size(); ++n) {
      const std::size_t i = open[n];
      if (i % w + 1 < w) reach(i + 1, closed.right[i]);
      if (i % w > 0) reach(i - 1, closed.right[i - 1]);
      if (i + w < map.size()) reach(i + w, closed.above[i]);
      if (i >= w) reach(i - w, closed.above[i - w]);
    }
    cells.push_back(static_cast<int>(open.size()));
  }
  return part;
}

/// Sides of cells along which two parts of one building meet.
using PartRims = std::vector<std::map<int, int>>;

PartRims part_rims(const HeightMap& map, const std::vector<int>& building,
                   const std::vector<int>& part, std::size_t parts) {
  PartRims rims(parts);
  const auto w = static_cast<std::size_t>(map.width);
  const auto touch = [&](std::size_t i, std::size_t j) {
    if (building[i] < 0 || building[i] != building[j] || part[i] == part[j]) return;
    ++rims[static_cast<std::size_t>(part[i])][part[j]];
    ++rims[static_cast<std::size_t>(part[j])][part[i]];
  };
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (i % w + 1 < w) touch(i, i + 1);
    if (i + w < map.size()) touch(i, i + w);
  }
  return rims;
}

/// Per part the cells that a house has at least.
std::vector<double> least_houses(const HeightMap& map, const std::vector<int>& building,
                                 const std::vector<int>& part, std::size_t parts) {
  const std::vector<double> block = cells_of(building);
  std::vector<double> least(parts, kLeastRowHouse / map.cell / map.cell);
  for (std::size_t i = 0; i < map.size(); ++i)
    if (part[i] >= 0) {
      const double whole = block[static_cast<std::size_t>(building[i])];
      const bool is_pair = whole * map.cell * map.cell < kLeastBlock;
      double& own = least[static_cast<std::size_t>(part[i])];
      own = std::max(own, (is_pair ? kPairShare : kLeastOfBlock) * whole);
    }
  return least;
}

/// Parts that are no house join the one that they touch most, the smallest first, each once a
/// round.
bool join_least(const HeightMap& map, const std::vector<int>& building,
                const std::vector<double>& least, std::vector<int>& part, std::vector<int>& cells) {
  const PartRims rims = part_rims(map, building, part, cells.size());
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return cells[a] < cells[b]; });
  std::vector<int> to(cells.size());
  std::iota(to.begin(), to.end(), 0);
  std::vector<char> is_busy(cells.size(), 0);
  bool has_joined = false;
  for (const std::size_t p : order) {
    if (cells[p] == 0 || cells[p] >= least[p] || is_busy[p]) continue;
    const auto most = std::max_element(rims[p].begin(), rims[p].end(),
                                       [](auto& a, auto& b) { return a.second < b.second; });
    if (most == rims[p].end()) continue;
    const auto other = static_cast<std::size_t>(most->first);
    if (is_busy[other]) continue;
    to[p] = most->first, is_busy[p] = is_busy[other] = 1, has_joined = true;
    cells[other] += cells[p], cells[p] = 0;
  }
  for (int& p : part)
    if (p >= 0) p = to[static_cast<std::size_t>(p)];
  return has_joined;
}

ClosedSides party_walls_of(const HeightMap& map, const SceneClasses& classes) {
  std::vector<std::vector<std::size_t>> cells(static_cast<std::size_t>(classes.buildings));
  for (std::size_t i = 0; i < map.size(); ++i)
    if (const int b = classes.building[i]; b >= 0) cells[static_cast<std::size_t>(b)].push_back(i);
  ClosedSides closed{std::vector<char>(map.size(), 0), std::vector<char>(map.size(), 0)};
  const auto borders = borders_of(map, classes.building, classes.buildings);
  for (std::size_t b = 0; b < cells.size(); ++b) {
    const double area = static_cast<double>(cells[b].size()) * map.cell * map.cell;
    if (area < kLeastPair) continue;
    const auto longest = std::max_element(borders[b].begin(), borders[b].end(),
                                          [](auto& u, auto& v) { return u.size() < v.size(); });
    const Ring ring = with_fewer_corners(map, *longest);
    if (ring.size() < 3) continue;
    for (const PartyWall& wall :
         find_party_walls(map, classes.building, cells[b], main_direction(ring)))
      shut(map, wall, closed);
  }
  return closed;
}

}  // namespace

void part_rows(const HeightMap& map, SceneClasses& classes) {
  std::vector<int> cells;
  std::vector<int> part =
      parts_of(map, part_at_tints(map, classes.building), party_walls_of(map, classes), cells);
  const std::vector<double> least = least_houses(map, classes.building, part, cells.size());
  for (int round = 0; round < kJoinRounds; ++round)
    if (!join_least(map, classes.building, least, part, cells)) break;
  classes.building = std::move(part);
  classes.buildings = renumber(classes.building);
}

}  // namespace colod
