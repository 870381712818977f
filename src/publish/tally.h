// What a scene's own figures count of its buildings, so that they need not all be in memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "pipeline/pipeline.h"

namespace colod {

struct Tally {
  std::size_t buildings = 0;
  std::size_t done = 0;    ///< that have layers
  std::size_t lossy = 0;   ///< of those, that have lost something, or a layer
  std::size_t amiss = 0;   ///< that failed, or have lost something, or a layer
  std::size_t failed = 0;  ///< that have no layer at all
  std::size_t failed_layers = 0, stand_in_layers = 0, lost_bodies = 0, lost_textures = 0;
  std::size_t segments = 0, beyond_layer0 = 0;
  std::uint64_t rays = 0;
  double ray_seconds = 0;

  Tally& operator+=(const Tally& other);
};

Tally tally_of(const Building& building);
Tally tally_of(const Scene& scene);

}  // namespace colod
