// 3TZ: a whole tileset as one archive, unpacked for as long as somebody works on it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/program.h"
#include "read.h"

namespace colod {

/// By its name: .3tz.
bool is_archive(const std::string& path);

/// What one file of an archive holds; none where it is not there or cannot be read. Throws
/// Error{kInput} for what is no archive.
std::optional<std::string> read_archived(const std::string& archive, const std::string& name);

/// The files of an archive in a temporary folder that goes away with this. Entries that may not be
/// unpacked, or cannot, are left out and named: whose name leads out of the archive or comes twice,
/// links, what is encrypted, damaged, packed by another method than deflate, or larger than
/// --input-memory.
class Unpacked {
 public:
  /// Throws Error{kInput} for what is no archive or one that is cut, that unpacks to far more than
  /// it takes or than the disk has room for, that has too many entries or no tileset.json at its
  /// root, and where the program was built without minizip.
  Unpacked(const std::string& path, const ReadOptions& options);

  const std::string& tileset() const { return tileset_; }  ///< its tileset.json, unpacked

  /// Why a file of the folder was left out, which counts as told then; empty: it was not.
  std::string tell_fault(const std::string& file);

  /// One line for each fault of entries that nobody was told of.
  std::vector<std::string> untold() const;

  /// A text that names files as they lie in the archive, not in the folder.
  std::string shown(std::string text) const;

 private:
  struct Fault {
    std::string name, cause;
    bool is_told = false;
  };

  std::string path_;
  Workplace place_;
  std::string folder_, tileset_;
  std::vector<Fault> faults_;                 // in the archive's order
  std::map<std::string, std::size_t> fault_;  // of a file that was left out
};

}  // namespace colod
