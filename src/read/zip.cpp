// Based on: ZIP (PKWARE's APPNOTE 6.3) as minizip reads it.
// Differs: nothing that an entry says of itself is trusted: names are made plain before a file is
// opened, sizes are added up before anything is unpacked, and no more is written than was said.
#include "zip.h"

#include <sys/stat.h>
#include <unzip.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>

#include "formats.h"

namespace colod::mesh_io {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kMostMembers = 2'000'000;  // as many as a tileset may have tiles
constexpr std::size_t kLongestName = 1024;         // bytes, with folders
constexpr std::uint64_t kMebibyte = 1 << 20;
// Text packs to a thirtieth, meshes and pictures to two thirds: what grows further is a bomb. Small
// ones harm nobody.
constexpr std::uint64_t kMostTimes = 100, kHarmless = 64 * kMebibyte;
constexpr const char* kIndex = "@3dtilesIndex1@";

struct Closer {
  void operator()(void* zip) const { unzClose(zip); }
};
using Zip = std::unique_ptr<void, Closer>;

struct ZipEntry {
  std::string name;
  unz64_file_pos place;
  unz_file_info64 info;
};

std::string in_mib(std::uint64_t bytes) { return std::to_string(bytes / kMebibyte) + " MiB"; }

/// Whether all that a file holds is the end of an archive's list of no entries, which minizip takes
/// for none, with or without a comment.
bool is_empty_archive(const std::string& path) {
  constexpr std::size_t kEnd = 22;
  std::string end(kEnd, '\0');
  std::ifstream in(path, std::ios::binary);
  if (!in.read(end.data(), kEnd) || !end.starts_with("PK\5\6")) return false;
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(end[at]); };
  return std::all_of(end.begin() + 4, end.end() - 2, [](char c) { return c == 0; }) &&
         fs::file_size(path) == kEnd + byte(20) + 256u * byte(21);
}

Zip open_zip(const std::string& path) {
  Zip zip(unzOpen64(path.c_str()));
  if (!zip && is_empty_archive(path)) fail(path, "is an empty archive: it holds no entries");
  if (!zip)
    fail(path, "is no ZIP archive, or is cut: its list of entries, which stands last, is missing");
  return zip;
}

std::vector<ZipEntry> list_entries(const std::string& path, unzFile zip) {
  unz_global_info64 all;
  if (unzGetGlobalInfo64(zip, &all) != UNZ_OK) fail(path, "its list of entries is damaged");
  if (all.number_entry > kMostMembers)
    fail(path, "says that it has " + std::to_string(all.number_entry) + " entries, more than " +
                   std::to_string(kMostMembers));
  std::vector<ZipEntry> out;
  std::vector<char> name(1 << 16);
  int state = UNZ_OK;
  for (std::uint64_t i = 0; i < all.number_entry && state == UNZ_OK; ++i) {
    ZipEntry e;
    state = i == 0 ? unzGoToFirstFile(zip) : unzGoToNextFile(zip);
    if (state == UNZ_OK)
      state =
          unzGetCurrentFileInfo64(zip, &e.info, name.data(), name.size(), nullptr, 0, nullptr, 0);
    if (state == UNZ_OK) state = unzGetFilePos64(zip, &e.place);
    if (state != UNZ_OK) break;
    e.name.assign(name.data(), std::min<std::size_t>(e.info.size_filename, name.size()));
    out.push_back(std::move(e));
  }
  if (out.size() != all.number_entry)
    fail(path, "its list of entries is damaged: it ends after " + std::to_string(out.size()) +
                   " of " + std::to_string(all.number_entry));
  return out;
}

/// Before anything is unpacked.
void check_room(const std::string& path, const std::string& folder,
                const std::vector<ZipEntry>& entries) {
  const std::uint64_t room = fs::space(folder).available, own = fs::file_size(path);
  const std::uint64_t most = std::max(kHarmless, kMostTimes * own);
  std::uint64_t total = 0;
  for (const ZipEntry& e : entries) {
    const std::uint64_t size = e.info.uncompressed_size;
    total = size > UINT64_MAX - total ? UINT64_MAX : total + size;
  }
  if (total > most)
    fail(path, "would unpack to " + in_mib(total) + ", more than " + std::to_string(kMostTimes) +
                   " times what it takes, which no tiles do: nothing of it is unpacked");
  if (total > room)
    fail(path, "would unpack to " + in_mib(total) + ", and the folder for temporary files has " +
                   in_mib(room) + " left: TMPDIR names another one");
}

/// Its folders and itself, without those that mean nothing.
std::vector<std::string> parts_of(const std::string& name) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= name.size();) {
    const std::size_t end = std::min(name.find('/', at), name.size());
    const std::string part = name.substr(at, end - at);
    if (!part.empty() && part != ".") parts.push_back(part);
    at = end + 1;
  }
  return parts;
}

