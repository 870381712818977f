// Based on: distances in steps of 3 and 4 (G. Borgefors, Distance transformations in digital
// images, 1986).
#include <algorithm>
#include <numeric>

#include "classes.h"
#include "parameters.h"
#include "patches.h"

namespace colod {

namespace {

using namespace parameters::annexes;

constexpr int kAlong = 3, kAslant = 4;  // from a cell to the next, in thirds of a cell

/// How far each cell of a building is from the nearest that is not of it, from middle to middle;
/// the map's rim is nobody's.
std::vector<int> depths_of(const HeightMap& map, const std::vector<int>& building) {
  std::vector<int> depth(map.size(), 0);
  const auto pass = [&](int x, int y, int back) {
    const std::size_t i = map.at(x, y);
    const auto by = [&](int dx, int dy, int step) {
      const int u = x + back * dx, v = y + back * dy;
      const bool is_own = u >= 0 && v >= 0 && u < map.width && v < map.height &&
                          building[map.at(u, v)] == building[i];
      return step + (is_own ? depth[map.at(u, v)] : 0);
    };
    return std::min(
        {by(-1, 0, kAlong), by(0, -1, kAlong), by(-1, -1, kAslant), by(1, -1, kAslant)});
  };
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      if (building[map.at(x, y)] >= 0) depth[map.at(x, y)] = pass(x, y, 1);
  for (int y = map.height - 1; y >= 0; --y)
    for (int x = map.width - 1; x >= 0; --x)
      if (const std::size_t i = map.at(x, y); building[i] >= 0)
        depth[i] = std::min(depth[i], pass(x, y, -1));
  return depth;
}

/// Per building how wide it is where it is widest; metres.
std::vector<double> widths_of(const HeightMap& map, const std::vector<int>& building,
                              std::size_t buildings) {
  const std::vector<int> depth = depths_of(map, building);
  std::vector<double> width(buildings, 0);
  for (std::size_t i = 0; i < map.size(); ++i)
    if (building[i] >= 0) {
      double& most = width[static_cast<std::size_t>(building[i])];
      most = std::max(most, (2.0 * depth[i] / kAlong - 1) * map.cell);
    }
  return width;
}

/// Per building the mean height over the ground; metres.
std::vector<double> mean_heights_of(const HeightMap& map, const SceneClasses& classes,
                                    const std::vector<double>& cells) {
  std::vector<double> height(cells.size(), 0);
  for (std::size_t i = 0; i < map.size(); ++i)
    if (const int b = classes.building[i]; b >= 0)
      height[static_cast<std::size_t>(b)] += map.top[i] - classes.ground[i];
  for (std::size_t b = 0; b < cells.size(); ++b) height[b] /= cells[b];
  return height;
}

/// Per building what becomes of its cells: the building that they are part of, mostly itself; −1:
/// none.
std::vector<int> fates_of(const HeightMap& map, const SceneClasses& classes) {
  const std::vector<double> cells = cells_of(classes.building);
  const std::vector<double> width = widths_of(map, classes.building, cells.size());
  const std::vector<double> height = mean_heights_of(map, classes, cells);
  const Rims rims = rims_of(map, classes.building);
  std::vector<int> fate(cells.size());
  std::iota(fate.begin(), fate.end(), 0);
  for (std::size_t b = 0; b < cells.size(); ++b) {
    if (width[b] > kAnnexWidth) continue;
    int all = 0, most = 0, to = -1;
    for (const auto& [other, count] : rims[b]) {
      all += count;
      if (other >= 0 && count > most) most = count, to = other;
    }
    if (to < 0 || most < kLeaning * all) continue;
    const auto host = static_cast<std::size_t>(to);
    if (cells[b] < kAnnexShare * cells[host])
      fate[b] = height[b] > kAnnexHeight * height[host] ? to : -1;
  }
  return fate;
}

}  // namespace

void settle_annexes(const HeightMap& map, SceneClasses& classes) {
  if (!map.told.empty()) return;
  for (int round = 0; round < kAnnexRounds; ++round) {
    const std::vector<int> fate = fates_of(map, classes);
    for (std::size_t i = 0; i < map.size(); ++i) {
      int& b = classes.building[i];
      if (b < 0) continue;
      b = fate[static_cast<std::size_t>(b)];
      if (b < 0) classes.of_cell[i] = SceneClass::kRest;
    }
    const int before = classes.buildings;
    classes.buildings = renumber(classes.building);
    if (classes.buildings == before) return;
  }
}

}  // namespace colod
