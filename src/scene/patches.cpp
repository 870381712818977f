// Based on: opening and growing back (P. Soille, Morphological Image Analysis, 2003).
// Differs: within regions that are known; what is too small to be a patch goes to whichever reaches
// it first.
#include "patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "parameters.h"

namespace colod {

namespace {

using namespace parameters::patches;

using Tint = std::array<double, 3>;  // 0..255

double area_of(const HeightMap& map, double cells) { return cells * map.cell * map.cell; }

/// Neighbours along rows and columns, of the same region.
template <typename Body>
void for_each_beside(const HeightMap& map, const std::vector<int>& region, std::size_t i,
                     Body body) {
  for_each_neighbour(map, i, [&](std::size_t j) {
    if (region[j] == region[i]) body(j);
  });
}

/// Cells that are in with all of the eight around them, of the same region.
std::vector<char> shrunk(const HeightMap& map, const std::vector<int>& region,
                         const std::vector<char>& is_in) {
  std::vector<char> out(map.size(), 0);
  for (int y = 1; y + 1 < map.height; ++y)
    for (int x = 1; x + 1 < map.width; ++x) {
      const std::size_t i = map.at(x, y);
      bool has_all = is_in[i];
      for (int v = y - 1; v <= y + 1 && has_all; ++v)
        for (int u = x - 1; u <= x + 1 && has_all; ++u) {
          const std::size_t j = map.at(u, v);
          has_all = is_in[j] && region[j] == region[i];
        }
      out[i] = has_all;
    }
  return out;
}

/// Numbers the connected cores of at least so many cells; −1: none.
std::vector<int> number_cores(const HeightMap& map, const std::vector<int>& region,
                              const std::vector<char>& is_core, double least) {
  std::vector<int> core =
      connect(map, is_core, [&](std::size_t i, std::size_t j) { return region[i] == region[j]; });
  const std::vector<double> cells = cells_of(core);
  for (int& c : core)
    if (c >= 0 && cells[static_cast<std::size_t>(c)] < least) c = -1;
  return core;
}

/// Cores grow over the rest of their region, one ring after the other; a region without a core is
/// one patch.
std::vector<int> grown(const HeightMap& map, const std::vector<int>& region,
                       const std::vector<char>& is_core, double least) {
  std::vector<int> core = number_cores(map, region, is_core, least);
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < map.size(); ++i)
    if (core[i] >= 0) open.push_back(i);
  for (std::size_t n = 0; n < open.size(); ++n)
    for_each_beside(map, region, open[n], [&](std::size_t j) {
      if (core[j] < 0) core[j] = core[open[n]], open.push_back(j);
    });
  std::map<std::pair<int, int>, int> number;
  std::vector<int> patch(map.size(), -1);
  for (std::size_t i = 0; i < map.size(); ++i)
    if (region[i] >= 0)
      patch[i] =
          number.try_emplace({region[i], core[i]}, static_cast<int>(number.size())).first->second;
  return patch;
}

/// Where colours change. Keeps references to both.
class Tints {
 public:
  Tints(const HeightMap& map, const std::vector<int>& region) : map_(map), region_(region) {}

  /// Whether the colour changes across a cell, from `step` cells before it to as many behind, on a
  /// surface that goes straight on.
  bool changes(int x, int y, int dx, int dy, int step) const {
    const int ax = x - dx * step, ay = y - dy * step, bx = x + dx * step, by = y + dy * step;
    if (!holds(ax, ay) || !holds(bx, by)) return false;
    const std::size_t a = map_.at(ax, ay), b = map_.at(bx, by);
    const int own = region_[map_.at(x, y)];
    if (region_[a] != own || region_[b] != own) return false;
    return differ(mean_about(ax, ay), mean_about(bx, by)) &&
           !bends(x, y, 2 * dx * step, 2 * dy * step);
  }

 private:
  bool holds(int x, int y) const { return x >= 0 && y >= 0 && x < map_.width && y < map_.height; }

  Tint mean_about(int x, int y) const {
    Tint sum = {0, 0, 0};
    int count = 0;
    for (int v = y - 1; v <= y + 1; ++v)
      for (int u = x - 1; u <= x + 1; ++u) {
        if (!holds(u, v) || region_[map_.at(u, v)] != region_[map_.at(x, y)]) continue;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += map_.color[map_.at(u, v)][c];
        ++count;
      }
    for (double& channel : sum) channel /= count;
    return sum;
  }

