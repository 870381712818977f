// Which tile shows what: a tree over buildings, before anything is encoded.
#pragma once

#include <deque>

#include "exporters/exporter.h"
#include "standins.h"

namespace colod {

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
  std::vector<TilePart> parts;
  std::vector<PlannedTile> children;
  bool is_cell = false;    ///< a tileset of its own, in its own frame
  bool is_finest = false;  ///< what nothing refines: a finer grid
};

/// All that the tree is planned by, of one building: its meshes need not be there.
struct TileOutline {
  Box box;                    ///< of its coarsest level, world
  std::size_t triangles = 0;  ///< of its finest level
  StandInBox stand_in;        ///< its own, of no building yet, before the scene's agree on a switch
  bool has_look = false;      ///< whether its coarsest level has a texture or colours
};

/// `building` has its meshes and looks. Throws Error{kOutput} for one without levels or triangles.
TileOutline outline_of(const ExportBuilding& building, const SwitchFacts& facts = {});

struct TilePlan {
  std::deque<PolygonMesh> stand_ins;  ///< what parts without a layer point to
  PlannedTile root;
  std::vector<StandInBox> farthest;  ///< what the root shows
};

/// From the root down: stand-ins, each tile's lighter than those of its children together, the last
/// one's a box for each building; below them groups of up to 16 buildings in their coarsest levels,
/// and below a group one chain of finer levels a building, so that REPLACE never waits for more
/// than 16. A building whose coarsest level may stand much nearer than the group's gets it again at
/// the top of its chain. Groups part by medians along the longer side and then across: every inner
/// tile has four children. Subtrees of up to 256 buildings and a kilometre become cells when the
/// whole is larger. `buildings` not empty, each with a level; the plan points into them, and of the
/// meshes takes nothing but their places: `outlines`, one a building, know the rest.
TilePlan plan_tiles(const std::vector<ExportBuilding>& buildings,
                    const std::vector<TileOutline>& outlines, const SwitchFacts& facts = {});
/// The same of buildings that have their meshes.
TilePlan plan_tiles(const std::vector<ExportBuilding>& buildings, const SwitchFacts& facts = {});

/// The root shows these instead of its stand-ins.
void show_farthest(TilePlan& plan, const std::vector<StandInBox>& boxes);

}  // namespace colod
