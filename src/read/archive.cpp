// Based on: 3D Tiles Archive Format 1.4 (vnd.maxar.archive.3tz+zip).
// Differs: the index of places by MD5 is not asked: the list of entries that every ZIP ends with
// holds the same, and an archive whose index is wrong is read all the same.
#include "archive.h"

#include <algorithm>
#include <filesystem>

#include "files.h"
#include "formats.h"
#include "zip.h"

namespace colod {

namespace fs = std::filesystem;

namespace {

constexpr double kMib = 1 << 20;

/// A name that may hold any bytes, for a message of one line.
std::string printable(const std::string& name) {
  std::string out = name.substr(0, 120);
  for (char& c : out)
    if (static_cast<unsigned char>(c) < ' ' || c == 127) c = '?';
  return "'" + out + "'";
}

}  // namespace

bool is_archive(const std::string& path) {
  return mesh_io::lower(fs::path(path).extension().string()) == ".3tz";
}

std::optional<std::string> read_archived(const std::string& archive, const std::string& name) {
  return mesh_io::read_zipped(archive, name,
                              static_cast<std::uint64_t>(ReadOptions().input_memory * kMib));
}

Unpacked::Unpacked(const std::string& path, const ReadOptions& options) : path_(path) {
  fs::create_directory(place_ / "files");
  folder_ = fs::canonical(place_ / "files").string();
  tileset_ = folder_ + "/tileset.json";
  for (mesh_io::LeftOut& entry :
       mesh_io::unzip(path, folder_, static_cast<std::uint64_t>(options.input_memory * kMib))) {
    if (!entry.file.empty()) fault_.emplace(entry.file, faults_.size());
    faults_.push_back({std::move(entry.name), std::move(entry.cause)});
  }
  std::error_code error;
  if (fs::is_regular_file(tileset_, error)) return;
  const std::string fault = tell_fault(tileset_);
  mesh_io::fail(path, fault.empty() ? "holds no tileset.json at its root: it is no 3TZ"
                                    : "its tileset.json " + fault);
}

std::string Unpacked::tell_fault(const std::string& file) {
  const auto found = fault_.find(file);
  if (found == fault_.end()) return "";
  Fault& fault = faults_[found->second];
  fault.is_told = true;
  return fault.cause;
}

std::vector<std::string> Unpacked::untold() const {
  std::vector<std::string> lines;
  std::map<std::string, std::size_t> count;
  for (const Fault& f : faults_) count[f.cause] += !f.is_told;
  for (const Fault& f : faults_) {
    if (f.is_told || count[f.cause] == 0) continue;
    lines.push_back(path_ + ": entry " + printable(f.name) + " is left out: it " + f.cause);
    if (count[f.cause] > 1)
      lines.back() += " (and " + std::to_string(count[f.cause] - 1) + " more entries)";
    count[f.cause] = 0;
  }
  return lines;
}

std::string Unpacked::shown(std::string text) const {
  const std::string own = path_ + "/";
  for (std::size_t at = text.find(folder_ + "/"); at != text.npos;
       at = text.find(folder_ + "/", at + own.size()))
    text.replace(at, folder_.size() + 1, own);
  return text;
}

}  // namespace colod
