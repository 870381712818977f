// Based on: nothing published; what the formats' writers get wrong decides what is checked.
// Differs: --rules does not matter here.
#include "read.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <new>
#include <set>
#include <tuple>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "files.h"
#include "formats.h"
#include "look.h"
#include "split.h"
#include "tileset.h"
#include "whole.h"

namespace colod {

namespace fs = std::filesystem;
using mesh_io::is_usable;
using mesh_io::lower;
using mesh_io::RawFile;
using mesh_io::Triangles;

std::string safe_name(const std::string& name) {
  std::string safe;
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    const bool is_word = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
                         (c >= 'a' && c <= 'z') || c == '-' || c == '_' || c == '.';
    if (u < 0x80 || u >= 0xC0) safe += is_word ? c : '_';  // one '_' for a UTF-8 character
  }
  if (safe.size() > 100) safe.resize(100);
  if (safe.empty() || safe.find_first_not_of("._") == safe.npos) return "building";
  if (safe.front() == '.') safe.front() = '_';
  return safe;
}

namespace {

Vec3 to_z_up(const Vec3& p) { return {p.x(), -p.z(), p.y()}; }
Vec3 to_y_up(const Vec3& p) { return {p.x(), p.z(), -p.y()}; }

/// Units, axes and origin; normals made unit length. Unusable points stay as they are.
void place(RawFile& raw, const mesh_io::Reading& how) {
  const auto turned = [&](const Vec3& p) {
    return how.is_y_up ? to_z_up(p) : how.is_turned_back ? to_y_up(p) : p;
  };
  for (Vec3& p : raw.points) p = turned(p) * how.unit + raw.origin;
  for (Vec3& n : raw.normals) {
    n = turned(n);
    const double length = n.norm();
    n = length > 0 && std::isfinite(length) ? Vec3(n / length) : Vec3(Vec3::Zero());
  }
}

/// Everything a file says, split as asked; `stem` is what names begin with. Throws when nothing in
/// it is usable.
std::vector<Source> validate(const std::string& path, const std::string& stem, RawFile raw,
                             const ReadOptions& options) {
  mesh_io::check_faces(path, raw);
  if (raw.is_turned && raw.origin.norm() > mesh_io::kEarth)
    raw.warnings.push_back(
        "its coordinates are seen from the middle of the Earth: the axes stay as they are, so that "
        "buildings may lie tilted; its tileset.json, read as a scene, turns them upright");
  const mesh_io::Reading how = mesh_io::judge(path, raw, options);
  place(raw, how);
  std::vector<Source> sources;
  mesh_io::Parting parting{{}, {{"", ""}}, ""};
  if (raw.face_count() == 0) {
    sources.push_back(mesh_io::read_cloud(path, raw));
  } else {
    mesh_io::color_corners(raw);
    mesh_io::warn_of_unworn(raw);
    if (raw.is_soup) {
      const std::vector<int> first = mesh_io::weld(raw.points);
      for (int& c : raw.corners) c = first[c];
    }
    int dropped = 0;
    const Triangles all = mesh_io::triangulate(raw, dropped);
    parting = mesh_io::part_buildings(raw, all, options.split);
    std::vector<std::vector<int>> chosen(parting.parts.size());
    for (std::size_t t = 0; t < all.faces.size(); ++t)
      if (const int part = parting.part_of[t]; part >= 0)
        chosen[part].push_back(static_cast<int>(t));
    for (const std::vector<int>& triangles : chosen)
      sources.push_back(mesh_io::take(raw, all, triangles));
    if (dropped > 0)
      raw.warnings.push_back(std::to_string(dropped) +
                             " faces left out: a coordinate is not finite");
  }
  std::vector<Source> usable;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    Source& s = sources[i];
    if (s.is_mesh()) mesh_io::leave_out_strays(s);
    if (s.cloud.points.empty() && !mesh_io::has_area(s.mesh)) continue;
    s.path = path;
    s.is_turned_back = how.is_turned_back;
    const mesh_io::Part& part = parting.parts[i];
    s.name = safe_name(part.name.empty() ? stem : stem + "_" + part.name);
    s.given_name = part.given.empty() ? stem : part.given;
    s.warnings.insert(s.warnings.begin(), raw.warnings.begin(), raw.warnings.end());
    if (usable.empty() && !parting.message.empty())  // of the file, said once
      s.warnings.push_back(fs::path(path).filename().string() + ": " + parting.message);
    usable.push_back(std::move(s));
  }
  if (!usable.empty())
    usable[0].warnings.insert(usable[0].warnings.begin(), how.doubts.begin(), how.doubts.end());
  else
    mesh_io::fail(path, "none of " + std::to_string(raw.face_count()) +
                            " faces has a positive area and finite coordinates");
  return usable;
}

std::vector<Source> read_file(const std::string& path, const ReadOptions& options) {
  return validate(path, fs::path(path).stem().string(), mesh_io::read_raw(path, options), options);
}

RawFile raw_of(const NamedArrays& arrays) {
  RawFile raw;
  raw.is_from_memory = true;
  raw.points = arrays.points;
  raw.normals = arrays.normals;
  for (const Face& f : arrays.triangles) {
    raw.face_begin.push_back(static_cast<int>(raw.corners.size()));
    raw.corners.insert(raw.corners.end(), f.begin(), f.end());
  }
  if (!raw.normals.empty() && raw.normals.size() != raw.points.size())
    mesh_io::fail(arrays.name, std::to_string(raw.normals.size()) + " normals for " +
                                   std::to_string(raw.points.size()) + " points");
  return raw;
}

