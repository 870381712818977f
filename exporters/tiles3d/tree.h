// Which tile shows what: a tree over buildings, before anything is encoded.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>

#include "exporters/exporter.h"
#include "standins.h"

namespace colod {

constexpr std::size_t kMostEntries =
    1400;  // tiles in a tileset's file: 1024 cells and what is above

/// One feature of a tile's content.
struct TilePart {
  std::vector<int> buildings;          ///< rising; one, unless a stand-in covers several
  const ExportLevel* level = nullptr;  ///< null: a stand-in, coarser than layer 0
  const PolygonMesh* mesh = nullptr;   ///< about `origin`
  Vec3 origin = Vec3::Zero();          ///< world
  double gsd = 0;                      ///< metres a pixel
  double deviation = 0;                ///< metres, measured
};

struct PlannedTile {
  std::string name;
  std::vector<StandInBox> boxes;  ///< stand-ins that it shows …
  std::vector<TilePart> parts;    ///< … as show_boxes() makes them, or buildings' levels
  std::vector<PlannedTile> children;
  bool is_tileset = false;  ///< a tileset of its own, in its own frame
  bool is_apart = false;    ///< with all below it in a file of its own, in its tileset's frame
  bool is_finest = false;   ///< what nothing refines: a finer grid
  std::size_t entries = 1;  ///< tiles in the file of its tileset, itself and those below; one that
                            ///< is a tileset itself counts as one
};

/// All that the tree is planned by, of one building: its meshes need not be there.
struct TileOutline {
  Box box;                    ///< of its coarsest level, world
  std::size_t triangles = 0;  ///< of its finest level
  StandInBox stand_in;        ///< its own, of no building yet, before the scene's agree on a switch
  bool has_look = false;      ///< whether its coarsest level has a texture or colours
  std::uint64_t source = 0;   ///< a hash of its source's name
};

/// `building` has its meshes and looks. Throws Error{kOutput} for one without levels or triangles.
TileOutline outline_of(const ExportBuilding& building, const SwitchFacts& facts = {});

/// A hash of ExportBuilding::source.
std::uint64_t source_id(const std::string& source);

/// Buildings while a tileset is planned from the root down and finished from below.
struct PlanAccess {
  /// Those below a tile that is to be a tileset with their levels, or the root: at() knows them,
  /// until it is finished.
  std::function<void(const std::vector<int>& buildings)> open;
  std::function<const ExportBuilding&(int building)> at;  ///< levels; of meshes nothing but places
  /// All below the tile, which is a tileset, is planned. What it shows is taken from its boxes;
  /// children and boxes may be taken away. Not called for the root.
  std::function<void(PlannedTile&)> finish;
};

/// From the root down: stand-ins, each tile's lighter than those of its children together, the last
/// one's a box for each building; below them groups of up to 16 buildings in their coarsest levels,
/// and below a group one chain of finer levels a building, so that REPLACE never waits for more
/// than 16. A building whose coarsest level may stand much nearer than the group's gets it again at
/// the top of its chain. Groups part by medians along the longer side and then across: every inner
/// tile has four children. Subtrees of up to 256 buildings and a kilometre become tilesets of their
/// own (cells) when the whole is larger, and so do the children of a tile whose tileset would have
/// more than `most_entries` tiles. Groups of several have files of their own in a tileset, so that
/// whoever is far away reads nothing of single buildings. `outlines` not empty; parts point to what
/// `access` gives. In memory are some numbers a building, and what waits for its tileset to be
/// finished.
PlannedTile plan_tiles(const std::vector<TileOutline>& outlines, const PlanAccess& access,
                       const SwitchFacts& facts = {}, std::size_t most_entries = kMostEntries);

/// Makes the parts of the tile and of all below that show boxes; `meshes` is what they point to.
void show_boxes(PlannedTile& tile, std::deque<PolygonMesh>& meshes);

}  // namespace colod
