// A scene that is cut into tiles: what 3D Tiles or a folder of meshes say of them, and one tile at
// a time, so that memory follows a tile and not the scene.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "read.h"

namespace colod {

class Unpacked;

enum class TileUp { kY, kZ, kX };  ///< the axis of a tile's glTF that points up in the tile

/// A tile of the tree, or a place in it that shows nothing itself.
struct TileNode {
  std::vector<std::string> contents;                      ///< files that it shows; mostly one
  Eigen::Matrix4d to_root = Eigen::Matrix4d::Identity();  ///< the tile's frame → the scene's
  TileUp up = TileUp::kY;
  double geometric_error = 0;  ///< metres, as the tileset has it
  bool is_added = false;       ///< its children join what it shows instead of replacing it
  int parent = -1;             ///< −1: the root
  std::vector<int> children;
};

/// All tiles of a scene, none of which has been read.
struct TileTree {
  std::string path;                   ///< the tileset.json, the archive, or the folder
  std::vector<TileNode> nodes;        ///< parents before children; 0 is the root
  std::vector<ReadFailure> failures;  ///< tiles and tilesets that are missing or not allowed
  std::vector<std::string> warnings;
  bool is_tileset = false;  ///< else meshes in the scene's frame, each a tile of its own
  std::shared_ptr<const Unpacked> archive;  ///< where contents lie while it lives; null: they are
                                            ///< files of their own
};

/// A text for the user, with files of an archive named as they lie in it.
std::string shown(const TileTree& tree, std::string text);

/// A name that is safe as a file's, on any system: letters, digits, `-`, `_` and `.`.
std::string safe_name(const std::string& name);

/// Whether an INPUT is a scene by what it is: a tileset.json that colod did not write, a folder
/// with one, a .3tz, or a folder with meshes in Data/Tile_*/. `why` says what tells it. Throws
/// Error{kInput} for a .3tz that colod wrote.
bool is_tiled_scene(const std::string& input, std::string& why);

/// Whether a file is a tile of 3D Tiles by its format, whatever it shows: b3dm.
bool is_tile_format(const std::string& path);

/// 3D Tiles 1.0 and 1.1: external tilesets, transforms, content.url and content.uri, contents,
/// `content: null`, implicit tiling, asset.gltfUpAxis. What lies outside the folder of the tileset
/// that is named, and what leads back to itself, are failures of their own. A
/// .3tz is unpacked (archive.h) and read as its tileset.json. Of another folder, or a mesh, each
/// file is a tile. Throws Error{kInput} where there is nothing to read.
TileTree list_tiles(const std::string& input, const ReadOptions& options = {});

/// The nodes that together show all of the scene once: `coarser` levels above the tiles without
/// children, and what these add to.
std::vector<int> finest_nodes(const TileTree& tree, int coarser = 0);

/// What a node shows, in the frame of `to_scene` · its own. Textures stay in their files. Throws
/// Error{kInput} for a content that cannot be read; one without faces is empty.
Source read_tile(const TileNode& node, const std::string& content, const Eigen::Matrix4d& to_scene,
                 const ReadOptions& options = {});

}  // namespace colod
