// Based on: own work; what people keep in folders beside their models decides what is passed over.
// Differs: --rules does not matter here.
// Notation: none.
#include "files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "formats.h"

namespace colod::mesh_io {

namespace fs = std::filesystem;

namespace {

constexpr const char* kMeshes[] = {".obj", ".ply", ".off", ".stl", ".gltf", ".glb", ".b3dm"};
constexpr const char* kClouds[] = {".xyz", ".pwn", ".pts", ".las", ".laz"};
constexpr const char* kTables[] = {".asc", ".csv", ".txt"};  // often something else
constexpr int kMostEntries = 100000;  // of subfolders that are looked through for a count

/// A format that is not read, and what turns it into one that is.
struct Foreign {
  const char* extension;
  const char* advice;
};

constexpr const char* kByAssimp =
    "is not read: `assimp export IN OUT.glb`, or Blender's import and glTF export, converts it";
constexpr Foreign kForeign[] = {
    {".e57", "E57 is not read: `pdal translate IN.e57 OUT.ply` converts it"},
    {".ifc", "IFC is not read: `IfcConvert IN.ifc OUT.glb` converts it"},
    {".gml",
     "CityGML is not read: `citygml-tools to-cityjson IN.gml`, then `cjio IN.json export "
     "obj OUT.obj` converts it"},
    {".citygml",
     "CityGML is not read: `citygml-tools to-cityjson IN.citygml`, then `cjio IN.json "
     "export obj OUT.obj` converts it"},
    {".cityjson", "CityJSON is not read: `cjio IN.cityjson export obj OUT.obj` converts it"},
    {".dae", kByAssimp},
    {".fbx", kByAssimp},
    {".3ds", kByAssimp},
    {".x3d", kByAssimp},
    {".wrl", kByAssimp},
    {".dxf", kByAssimp},
    {".blend", "Blender's own file is not read: its glTF export converts it"},
    {".skp", "SketchUp's own file is not read: its OBJ or glTF export converts it"},
    {".3dm", "Rhino's own file is not read: its OBJ or glTF export converts it"},
    {".zip", "an archive is not read: unpack it"},
    {".3tz",
     "3tz holds a whole tileset: `colod build IN.3tz` takes it for a scene, `unzip IN.3tz -d DIR` "
     "unpacks it for other commands"},
    {".osgb", "OSGB is not read: `osgconv IN.osgb OUT.obj` converts a tile"},
    {".i3dm", "i3dm (instances of models) is not read"},
    {".pnts", "pnts (points) is not read: `pdal translate` makes PLY of the cloud it came from"},
    {".cmpt", "cmpt (a composite) is not read"},
};

template <std::size_t N>
bool is_in(const std::string& extension, const char* const (&list)[N]) {
  return std::find(std::begin(list), std::end(list), extension) != std::end(list);
}

std::string ending_of(const fs::path& path) { return lower(path.extension().string()); }

constexpr std::size_t kHead = 4096;  // bytes that tell what a file is

bool is_report(const fs::path& path) {
  return file_head(path, kHead).find("\"colod\":") != std::string::npos;
}

/// A folder of levels for engines, wherever it was copied to: by what its list says of itself.
bool is_engine_export(const fs::path& folder) {
  return file_head(folder / "lods.json", kHead)
             .find("LOD0 is the finest. A level is shown from switch_distance") !=
         std::string::npos;
}

/// A folder of buildings, tiles or engine files that colod build wrote.
bool is_part_of_output(const fs::path& folder) {
  std::error_code error;
  if (is_engine_export(folder)) return true;
  const fs::path whole = fs::weakly_canonical(folder, error);
  const std::string name = whole.filename().string();
  const bool is_part = name == "buildings" || name == "tiles" || name == "engine";
  return is_part && is_report(whole.parent_path() / "report.json");
}

/// Such a folder, or all that colod build wrote.
bool is_own_output(const fs::path& folder) {
  std::error_code error;
  return is_part_of_output(folder) ||
         (is_report(folder / "report.json") && fs::exists(folder / "buildings", error));
}

/// What a folder holds, by what is done with it.
struct Folder {
  std::vector<std::string> files;    // to be read
  std::vector<std::string> foreign;  // in formats that are not
  std::vector<std::string> own;      // subfolders that colod wrote, which are not entered
  int deeper = 0;                    // files that could be read in subfolders that are not entered
  bool has_more = false;             // not all subfolders were looked through
};

void sort_in(const fs::path& path, bool is_entered, Folder& folder) {
  if (is_supported(path)) {
    if (is_passed_over(path)) return;
    if (is_entered) folder.files.push_back(path.string());
    folder.deeper += !is_entered;
  } else if (is_entered && !foreign_advice(path).empty()) {
    folder.foreign.push_back(path.string());
  }
}

/// Links to folders are not followed, so that none is entered twice; hidden folders and own output
/// are not entered, the latter with a word where others are.
Folder look_through(const std::string& path, bool is_recursive) {
  Folder folder;
  std::error_code error;
  int seen = 0;
  fs::recursive_directory_iterator at(path, fs::directory_options::skip_permission_denied, error);
  for (const fs::recursive_directory_iterator end; !error && at != end; at.increment(error)) {
    std::error_code unknown;  // such as a link that leads to itself: reading it says so
    if (!at->is_directory(unknown)) {
      sort_in(at->path(), is_recursive || at.depth() == 0, folder);
    } else if (at->path().filename().string().starts_with('.')) {
      at.disable_recursion_pending();
    } else if (is_own_output(at->path())) {
      at.disable_recursion_pending();
      if (is_recursive) folder.own.push_back(at->path().string());
    }
    if (at.depth() > 0 && !is_recursive && ++seen > kMostEntries) {
      folder.has_more = true;
      break;
    }
  }
  if (error) throw Error(Stage::kInput, path, error.message());
  std::sort(folder.files.begin(), folder.files.end());
  std::sort(folder.foreign.begin(), folder.foreign.end());
  std::sort(folder.own.begin(), folder.own.end());
  return folder;
}

/// "12 files that can be read lie in subfolders: --recursive reads them, too", or nothing.
std::string said_of_deeper(const Folder& folder) {
  if (folder.deeper == 0) return "";
  return std::string(folder.has_more ? "at least " : "") + std::to_string(folder.deeper) +
         (folder.deeper == 1 ? " file that can be read lies" : " files that can be read lie") +
         " in subfolders: --recursive reads them, too";
}

[[noreturn]] void refuse_own_output(const std::string& input) {
  throw Error(Stage::kInput, input,
              "the folder holds what colod itself wrote, several levels of one building: name the "
              "sources, or single files of it");
}

void add_folder(const std::string& input, bool is_recursive, InputList& list) {
  if (is_part_of_output(input)) refuse_own_output(input);
  const Folder folder = look_through(input, is_recursive);
  const std::string deeper = said_of_deeper(folder);
  if (folder.files.empty()) {
    if (is_own_output(input)) refuse_own_output(input);
    std::string message =
        "the folder holds no file that can be read (obj, ply, off, stl, gltf, "
        "glb, b3dm, xyz, pwn, pts, asc, csv, txt)";
    if (!folder.foreign.empty())
      message += "; " + fs::path(folder.foreign[0]).filename().string() + ": " +
                 foreign_advice(folder.foreign[0]);
    throw Error(Stage::kInput, input, message + (deeper.empty() ? "" : "; " + deeper));
  }
  if (!deeper.empty()) list.warnings.push_back(input + ": " + deeper);
  for (const std::string& own : folder.own)
    list.warnings.push_back(own + ": what colod itself wrote, not read again");
  if (!folder.foreign.empty())
    list.warnings.push_back(
        folder.foreign[0] + ": " + foreign_advice(folder.foreign[0]) +
        (folder.foreign.size() > 1
             ? " (and " + std::to_string(folder.foreign.size() - 1) + " more files not read)"
             : ""));
  list.files.insert(list.files.end(), folder.files.begin(), folder.files.end());
}

/// Of several ways to one file the one that is no link, or comes first by name, is kept.
void keep_each_once(InputList& list) {
  std::map<std::string, std::string> kept;  // the file itself → the path that is read
  const auto rank = [](const std::string& path) {
    std::error_code error;
    return std::make_pair(fs::is_symlink(path, error), path);
  };
  const auto itself = [](const std::string& path) {
    std::error_code error;
    const fs::path whole = fs::canonical(path, error);
    return error ? fs::path(path).lexically_normal().string() : whole.string();
  };
  for (const std::string& file : list.files) {
    const auto [at, is_new] = kept.emplace(itself(file), file);
    if (!is_new && rank(file) < rank(at->second)) at->second = file;
  }
  std::vector<std::string> files;
  std::set<std::string> seen;
  for (const std::string& file : list.files) {
    const std::string& path = kept.at(itself(file));
    if (path == file) {
      if (seen.insert(file).second) files.push_back(file);
    } else if (itself(file) != fs::absolute(file).lexically_normal().string()) {
      list.warnings.push_back(file + ": the same file as " + path + ", which is read once");
    }
  }
  list.files = std::move(files);
}

}  // namespace

bool is_passed_over(const fs::path& path) {
  const std::string name = path.filename().string();
  if (name.starts_with("._") || name.ends_with("_offset.xyz")) return true;
  std::error_code error;
  return is_in(ending_of(path), kTables) && fs::is_regular_file(path, error) &&
         !is_point_table(as_text(file_head(path, kHead)));
}

std::string lower(std::string s) {
  for (char& c : s)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return s;
}

bool is_supported(const fs::path& path) {
  const std::string e = ending_of(path);
  return is_in(e, kMeshes) || is_in(e, kClouds) || is_in(e, kTables);
}

std::string foreign_advice(const fs::path& path) {
  const std::string e = ending_of(path);
  for (const Foreign& f : kForeign)
    if (e == f.extension) {
      const std::string advice = f.advice;
      return advice.starts_with("is not") ? e.substr(1) + " " + advice : advice;
    }
  std::error_code error;
  if (e == ".json" && fs::is_regular_file(path, error) &&
      file_head(path, kHead).find("\"CityJSON\"") != std::string::npos)
    return "CityJSON is not read: `cjio IN.json export obj OUT.obj` converts it";
  return "";
}

InputList list_files(const std::vector<std::string>& inputs, bool is_recursive) {
  InputList list;
  for (const std::string& input : inputs) {
    std::error_code error;
    const fs::file_status status = fs::status(input, error);
    if (status.type() == fs::file_type::directory)
      add_folder(input, is_recursive, list);
    else if (status.type() == fs::file_type::not_found)
      throw Error(Stage::kInput, input, "no such file or folder");
    else
      list.files.push_back(input);
  }
  keep_each_once(list);
  return list;
}

std::string file_head(const fs::path& path, std::size_t bytes) {
  std::string head(bytes, '\0');
  std::error_code error;
  std::ifstream file;
  if (fs::is_regular_file(path, error)) file.open(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(bytes));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

std::string read_bytes(const std::string& path, double input_memory) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);  // follows links
  if (error && status.type() != fs::file_type::not_found) fail(path, error.message());
  if (status.type() == fs::file_type::not_found)
    fail(path, "is a link to a file that is not there, or went away");
  if (status.type() != fs::file_type::regular)
    fail(path, "is no regular file but a pipe, a socket or a device, which is not read");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) fail(path, error.message());
  if (size == 0) fail(path, "the file is empty");
  const double mib = static_cast<double>(size) / 1048576;
  if (mib > input_memory)
    fail(path, "takes " + std::to_string(std::llround(std::ceil(mib))) +
                   " MiB, more than --input-memory " + std::to_string(std::llround(input_memory)) +
                   " allows one file");
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(path, "cannot be opened");
  std::string bytes(size, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(file.gcount()) != size) fail(path, "cannot be read to its end");
  return bytes;
}

