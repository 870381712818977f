// What bad input, options or files are answered with. A programmer's mistake is an assert instead.
#pragma once

#include <stdexcept>
#include <string>

namespace colod {

/// Exit codes of the command line; 0 is all done, 1 some buildings failed.
enum class Stage { kUsage = 2, kInput = 3, kProcess = 4, kOutput = 5 };

/// Caught once in main, and once per building in the pipeline. `item` names the file, building or
/// option; what() is one line: "item: message".
struct Error : std::runtime_error {
  Error(Stage where, std::string what_item, const std::string& message)
      : std::runtime_error(what_item + ": " + message), stage(where), item(std::move(what_item)) {}
  Stage stage;
  std::string item;
};

}  // namespace colod