std::string fault_of_name(const std::string& name) {
  if (name.size() > kLongestName) return "has a name of " + std::to_string(name.size()) + " bytes";
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 127; };
  if (std::any_of(name.begin(), name.end(), is_control))
    return "has a name with control characters";
  if (name.find('\\') != name.npos) return "has a backslash in its name, where 3TZ has '/'";
  if (name.starts_with('/') || name.find(':') != name.npos)
    return "has an absolute name, which leads out of the archive";
  const std::vector<std::string> parts = parts_of(name);
  if (std::count(parts.begin(), parts.end(), "..") > 0)
    return "has '..' in its name, which leads out of the archive";
  return parts.empty() ? "has no name" : "";
}

std::string fault_of(const unz_file_info64& info, std::uint64_t most_bytes) {
  const auto kind = info.external_fa >> 16 & S_IFMT;
  if (kind != 0 && kind != S_IFREG && kind != S_IFDIR) return "is a link or a device, no file";
  constexpr unsigned long kEncrypted = 1 | 1 << 6 | 1 << 13;
  if (info.flag & kEncrypted) return "is encrypted, which is not read";
  const unsigned long method = info.compression_method;
  if (method == 93 || method == 20)
    return "is packed with Zstandard, which is not read: `bsdtar -xf IN.3tz -C DIR` "
           "(libarchive 3.6 or newer) unpacks it, then DIR is the input";
  if (method != 0 && method != Z_DEFLATED)
    return "is packed by method " + std::to_string(method) +
           ", which is not read: stored and deflate are";
  if (info.uncompressed_size > most_bytes)
    return "takes " + in_mib(info.uncompressed_size) + ", more than --input-memory " +
           std::to_string(most_bytes / kMebibyte) + " allows one file";
  return "";
}

/// Bytes of an entry → `take`, which says whether it can go on; what went wrong, or nothing.
template <typename Take>
std::string read_entry(unzFile zip, const ZipEntry& e, const Take& take) {
  unz64_file_pos place = e.place;
  if (unzGoToFilePos64(zip, &place) != UNZ_OK || unzOpenCurrentFile(zip) != UNZ_OK)
    return "is damaged: its own header contradicts the list of entries";
  std::vector<char> buffer(1 << 16);
  std::uint64_t left = e.info.uncompressed_size;
  int count = 0;
  while ((count = unzReadCurrentFile(zip, buffer.data(), static_cast<unsigned>(buffer.size()))) >
         0) {
    const auto bytes = static_cast<std::uint64_t>(count);
    if (bytes > left || !take(buffer.data(), bytes)) break;
    left -= bytes;
  }
  const bool is_whole = unzCloseCurrentFile(zip) == UNZ_OK && count == 0 && left == 0;
  return is_whole ? "" : "is damaged: its bytes contradict its length or checksum";
}

std::string write_entry(const std::string& path, unzFile zip, const ZipEntry& e,
                        const fs::path& file) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  std::ofstream out(file, std::ios::binary);
  if (error || !out) return "has a name that no file can have beside the others";
  const std::string fault = read_entry(zip, e, [&](const char* bytes, std::uint64_t size) {
    return static_cast<bool>(out.write(bytes, static_cast<std::streamsize>(size)));
  });
  out.close();
  if (!out)
    fail(path, "cannot be unpacked: the folder for temporary files is full; TMPDIR names another");
  if (!fault.empty()) fs::remove(file, error);
  return fault;
}

}  // namespace

std::vector<LeftOut> unzip(const std::string& path, const std::string& folder,
                           std::uint64_t most_bytes) {
  const Zip zip = open_zip(path);
  const std::vector<ZipEntry> entries = list_entries(path, zip.get());
  check_room(path, folder, entries);
  std::vector<LeftOut> out;
  std::set<std::string> seen;
  for (const ZipEntry& e : entries) {
    LeftOut entry{e.name, "", fault_of_name(e.name)};
    if (entry.cause.empty()) {
      if (e.name.ends_with('/') || e.name == kIndex) continue;
      fs::path file = folder;
      for (const std::string& part : parts_of(e.name)) file /= part;
      entry.file = file.string();
      if (seen.insert(entry.file).second) {
        entry.cause = fault_of(e.info, most_bytes);
        if (entry.cause.empty()) entry.cause = write_entry(path, zip.get(), e, file);
      } else {
        entry.file.clear();
        entry.cause = "comes twice: the first one is taken";
      }
    }
    if (!entry.cause.empty()) out.push_back(std::move(entry));
  }
  return out;
}

std::optional<std::string> read_zipped(const std::string& path, const std::string& name,
                                       std::uint64_t most_bytes) {
  const Zip zip = open_zip(path);
  for (const ZipEntry& e : list_entries(path, zip.get())) {
    if (!fault_of_name(e.name).empty() || parts_of(e.name) != parts_of(name)) continue;
    if (!fault_of(e.info, most_bytes).empty()) return {};
    std::string bytes;
    const std::string fault = read_entry(zip.get(), e, [&](const char* more, std::uint64_t size) {
      bytes.append(more, size);
      return true;
    });
    if (fault.empty()) return bytes;
    return {};
  }
  return {};
}

}  // namespace colod::mesh_io
