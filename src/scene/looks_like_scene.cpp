// Based on: own work: a building, however large its plot, is one group of roofs.
#include "looks_like_scene.h"

#include <algorithm>
#include <cmath>

#include "classes.h"
#include "core/drawn.h"
#include "parameters.h"
#include "survey.h"

namespace colod {

namespace {

using namespace parameters::whole_place;

HeightMap heights_of(const Source& source, const Box& box) {
  HeightMap map;
  const Vec3 size = box.size();
  map.cell = std::max(parameters::survey::kCell, std::sqrt(size.x() * size.y() / kMostCells));
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

/// Cells of buildings that hang together, as m²; whatever parts them by height.
std::vector<double> groups_of(const HeightMap& map, const SceneClasses& classes) {
  std::vector<double> areas;
  std::vector<char> is_done(map.size(), 0);
  std::vector<int> open;
  for (std::size_t first = 0; first < map.size(); ++first) {
    if (is_done[first] || classes.of_cell[first] != SceneClass::kBuilding) continue;
    double area = 0;
    open.push_back(static_cast<int>(first));
    is_done[first] = 1;
    while (!open.empty()) {
      const int x = open.back() % map.width, y = open.back() / map.width;
      open.pop_back();
      area += map.cell * map.cell;
      for (int v = std::max(0, y - kReach); v <= std::min(map.height - 1, y + kReach); ++v)
        for (int u = std::max(0, x - kReach); u <= std::min(map.width - 1, x + kReach); ++u) {
          const std::size_t next = map.at(u, v);
          if (is_done[next] || classes.of_cell[next] != SceneClass::kBuilding) continue;
          is_done[next] = 1;
          open.push_back(static_cast<int>(next));
        }
    }
    areas.push_back(area);
  }
  return areas;
}

/// Shares of the cells on the border of what is covered.
struct Rim {
  double building = 0, ground = 0;
};

Rim rim_of(const HeightMap& map, const SceneClasses& classes) {
  const auto is_open = [&](int x, int y) {
    return x < 0 || y < 0 || x >= map.width || y >= map.height ||
           classes.of_cell[map.at(x, y)] == SceneClass::kNothing;
  };
  Rim rim;
  double cells = 0;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      if (is_open(x, y) ||
          !(is_open(x - 1, y) || is_open(x + 1, y) || is_open(x, y - 1) || is_open(x, y + 1)))
        continue;
      cells += 1;
      rim.building += classes.of_cell[map.at(x, y)] == SceneClass::kBuilding;
      rim.ground += classes.of_cell[map.at(x, y)] == SceneClass::kGround;
    }
  return {rim.building / std::max(cells, 1.0), rim.ground / std::max(cells, 1.0)};
}

std::string percent(double share) {
  return std::to_string(static_cast<int>(std::lround(100 * share))) + " %";
}

}  // namespace

std::string looks_like_scene(const Source& source) {
  if (!source.is_mesh()) return "";
  const Box box = bounding_box(source.mesh.vertices);
  if (std::min(box.size().x(), box.size().y()) < kLeastSide) return "";
  if (drawn_share(source.mesh) >= kLeastDrawn) return "";
  const HeightMap map = heights_of(source, box);
  const SceneClasses classes = classify(map);
  const auto count = [&](SceneClass c) {
    return static_cast<double>(std::count(classes.of_cell.begin(), classes.of_cell.end(), c));
  };
  const double covered =
      std::max(static_cast<double>(map.size()) - count(SceneClass::kNothing), 1.0);
  const double ground = count(SceneClass::kGround) / covered;
  const std::vector<double> groups = groups_of(map, classes);
  const auto houses =
      std::count_if(groups.begin(), groups.end(), [](double area) { return area >= kLeastHouse; });
  if (ground >= kLeastGround && houses >= kLeastHouses)
    return "looks like a scene: " + std::to_string(houses) +
           " buildings stand apart on terrain that takes " + percent(ground) + " of its plan";
  if (ground >= kBareGround && houses == 0)
    return "looks like a piece of terrain: it takes " + percent(ground) +
           " of its plan, and no building stands on it";
  const Rim rim = rim_of(map, classes);
  const bool is_rectangle = covered >= kFilled * static_cast<double>(map.size());
  if (is_rectangle && std::min(rim.ground, ground) >= kGroundAtRim && rim.building >= kCutOff)
    return "looks like a piece of a scene: its border cuts through terrain and buildings";
  return "";
}

bool is_wide(const Source& source) {
  return bounding_box(source.mesh.vertices).size().head<2>().maxCoeff() >= kLeastSide;
}

}  // namespace colod
