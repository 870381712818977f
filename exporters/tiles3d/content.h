// A tile's content: one GLB of all that it shows.
#pragma once

#include <nlohmann/json.hpp>

#include "frame.h"
#include "tiles3d.h"
#include "tree.h"

namespace colod {

/// What all tiles of a tileset are made with.
struct TilesetInput {
  const std::vector<TileOutline>& outlines;
  const TilesOptions& options;
  const LevelDepot& depot;
};

/// A tile's GLB and what the tileset says of it.
struct Content {
  const PlannedTile* tile;
  Encoded file;
  Box box;  // z-up tile space
  double gsd = 0;
  // Of the file, which may be handed over, or was there before:
  std::size_t bytes = 0;
  std::string hash;
};

/// Makes file.bytes, box, gsd and bytes; the buildings whose levels the tile shows have them.
/// Thread-safe for different contents.
void encode_content(const TilesetInput& input, const TileFrame& frame, Content& content);

/// Whom and which layers a tile of one part shows.
nlohmann::ordered_json identity_json(const std::string& name, const std::string& given_name,
                                     const TilePart& part);

nlohmann::ordered_json vec_json(const Vec3& v);

}  // namespace colod
