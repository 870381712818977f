// Archives made up for tests, by minizip: good ones, and ones that nobody should write.
#pragma once

#include <zip.h>

#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace colod::test {

struct ArchiveEntry {
  std::string name, bytes;
  bool is_packed = true;   ///< by deflate; else stored
  unsigned long mode = 0;  ///< of Unix, as S_IFLNK; 0: not said
  const char* password = nullptr;
  std::uint64_t claimed = 0;  ///< bytes that it says to unpack to; 0: the truth
  bool is_zip64 = false;
};

inline void add_entry(zipFile zip, const ArchiveEntry& e) {
  zip_fileinfo info = {};
  info.external_fa = e.mode << 16;
  const bool is_raw = e.claimed > 0;
  constexpr unsigned long kByUnix = 3 << 8;
  REQUIRE(zipOpenNewFileInZip4_64(zip, e.name.c_str(), &info, nullptr, 0, nullptr, 0, nullptr,
                                  e.is_packed ? Z_DEFLATED : 0, 6, is_raw, -MAX_WBITS,
                                  DEF_MEM_LEVEL, Z_DEFAULT_STRATEGY, e.password, 0, kByUnix, 0,
                                  e.is_zip64) == ZIP_OK);
  zipWriteInFileInZip(zip, e.bytes.data(), static_cast<unsigned>(e.bytes.size()));
  CHECK((is_raw ? zipCloseFileInZipRaw64(zip, e.claimed, 0) : zipCloseFileInZip(zip)) == ZIP_OK);
}

inline std::string write_archive(const std::string& path,
                                 const std::vector<ArchiveEntry>& entries) {
  zipFile zip = zipOpen64(path.c_str(), APPEND_STATUS_CREATE);
  REQUIRE(zip);
  for (const ArchiveEntry& e : entries) add_entry(zip, e);
  CHECK(zipClose(zip, nullptr) == ZIP_OK);
  return path;
}

}  // namespace colod::test
