// Inside room `publish`: what a merge remembers of the one before.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cells.h"
#include "exporters/tiles3d/tiles3d.h"

namespace colod {

/// Tiles and buildings on the shelf TileFolder::kept. Not thread-safe.
class MergeMemory {
 public:
  explicit MergeMemory(const TileFolder& folder);

  /// Every building of the tileset, in its order, before tiles() is used.
  void add(const std::string& building, const std::string& key);
  const KeptTiles& tiles() const { return tiles_; }
  /// The tileset is written. Tells what has changed since the merge before, if there was one.
  void finish(const Tell& tell);

 private:
  std::map<std::string, TileFacts> get(const std::string& folder);
  void put(const std::string& folder, const std::map<std::string, TileFacts>& facts);

  const TileFolder& folder_;
  Shelf& shelf_;
  KeptTiles tiles_;
  std::map<std::string, std::string> now_;  // building → key
  std::vector<std::string> folders_;        // that there are
};

}  // namespace colod
