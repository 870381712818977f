// 3TZ: a whole tileset in one file.
#pragma once

#include <cstdint>
#include <functional>

#include "exporters/exporter.h"

namespace colod {

/// tileset.3tz: a ZIP of stored files, tileset.json among them, whose last entry is the index
/// "@3dtilesIndex1@" (MD5 of a path → place of its local header). Large archives become ZIP64.
/// No entry may reach 4 GiB: throws Error{kOutput}.
Encoded encode_3tz(const std::vector<Encoded>& files);

constexpr const char* kArchiveName = "tileset.3tz";

/// The same file by file: in memory is where they are, some 100 bytes each.
class ArchiveWriter {
 public:
  /// `append` takes the archive's bytes.
  explicit ArchiveWriter(std::function<void(const std::string&)> append)
      : append_(std::move(append)) {}

  void add(const std::string& path, const std::string& bytes);
  /// After the last file.
  void finish();

  struct Entry {
    std::string path;
    std::uint64_t offset = 0;
    std::uint32_t crc = 0, size = 0;
  };

 private:
  void put(const std::string& bytes);

  std::function<void(const std::string&)> append_;
  std::vector<Entry> entries_;
  std::uint64_t end_ = 0;
};

}  // namespace colod
