// The tiles of a scene as a store: each is read when it is asked for, and let go of when others
// need the room.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "read/tileset.h"

namespace colod {

struct HeightMap;

class SceneTiles {
 public:
  /// Reads each of the finest tiles once, to learn where it lies and whether it can be read.
  /// `to_scene`: the tree's root frame → the scene's. Where `may_turn` (the scene is nowhere on
  /// Earth) and options do not say which axis is up, the surface tells: what faces up of a scene
  /// that was seen from above is far more than what faces any other way.
  SceneTiles(TileTree tree, const Eigen::Matrix4d& to_scene, int coarser, bool may_turn,
             const ReadOptions& options);
  /// The squares of a map that was made of a cloud, `path`.
  SceneTiles(const std::string& path, std::shared_ptr<const HeightMap> surface);
  ~SceneTiles();
  SceneTiles(SceneTiles&&) noexcept;

  std::size_t count() const;
  /// Thread-safe. A tile that could be read once and no longer can throws Error{kInput}.
  std::shared_ptr<const Source> get(std::size_t tile) const;
  /// In the scene's frame, z up, metres.
  const Box& box(std::size_t tile) const;
  const Box& box() const;
  /// Those that may have something over an area; heights do not count.
  std::vector<std::size_t> over(const Box& area) const;

  const TileTree& tree() const;
  /// Of the tree: the nodes whose tiles these are, rising.
  const std::vector<int>& finest() const;
  const Eigen::Matrix4d& to_scene() const;  ///< turned as it was found to be
  std::size_t faces() const;
  const std::vector<ReadFailure>& failures() const;  ///< of the tree, and of tiles
  const std::vector<std::string>& warnings() const;
  /// Of the tree: the one that a tile is, or is a part of.
  int node(std::size_t tile) const;
  /// Whether it is a part of a mesh that was too large for one tile.
  bool is_piece(std::size_t tile) const;
  /// Null where tiles are meshes.
  const std::shared_ptr<const HeightMap>& surface() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Several meshes of one scene as one; equal vertices and images become one.
Source joined(const std::vector<Source>& parts);

}  // namespace colod
