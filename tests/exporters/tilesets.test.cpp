// Tilesets of tilesets: no file grows with the scene.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include "exporters/check/check.h"
#include "exporters/files.h"
#include "exporters/tiles3d/standins.h"
#include "exporters/tiles3d/tiles3d.h"
#include "exporters_helpers.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;
using Json = nlohmann::ordered_json;

namespace {

constexpr const char* kTileset = "tileset.json";

struct Files : std::map<std::string, std::string> {
  explicit Files(const std::vector<Encoded>& files) {
    for (const Encoded& file : files) {
      if (contains(file.path)) FAIL_CHECK(file.path << " twice");
      (*this)[file.path] = file.bytes;
    }
  }
};

/// Tiles that the file has itself.
std::size_t entries_of(const Json& tile) {
  std::size_t count = 1;
  for (const Json& child : tile.value("children", Json::array())) count += entries_of(child);
  return count;
}

/// What is found from tileset.json on, by path; errors fall all the way.
void collect(const Files& files, const std::string& path, const Json& tile, double above,
             std::set<std::string>& found) {
  const double error = tile["geometricError"];
  if (error >= above) FAIL_CHECK(path << ": errors do not fall");
  const std::filesystem::path base = std::filesystem::path(path).parent_path();
  if (tile.contains("content")) {
    const std::string own =
        (base / tile["content"]["uri"].get<std::string>()).lexically_normal().generic_string();
    if (!files.contains(own) || !found.insert(own).second)
      FAIL(own << " is missing, or named twice");
    if (own.ends_with(".json"))
      collect(files, own, Json::parse(files.at(own))["root"], error, found);
  }
  for (const Json& child : tile.value("children", Json::array()))
    collect(files, path, child, error, found);
}

std::vector<ExportBuilding> streets(int rows, int columns) {
  std::vector<ExportBuilding> all;
  for (int row = 0; row < rows; ++row)
    for (ExportBuilding b : street(columns)) {
      b.name += "_row" + std::to_string(row);
      b.origin.y() += 500.0 * row;  // so that some groups are wide and the tree is not even
      all.push_back(std::move(b));
    }
  return all;
}

}  // namespace

TEST_CASE("a tileset of many cells becomes a tree of files of bounded size") {
  for (const auto& [rows, columns] : {std::pair{3, 90}, {9, 33}}) {
    const std::vector<ExportBuilding> all = streets(rows, columns);
    const Files flat(encode_tileset(all, {.compression = Compression::kNone}));
    for (const std::size_t most : {5, 12, 400}) {
      INFO(rows << " " << columns << " " << most);
      const Files deep(
          encode_tileset(all, {.compression = Compression::kNone, .most_entries = most}));
      std::size_t nested = 0;
      std::set<std::string> found = {kTileset};
      collect(deep, kTileset, Json::parse(deep.at(kTileset))["root"], 1e300, found);
      CHECK(found.size() == deep.size());  // all of it, and nothing else
      for (const auto& [path, bytes] : deep) {
        if (!path.ends_with(".json")) continue;
        const bool is_new = !flat.contains(path);
        nested += is_new;
        if (path == kTileset || is_new)
          CHECK(entries_of(Json::parse(bytes)["root"]) <= most);
        else
          CHECK(bytes == flat.at(path));  // cells are what they were
      }
      std::size_t same = 0;
      for (const auto& [path, bytes] : flat) same += deep.contains(path) && deep.at(path) == bytes;
      CHECK((nested > 0) == (rows == 9 && most < 400));  // the first has four cells
      if (nested == 0)
        CHECK(same == flat.size());
      else
        CHECK(same * 10 > flat.size() * 8);  // all but the tiles between root and cells
    }
  }
}

TEST_CASE("whoever is far away reads nothing of single buildings, and sees a box of each early") {
  for (const std::size_t n : {17, 40, 120, 256, 300}) {
    std::size_t groups = 0, boxed = 0;
    for (const Encoded& file : encode_tileset(street(static_cast<int>(n)))) {
      const std::string name = file.path.substr(file.path.rfind('/') + 1);
      const auto dots = std::count(name.begin(), name.end(), '.');
      if (name.ends_with(".json")) {
        const bool is_group = name != kTileset;
        groups += is_group;
        CHECK((is_group || file.bytes.find("\"layer\":") == std::string::npos));
      } else if (n > 64 && name.starts_with("root.") && dots == 2 && name != "root.glb") {
        const Json json = Json::parse(parse_glb(file.bytes).json.dump());
        const int indices = json["meshes"][0]["primitives"][0]["indices"];
        const std::size_t boxes =
            json["accessors"][indices]["count"].get<std::size_t>() / (3 * kStandInTriangles);
        CHECK((n > 256 ? boxes < n / 4 : boxes == n / 4));  // one of the root's four parts
        ++boxed;
      }
    }
    CHECK(groups >= n / 16);
    CHECK(boxed == (n > 64 ? 4 : 0));
  }
}

TEST_CASE("files of a place's tiles are small, and the first names few of them") {
  for (const int depth : {1, 2, 3, 5})
    for (const std::size_t shown_from : {0, 1}) {  // the top may show nothing
      ContextTiles place{{{}}, [&](std::size_t i) {
                           ContextMesh mesh;
                           if (i < shown_from) return mesh;
                           const double x = 3.0 * static_cast<double>(i);
                           mesh.mesh.vertices = {{x, 0, 0}, {x + 2, 0, 0}, {x, 2, 0}};
                           mesh.mesh.faces = {{0, 1, 2}};
                           mesh.face_image = {-1};
                           mesh.uvs.resize(1), mesh.colors.resize(1);
                           return mesh;
                         }};
      std::size_t first = 0;
      for (int level = 0; level < depth; ++level) {
        const std::size_t end = place.nodes.size();
        for (; first < end; ++first)
          for (int k = 0; k < 4; ++k)
            place.nodes.push_back({static_cast<int>(first), std::exp2(depth - level), k == 3});
      }
      const TemporaryFolder folder;
      const std::vector<Encoded> encoded =
          encode_tileset(street(3), {.compression = Compression::kNone, .context = &place});
      for (const Encoded& file : encoded) write_file(folder.path().string(), file);
      for (const Finding& f : check_output(folder.path().string()))
        FAIL_CHECK(f.code << " " << f.where << " " << f.message);
      const Files files(encoded);
      std::set<std::string> found = {kTileset};
      collect(files, kTileset, Json::parse(files.at(kTileset))["root"], 1e300, found);
      CHECK(found.size() == files.size());
      std::size_t glbs = 0;
      for (const std::string& path : found) {
        glbs += path.starts_with("tiles/context/") && path.ends_with(".glb");
        if (path.ends_with(".json")) CHECK(entries_of(Json::parse(files.at(path))["root"]) < 110);
      }
      CHECK(glbs == place.nodes.size() - shown_from);
    }
}

TEST_CASE("a tree of tilesets is sound, and on Earth as well") {
  const std::vector<ExportBuilding> all = streets(9, 33);
  const auto to_ecef = [](const Vec3& p) {
    return Vec3(p.y() + 6378137, p.x(), 0.7 * p.z() + 0.1 * p.x());
  };
  for (const bool is_on_earth : {false, true}) {
    const TemporaryFolder folder;
    TilesOptions options{.compression = Compression::kNone, .most_entries = 6};
    if (is_on_earth) options.placement = {to_ecef, "test"};
    for (const Encoded& file : encode_tileset(all, options))
      write_file(folder.path().string(), file);
    for (const Finding& f : check_output(folder.path().string()))
      FAIL_CHECK(f.code << " " << f.where << " " << f.message);
  }
}
