// Inside check: reading what a folder holds and names. The folder may be anybody's: only regular
// files are read, up to a size, and none outside of it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "check.h"

namespace colod {

/// As nlohmann parses it; discarded where it is no JSON, or nests deeper than kDeepestJson levels,
/// so that what walks it recursively keeps its stack.
nlohmann::json parse_json(const std::string& text);
constexpr int kDeepestJson = 1000;

/// The folder that nothing may lead out of.
class CheckedFolder {
 public:
  explicit CheckedFolder(const std::filesystem::path& root);

  /// Where a URI of a file in `base` leads. Empty, with a finding, where it is absolute, names
  /// another host, leads out of the folder (through a link, too) or to no file.
  std::filesystem::path resolve(const std::filesystem::path& base, const std::string& uri,
                                const std::string& where, std::vector<Finding>& findings) const;

  bool holds(const std::filesystem::path& path) const;

 private:
  std::filesystem::path root_;
};

/// All bytes of a regular file of at most 1 GiB. Throws Error{kInput} for anything else.
std::string read_regular(const std::filesystem::path& path);

}  // namespace colod
