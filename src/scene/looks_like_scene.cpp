// Based on: own work: a building, however large its plot, is one group of roofs.
#include "looks_like_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "border.h"
#include "classes.h"
#include "core/drawn.h"
#include "parameters.h"
#include "survey.h"

namespace colod {

namespace {

using namespace parameters::whole_place;

HeightMap height_map_of(const Source& source, const Box& box) {
  HeightMap map;
  const Vec3 size = box.size();
  map.cell = std::max(parameters::survey::kCell, std::sqrt(size.x() * size.y() / kMostCellsOfPlan));
  map.origin = box.min.head<2>();
  map.width = static_cast<int>(std::ceil(size.x() / map.cell)) + 1;
  map.height = static_cast<int>(std::ceil(size.y() / map.cell)) + 1;
  map.top.assign(static_cast<std::size_t>(map.width) * map.height, NAN);
  map.color.assign(map.top.size(), Rgb{});
  Source bare;
  bare.mesh = source.mesh;
  draw_from_above(bare, ImageCache(0), map);
  map.color.clear();
  return map;
}

/// Cells of buildings that hang together, whatever parts them by height.
struct Group {
  double area = 0;                  ///< m²
  double outline = 0;               ///< metres
  std::array<double, 4> cut_off{};  ///< metres where the surface ends at its roof, by side
};

/// Of the box of the plan, the one that a cell lies nearest to: −x, +x, −y, +y.
std::size_t side_of(const HeightMap& map, int x, int y) {
  const std::array<int, 4> to = {x, map.width - 1 - x, y, map.height - 1 - y};
  return static_cast<std::size_t>(std::min_element(to.begin(), to.end()) - to.begin());
}

SceneClass class_at(const HeightMap& map, const SceneClasses& classes, int x, int y) {
  const bool is_outside = x < 0 || y < 0 || x >= map.width || y >= map.height;
  return is_outside ? SceneClass::kNothing : classes.of_cell[map.at(x, y)];
}

/// Whether one of the four cells about it is, or is not, of a class.
bool touches(const HeightMap& map, const SceneClasses& classes, int x, int y, SceneClass c,
             bool is_it) {
  return (class_at(map, classes, x - 1, y) == c) == is_it ||
         (class_at(map, classes, x + 1, y) == c) == is_it ||
         (class_at(map, classes, x, y - 1) == c) == is_it ||
         (class_at(map, classes, x, y + 1) == c) == is_it;
}

std::vector<Group> groups_of(const HeightMap& map, const SceneClasses& classes,
                             const std::vector<char>& ends) {
  std::vector<Group> groups;
  std::vector<char> is_done(map.size(), 0);
  std::vector<int> open;
  for (std::size_t first = 0; first < map.size(); ++first) {
    if (is_done[first] || classes.of_cell[first] != SceneClass::kBuilding) continue;
    Group& group = groups.emplace_back();
    open.push_back(static_cast<int>(first));
    is_done[first] = 1;
    while (!open.empty()) {
      const int x = open.back() % map.width, y = open.back() / map.width;
      open.pop_back();
      group.area += map.cell * map.cell;
      if (touches(map, classes, x, y, SceneClass::kBuilding, false)) group.outline += map.cell;
      if (ends[map.at(x, y)] && touches(map, classes, x, y, SceneClass::kNothing, true))
        group.cut_off[side_of(map, x, y)] += map.cell;
      for (int v = std::max(0, y - kTogether); v <= std::min(map.height - 1, y + kTogether); ++v)
        for (int u = std::max(0, x - kTogether); u <= std::min(map.width - 1, x + kTogether); ++u) {
          const std::size_t next = map.at(u, v);
          if (is_done[next] || classes.of_cell[next] != SceneClass::kBuilding) continue;
          is_done[next] = 1;
          open.push_back(static_cast<int>(next));
        }
    }
  }
  return groups;
}

/// A house of which the border cuts off so much that it is not told from another one's corner or a
/// tree beside it.
bool is_cut_off(const Group& group) {
  const auto& cut = group.cut_off;
  return group.area >= kLeastHouse && *std::max_element(cut.begin(), cut.end()) >= kLeastCut &&
         std::accumulate(cut.begin(), cut.end(), 0.0) >= kCutOff * group.outline;
}

/// 0..1 of the cells on the border of what is covered.
struct Rim {
  double ground = 0;
  double at_top = 0;  ///< the surface ends there at its top, and not at the foot of a wall
};

Rim rim_of(const HeightMap& map, const SceneClasses& classes, const std::vector<char>& ends) {
  Rim rim;
  double cells = 0;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const SceneClass own = class_at(map, classes, x, y);
      if (own == SceneClass::kNothing || !touches(map, classes, x, y, SceneClass::kNothing, true))
        continue;
      cells += 1;
      rim.ground += own == SceneClass::kGround;
      rim.at_top += ends[map.at(x, y)];
    }
  return {rim.ground / std::max(cells, 1.0), rim.at_top / std::max(cells, 1.0)};
}

std::string percent(double share) {
  return std::to_string(static_cast<int>(std::lround(100 * share))) + " %";
}

/// What a plan from above tells.
struct PlaceFromAbove {
  bool is_tile = false;  ///< two sides of it end straight, and most of it at the top
  double side = 0;       ///< metres, the shorter one of its box
  double covered = 0;    ///< 0..1 of its box
  double ground = 0;     ///< 0..1 of what is covered
  Rim rim;
  double built = 0;           ///< 0..1 of its box
  std::vector<Group> groups;  ///< of buildings
};

PlaceFromAbove place_of(const Mesh& mesh, const std::vector<Edge>& open, const HeightMap& map) {
  const SceneClasses classes = classify(map);
  const auto count = [&](SceneClass c) {
    return static_cast<double>(std::count(classes.of_cell.begin(), classes.of_cell.end(), c));
  };
  const double cells = static_cast<double>(map.size());
  const double covered = std::max(cells - count(SceneClass::kNothing), 1.0);
  PlaceFromAbove plan;
  plan.covered = covered / cells;
  plan.ground = count(SceneClass::kGround) / covered;
  const std::vector<char> ends = ends_at_top(mesh, open, map);
  plan.rim = rim_of(map, classes, ends);
  plan.groups = groups_of(map, classes, ends);
  for (const Group& group : plan.groups) plan.built += group.area / (cells * map.cell * map.cell);
  return plan;
}

bool is_bare(const PlaceFromAbove& plan, std::ptrdiff_t houses) {
  if (plan.ground < kBareGround) return false;
  const bool has_whole_house =
      houses > 0 && std::none_of(plan.groups.begin(), plan.groups.end(), is_cut_off);
  return (plan.side >= kLeastSide && houses == 0) ||
         (plan.is_tile && plan.built <= kBareBuilt && !has_whole_house);
}

bool is_cut_through(const PlaceFromAbove& plan) {
  const bool has_ground = std::min(plan.rim.ground, plan.ground) >= kGroundAtRim;
  const bool is_large_tile = plan.is_tile && plan.side >= kLeastSide;
  return (plan.is_tile || plan.covered >= kFilled) && (has_ground || is_large_tile) &&
         std::any_of(plan.groups.begin(), plan.groups.end(), is_cut_off);
}

PlaceDoubt doubt_of(const PlaceFromAbove& plan) {
  const auto houses = std::count_if(plan.groups.begin(), plan.groups.end(),
                                    [](const Group& g) { return g.area >= kLeastHouse; });
  if (plan.ground >= kLeastGround && houses >= (plan.is_tile ? kLeastHousesOfTile : kLeastHouses)) {
    const std::string place = std::to_string(houses) +
                              " buildings stand apart on terrain that takes " +
                              percent(plan.ground) + " of its plan";
    return {"looks like a scene: " + place, true, place};
  }
  if (is_bare(plan, houses))
    return {"looks like a piece of terrain: it takes " + percent(plan.ground) +
                " of its plan, buildings " + percent(plan.built),
            true, ""};
  if (is_cut_through(plan))
    return {"looks like a piece of a scene: its border cuts through buildings", true, ""};
  return {};
}

}  // namespace

