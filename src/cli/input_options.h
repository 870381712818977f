// Options that every subcommand that reads meshes shares.
#pragma once

#include "cli.h"
#include "numbers.h"
#include "read/read.h"

namespace colod::cli {

inline void add_input_options(CLI::App& app, ReadOptions& read) {
  app.add_option_function<std::string>(
         "--up",
         [&read](const std::string& v) {
           read.up = v == "y" ? Up::kY : v == "auto" ? Up::kAuto : Up::kZ;
         },
         "the files' up axis: z (default, with a warning where it seems to be y), y, or auto, "
         "which decides and says so; glTF is y, and auto turns it where its content is z up")
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
         "the files' unit, glTF's too: m (default, with a warning where sizes tell otherwise), cm, "
         "mm, in, ft")
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

/// For subcommands whose INPUT may be a folder.
inline void add_folder_options(CLI::App& app, ReadOptions& read) {
  app.add_flag("--recursive", read.is_recursive, "folders with their subfolders");
}

}  // namespace colod::cli
