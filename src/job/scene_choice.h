// What a caller says of a scene.
#pragma once

#include <string>

namespace colod {

enum class SceneMode { kAuto, kBuildings, kScene };
enum class ContextMode { kAuto, kNone, kGround };

struct SceneChoice {
  SceneMode mode = SceneMode::kAuto;
  ContextMode context = ContextMode::kAuto;  ///< what is no building: in the tileset, left out, or
                                             ///< its terrain alone
  std::string footprints;                    ///< a file of outlines; empty: they are found
  std::string footprint_id;  ///< the attribute that names buildings; empty: a usual one
  int source_level = 0;      ///< levels above the finest tiles, 0..30
};

}  // namespace colod
