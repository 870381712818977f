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

struct TilePlan {
  std::deque<PolygonMesh> stand_ins;  ///< what parts without a layer point to
  PlannedTile root;
  std::vector<StandIn> farthest;  ///< what the root shows
};

/// From the root down: stand-ins, each tile's lighter than those of its children together, the last
/// one's a box for each building; below them groups of up to 16 buildings in their coarsest levels,
/// and below a group one chain of finer levels a building, so that REPLACE never waits for more
/// than 16. A building whose coarsest level may stand much nearer than the group's gets it again at
/// the top of its chain. Groups part by medians along the longer side and then across: every inner
/// tile has four children. Subtrees of up to 256 buildings and a kilometre become cells when the
/// whole is larger. `buildings` not empty, each with a level; the plan points into them.
TilePlan plan_tiles(const std::vector<ExportBuilding>& buildings, const SwitchFacts& facts = {});

/// The root shows these instead of its stand-ins.
void show_farthest(TilePlan& plan, const std::vector<StandIn>& boxes);

}  // namespace colod
