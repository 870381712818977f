// The house rules that a compiler does not check: what stays behind which door, who sees whom.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

const fs::path kRoot = COLOD_SOURCE_DIR;

struct Include {
  fs::path file;     // relative to the repository
  std::string what;  // as written
};

std::string slurp(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<fs::path> sources(const std::vector<std::string>& folders) {
  std::vector<fs::path> files;
  for (const std::string& folder : folders)
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder))
      if (entry.path().extension() == ".cpp" || entry.path().extension() == ".h")
        files.push_back(fs::relative(entry.path(), kRoot));
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<Include> includes(const std::vector<std::string>& folders) {
  static const std::regex include("(?:^|\n)#include [<\"]([^>\"]+)[>\"]");
  std::vector<Include> found;
  for (const fs::path& file : sources(folders)) {
    const std::string text = slurp(kRoot / file);
    for (std::sregex_iterator it(text.begin(), text.end(), include), end; it != end; ++it)
      found.push_back({file, (*it)[1]});
  }
  return found;
}

/// Includes that match `library` in files that do not match `door`.
std::vector<std::string> leaks(const std::string& library, const std::string& door) {
  std::vector<std::string> found;
  for (const Include& i : includes({"src", "exporters", "synth", "bench"}))
    if (std::regex_search(i.what, std::regex("^" + library)) &&
        !std::regex_match(i.file.string(), std::regex(door)))
      found.push_back(i.file.string() + " includes " + i.what);
  return found;
}

/// The rooms of src/ in the order in which data flow, as CMakeLists.txt adds them.
std::vector<std::string> rooms() {
  static const std::regex added("foreach\\(room ([a-z_ ]+)\\)");
  std::smatch found;
  const std::string text = slurp(kRoot / "CMakeLists.txt");
  REQUIRE(std::regex_search(text, found, added));
  std::istringstream words(found[1]);
  std::vector<std::string> all{std::istream_iterator<std::string>(words), {}};
  for (const char* last : {"publish", "job", "viewer", "cli", "library"}) all.emplace_back(last);
  return all;
}

/// The headers of a room that others may include: `DOORS` of its CMakeLists.txt, else its own.
std::vector<std::string> doors(const std::string& room) {
  static const std::regex doors("DOORS ([a-z0-9_.\\s]+)");
  std::smatch found;
  const std::string text = slurp(kRoot / "src" / room / "CMakeLists.txt");
  if (!std::regex_search(text, found, doors)) return {room + ".h"};
  std::istringstream words(found[1]);
  return {std::istream_iterator<std::string>(words), {}};
}

using Leaks = std::vector<std::string>;

}  // namespace

TEST_CASE("every library stays behind its door") {
  CHECK(leaks("embree", "src/(core/rays|visibility/[a-z_]+)\\.cpp") == Leaks{});
  CHECK(leaks("(tbb|oneapi)/", "src/core/parallel\\.cpp") == Leaks{});
  CHECK(leaks("draco/", "exporters/gltf/draco\\.cpp|src/read/[a-z_]+\\.cpp") == Leaks{});
  CHECK(leaks("meshoptimizer", "src/core/meshopt\\.cpp|bench/.*\\.cpp") == Leaks{});
  CHECK(leaks("tiny_gltf", "src/read/gltf[a-z_]*\\.(cpp|h)") == Leaks{});  // h: of this room only
  CHECK(leaks("lpsolve/|lp_lib", "src/coanalysis/selection[a-z_]*\\.cpp") == Leaks{});
  CHECK(leaks("proj(_experimental)?\\.h", "src/place/([a-z_]+\\.cpp|proj_objects\\.h)") == Leaks{});
  CHECK(leaks("(gdal|ogr|cpl_)", "src/place/(footprints|geokeys)\\.cpp") == Leaks{});
  CHECK(leaks("unzip\\.h", "src/read/zip\\.cpp") == Leaks{});
  CHECK(leaks("pugixml", "src/place/[a-z_]+\\.cpp") == Leaks{});
  CHECK(leaks("sqlite3", "src/store/[a-z_]+\\.cpp") == Leaks{});
  CHECK(leaks("png\\.h", "src/(image|picture)/[a-z_]+\\.cpp|bench/.*\\.cpp") == Leaks{});
  CHECK(leaks("(jpeglib|webp/)", "src/image/[a-z_]+\\.cpp") == Leaks{});
  CHECK(leaks("stb/", "src/image/packing\\.cpp") == Leaks{});
  CHECK(leaks("Spectra/", "src/coanalysis/clustering[a-z_]*\\.cpp") == Leaks{});
  CHECK(leaks("nanoflann", "src/(core/point_tree\\.h|coanalysis/[a-z_]+\\.cpp)") == Leaks{});
  CHECK(leaks("httplib", "src/viewer/viewer\\.cpp") == Leaks{});
  CHECK(leaks("CLI/", "src/cli/.*|bench/.*\\.cpp") == Leaks{});
  CHECK(leaks("(CGAL|boost)/", ".*\\.cpp") == Leaks{});  // in no header
}

