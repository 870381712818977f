// Based on: hierarchical levels of detail over a quadtree, as 3D Tiles writers lay them out.
// Differs: parted by medians, so that no tile has one child or thousands; what stands above the
// buildings' own layers has a budget of triangles and a measured error.
#include "tree.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/error.h"
#include "core/hash.h"

namespace colod {

namespace {

constexpr std::size_t kMostChildren = 16;  // REPLACE waits for all children of a tile
constexpr std::size_t kMostInCell = 256;   // buildings
constexpr double kWidestCell = 1000;       // metres: the Earth is flat to 2 cm about its middle
constexpr double kStandInShare = 0.025;    // of the finest layers' triangles
constexpr double kMostShare = 0.05;  // … of the root, where that gives each building its own
constexpr std::size_t kMostStandIns = 64;  // in one tile
constexpr double kNearer = 1.005;  // scope scene: a level may stand so much nearer than others' …
constexpr double kWorthATile = 1.4;  // … scope building: so much nearer that it is worth a tile
constexpr const char* kRoot = "root";

class Planner {
 public:
  Planner(const std::vector<TileOutline>& outlines, const PlanAccess& access,
          const SwitchFacts& facts, std::size_t most_entries)
      : outlines_(outlines),
        access_(access),
        most_entries_(most_entries),
        pixel_error_(facts.pixel_error),
        worth_a_tile_(facts.scope == "scene" ? kNearer : kWorthATile) {
    std::vector<double> own;
    for (const TileOutline& outline : outlines) own.push_back(outline.stand_in.gsd);
    shared_gsd_ = shared_gsd(own, facts);
  }

  PlannedTile plan() {
    std::vector<int> all(outlines_.size());
    std::iota(all.begin(), all.end(), 0);
    std::vector<StandInBox> farthest;
    return far_tile(std::move(all), "root", false, farthest);
  }

 private:
  /// A building's own box.
  StandInBox single(int b) const {
    StandInBox box = outlines_[b].stand_in;
    box.buildings = {b};
    if (shared_gsd_) box.gsd = *shared_gsd_;
    return box;
  }

  /// Shows stand-ins; what is in `below` is of other tiles, and the tile's own join it.
  PlannedTile far_tile(std::vector<int> group, const std::string& name, bool is_in_cell,
                       std::vector<StandInBox>& below) {
    PlannedTile tile{.name = name, .boxes = {}, .parts = {}, .children = {}};
    const bool is_top = name == kRoot, starts_cell = !is_in_cell && is_cell(group);
    if (starts_cell) access_.open(group);
    is_in_cell |= starts_cell;
    const std::size_t most = budget(group, is_top);
    const bool is_one_of_many = group.size() > kMostChildren;
    std::vector<StandInBox> shown;
    const auto add_near = [&](const std::vector<int>& part, const std::string& child) {
      tile.children.push_back(most < group.size() ? box_tile(part, child) : near_tile(part, child));
      PlannedTile& near = tile.children.back();
      near.is_apart = is_one_of_many && !near.children.empty();
      for (const int b : part) shown.push_back(single(b));
    };
    if (group.size() <= kMostChildren) {
      add_near(group, name + ".0");
    } else {
      int number = 0;
      std::vector<std::vector<int>> parts = quarter(group);
      if (!is_in_cell) group = {};  // its parts have them all
      for (std::vector<int>& part : parts) {
        const std::string child = name + "." + std::to_string(number++);
        if (part.size() > kMostChildren || !is_in_cell)
          tile.children.push_back(far_tile(std::move(part), child, is_in_cell, shown));
        else
          add_near(part, child);
      }
    }
    tile.boxes = merge_stand_ins(std::move(shown), most, pixel_error_);
    below.insert(below.end(), tile.boxes.begin(), tile.boxes.end());
    if (!is_in_cell) part_file(tile);
    if (starts_cell && !is_top) finish(tile);
    return tile;
  }

