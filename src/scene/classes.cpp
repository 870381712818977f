// Based on: height over ground, planarity and greenness as airborne mapping uses them (F.
// Rottensteiner et al., ISPRS benchmark, 2014).
// Differs: decided for patches of even surface, which trees fall apart into, and not for cells; a
// block is parted where its patches lie at different heights.
#include "classes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>

#include "core/union_find.h"
#include "flatness.h"
#include "parameters.h"
#include "patches.h"
#include "terrain.h"

namespace colod {

namespace {

using namespace parameters::classes;

/// −1 … 1: how much green stands out of a colour's own brightness.
float greenness(const Rgb& rgb) {
  const float r = rgb[0], g = rgb[1], b = rgb[2], all = r + g + b;
  return all > 0 ? (2 * g - r - b) / all : 0;
}

/// The sum over a square window about each cell, of cells that count.
class WindowMean {
 public:
  WindowMean(const HeightMap& map, int radius) : map_(map), radius_(radius) {}

  /// NaN where no cell of the window counts.
  std::vector<float> operator()(const std::vector<float>& values) const {
    const auto w = static_cast<std::size_t>(map_.width) + 1;
    std::vector<double> sums(w * (static_cast<std::size_t>(map_.height) + 1), 0), counts = sums;
    for (int y = 0; y < map_.height; ++y)
      for (int x = 0; x < map_.width; ++x) {
        const float v = values[map_.at(x, y)];
        const std::size_t to =
            (static_cast<std::size_t>(y) + 1) * w + static_cast<std::size_t>(x) + 1;
        const bool is_known = !std::isnan(v);
        sums[to] = (is_known ? v : 0) + sums[to - 1] + sums[to - w] - sums[to - w - 1];
        counts[to] = is_known + counts[to - 1] + counts[to - w] - counts[to - w - 1];
      }
    std::vector<float> out(values.size(), NAN);
    for (int y = 0; y < map_.height; ++y)
      for (int x = 0; x < map_.width; ++x) {
        const auto x0 = static_cast<std::size_t>(std::max(0, x - radius_)),
                   y0 = static_cast<std::size_t>(std::max(0, y - radius_)),
                   x1 = static_cast<std::size_t>(std::min(map_.width, x + radius_ + 1)),
                   y1 = static_cast<std::size_t>(std::min(map_.height, y + radius_ + 1));
        const auto over = [&](const std::vector<double>& all) {
          return all[y1 * w + x1] - all[y0 * w + x1] - all[y1 * w + x0] + all[y0 * w + x0];
        };
        if (const double count = over(counts); count > 0.5)
          out[map_.at(x, y)] = static_cast<float>(over(sums) / count);
      }
    return out;
  }

