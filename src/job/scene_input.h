// Inputs → what the pipeline reads: files with buildings, or one scene that is taken apart.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/pipeline.h"
#include "place/footprints.h"
#include "publish/messages.h"
#include "read/read.h"
#include "scene/classes.h"
#include "scene/survey.h"
#include "scene/territory.h"
#include "scene/tiles.h"
#include "scene_choice.h"

namespace colod {

/// A scene that was taken apart. Shared by all that read from it.
struct PartedScene {
  SceneTiles tiles;
  std::optional<Georeference> place;  ///< none: nowhere on Earth
  std::vector<Footprint> footprints;
  Territories territories;
  HeightMap map;         ///< empty where it is not needed
  SceneClasses classes;  ///< of the map
};

struct Inputs {
  Inventory inventory;
  Reader read;
  std::shared_ptr<const PartedScene> scene;      ///< null: files with buildings
  std::map<std::string, Attributes> attributes;  ///< by building's name
  std::shared_ptr<const Context> context;        ///< null: none is written
  std::vector<ClassArea> classes;                ///< of a scene whose map was drawn
  std::string found_footprints;                  ///< as GeoJSON; empty: they were given
};

/// What of the output's options a scene is opened with.
struct SceneOutput {
  std::string crs, origin;
  double target_sse = 16, pixel_error = 2;  ///< pixels
};

/// Tells what an INPUT is taken for, and why. Throws Error{kInput} for inputs that are not there or
/// a scene without a tile, Error{kUsage} for options that do not go together.
Inputs open_inputs(const std::vector<std::string>& inputs, const ReadOptions& read,
                   const SceneChoice& choice, const SceneOutput& output, const Tell& tell);

}  // namespace colod
