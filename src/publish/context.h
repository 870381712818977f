// Inside room `publish`: what of a scene is no building, for the tileset.
#pragma once

#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "exporters/tiles3d/context.h"
#include "outputs.h"

namespace colod {

/// Images of the context that cannot be shown. Thread-safe.
class LostImages {
 public:
  void add(const std::string& line) {
    const std::lock_guard lock(mutex_);
    lines_.insert(line);
  }
  /// Each once, sorted.
  std::vector<std::string> lines() const { return {lines_.begin(), lines_.end()}; }

 private:
  std::mutex mutex_;
  std::set<std::string> lines_;
};

/// Nothing where the scene has no context. It points into `scene`, and into `lost`, which learns of
/// images as meshes are asked for.
std::optional<ContextTiles> context_tiles(const Scene& scene, const TextureOptions& options,
                                          LostImages& lost);

}  // namespace colod
