// 3TZ from outside: an archive becomes what its unpacked tileset becomes.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "archives.h"
#include "image/image.h"
#include "program.h"
#include "scenes.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;
namespace fs = std::filesystem;
using Files = std::map<std::string, std::string>;

namespace {

/// A block of 12 by 12 m on level ground, that wears a picture of its plan.
std::string textured_scene() {
  const Mesh m = terrain_with_boxes(40, 1, {Box{{14, 14, 0}, {26, 26, 8}}});
  std::ostringstream out;
  out << "mtllib a.mtl\nusemtl photo\n";
  for (const Vec3& v : m.vertices)
    out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << "\nvt " << v.x() / 40 << ' '
        << v.y() / 40 << '\n';
  for (const Face& f : m.faces) {
    out << 'f';
    for (const int v : f) out << ' ' << v + 1 << '/' << v + 1;
    out << '\n';
  }
  return out.str();
}

std::string photo() {
  Raster raster(64, 64);
  for (std::size_t i = 0; i < raster.rgb.size(); ++i)
    raster.rgb[i] = static_cast<std::uint8_t>(i / 48);
  return encode_image(raster, ImageFormat::kPng, 0);
}

Files scene_files(const std::string& second) {
  return {{"tileset.json", tileset_of(tile_of("", R"(,"children":[)" + tile_of("a.obj") + "," +
                                                      tile_of("b.glb") + "]"))},
          {"a.obj", textured_scene()},
          {"a.mtl", "newmtl photo\nmap_Kd a.png\n"},
          {"a.png", photo()},
          {"b.glb", second}};
}

/// An archive whose name is as long as that of what it holds, which outputs name as their source.
const std::string kArchive = "tileset4.3tz";

/// The same files in a folder `unpacked` and in an archive.
void write_both(const TempFolder& folder, const Files& files) {
  fs::create_directory(folder.path / "unpacked");
  fs::create_directory(folder.path / "temporary");
  std::vector<ArchiveEntry> entries;
  for (const auto& [name, bytes] : files) {
    folder.write("unpacked/" + name, bytes);
    entries.push_back({name, bytes});
  }
  write_archive((folder.path / kArchive).string(), entries);
}

int run(const TempFolder& folder, const std::string& arguments) {
  const std::string own = "TMPDIR=" + (folder.path / "temporary").string();
  return run_colod(folder.path, arguments, own).exit_code;
}

Files built(const TempFolder& folder, const std::string& input, const std::string& options,
            int ends) {
  fs::remove_all(folder.path / "out");
  const int code =
      run(folder, "build " + input + " -o out --ns 24 --nr 24 --no-report-html " + options);
  INFO(slurp(folder.path / "stderr"));
  CHECK(code == ends);
  CHECK(fs::is_empty(folder.path / "temporary"));
  Files out;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path / "out"))
    if (entry.is_regular_file())
      out[fs::relative(entry.path(), folder.path).string()] = slurp(entry.path());
  return out;
}

/// To what an unpacked one is called.
void rename_source(std::string& bytes) {
  for (std::size_t at = bytes.find(kArchive); at != bytes.npos; at = bytes.find(kArchive, at))
    bytes.replace(at, kArchive.size(), "tileset.json");
}

/// What differs between two runs: the names of files that do.
std::vector<std::string> differing(const Files& a, const Files& b) {
  std::vector<std::string> names;
  for (const auto& [name, bytes] : a)
    if (const auto other = b.find(name); other == b.end() || other->second != bytes)
      names.push_back(name);
  for (const auto& [name, bytes] : b)
    if (!a.contains(name)) names.push_back(name);
  return names;
}

}  // namespace

TEST_CASE("an archive becomes what its unpacked tileset becomes, byte for byte") {
  const TempFolder folder;
  write_both(folder, scene_files(glb_of(y_up(moved(terrain_with_boxes(8, 1, {}), {40, 0, 0})))));
  for (const char* options : {"", "--context none", "--texture colors"}) {
    INFO(options);
    const Files unpacked = built(folder, "unpacked/tileset.json", options, 0);
    Files archived = built(folder, kArchive, options, 0);
    CHECK(nlohmann::json::parse(archived.at("out/report.json"))["buildings"][0]["source"] ==
          kArchive);
    CHECK(archived.size() > 3);
    for (auto& [name, bytes] : archived) rename_source(bytes);
    CHECK(differing(unpacked, archived) == std::vector<std::string>{"out/report.json"});  // times
  }
}

TEST_CASE("messages name tiles as they lie in the archive") {
  const TempFolder folder;
  Files files = scene_files("broken");
  files["a.png"] = "no picture";
  write_both(folder, files);
  const Files out = built(folder, kArchive, "", 1);
  const std::string log = slurp(folder.path / "stderr");
  CHECK_THAT(log, Contains(kArchive + "/b.glb: ") && Contains(kArchive + "/a.png: "));
  CHECK_THAT(log, !Contains("temporary"));
  CHECK_THAT(out.at("out/report.json"), !Contains("temporary"));
}

TEST_CASE("stages, other commands and folders say what to do with an archive") {
  const TempFolder folder;
  write_both(folder, scene_files("broken"));
  CHECK(run(folder, "segment " + kArchive + " -o x.colod") == 2);
  CHECK_THAT(slurp(folder.path / "stderr"), Contains("`unzip IN.3tz -d DIR`"));
  CHECK(run(folder, "info " + kArchive) == 3);
  CHECK_THAT(slurp(folder.path / "stderr"), Contains("takes it for a scene"));
  CHECK(run(folder, "build . -o out") == 3);
  CHECK_THAT(slurp(folder.path / "stderr"), Contains(kArchive + ": 3tz holds a whole tileset"));
}