 private:
  const HeightMap& map_;
  int radius_;
};

float part(float value, double from, double to) {
  return std::clamp(static_cast<float>((value - from) / (to - from)), 0.0f, 1.0f);
}

Flatness flatness_over(const HeightMap& map, double window) {
  return measure_flatness(map, static_cast<int>(std::lround(window / map.cell / 2)));
}

/// Where something stands: 0 like a roof … 1 like a tree; NaN where nothing does.
std::vector<float> plantness(const HeightMap& map, const std::vector<float>& ground,
                             const Flatness& narrow) {
  const Flatness wide = flatness_over(map, kWindow), least = flatness_over(map, kLeastWindow);
  const auto times = [](double factor, float roughness) {
    return static_cast<float>(factor) * roughness;
  };
  std::vector<float> out(map.size(), NAN);
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (!(map.top[i] - ground[i] > kLow)) continue;
    const bool is_green = !map.color.empty() && greenness(map.color[i]) > kGrey;
    const float rough = is_green
                            ? wide.roughness[i]
                            : std::min({wide.roughness[i], times(kNarrowTimes, narrow.roughness[i]),
                                        times(kLeastTimes, least.roughness[i])});
    out[i] = static_cast<float>(kRoughWeight) * part(rough, kEven, kUneven);
    if (!map.color.empty())
      out[i] += static_cast<float>(kGreenWeight) * part(greenness(map.color[i]), kGrey, kGreen);
  }
  return WindowMean(map, static_cast<int>(std::lround(kCalm / map.cell / 2)))(out);
}

/// What a source tells is as sure as can be; where it tells buildings, nothing else is one.
void believe(const HeightMap& map, std::vector<float>& plant) {
  const bool has_buildings =
      std::find(map.told.begin(), map.told.end(), SceneClass::kBuilding) != map.told.end();
  for (std::size_t i = 0; i < map.told.size(); ++i) {
    if (map.told[i] == SceneClass::kBuilding)
      plant[i] = 0;
    else if (has_buildings || map.told[i] == SceneClass::kPlant)
      plant[i] = 1;
  }
}

/// Of what stands and is no building.
SceneClass class_beside(const HeightMap& map, const std::vector<float>& plant, std::size_t i) {
  if (!map.told.empty() && map.told[i] == SceneClass::kRest) return SceneClass::kRest;
  return plant[i] >= kRoof ? SceneClass::kPlant : SceneClass::kRest;
}

/// How much higher one of two neighbours is than the slope of what they lie on makes it: steep
/// roofs have no steps. Keeps references to both.
class RoofSteps {
 public:
  RoofSteps(const HeightMap& map, const Flatness& narrow) : map_(map), narrow_(narrow) {}

  /// Of the second over the first; metres.
  double rise(std::size_t i, std::size_t j) const {
    const double step = map_.top[j] - map_.top[i];
    const double slope = std::max(slope_at(i, j), slope_at(j, i));
    return std::copysign(std::max(0.0, std::abs(step) - slope), step);
  }

 private:
  bool is_row(std::size_t i, std::size_t j) const {
    const auto w = static_cast<std::size_t>(map_.width);
    return i / w == j / w;
  }

  /// Metres that the surface at a cell rises or falls towards its neighbour.
  double slope_at(std::size_t i, std::size_t j) const {
    if (map_.is_sharp) return slope_beyond(i, j);
    if (!(narrow_.roughness[i] < kSmooth)) return 0;
    const double slope = std::abs(is_row(i, j) ? narrow_.slope_x[i] : narrow_.slope_y[i]);
    return std::min(slope, kSteepestRoof) * map_.cell;
  }

  /// From a cell to the one on its side away from the neighbour; where there is none, nothing.
  double slope_beyond(std::size_t from, std::size_t to) const {
    const auto w = static_cast<std::size_t>(map_.width);
    const std::size_t beyond = 2 * from - to;  // huge where there is none
    if (beyond >= map_.size() || (is_row(from, to) && beyond / w != from / w)) return 0;
    const double slope = std::abs(map_.top[from] - map_.top[beyond]);
    return slope > 0 ? slope : 0;
  }

  const HeightMap& map_;
  const Flatness& narrow_;
};

/// Whether a cell lies well below one beside it: part of a melted wall.
bool is_on_wall(const HeightMap& map, const RoofSteps& steps, std::size_t i) {
  bool is_low = false;
  for_each_neighbour(map, i, [&](std::size_t j) { is_low |= steps.rise(i, j) > kWallStep; });
  return is_low;
}

/// Regions of cells that were told apart.
struct Regions {
  std::vector<int> of_cell;  ///< −1: none
  std::vector<double> cells;
};

/// All cells that are in and touch.
Regions blocks_of(const HeightMap& map, const std::vector<char>& is_in) {
  Regions out{connect(map, is_in, [](std::size_t, std::size_t) { return true; }), {}};
  out.cells = cells_of(out.of_cell);
  return out;
}

/// Cells beside a region at its height join it, a ring: those at the foot of a higher roof.
void take_rim(const HeightMap& map, const std::vector<char>& is_open, Regions& regions) {
  const std::vector<int> before = regions.of_cell;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (before[i] >= 0 || !is_open[i]) continue;
    float least = static_cast<float>(kStep);
    for_each_neighbour(map, i, [&](std::size_t j) {
      const float step = std::abs(map.top[i] - map.top[j]);
      if (before[j] >= 0 && step < least) least = step, regions.of_cell[i] = before[j];
    });
    if (regions.of_cell[i] >= 0) ++regions.cells[static_cast<std::size_t>(regions.of_cell[i])];
  }
}