PlaceDoubt looks_like_scene(const Source& source) {
  if (!source.is_mesh()) return {};
  const Box box = bounding_box(source.mesh.vertices);
  const double side = std::min(box.size().x(), box.size().y());
  if (side < kLeastPiece || drawn_share(source.mesh) >= kLeastDrawn) return {};
  const std::vector<Edge> open = open_edges(source.mesh);
  const int straight = straight_sides(source.mesh, open);
  if (straight == 0 && side < kLeastSide) return {};
  PlaceFromAbove plan = place_of(source.mesh, open, height_map_of(source, box));
  const bool ends_as_cut = plan.rim.at_top >= kMostAtTop;
  plan.is_tile = straight >= kStraightSides && ends_as_cut;
  plan.side = side;
  if (const PlaceDoubt doubt = doubt_of(plan); side >= kLeastTile && doubt.is_certain) return doubt;
  if (straight > 0 && ends_as_cut && plan.rim.ground >= kGroundAtRim)
    return {"is cut off straight on " + std::to_string(straight) +
                (straight > 1 ? " sides" : " side") + " of its plan, as tiles of scenes are",
            false, ""};
  return {};
}

PlaceDoubt looks_like_scene(const HeightMap& map) {
  const SceneClasses classes = classify(map);
  PlaceFromAbove plan;
  const auto count = [&](SceneClass c) {
    return static_cast<double>(std::count(classes.of_cell.begin(), classes.of_cell.end(), c));
  };
  const double cells = static_cast<double>(map.size());
  const double covered = std::max(cells - count(SceneClass::kNothing), 1.0);
  plan.ground = count(SceneClass::kGround) / covered;
  plan.groups = groups_of(map, classes, std::vector<char>(map.size(), 0));
  plan.side = map.cell * std::min(map.width, map.height);
  plan.is_tile = covered >= kFilled * cells;  // as surveys are cut
  if (const PlaceDoubt doubt = doubt_of(plan); plan.side >= kLeastTile && !doubt.place.empty())
    return doubt;
  if (plan.side >= kLeastSide && plan.ground >= kLeastGround)
    return {"is " + std::to_string(std::lround(plan.side)) + " m wide, and terrain takes " +
                percent(plan.ground) + " of its plan",
            false, ""};
  return {};
}

bool is_wide(const Source& source) {
  return bounding_box(source.mesh.vertices).size().head<2>().maxCoeff() >= kLeastSide;
}

}  // namespace colod
