// Inputs → what the pipeline reads: files with buildings, or one scene that is taken apart.
#pragma once

#include <functional>
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
  std::vector<std::string> names;  ///< of the footprints' buildings
  bool is_found = false;           ///< the footprints are by the program, not of a file
  Territories territories;
  HeightMap map;         ///< empty where it is not needed
  SceneClasses classes;  ///< of the map
};

struct Inputs {
  Inventory inventory;
  Reader read;
  std::shared_ptr<const PartedScene> scene;      ///< null: files with buildings
  std::map<std::string, Attributes> attributes;  ///< by building's name
  std::vector<ClassArea> classes;                ///< of a scene whose map was drawn
  /// What is no building of a scene, once it is known for which of its footprints there is a mesh;
  /// null: none is written.
  std::function<std::shared_ptr<const Context>(const std::vector<char>& is_unbuilt)> context;
};

/// What of the output's options a scene is opened with.
struct SceneOutput {
  std::string crs, origin;
  double target_sse = 16, pixel_error = 2;  ///< pixels
};

/// What a scene has beside its buildings: those without a mesh stay in the context as the source
/// shows them, and what was dismissed goes from the buildings and the footprints. Nothing for files
/// with buildings. Throws Error{kInput} where all were dismissed.
void add_place(const Inputs& inputs, Scene& built);

/// Tells what an INPUT is taken for, and why. Throws Error{kInput} for inputs that are not there or
/// a scene without a tile, Error{kUsage} for options that do not go together.
Inputs open_inputs(const std::vector<std::string>& inputs, const ReadOptions& read,
                   const SceneChoice& choice, const SceneOutput& output, const Tell& tell);

}  // namespace colod
