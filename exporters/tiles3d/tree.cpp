// Based on: hierarchical levels of detail over a quadtree, as 3D Tiles writers lay them out.
// Differs: parted by medians, so that no tile has one child or thousands; what stands above the
// buildings' own layers has a budget of triangles and a measured error.
#include "tree.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"

namespace colod {

namespace {

constexpr std::size_t kMostChildren = 16;  // REPLACE waits for all children of a tile
constexpr std::size_t kMostInCell = 256;   // buildings
constexpr double kWidestCell = 1000;       // metres: the Earth is flat to 2 cm about its middle
constexpr double kStandInShare = 0.025;    // of the finest layers' triangles
constexpr double kMostShare = 0.05;        // of them, where that gives each building its own
constexpr std::size_t kMostStandIns = 64;  // in one tile
constexpr double kNearer = 1.005;  // scope scene: a level may stand so much nearer than others' …
constexpr double kWorthATile = 1.4;  // … scope building: so much nearer that it is worth a tile

void show(std::deque<PolygonMesh>& meshes, PlannedTile& tile,
          const std::vector<StandInBox>& boxes) {
  tile.parts.clear();
  for (const StandInBox& box : boxes) {
    meshes.push_back(mesh_of(box));
    tile.parts.push_back({box.buildings, nullptr, &meshes.back(), box.origin, box.gsd, box.error});
  }
}

class Planner {
 public:
  Planner(const std::vector<ExportBuilding>& buildings, const std::vector<TileOutline>& outlines,
          const SwitchFacts& facts)
      : buildings_(buildings),
        outlines_(outlines),
        pixel_error_(facts.pixel_error),
        worth_a_tile_(facts.scope == "scene" ? kNearer : kWorthATile) {
    for (const TileOutline& outline : outlines) {
      singles_.push_back(outline.stand_in);
      singles_.back().buildings = {static_cast<int>(singles_.size()) - 1};
    }
    agree_on_switch(singles_, facts);
  }

  TilePlan plan() {
    std::vector<int> all(buildings_.size());
    std::iota(all.begin(), all.end(), 0);
    plan_.root = far_tile(all, "root", false, plan_.farthest);
    return std::move(plan_);
  }

 private:
  /// Shows stand-ins; what is in `below` is of other tiles, and the tile's own join it.
  PlannedTile far_tile(const std::vector<int>& group, const std::string& name, bool is_in_cell,
                       std::vector<StandInBox>& below) {
    PlannedTile tile{.name = name, .parts = {}, .children = {}};
    tile.is_cell = !is_in_cell && is_cell(group);
    is_in_cell |= tile.is_cell;
    std::vector<StandInBox> shown;
    const bool is_merged = budget(group) < group.size();
    const auto add_near = [&](const std::vector<int>& part, const std::string& child) {
      tile.children.push_back(is_merged ? box_tile(part, child) : near_tile(part, child));
      for (const int b : part) shown.push_back(singles_[b]);
    };
    if (group.size() <= kMostChildren) {
      add_near(group, name + ".0");
    } else {
      int number = 0;
      for (const std::vector<int>& part : quarter(group)) {
        const std::string child = name + "." + std::to_string(number++);
        if (part.size() > kMostChildren || !is_in_cell)
          tile.children.push_back(far_tile(part, child, is_in_cell, shown));
        else
          add_near(part, child);
      }
    }
    shown = merge_stand_ins(std::move(shown), budget(group), pixel_error_);
    show(plan_.stand_ins, tile, shown);
    below.insert(below.end(), shown.begin(), shown.end());
    return tile;
  }

  /// Shows a box for each building, below a tile that merged them.
  PlannedTile box_tile(const std::vector<int>& group, const std::string& name) {
    PlannedTile tile{.name = name, .parts = {}, .children = {}};
    std::vector<StandInBox> boxes;
    for (const int b : group) boxes.push_back(singles_[b]);
    show(plan_.stand_ins, tile, boxes);
    tile.children.push_back(near_tile(group, name + ".0"));
    return tile;
  }

  /// Shows the buildings' coarsest levels.
  PlannedTile near_tile(const std::vector<int>& group, const std::string& name) const {
    PlannedTile tile{.name = name, .parts = {}, .children = {}};
    const bool has_finer = std::any_of(group.begin(), group.end(),
                                       [&](int b) { return buildings_[b].levels.size() > 1; });
    double gsd = 0;
    for (const int b : group) gsd = std::max(gsd, buildings_[b].levels.front().gsd);
    for (const int b : group) {
      tile.parts.push_back(part_of(b, 0));
      if (has_finer) tile.children.push_back(chain(b, first_below(b, gsd)));
    }
    tile.is_finest = !has_finer;
    return tile;
  }