/// Small regions, and those that another one mostly surrounds, join the one that they touch most,
/// until none does.
void join_small(const HeightMap& map, Regions& regions) {
  for (int round = 0; round < kRounds; ++round) {
    const Rims rims = rims_of(map, regions.of_cell);
    UnionFind sets(rims.size());
    bool has_changed = false;
    for (std::size_t r = 0; r < rims.size(); ++r) {
      int all = 0, most = 0, to = -1;
      for (const auto& [other, count] : rims[r]) {
        all += count;
        if (other >= 0 && count > most) most = count, to = other;
      }
      if (to < 0) continue;
      const double area = regions.cells[r] * map.cell * map.cell;
      const bool is_small = area < kLeastRoof && most > kTouching * all;
      const bool is_held = most > kSurrounded * all &&
                           regions.cells[r] < regions.cells[static_cast<std::size_t>(to)];
      if (!is_small && !is_held) continue;
      sets.unite(static_cast<int>(r), to);
      has_changed = true;
    }
    if (!has_changed) return;
    std::map<int, int> number;
    std::vector<double> cells;
    for (int& r : regions.of_cell) {
      if (r < 0) continue;
      const auto [at, is_new] = number.try_emplace(sets.find(r), static_cast<int>(cells.size()));
      if (is_new) cells.push_back(0);
      r = at->second;
      ++cells[static_cast<std::size_t>(r)];
    }
    regions.cells = std::move(cells);
  }
}

/// Per region the height over the ground that a share of its cells lies below.
std::vector<float> heights_of(const HeightMap& map, const std::vector<float>& ground,
                              const Regions& regions, double share) {
  std::vector<std::vector<float>> all(regions.cells.size());
  for (std::size_t i = 0; i < map.size(); ++i)
    if (regions.of_cell[i] >= 0)
      all[static_cast<std::size_t>(regions.of_cell[i])].push_back(map.top[i] - ground[i]);
  std::vector<float> out;
  for (std::vector<float>& h : all) {
    const auto at = h.begin() + static_cast<long>(share * static_cast<double>(h.size() - 1));
    std::nth_element(h.begin(), at, h.end());
    out.push_back(*at);
  }
  return out;
}

/// Cells whose whole square window is in, and then all that such a window covers.
std::vector<char> opened(const HeightMap& map, const std::vector<char>& is_in, int radius) {
  const auto pass = [&](const std::vector<char>& from, bool is_shrinking) {
    std::vector<float> values(from.begin(), from.end());
    const std::vector<float> mean = WindowMean(map, radius)(values);
    std::vector<char> out(from.size());
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = is_shrinking ? mean[i] > 0.999f : mean[i] > 0.001f;
    return out;
  };
  return pass(pass(is_in, true), false);
}

/// Per region whether a square so wide fits into what the regions cover, about one of its cells;
/// what a source tells is as wide as it likes.
std::vector<char> wide_ones(const HeightMap& map, const Regions& regions, double width) {
  std::vector<char> is_in(map.size()), is_wide(regions.cells.size(), 0);
  for (std::size_t i = 0; i < map.size(); ++i) is_in[i] = regions.of_cell[i] >= 0;
  const std::vector<char> wide =
      opened(map, is_in, static_cast<int>(std::lround(width / map.cell / 2)));
  for (std::size_t i = 0; i < map.size(); ++i) {
    const bool is_told = !map.told.empty() && map.told[i] == SceneClass::kBuilding;
    if (is_in[i] && (wide[i] || is_told)) is_wide[static_cast<std::size_t>(regions.of_cell[i])] = 1;
  }
  return is_wide;
}

