// 3D Tiles 1.1: tileset.json and tiles/ over all buildings' levels; clients switch where they were
// measured to.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>

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
  std::string hash;  ///< of its bytes
};

/// A hash of what a building's levels and their looks are made from, and of its names.
using BuildingKey = std::array<std::uint64_t, 2>;

/// What an earlier run has left. A tile that would be made from the same again is not encoded and
/// not handed over.
struct KeptTiles {
  std::vector<BuildingKey> keys;  ///< per building
  /// What is there of a path below a folder, "tiles/" or a tileset's own, when it was made from
  /// what the key says. A folder is asked for tile by tile before the next one is.
  std::function<std::optional<TileFacts>(const std::string& folder, const std::string& path,
                                         const std::string& key)>
      find;
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
  const KeptTiles* kept = nullptr;                        ///< null: all is made anew
  bool lists_files = true;  ///< false: of what was handed over, not even paths are in the result
  std::size_t most_entries = kMostEntries;  ///< tiles in one tileset.json
  Placement placement = {};  ///< empty: the frame is local and no place on Earth is made up
};

/// First of the result is tileset.json, last written. Frames have their origin at the middle of the
/// buildings' foot, to the metre; its world position is in asset.extras. Boxes in z-up tile space,
/// children inside parents, errors strictly falling, leaves 0. Beyond 256 buildings or a kilometre,
/// cells are tilesets of their own, tiles/<cell>/tileset.json, and beyond `most_entries` so are the
/// tiles above them, so that no file grows with the scene. Runs in parallel. Throws Error{kOutput}
/// for a building without levels or triangles.
std::vector<Encoded> encode_tileset(const std::vector<ExportBuilding>& buildings,
                                    const TilesOptions& options = {});

/// Buildings that lie elsewhere, by their place in the list.
struct LevelDepot {
  /// at() knows these until close(): all of a building but its levels' meshes and looks, which are
  /// there between get() and drop().
  std::function<void(const std::vector<int>& buildings)> open;
  std::function<void()> close;
  std::function<const ExportBuilding&(int building)> at;  ///< thread-safe
  std::function<void(int building)> get, drop;            ///< called from several threads
  /// Its names, whether it is open or not; thread-safe.
  std::function<ExportBuilding(int building)> named;
  std::function<CoarsestLook(int building)> coarsest;  ///< the same; thread-safe
};

/// The same of buildings of which only what `outlines` tell is in memory: they come cell by cell,
/// and what is above them file by file. `take` gets a cell's files, its tileset last, when they are
/// made, and at the end all others but tileset.json and the context's; in the result they, and
/// those that were kept, have their place, but no bytes. Empty: all is in the result.
std::vector<Encoded> encode_tileset(const std::vector<TileOutline>& outlines,
                                    const LevelDepot& depot, const TilesOptions& options,
                                    const std::function<void(const Encoded&)>& take);

}  // namespace colod
