// 3D Tiles 1.1: tileset.json and tiles/ over all buildings' levels; clients switch where they were
// measured to.
#pragma once

#include <functional>

#include "context.h"
#include "exporters/exporter.h"
#include "looks.h"

namespace colod {

struct TilesOptions {
  Compression compression = Compression::kDraco;
  double quantization = 0.01;  ///< metres: bound on the position error, finer for the finest layer
  double target_sse = 16;      ///< pixels that clients refine at: a tile's geometricError is
                               ///< target_sse times the gsd of what it shows
  SwitchFacts switching = {};  ///< pixel_error: what a stand-in's deviation may be
  int largest_texture = 4096;  ///< texels a side of a tile's atlas
  const ContextTiles* context = nullptr;                  ///< what stands around; null: nothing
  std::function<void(const Encoded&)> take_context = {};  ///< its files as soon as they are made,
                                                          ///< from several threads; empty: they
                                                          ///< are among the result
  Placement placement = {};  ///< empty: the frame is local and no place on Earth is made up
};

/// First of the result is tileset.json, last written. Frames have their origin at the middle of the
/// buildings' foot, to the metre; its world position is in asset.extras. Boxes in z-up tile space,
/// children inside parents, errors strictly falling, leaves 0. Beyond 256 buildings or a kilometre,
/// cells are tilesets of their own, tiles/<cell>/tileset.json. Runs in parallel. Throws
/// Error{kOutput} for a building without levels or triangles.
std::vector<Encoded> encode_tileset(const std::vector<ExportBuilding>& buildings,
                                    const TilesOptions& options = {});

/// Levels that lie elsewhere. By a building's place in the list; called from several threads.
struct LevelDepot {
  std::function<void(int building)> get;   ///< gives its levels their meshes and looks …
  std::function<void(int building)> drop;  ///< … and takes them away
  std::function<CoarsestLook(int building)> coarsest;  ///< whether they are there or not
};

/// The same of buildings of which only what `outlines` tell is in memory: levels come cell by cell.
/// `take` gets a cell's files, its tileset last, when they are made; empty: all is in the result.
std::vector<Encoded> encode_tileset(const std::vector<ExportBuilding>& buildings,
                                    const std::vector<TileOutline>& outlines,
                                    const LevelDepot& depot, const TilesOptions& options,
                                    const std::function<void(const Encoded&)>& take);

}  // namespace colod
