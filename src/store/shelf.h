// Pieces of bytes by name in one file: what a cell's export hands to the merge.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace colod {

/// A SQLite database of its own (docs/scale.md). All pieces of a name are written in one
/// transaction, so that a killed run leaves whole names only. Not thread-safe. Every function
/// throws Error{kInput} (reading) or Error{kOutput} (writing) naming the file.
class Shelf {
 public:
  using Pieces = std::map<std::string, std::string>;

  /// Opens a file; `is_new_allowed` makes it when there is none.
  Shelf(const std::string& path, bool is_new_allowed);
  ~Shelf();
  Shelf(Shelf&&) noexcept;

  /// Of all that is there, rising.
  std::vector<std::string> names() const;
  /// Replaces what is there under this name.
  void put(const std::string& name, const Pieces& pieces);
  /// Empty: not there.
  std::string get(const std::string& name, const std::string& piece) const;
  /// What has other names goes away.
  void keep_only(const std::vector<std::string>& names);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colod