/// Per region the number of the building that it is, counted on from `buildings`; −1: it is too
/// small, low or narrow.
std::vector<int> number_buildings(const HeightMap& map, const std::vector<float>& ground,
                                  const Regions& regions, int& buildings) {
  const std::vector<float> heights = heights_of(map, ground, regions, kHeightShare);
  const std::vector<char> is_wide = wide_ones(map, regions, kHouseWidth),
                          is_shed = wide_ones(map, regions, kShedWidth);
  std::vector<int> number(regions.cells.size(), -1);
  for (std::size_t r = 0; r < number.size(); ++r) {
    const double area = regions.cells[r] * map.cell * map.cell;
    if (area > kLeastBuilding && heights[r] > kLeastHeight &&
        (is_wide[r] || (is_shed[r] && area < kLargestShed)))
      number[r] = buildings++;
  }
  return number;
}

/// What stands right beside a building is its parapets and melted walls, down to half its height:
/// it joins the one whose height is nearest.
void take_walls(const HeightMap& map, const std::vector<float>& ground,
                const std::vector<char>& is_open, std::vector<int>& building) {
  for (int round = 0; round < kWallRounds; ++round) {
    const std::vector<int> before = building;
    for (std::size_t i = 0; i < map.size(); ++i) {
      if (before[i] >= 0 || !is_open[i]) continue;
      float least = map.top[i] - ground[i];
      for_each_neighbour(map, i, [&](std::size_t j) {
        const float step = std::abs(map.top[i] - map.top[j]);
        if (before[j] >= 0 && step < least) least = step, building[i] = before[j];
      });
    }
  }
}

/// Tanks, stairs, washing lines: what is not green and lies amid roofs is a part of them, however
/// rough it is.
void take_clutter(const HeightMap& map, const std::vector<char>& stands,
                  std::vector<int>& building) {
  std::vector<char> is_in(map.size(), 0);
  for (std::size_t i = 0; i < map.size(); ++i)
    is_in[i] = stands[i] && building[i] < 0 &&
               (map.color.empty() || part(greenness(map.color[i]), kGrey, kGreen) < kRoof);
  const Regions regions = blocks_of(map, is_in);
  std::vector<std::map<int, int>> rims(regions.cells.size());  // by building
  for (std::size_t i = 0; i < map.size(); ++i)
    if (const int own = regions.of_cell[i]; own >= 0)
      for_each_neighbour(map, i, [&](std::size_t j) {
        if (regions.of_cell[j] != own) ++rims[static_cast<std::size_t>(own)][building[j]];
      });
  std::vector<int> joined(regions.cells.size(), -1);
  for (std::size_t r = 0; r < rims.size(); ++r) {
    int all = 0, built = 0, most = 0;
    for (const auto& [to, count] : rims[r]) {
      all += count;
      if (to < 0) continue;
      built += count;
      if (count > most) most = count, joined[r] = to;
    }
    if (built < kAmid * all) joined[r] = -1;
  }
  for (std::size_t i = 0; i < map.size(); ++i)
    if (regions.of_cell[i] >= 0) building[i] = joined[static_cast<std::size_t>(regions.of_cell[i])];
}

/// Per block the share of what is around it, kAround metres off, that is leaves.
std::vector<double> leafy_rims(const HeightMap& map, const std::vector<char>& stands,
                               const Regions& blocks) {
  std::vector<double> rim(blocks.cells.size(), 0), leafy = rim;
  const int off = std::max(1, static_cast<int>(std::lround(kAround / map.cell)));
  for (int y = off; y + off < map.height; ++y)
    for (int x = off; x + off < map.width; ++x) {
      const int block = blocks.of_cell[map.at(x, y)];
      if (block < 0) continue;
      for (const auto& [u, v] : {std::pair{x - off, y}, {x + off, y}, {x, y - off}, {x, y + off}}) {
        const std::size_t j = map.at(u, v);
        if (blocks.of_cell[j] >= 0) continue;
        ++rim[static_cast<std::size_t>(block)];
        leafy[static_cast<std::size_t>(block)] += stands[j] && greenness(map.color[j]) > kGrey;
      }
    }
  for (std::size_t b = 0; b < rim.size(); ++b) leafy[b] /= std::max(1.0, rim[b]);
  return leafy;
}