/// One building of one file.
struct Entry {
  std::string path, name;
  std::size_t file, place;  ///< place in its file
};

/// Sorts by name and path; names differ even where upper and lower case do not: the later one by
/// path and place changes.
void make_unique(std::vector<Entry>& entries) {
  const auto by_name = [](const Entry& a, const Entry& b) {
    return std::tie(a.name, a.path) < std::tie(b.name, b.path);
  };
  std::stable_sort(entries.begin(), entries.end(), by_name);
  std::set<std::string> used;
  for (const Entry& e : entries) used.insert(lower(e.name));
  std::set<std::string> given;
  for (Entry& e : entries) {
    const std::string base = e.name;
    for (int i = 2; !given.insert(lower(e.name)).second; ++i) do
        e.name = base + "_" + std::to_string(i);
      while (used.contains(lower(e.name)) && ++i);
  }
}

}  // namespace

Inventory take_inventory(const std::vector<std::string>& inputs, const ReadOptions& options) {
  mesh_io::InputList list = mesh_io::list_files(inputs, options.is_recursive);
  const std::vector<std::string>& paths = list.files;
  std::vector<std::vector<std::string>> found(paths.size());
  std::vector<std::string> problem(paths.size());
  parallel_for(paths.size(), [&](std::size_t i) {
    try {
      for (const Source& s : read_file(paths[i], options)) found[i].push_back(s.name);
    } catch (const Error& e) {
      problem[i] = std::string(e.what()).substr(e.item.size() + 2);
    } catch (const std::bad_alloc&) {
      problem[i] = "needs more memory than there is: fewer --threads, or a smaller file";
    } catch (const std::exception& e) {  // a library gave up: this file's problem only
      problem[i] = std::string("cannot be read: ") + e.what();
    }
  });
  Inventory inventory;
  inventory.warnings = std::move(list.warnings);
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (found[i].empty()) {
      inventory.failures.push_back({paths[i], problem[i]});
      continue;
    }
    for (std::size_t place = 0; place < found[i].size(); ++place)
      entries.push_back({paths[i], found[i][place], inventory.files.size(), place});
    inventory.files.push_back({paths[i], std::move(found[i])});
  }
  make_unique(entries);
  for (const Entry& e : entries) inventory.files[e.file].names[e.place] = e.name;
  return inventory;
}

std::vector<Source> read_file(const InputFile& file, const ReadOptions& options) {
  double seconds = 0;
  std::vector<Source> sources;
  {
    Stopwatch watch(seconds);
    sources = read_file(file.path, options);
  }
  if (sources.size() != file.names.size())
    mesh_io::fail(file.path, "changed while it was being worked on");
  for (std::size_t i = 0; i < sources.size(); ++i) {
    sources[i].name = file.names[i];
    sources[i].read_seconds = seconds;
  }
  return sources;
}

ReadResult read_sources(const std::vector<std::string>& inputs, const ReadOptions& options) {
  Inventory inventory = take_inventory(inputs, options);
  ReadResult result;
  result.failures = std::move(inventory.failures);
  for (const InputFile& file : inventory.files)
    for (Source& s : read_file(file, options)) result.sources.push_back(std::move(s));
  std::sort(result.sources.begin(), result.sources.end(),
            [](const Source& a, const Source& b) { return a.name < b.name; });
  return result;
}

ReadResult take_arrays(const std::vector<NamedArrays>& buildings, const ReadOptions& options) {
  ReadOptions whole = options;
  whole.split = Split::kNone;
  std::vector<std::optional<Source>> found(buildings.size());
  std::vector<std::string> problem(buildings.size());
  parallel_for(buildings.size(), [&](std::size_t i) {
    const std::string& name = buildings[i].name;
    try {
      found[i] = std::move(validate(name, name, raw_of(buildings[i]), whole).front());
      found[i]->path.clear();
    } catch (const Error& e) {
      problem[i] = std::string(e.what()).substr(e.item.size() + 2);
    } catch (const std::exception& e) {  // a library gave up: this building's problem only
      problem[i] = std::string("cannot be taken: ") + e.what();
    }
  });
  ReadResult result;
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < buildings.size(); ++i)
    if (found[i])
      entries.push_back({buildings[i].name, found[i]->name, i, 0});
    else
      result.failures.push_back({buildings[i].name, problem[i]});
  make_unique(entries);
  for (const Entry& e : entries) {
    found[e.file]->name = e.name;
    result.sources.push_back(std::move(*found[e.file]));
  }
  std::sort(result.sources.begin(), result.sources.end(),
            [](const Source& a, const Source& b) { return a.name < b.name; });
  return result;
}

Source read_single(const std::string& path, const ReadOptions& options) {
  std::error_code error;
  if (!fs::exists(path, error)) throw Error(Stage::kInput, path, "no such file");
  if (fs::is_directory(path, error)) throw Error(Stage::kInput, path, "this is a folder");
  ReadOptions whole = options;
  whole.split = Split::kNone;
  return std::move(read_file(path, whole).front());
}

}  // namespace colod
