// Options that every subcommand that reads meshes shares.
#pragma once

#include "cli.h"
#include "job/scene_choice.h"
#include "numbers.h"
#include "place/cloud_place.h"
#include "read/read.h"

namespace colod::cli {

inline void add_input_options(CLI::App& app, ReadOptions& read) {
  read.cloud_units = units_of_cloud;
  app.add_option_function<std::string>(
         "--up",
         [&read](const std::string& v) {
           read.up = v == "y" ? Up::kY : v == "auto" ? Up::kAuto : Up::kZ;
         },
         "the files' up axis: z (default, with a warning where it seems to be y), y, or auto, "
         "which decides and says so; glTF is y unless z is given, and auto turns it where its "
         "content is z up")
      ->check(CLI::IsMember({"z", "y", "auto"}));
  app.add_option_function<std::string>(
         "--unit",
         [&read](const std::string& v) {
           read.unit = v == "mm"   ? 1e-3
                       : v == "cm" ? 1e-2
                       : v == "in" ? 0.0254
                       : v == "ft" ? 0.3048
                                   : 1.0;
         },
         "the files' unit, glTF's too: m (default, with a warning where sizes tell otherwise; of "
         "LAS "
         "what its own reference system says), cm, mm, in, ft")
      ->check(CLI::IsMember({"m", "cm", "mm", "in", "ft"}));
  app.add_option(
         "--input-memory", read.input_memory,
         "MiB that one file may take, with those that it names, checked before they are read; "
         "default 2048")
      ->check(number_between(1.0, 4095.0));
  app.add_option_function<std::string>(
         "--split",
         [&read](const std::string& v) {
           read.split = v == "none"        ? Split::kNone
                        : v == "object"    ? Split::kObject
                        : v == "group"     ? Split::kGroup
                        : v == "component" ? Split::kComponent
                                           : Split::kAuto;
         },
         "how a file is taken apart into buildings: auto (default), none, object, group, component")
      ->check(CLI::IsMember({"auto", "none", "object", "group", "component"}));
}

/// For subcommands whose INPUT may be a scene.
inline void add_scene_options(CLI::App& app, SceneChoice& scene) {
  app.add_option_function<std::string>(
         "--scene",
         [&scene](const std::string& v) {
           scene.mode = v == "buildings" ? SceneMode::kBuildings
                        : v == "scene"   ? SceneMode::kScene
                                         : SceneMode::kAuto;
         },
         "auto (default): a tileset.json, a .3tz, a folder with a tileset, a folder with "
         "Data/Tile_*/, and one file that shows several buildings on terrain are scenes, all else "
         "is "
         "buildings; scene: the INPUT is a place with terrain "
         "and several buildings, each file of it a tile; buildings: each file holds buildings "
         "alone")
      ->check(CLI::IsMember({"auto", "buildings", "scene"}));
  app.add_option("--footprints", scene.footprints,
                 "of a scene: the plans of its buildings, in any format that GDAL reads (GeoJSON, "
                 "GeoPackage, Shapefile, CityJSON, FlatGeobuf); of a scene nowhere on Earth in its "
                 "own metres")
      ->check(CLI::ExistingFile);
  app.add_option("--footprint-id", scene.footprint_id,
                 "the attribute of --footprints that names buildings; default id, else name");
  app.add_option_function<std::string>(
         "--context",
         [&scene](const std::string& v) {
           scene.context = v == "none"     ? ContextMode::kNone
                           : v == "ground" ? ContextMode::kGround
                                           : ContextMode::kAuto;
         },
         "of a scene: auto (default) writes what is no building into the same tileset, cut out "
         "where buildings stand and closed below them; ground writes its terrain alone, without "
         "plants and clutter; none leaves it out")
      ->check(CLI::IsMember({"auto", "ground", "none"}));
  app.add_option("--source-level", scene.source_level,
                 "of a tileset: take tiles so many levels above the finest ones, default 0")
      ->check(number_between(0, 30));
}

/// For subcommands whose INPUT may be a folder.
inline void add_folder_options(CLI::App& app, ReadOptions& read) {
  app.add_flag("--recursive", read.is_recursive, "folders with their subfolders");
}

}  // namespace colod::cli
