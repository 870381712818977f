// What buildings' tiles and the context's have in common in the tileset's JSON.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "core/geometry.h"

namespace colod {

constexpr double kRise = 1.01;        // a parent's error is at least this times its children's
constexpr double kLeastError = 1e-3;  // metres; of a tile that has children, or coarse pixels

/// As short as it gets: clients read tilesets before anything else.
inline std::string compact(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// A bounding volume, z up.
inline nlohmann::ordered_json box_json(const Box& box) {
  const Vec3 c = box.center(), h = 0.5 * box.size();
  return {{"box", {c.x(), c.y(), c.z(), h.x(), 0, 0, 0, h.y(), 0, 0, 0, h.z()}}};
}

/// A tile in a file of its own, with all below it; what stands for it in the file above, where the
/// file is `uri`, takes its place. `error`: the tile's, and then that of what stands for it.
inline std::string put_apart(nlohmann::ordered_json& tile, double& error, const std::string& uri) {
  error = std::max(kLeastError, kRise * error);
  nlohmann::ordered_json stub, tileset;
  stub["boundingVolume"] = tile.at("boundingVolume");
  stub["geometricError"] = error;
  stub["content"]["uri"] = uri;
  tileset["asset"] = {{"version", "1.1"}, {"generator", "colod"}};
  tileset["geometricError"] = error;
  tileset["root"] = std::move(tile);
  tile = std::move(stub);
  return compact(tileset);
}

}  // namespace colod
