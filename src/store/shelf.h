// Pieces of bytes by name in one file: what a cell's export hands to the merge.
#pragma once

#include <functional>
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

  /// Opens a file; `is_new_allowed` makes it when there is none. Throws Error{kInput} for one that
  /// is seen at once to be damaged, or not to be this colod's.
  Shelf(const std::string& path, bool is_new_allowed);
  /// Opens or makes a file that a run can make again: one that is damaged, or not this colod's, is
  /// deleted, `tell` gets a line that says so, and a new one is begun. Reads all of it.
  static Shelf open_or_renew(const std::string& path,
                             const std::function<void(const std::string& line)>& tell);
  ~Shelf();
  Shelf(Shelf&&) noexcept;

  /// Of all that is there, rising.
  std::vector<std::string> names() const;
  /// Replaces what is there under this name.
  void put(const std::string& name, const Pieces& pieces);
  enum class State { kAbsent, kWhole, kDamaged };
  /// Whether all that was put under this name is there, by the hashes of its bytes.
  State state(const std::string& name) const;
  /// Empty: not there, or damaged.
  std::string get(const std::string& name, const std::string& piece) const;
  /// What has other names goes away.
  void keep_only(const std::vector<std::string>& names);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colod