/// Trees are smooth where they were seen badly: what stands alone, has leaves around it, and is as
/// green as they, or no larger than a crown and has no roof's colour, is one. For maps with
/// colours.
void drop_crowns(const HeightMap& map, const std::vector<char>& stands, std::vector<float>& plant,
                 std::vector<int>& building) {
  std::vector<char> is_in(map.size());
  for (std::size_t i = 0; i < map.size(); ++i) is_in[i] = building[i] >= 0;
  const Regions blocks = blocks_of(map, is_in);
  const std::vector<double> leafy = leafy_rims(map, stands, blocks);
  std::vector<double> green(leafy.size(), 0);
  for (std::size_t i = 0; i < map.size(); ++i)
    if (const int b = blocks.of_cell[i]; b >= 0)
      green[static_cast<std::size_t>(b)] +=
          greenness(map.color[i]) / blocks.cells[static_cast<std::size_t>(b)];
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (!is_in[i]) continue;
    const auto b = static_cast<std::size_t>(blocks.of_cell[i]);
    const bool is_crown = blocks.cells[b] * map.cell * map.cell < kLargestCrown;
    if (leafy[b] > kLeafy && green[b] > (is_crown ? kGreenish : kLeafGreen))
      building[i] = -1, plant[i] = 1;
  }
}

}  // namespace

SceneClasses classify(const HeightMap& map) {
  SceneClasses out;
  out.ground = find_terrain(map);
  const Flatness narrow = flatness_over(map, kNarrowWindow);
  const RoofSteps steps(map, narrow);
  std::vector<float> plant = plantness(map, out.ground, narrow);
  believe(map, plant);
  std::vector<char> stands(map.size(), 0), is_open = stands, is_roof = stands;
  for (std::size_t i = 0; i < map.size(); ++i) {
    stands[i] = map.top[i] - out.ground[i] > kLow;
    is_open[i] = stands[i] && plant[i] < kRoof;
    is_roof[i] = is_open[i] && !is_on_wall(map, steps, i);
  }
  is_roof = opened(map, is_roof, static_cast<int>(std::lround(kNarrow / map.cell / 2)));
  for (std::size_t i = 0; i < map.told.size(); ++i)
    if (map.told[i] == SceneClass::kBuilding) is_roof[i] = is_open[i];
  const std::vector<int> level = connect(map, is_roof, [&](std::size_t i, std::size_t j) {
    return std::abs(steps.rise(i, j)) < kStep;
  });
  Regions regions{part_at_necks(map, level), {}};
  regions.cells = cells_of(regions.of_cell);
  for (int round = 0; round < kRimRounds; ++round) take_rim(map, is_open, regions);
  join_small(map, regions);
  const std::vector<int> number = number_buildings(map, out.ground, regions, out.buildings);
  out.of_cell.assign(map.size(), SceneClass::kNothing);
  out.building.assign(map.size(), -1);
  for (std::size_t i = 0; i < map.size(); ++i)
    if (const int r = regions.of_cell[i]; r >= 0)
      out.building[i] = number[static_cast<std::size_t>(r)];
  take_walls(map, out.ground, is_open, out.building);
  if (map.told.empty()) {
    take_clutter(map, stands, out.building);
    if (!map.color.empty()) drop_crowns(map, stands, plant, out.building);
    out.buildings = renumber(out.building);
  }
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (std::isnan(map.top[i])) continue;
    out.of_cell[i] = out.building[i] >= 0 ? SceneClass::kBuilding
                     : !stands[i]         ? SceneClass::kGround
                                          : class_beside(map, plant, i);
  }
  return out;
}

}  // namespace colod