  /// By light, or by hue, which shade changes little.
  static bool differ(const Tint& a, const Tint& b) {
    const double la = (a[0] + a[1] + a[2]) / 3, lb = (b[0] + b[1] + b[2]) / 3;
    if (std::abs(la - lb) > kLight) return true;
    double hue = 0;
    for (std::size_t c = 0; c < 3; ++c)
      hue = std::max(hue, std::abs((a[c] - la) / (la + kDark) - (b[c] - lb) / (lb + kDark)));
    return hue > kHue;
  }

  /// Whether the slope changes; not known at the map's rim: it does.
  bool bends(int x, int y, int dx, int dy) const {
    if (!holds(x - dx, y - dy) || !holds(x + dx, y + dy)) return true;
    const double change = map_.top[map_.at(x - dx, y - dy)] - 2 * map_.top[map_.at(x, y)] +
                          map_.top[map_.at(x + dx, y + dy)];
    return !(std::abs(change) < kBend * std::hypot(dx, dy) * map_.cell);
  }

  const HeightMap& map_;
  const std::vector<int>& region_;
};

/// A region that changes its colour on too many cells has no patches: its colours are noise.
void keep_motley(const std::vector<int>& region, const std::vector<double>& cells,
                 std::vector<char>& is_core) {
  std::vector<double> calm(cells.size(), 0);
  for (std::size_t i = 0; i < region.size(); ++i)
    if (region[i] >= 0) calm[static_cast<std::size_t>(region[i])] += is_core[i];
  for (std::size_t i = 0; i < region.size(); ++i) {
    if (region[i] < 0) continue;
    const auto r = static_cast<std::size_t>(region[i]);
    if (calm[r] < kLeastCalm * cells[r]) is_core[i] = 1;
  }
}

}  // namespace

Rims rims_of(const HeightMap& map, const std::vector<int>& region) {
  Rims rims;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (region[i] < 0) continue;
    const auto own = static_cast<std::size_t>(region[i]);
    if (own >= rims.size()) rims.resize(own + 1);
    for_each_neighbour(map, i, [&](std::size_t j) {
      if (region[j] != region[i]) ++rims[own][region[j]];
    });
  }
  return rims;
}

std::vector<int> part_at_necks(const HeightMap& map, const std::vector<int>& region) {
  if (region.empty()) return {};  // cells of an empty map have no size
  std::vector<char> is_core(map.size());
  for (std::size_t i = 0; i < map.size(); ++i) is_core[i] = region[i] >= 0;
  const int rings = static_cast<int>(kNeck / map.cell / 2);
  for (int k = 0; k < rings; ++k) is_core = shrunk(map, region, is_core);
  return grown(map, region, is_core, kLeastCore / area_of(map, 1));
}

std::vector<int> part_at_tints(const HeightMap& map, const std::vector<int>& region) {
  std::vector<char> is_core(map.size());
  for (std::size_t i = 0; i < map.size(); ++i) is_core[i] = region[i] >= 0;
  if (map.color.empty() || map.is_sharp) return grown(map, region, is_core, 0);
  const std::vector<double> cells = cells_of(region);
  const Tints tints(map, region);
  const int step = std::max(1, static_cast<int>(std::lround(kTintStep / map.cell)));
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const std::size_t i = map.at(x, y);
      if (region[i] < 0 || area_of(map, cells[static_cast<std::size_t>(region[i])]) < kLeastTinted)
        continue;
      is_core[i] = !tints.changes(x, y, 1, 0, step) && !tints.changes(x, y, 0, 1, step);
    }
  keep_motley(region, cells, is_core);
  return grown(map, region, shrunk(map, region, is_core), kLeastPatch / area_of(map, 1));
}

std::vector<double> cells_of(const std::vector<int>& region) {
  std::vector<double> cells;
  for (const int r : region) {
    if (r < 0) continue;
    if (static_cast<std::size_t>(r) >= cells.size()) cells.resize(static_cast<std::size_t>(r) + 1);
    ++cells[static_cast<std::size_t>(r)];
  }
  return cells;
}

int renumber(std::vector<int>& region) {
  std::map<int, int> number;
  for (int& r : region)
    if (r >= 0) r = number.try_emplace(r, static_cast<int>(number.size())).first->second;
  return static_cast<int>(number.size());
}

}  // namespace colod
