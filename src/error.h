// What bad input, options or files are answered with. A programmer's mistake is an assert instead.
#pragma once

#include <stdexcept>
#include <string>

namespace colod {

/// Exit codes of the command line (DESIGN: 0 all done, 1 some buildings failed).
enum class Stage { kUsage = 2, kInput = 3, kProcess = 4, kOutput = 5 };

/// Caught once in main, and once per building in the pipeline. `item` names the file, building or
/// option.
struct Error : std::runtime_error {
  Error(Stage stage, std::string item, const std::string& message)
      : std::runtime_error(item + ": " + message), stage(stage), item(std::move(item)) {}
  Stage stage;
  std::string item;
};

}  // namespace colod
