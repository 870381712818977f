// Options that every subcommand that reads meshes shares.
#pragma once

#include "../mesh_io.h"
#include "cli.h"

namespace colod::cli {

inline void add_input_options(CLI::App& app, ReadOptions& read) {
  app.add_option_function<std::string>(
         "--up", [&read](const std::string& v) { read.is_y_up = v == "y"; },
         "the files' up axis: z (default) or y; glTF is always y")
      ->check(CLI::IsMember({"z", "y"}));
  app.add_option_function<std::string>(
         "--unit",
         [&read](const std::string& v) {
           read.unit = v == "mm" ? 1e-3 : v == "cm" ? 1e-2 : v == "ft" ? 0.3048 : 1.0;
         },
         "the files' unit: m (default), cm, mm, ft")
      ->check(CLI::IsMember({"m", "cm", "mm", "ft"}));
  app.add_option_function<std::string>(
         "--split",
         [&read](const std::string& v) {
           read.split = v == "none"        ? Split::kNone
                        : v == "object"    ? Split::kObject
                        : v == "component" ? Split::kComponent
                                           : Split::kAuto;
         },
         "how a file is taken apart into buildings: auto (default), none, object, component")
      ->check(CLI::IsMember({"auto", "none", "object", "component"}));
}

}  // namespace colod::cli