  /// A tile of the top: where its file would become too large, its children get files of their own.
  void part_file(PlannedTile& tile) {
    const auto count = [&] {
      tile.entries = 1;
      for (const PlannedTile& child : tile.children) tile.entries += child.entries;
      return tile.entries;
    };
    if (count() <= most_entries_) return;
    for (PlannedTile& child : tile.children)
      if (!child.is_tileset) finish(child);
    count();
  }

  void finish(PlannedTile& tile) {
    tile.is_tileset = true;
    tile.entries = 1;
    access_.finish(tile);
  }

  /// Shows a box for each building, below a tile that merged them.
  PlannedTile box_tile(const std::vector<int>& group, const std::string& name) {
    PlannedTile tile{.name = name, .boxes = {}, .parts = {}, .children = {}};
    for (const int b : group) tile.boxes.push_back(single(b));
    tile.children.push_back(near_tile(group, name + ".0"));
    return tile;
  }

  /// Shows the buildings' coarsest levels.
  PlannedTile near_tile(const std::vector<int>& group, const std::string& name) const {
    PlannedTile tile{.name = name, .boxes = {}, .parts = {}, .children = {}};
    const bool has_finer = std::any_of(group.begin(), group.end(),
                                       [&](int b) { return access_.at(b).levels.size() > 1; });
    double gsd = 0;
    for (const int b : group) gsd = std::max(gsd, access_.at(b).levels.front().gsd);
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
    const std::vector<ExportLevel>& levels = access_.at(b).levels;
    return levels.size() == 1 || worth_a_tile_ * levels.front().gsd < gsd ? 0 : 1;
  }

  /// The building's levels from this one on, each the only child of the coarser one.
  PlannedTile chain(int b, std::size_t level) const {
    const ExportBuilding& building = access_.at(b);
    PlannedTile tile{
        .name = building.name + ".layer" + std::to_string(building.levels[level].layers.back()),
        .boxes = {},
        .parts = {part_of(b, level)},
        .children = {}};
    tile.is_finest = level + 1 == building.levels.size();
    if (!tile.is_finest) tile.children.push_back(chain(b, level + 1));
    return tile;
  }

  TilePart part_of(int b, std::size_t number) const {
    const ExportBuilding& building = access_.at(b);
    const ExportLevel& level = building.levels[number];
    return {{b}, &level, &level.mesh, building.origin, level.gsd, level.deviation};
  }

  /// Of boxes. So many as a tile may have at all cost a client nothing, each building its own:
  /// merged ones are metres off, and would give way to those of single buildings soon. From where
  /// the root is seen nearly nothing is needed.
  std::size_t budget(const std::vector<int>& group, bool is_top) const {
    if (!is_top && group.size() <= kMostStandIns) return group.size();
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

  const std::vector<TileOutline>& outlines_;
  const PlanAccess& access_;
  std::size_t most_entries_;
  double pixel_error_;
  double worth_a_tile_;  // a factor between the gsds of a group and of one of its buildings
  std::optional<double> shared_gsd_;  // of all single boxes
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
  outline.source = source_id(building.source);
  return outline;
}

std::uint64_t source_id(const std::string& source) {
  Hash hash;
  hash.add(source.data(), source.size());
  return hash.value()[0];
}

PlannedTile plan_tiles(const std::vector<TileOutline>& outlines, const PlanAccess& access,
                       const SwitchFacts& facts, std::size_t most_entries) {
  return Planner(outlines, access, facts, most_entries).plan();
}

void show_boxes(PlannedTile& tile, std::deque<PolygonMesh>& meshes) {
  if (!tile.boxes.empty()) tile.parts.clear();
  for (const StandInBox& box : tile.boxes) {
    meshes.push_back(mesh_of(box));
    tile.parts.push_back({box.buildings, nullptr, &meshes.back(), box.origin, box.gsd, box.error});
  }
  for (PlannedTile& child : tile.children) show_boxes(child, meshes);
}

}  // namespace colod
