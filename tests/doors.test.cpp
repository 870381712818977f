// The house rules that a compiler does not check: what stays behind which door, who sees whom.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

const fs::path kRoot = COLOD_SOURCE_DIR;

/// Rooms in the order in which data flow (src/README.md), then what stands beside or behind them.
const std::vector<std::string> kRooms = {"geometry",     "error",         "options",
                                         "parallel",     "stopwatch",     "spread",
                                         "union_find",   "rays",          "mesh_io",
                                         "frame",        "intersections", "deviation",
                                         "face_samples", "solid",         "lost_bodies",
                                         "scene_part",   "left_out",      "ground",
                                         "hidden",       "rounds",        "planes",
                                         "hollows",      "visibility",    "segments",
                                         "similarity",   "selection",     "clustering",
                                         "partition",    "extraction",    "metrics",
                                         "light_field",  "consistency",   "picture_difference",
                                         "switching",    "synth",         "preview",
                                         "georeference", "pipeline",      "publish",
                                         "report",       "store"};

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
  static const std::regex kInclude("(?:^|\n)#include [<\"]([^>\"]+)[>\"]");
  std::vector<Include> found;
  for (const fs::path& file : sources(folders)) {
    const std::string text = slurp(kRoot / file);
    for (std::sregex_iterator it(text.begin(), text.end(), kInclude), end; it != end; ++it)
      found.push_back({file, (*it)[1]});
  }
  return found;
}

/// Includes that match `library` in files that do not match `door`.
std::vector<std::string> leaks(const std::string& library, const std::string& door) {
  std::vector<std::string> found;
  for (const Include& i : includes({"src", "exporters", "bench"}))
    if (std::regex_search(i.what, std::regex("^" + library)) &&
        !std::regex_match(i.file.string(), std::regex(door)))
      found.push_back(i.file.string() + " includes " + i.what);
  return found;
}

/// The longest room that a file of src/ belongs to: `planes_noise.cpp` and `planes.h` to planes.
int room_of(const fs::path& file) {
  const std::string stem = file.stem().string();
  int best = -1;
  for (int r = 0; r < static_cast<int>(kRooms.size()); ++r)
    if (stem == kRooms[r] || stem.starts_with(kRooms[r] + "_")) best = r;
  return best;
}

using Leaks = std::vector<std::string>;

}  // namespace

TEST_CASE("every library stays behind its door") {
  CHECK(leaks("embree", "src/(rays|visibility)[a-z_]*\\.cpp") == Leaks{});
  CHECK(leaks("(tbb|oneapi)/", "src/parallel[a-z_]*\\.cpp") == Leaks{});
  CHECK(leaks("draco/", "exporters/draco\\.cpp|src/mesh_io[a-z_]*\\.cpp") == Leaks{});
  CHECK(leaks("meshoptimizer", "exporters/meshopt\\.cpp|bench/.*\\.cpp") == Leaks{});
  CHECK(leaks("tiny_gltf", "src/mesh_io_gltf[a-z_]*\\.(cpp|h)") == Leaks{});  // h: of room 1 only
  CHECK(leaks("lpsolve/|lp_lib", "src/selection[a-z_]*\\.cpp") == Leaks{});
  CHECK(leaks("proj(_experimental)?\\.h", "src/georeference[a-z_]*\\.cpp") == Leaks{});
  CHECK(leaks("pugixml", "src/georeference[a-z_]*\\.cpp") == Leaks{});
  CHECK(leaks("sqlite3", "src/store[a-z_]*\\.cpp") == Leaks{});
  CHECK(leaks("png\\.h", "src/preview[a-z_]*\\.cpp|bench/.*\\.cpp") == Leaks{});
  CHECK(leaks("Spectra/", "src/clustering[a-z_]*\\.cpp") == Leaks{});
  CHECK(leaks("nanoflann", "src/(clustering|metrics)[a-z_]*\\.cpp") == Leaks{});
  CHECK(leaks("httplib", "src/cli/view_server\\.cpp") == Leaks{});
  CHECK(leaks("CLI/", "src/cli/.*|bench/.*\\.cpp") == Leaks{});
  CHECK(leaks("(CGAL|boost)/", ".*\\.cpp") == Leaks{});  // in no header
}

TEST_CASE("rooms see earlier rooms only, and exporters no room but what all share") {
  for (const Include& i : includes({"src", "exporters"})) {
    const fs::path folder = i.file.parent_path();
    if (i.what.find(".h") == std::string::npos || folder == "src/cli") continue;
    const fs::path seen = (folder / i.what).lexically_normal();
    if (!fs::exists(kRoot / seen)) continue;  // a library's
    INFO(i.file.string() << " includes " << i.what);
    if (folder == "exporters") {
      const bool is_shared =
          seen == "src/rays.h" || seen == "src/parallel.h" || seen == "src/switching.h";
      const bool is_allowed = seen.parent_path() == "exporters" || is_shared || room_of(seen) <= 1;
      CHECK(is_allowed);
    } else if (seen.parent_path() == "src") {
      REQUIRE(room_of(i.file) >= 0);
      CHECK(room_of(seen) >= 0);
      CHECK(room_of(seen) <= room_of(i.file));
    }
  }
}

TEST_CASE("every library that CMake looks for has a page in third_party_notes") {
  const std::string text =
      slurp(kRoot / "CMakeLists.txt") + slurp(kRoot / "tests" / "CMakeLists.txt");
  static const std::regex kFind("(?:find_package|find_library)\\(([A-Za-z0-9_]+)");
  static const std::vector<std::pair<std::string, std::string>> kOthers = {
      {"Eigen3", "eigen"},
      {"TBB", "onetbb"},
      {"PNG", "libpng"},
      {"nlohmann_json", "nlohmann-json"},
      {"SQLite3", "sqlite"},
      {"LPSOLVE_LIBRARY", "lp_solve"},
      {"COLAMD_LIBRARY", "lp_solve"},
      {"PkgConfig", "cpp-httplib"}};
  for (std::sregex_iterator it(text.begin(), text.end(), kFind), end; it != end; ++it) {
    std::string page = (*it)[1];
    for (const auto& [name, other] : kOthers)
      if (page == name) page = other;
    std::transform(page.begin(), page.end(), page.begin(), [](char c) { return std::tolower(c); });
    INFO((*it)[1] << " needs third_party_notes/" << page << ".md");
    CHECK(fs::exists(kRoot / "third_party_notes" / (page + ".md")));
  }
}

TEST_CASE("files stay short and are formatted as promised") {
  for (const fs::path& file : sources({"src", "exporters", "tests", "bench"})) {
    const std::string text = slurp(kRoot / file);
    INFO(file.string());
    CHECK(std::count(text.begin(), text.end(), '\n') <= 800);
    CHECK(text.find('\r') == std::string::npos);
    CHECK(text.find('\t') == std::string::npos);
    if (file.extension() == ".h") CHECK(text.find("#pragma once") != std::string::npos);
  }
}

TEST_CASE("locked npm packages are told by their hashes, wherever they are fetched from") {
  for (const char* file : {"src/cli/viewer/package-lock.json", "tests/clients/package-lock.json"}) {
    INFO(file);
    const std::string text = slurp(kRoot / file);
    CHECK(text.find("\"integrity\"") != std::string::npos);
    CHECK(text.find("\"resolved\"") == std::string::npos);
  }
}