  /// The level that a building's chain starts with, below a group that stands from `gsd` on: the
  /// coarsest again where it may stand nearer (in scope scene at all, so that no building is finer
  /// than one before it), or has no finer one and is replaced by itself.
  std::size_t first_below(int b, double gsd) const {
    const std::vector<ExportLevel>& levels = buildings_[b].levels;
    return levels.size() == 1 || worth_a_tile_ * levels.front().gsd < gsd ? 0 : 1;
  }

  /// The building's levels from this one on, each the only child of the coarser one.
  PlannedTile chain(int b, std::size_t level) const {
    const ExportBuilding& building = buildings_[b];
    PlannedTile tile{
        .name = building.name + ".layer" + std::to_string(building.levels[level].layers.back()),
        .parts = {part_of(b, level)},
        .children = {}};
    tile.is_finest = level + 1 == building.levels.size();
    if (!tile.is_finest) tile.children.push_back(chain(b, level + 1));
    return tile;
  }

  TilePart part_of(int b, std::size_t number) const {
    const ExportLevel& level = buildings_[b].levels[number];
    return {{b}, &level, &level.mesh, buildings_[b].origin, level.gsd, level.deviation};
  }

  std::size_t budget(const std::vector<int>& group) const {
    double finest = 0;
    for (const int b : group) finest += static_cast<double>(outlines_[b].triangles);
    const auto boxes = [&](double share) {
      return static_cast<std::size_t>(share * finest / kStandInTriangles);
    };
    const std::size_t own = std::min({group.size(), kMostChildren, boxes(kMostShare)});
    return std::clamp<std::size_t>(boxes(kStandInShare), std::max<std::size_t>(own, 1),
                                   kMostStandIns);
  }

  Vec3 extent(const std::vector<int>& group) const {
    Box box;
    for (const int b : group) box.extend(outlines_[b].box);
    return box.size();
  }

  bool is_cell(const std::vector<int>& group) const {
    const bool is_small =
        group.size() <= kMostInCell && extent(group).head<2>().maxCoeff() <= kWidestCell;
    return is_small || group.size() <= kMostChildren;
  }

  /// Four groups of equal size by halving along the longer side, then across it. Ties go by place
  /// in the list.
  std::vector<std::vector<int>> quarter(const std::vector<int>& group) const {
    const auto halve = [&](std::vector<int> all, int axis) {
      std::stable_sort(all.begin(), all.end(), [&](int a, int b) {
        return outlines_[a].box.center()[axis] < outlines_[b].box.center()[axis];
      });
      const auto half = all.begin() + static_cast<long>((all.size() + 1) / 2);
      return std::array{std::vector<int>(all.begin(), half), std::vector<int>(half, all.end())};
    };
    const Vec3 size = extent(group);
    const int first = size.x() >= size.y() ? 0 : 1;
    std::vector<std::vector<int>> out;
    for (const std::vector<int>& side : halve(group, first))
      for (const std::vector<int>& part : halve(side, 1 - first)) out.push_back(part);
    for (std::vector<int>& part : out) std::sort(part.begin(), part.end());
    return out;
  }

  const std::vector<ExportBuilding>& buildings_;
  const std::vector<TileOutline>& outlines_;
  double pixel_error_;
  double worth_a_tile_;  // a factor between the gsds of a group and of one of its buildings
  std::vector<StandInBox> singles_;  // one a building
  TilePlan plan_;
};

}  // namespace

TileOutline outline_of(const ExportBuilding& building, const SwitchFacts& facts) {
  const bool is_whole = !building.levels.empty() &&
                        std::none_of(building.levels.begin(), building.levels.end(),
                                     [](const ExportLevel& l) { return l.mesh.triangles.empty(); });
  if (!is_whole)
    throw Error(Stage::kOutput, building.name, "no level, or a level without triangles");
  TileOutline outline;
  const ExportLevel& coarsest = building.levels.front();
  for (const Vec3& p : coarsest.mesh.vertices) outline.box.extend(Vec3(p + building.origin));
  outline.triangles = building.levels.back().mesh.triangles.size();
  outline.stand_in = stand_in_for(building, 0, facts);
  outline.has_look = coarsest.look.has_texture() || !coarsest.look.facet_colors.empty();
  return outline;
}

TilePlan plan_tiles(const std::vector<ExportBuilding>& buildings,
                    const std::vector<TileOutline>& outlines, const SwitchFacts& facts) {
  return Planner(buildings, outlines, facts).plan();
}

TilePlan plan_tiles(const std::vector<ExportBuilding>& buildings, const SwitchFacts& facts) {
  std::vector<TileOutline> outlines(buildings.size());
  parallel_for(buildings.size(),
               [&](std::size_t i) { outlines[i] = outline_of(buildings[i], facts); });
  return plan_tiles(buildings, outlines, facts);
}

void show_farthest(TilePlan& plan, const std::vector<StandInBox>& boxes) {
  show(plan.stand_ins, plan.root, boxes);
}

}  // namespace colod
