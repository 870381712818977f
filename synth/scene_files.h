// A made-up scene's tiles and truth as files, in the layouts that programs for photogrammetry
// write.
#pragma once

#include "scene.h"

namespace colod {

enum class SynthLayout {
  kObj,      ///< ContextCapture's: Data/Tile_*/Tile_*.obj with MTL and JPEG each
  kOdm,      ///< OpenDroneMap's: one OBJ with a material and a JPEG for each tile
  k3dTiles,  ///< tileset.json and a b3dm for each tile
  kLas       ///< no surface: the points of an airborne scan in one file
};

/// Vertices and texture coordinates that stand in an OBJ before a tile's.
struct ObjCount {
  std::size_t vertices = 0, coordinates = 0;
};

/// A tile's lines of an OBJ, without `mtllib`; raises the count.
std::string tile_obj(const SynthTile& tile, const std::string& material, ObjCount& count);
std::string tile_mtl(const std::string& material, const std::string& image);
std::string tile_jpeg(const SynthTile& tile);

/// glTF 2.0 about the tile's middle, y up, with its picture, in a b3dm.
std::string tile_b3dm(const SynthTile& tile);
/// LAS 1.2, point format 0, in millimetres: the header of a file of so many points, and points.
std::string las_header(std::size_t count, const Box& box);
std::string las_points(const std::vector<SynthPoint>& points);

/// `names` and `boxes`: of the tiles that have a surface.
std::string tileset_json(const std::vector<std::string>& names, const std::vector<Box>& boxes);

/// What an accessor of truth/ must know: cells, classes, tiles.
std::string scene_truth_json(const SynthScene& scene, const SynthSceneOptions& options,
                             const std::vector<std::string>& tiles,
                             const std::vector<Vec2>& corners);
/// A GeoJSON collection in the scene's metres.
std::string scene_footprints(const SynthScene& scene,
                             const std::vector<SynthSceneBuilding>& buildings);

}  // namespace colod
