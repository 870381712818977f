// 3D Tiles 1.1: tileset.json and tiles/ over all buildings' levels; clients switch where they were
// measured to.
#pragma once

#include <functional>
#include <map>

#include "context.h"
#include "exporters/exporter.h"
#include "looks.h"

namespace colod {

/// A tile's file that was written, and what it was made from.
struct TileFacts {
  std::string key;
  Box box;  ///< z-up tile space
  double gsd = 0;
  std::size_t bytes = 0;
};

/// What an earlier run has left. A tile that would be made from the same again is not encoded and
/// not handed over.
struct KeptTiles {
  std::vector<std::string> keys;  ///< per building: what its levels and their looks are made from
  std::function<std::map<std::string, TileFacts>(const std::string& folder)>
      get;  ///< by path: those below the folder, "tiles/" or a cell's own, that are there
  std::function<void(const std::string& folder, const std::map<std::string, TileFacts>&)>
      put;  ///< all of a folder, its files having been handed over; none: they are about to change
};

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
  const KeptTiles* kept = nullptr;  ///< null, or levels lie in a depot: all is made anew
  Placement placement = {};         ///< empty: the frame is local and no place on Earth is made up
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
/// `take` gets a cell's files, its tileset last, when they are made, and at the end all others but
/// tileset.json and the context's; in the result they, and those that were kept, have their place,
/// but no bytes. Empty: all is in the result.
std::vector<Encoded> encode_tileset(const std::vector<ExportBuilding>& buildings,
                                    const std::vector<TileOutline>& outlines,
                                    const LevelDepot& depot, const TilesOptions& options,
                                    const std::function<void(const Encoded&)>& take);

}  // namespace colod
