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

/// Per building the one that it is an annex of, or itself.
std::vector<int> hosts_of(const HeightMap& map, const std::vector<int>& building) {
  const std::vector<double> cells = cells_of(building);
  const std::vector<double> width = widths_of(map, building, cells.size());
  const Rims rims = rims_of(map, building);
  std::vector<int> host(cells.size());
  std::iota(host.begin(), host.end(), 0);
  for (std::size_t b = 0; b < cells.size(); ++b) {
    if (width[b] > kAnnexWidth) continue;
    int all = 0, most = 0, to = -1;
    for (const auto& [other, count] : rims[b]) {
      all += count;
      if (other >= 0 && count > most) most = count, to = other;
    }
    if (most > kLeaning * all && cells[b] < kAnnexShare * cells[static_cast<std::size_t>(to)])
      host[b] = to;
  }
  return host;
}

}  // namespace

void join_annexes(const HeightMap& map, SceneClasses& classes) {
  for (int round = 0; round < kAnnexRounds; ++round) {
    const std::vector<int> host = hosts_of(map, classes.building);
    for (int& b : classes.building)
      if (b >= 0) b = host[static_cast<std::size_t>(b)];
    const int before = classes.buildings;
    classes.buildings = renumber(classes.building);
    if (classes.buildings == before) return;
  }
}

}  // namespace colod
