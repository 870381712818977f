// Inside room `publish`: what a merge remembers of the one before.
#pragma once

#include <cstdint>
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

  /// What a building's tiles are made from. `key`: of its files.
  BuildingKey key_of(const ExportBuilding& building, const std::string& key) const;

  /// `keys`: per building of the tileset, in its order.
  void set_keys(std::vector<BuildingKey> keys) { tiles_.keys = std::move(keys); }
  const KeptTiles& tiles() const { return tiles_; }

  /// The tileset is written. Tells what was damaged, and what has changed since the merge before,
  /// if there was one. `names` and `cells`: per building of the tileset.
  void finish(const std::vector<const std::string*>& names, const std::vector<std::uint32_t>& cells,
              const Tell& tell);

 private:
  std::optional<TileFacts> find(const std::string& folder, const std::string& path,
                                const std::string& key);
  void enter(const std::string& folder);
  void put(const std::string& folder, const std::map<std::string, TileFacts>& facts);

  const TileFolder& folder_;
  Shelf& shelf_;
  KeptTiles tiles_;
  std::vector<std::string> folders_;        // that there are; the last is the one that is asked for
  std::map<std::string, TileFacts> there_;  // of it
  std::vector<std::string> damaged_;        // what was there, and is not as it was
};

}  // namespace colod