namespace {

void append_utf8(std::string& out, char32_t c) {
  const auto put = [&out](char32_t byte) { out += static_cast<char>(byte); };
  if (c < 0x80) return put(c);
  if (c < 0x800) return put(0xC0 | c >> 6), put(0x80 | (c & 0x3F));
  if (c >= 0x10000) {
    put(0xF0 | c >> 18), put(0x80 | (c >> 12 & 0x3F));
  } else {
    put(0xE0 | c >> 12);
  }
  put(0x80 | (c >> 6 & 0x3F)), put(0x80 | (c & 0x3F));
}

/// UTF-16 behind its mark; half a pair becomes the sign for what cannot be shown.
std::string utf8_of_utf16(std::string_view bytes, bool is_big_endian) {
  const auto unit = [&](std::size_t i) {
    const auto a = static_cast<unsigned char>(bytes[i]);
    const auto b = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<char32_t>(is_big_endian ? a << 8 | b : b << 8 | a);
  };
  std::string out;
  for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
    char32_t c = unit(i);
    const bool is_first = c >= 0xD800 && c < 0xDC00;
    const char32_t second = is_first && i + 3 < bytes.size() ? unit(i + 2) : 0;
    if (second >= 0xDC00 && second < 0xE000)
      c = 0x10000 + ((c - 0xD800) << 10) + (second - 0xDC00), i += 2;
    else if (c >= 0xD800 && c < 0xE000)
      c = 0xFFFD;
    append_utf8(out, c);
  }
  return out;
}

}  // namespace

std::string as_text(std::string bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF")) return bytes.substr(3);
  if (bytes.starts_with("\xFF\xFE")) return utf8_of_utf16(bytes, false);
  if (bytes.starts_with("\xFE\xFF")) return utf8_of_utf16(bytes, true);
  return bytes;
}

}  // namespace colod::mesh_io