TEST_CASE("every folder of src is a room, and no file stands outside of one") {
  const std::vector<std::string> all = rooms();
  for (const auto& entry : fs::directory_iterator(kRoot / "src")) {
    const std::string name = entry.path().filename().string();
    INFO("src/" << name);
    CHECK((entry.is_directory() ? std::count(all.begin(), all.end(), name) == 1
                                : name == "README.md"));
  }
}

TEST_CASE("rooms see the doors of earlier rooms only") {
  const std::vector<std::string> all = rooms();
  const auto number = [&](const std::string& room) {
    return std::find(all.begin(), all.end(), room) - all.begin();
  };
  for (const Include& i : includes({"src"})) {
    const fs::path seen = i.what;
    const std::string room = seen.parent_path().string(), own = i.file.parent_path().filename();
    if (room.empty() || number(room) == std::ssize(all)) continue;  // its own file, or a library's
    INFO(i.file.string() << " includes " << i.what);
    CHECK(number(room) < number(own));
    const std::vector<std::string> open = doors(room);
    CHECK(std::count(open.begin(), open.end(), seen.filename().string()) == 1);
  }
}

TEST_CASE(
    "exporters see what all rooms share, images and how pictures are compared, synth only the "
    "first") {
  for (const Include& i : includes({"exporters", "synth"})) {
    const std::string room = fs::path(i.what).parent_path().string();
    if (!fs::exists(kRoot / "src" / room) || room.empty()) continue;
    INFO(i.file.string() << " includes " << i.what);
    const bool is_exporter = i.file.string().starts_with("exporters");
    CHECK((room == "core" || room == "image" || (is_exporter && room == "measure")));
  }
}

TEST_CASE("every library that CMake looks for has a page in third_party_notes") {
  const std::string text =
      slurp(kRoot / "CMakeLists.txt") + slurp(kRoot / "tests" / "CMakeLists.txt");
  static const std::regex find("(?:find_package|find_library)\\(([A-Za-z0-9_]+)");
  static const std::vector<std::pair<std::string, std::string>> others = {
      {"Eigen3", "eigen"},
      {"TBB", "onetbb"},
      {"JPEG", "libjpeg-turbo"},
      {"PNG", "libpng"},
      {"nlohmann_json", "nlohmann-json"},
      {"SQLite3", "sqlite"},
      {"LPSOLVE_LIBRARY", "lp_solve"},
      {"COLAMD_LIBRARY", "lp_solve"},
      {"PkgConfig", "cpp-httplib"}};
  for (std::sregex_iterator it(text.begin(), text.end(), find), end; it != end; ++it) {
    std::string page = (*it)[1];
    for (const auto& [name, other] : others)
      if (page == name) page = other;
    std::transform(page.begin(), page.end(), page.begin(), [](char c) { return std::tolower(c); });
    INFO((*it)[1] << " needs third_party_notes/" << page << ".md");
    CHECK(fs::exists(kRoot / "third_party_notes" / (page + ".md")));
  }
}

TEST_CASE("files stay short and are formatted as promised") {
  for (const fs::path& file : sources({"src", "exporters", "synth", "tests", "bench"})) {
    const std::string text = slurp(kRoot / file);
    INFO(file.string());
    CHECK(std::count(text.begin(), text.end(), '\n') <= 800);
    CHECK(text.find('\r') == std::string::npos);
    CHECK(text.find('\t') == std::string::npos);
    if (file.extension() == ".h") CHECK(text.find("#pragma once") != std::string::npos);
  }
}

TEST_CASE("locked npm packages are told by their hashes, wherever they are fetched from") {
  for (const char* file : {"src/viewer/package-lock.json", "tests/clients/package-lock.json"}) {
    INFO(file);
    const std::string text = slurp(kRoot / file);
    CHECK(text.find("\"integrity\"") != std::string::npos);
    CHECK(text.find("\"resolved\"") == std::string::npos);
  }
}
