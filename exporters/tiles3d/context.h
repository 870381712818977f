// What of a scene is no building, as tiles beside those of the buildings.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "exporters/exporter.h"
#include "frame.h"

namespace colod {

/// An image as the source has it.
struct ContextImage {
  std::string bytes;  ///< encoded
  ImageFormat format = ImageFormat::kJpeg;
};

/// A surface in world coordinates, z up.
struct ContextMesh {
  Mesh mesh;
  std::vector<std::array<Vec2f, 3>> uvs;   ///< per face; where its image is −1 without meaning
  std::vector<int> face_image;             ///< per face; −1: its colours
  std::vector<std::array<Rgb, 3>> colors;  ///< per face, of its corners
  std::vector<ContextImage> images;
};

/// A tile of the tree.
struct ContextNode {
  int parent = -1;             ///< rising: parents come before children; −1: beside the buildings
  double geometric_error = 0;  ///< metres; raised where children's would not lie below it
  bool is_added = false;       ///< its children join what it shows
  double rounding = 0;         ///< metres that positions may be off, if more than `quantization`
  bool is_farthest = true;     ///< nothing coarser is shown for it: its image needs mip levels
};

/// All of it; a mesh is asked for when its tile is encoded.
struct ContextTiles {
  std::vector<ContextNode> nodes;
  std::function<ContextMesh(std::size_t node)> mesh;  ///< thread-safe; empty: it shows nothing
};

/// A finished tile, with all below.
struct ContextTile {
  nlohmann::ordered_json json;
  Box box;  ///< z-up tile space
  double error = 0;
};

/// The tiles beside the buildings, in `frame`; `take` gets their files, tiles/context/<n>.glb, as
/// soon as they are made, from several threads; where many lie below a tile it and these are a
/// tileset, tiles/context/<n>.json. Without normals, since nothing is lit. Images are written as
/// they are; positions are rounded to `quantization`, in metres, or as the node says. Runs in
/// parallel.
std::vector<ContextTile> encode_context(const ContextTiles& context, const TileFrame& frame,
                                        Compression compression, double quantization,
                                        const std::function<void(const Encoded&)>& take);

}  // namespace colod
