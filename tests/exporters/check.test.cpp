// Plants each fault in an output that has none; colod's own checks name it.
#include "exporters/check/check.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>

#include "check_helpers.h"
#include "core/error.h"
#include "exporters/files.h"
#include "exporters/gltf/engine.h"
#include "exporters/gltf/glb.h"
#include "exporters/tiles3d/tiles3d.h"
#include "exporters_helpers.h"

using namespace colod;
using namespace colod::test;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

/// What street() switches by.
const SwitchFacts kScene{.layer_gsd = {0.6, 0.3, 0}};

using Change = std::function<void(Json&, std::string&)>;

/// Codes found in a GLB after its JSON and binary were changed.
Codes after(const std::string& glb, const Change& change) {
  Glb parsed = parse_glb(glb);
  Json json = Json::parse(parsed.json.dump());
  change(json, parsed.binary);
  return check(packed(json.dump(), parsed.binary));
}

/// A tileset on disk that goes away with the test.
class Tileset {
 public:
  Tileset() : folder_(fs::temp_directory_path() / ("colod_check_" + std::to_string(getpid()))) {
    for (const Encoded& file : encode_tileset(street(16), {.switching = kScene}))
      write_file(folder_.string(), file);
    for (const ExportBuilding& b : street(3))
      write_file(folder_.string(), encode_building_glb(b, {.switching = kScene}));
    write_file(folder_.string(), encode_lods_json(street(3), {.switching = kScene}));
    json = Json::parse(slurp("tileset.json"));
  }
  ~Tileset() { fs::remove_all(folder_); }
  Codes codes() const {
    write_file(folder_.string(), {"tileset.json", json.dump()});
    return codes_of(check_output(folder_.string()));
  }
  std::string slurp(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write(const std::string& name, const std::string& bytes) const {
    write_file(folder_.string(), {name, bytes});
  }
  Json json;
  Json& group() { return json["root"]["children"][0]["children"][0]; }
  Json& chain() { return group()["children"][0]; }
  Json& leaf() { return chain()["children"][0]; }

 private:
  fs::path folder_;
};

/// A place of one tile: a face of colours at 0, and one for each image, ten metres farther each.
ContextTiles place_with(int images) {
  ContextMesh all;
  for (int i = -1; i < images; ++i) {
    const int v = 3 * (i + 1);
    for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)})
      all.mesh.vertices.push_back(corner + 10 * (i + 1) * Vec3::UnitX());
    all.mesh.faces.push_back({v, v + 1, v + 2});
    all.face_image.push_back(i);
    all.uvs.push_back({Vec2f(0, 0), Vec2f(1, 0), Vec2f(0, 1)});
    all.colors.push_back({Rgb{}, Rgb{}, Rgb{}});
    if (i >= 0) all.images.push_back({"image " + std::to_string(i), ImageFormat::kJpeg});
  }
  return {{{}}, [all](std::size_t) { return all; }};
}

/// The names of a property table with 5 rows.
std::vector<std::string> split_names(const Glb& glb, std::size_t values, std::size_t offsets) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < 5; ++i) {
    const std::uint32_t from = u32(glb.binary, offsets + 4 * i),
                        to = u32(glb.binary, offsets + 4 * i + 4);
    out.push_back(glb.binary.substr(values + from, to - from));
  }
  return out;
}

void every_tile(Json& tile, const std::function<void(Json&)>& change) {
  change(tile);
  if (tile.contains("children"))
    for (Json& child : tile["children"]) every_tile(child, change);
}

}  // namespace

TEST_CASE("what colod writes has no fault, in any compression") {
  Tileset tileset;
  CHECK(tileset.codes() == Codes{});
  for (const Compression c : {Compression::kNone, Compression::kDraco, Compression::kMeshopt}) {
    std::vector<Finding> findings;
    check_glb(encode_building_glb(street(1)[0], {.compression = c}).bytes, "a.glb", findings);
    for (const Encoded& file : encode_tileset(street(2), {.compression = c}))
      if (file.path.ends_with(".glb")) check_glb(file.bytes, file.path, findings);
    CHECK(codes_of(findings) == Codes{});
  }
  std::vector<Finding> findings;
  for (const Encoded& file : encode_engine_levels(street(1)[0]))
    check_glb(file.bytes, file.path, findings);
  CHECK(codes_of(findings) == Codes{});
}

TEST_CASE("faults of geometric errors") {
  Tileset tileset;
  SECTION("all zero") {
    every_tile(tileset.json["root"], [](Json& tile) { tile["geometricError"] = 0; });
    tileset.json["geometricError"] = 0;
    CHECK(tileset.codes().contains("error-zero"));
  }
  SECTION("a child as coarse as its parent") {
    tileset.chain()["geometricError"] = tileset.group()["geometricError"];
    CHECK(tileset.codes() == Codes{"error-not-falling"});
  }
  SECTION("guessed too small") {
    every_tile(tileset.json["root"], [](Json& tile) {
      tile["geometricError"] = 0.1 * tile["geometricError"].get<double>();
    });
    CHECK(tileset.codes() == Codes{"error-gsd"});
  }
  SECTION("a leaf that is not exact") {
    tileset.leaf()["geometricError"] = 1e-6;
    CHECK(tileset.codes() == Codes{"error-leaf"});
  }
  SECTION("vanishing from afar") {
    tileset.json["geometricError"] = tileset.json["root"]["geometricError"];
    CHECK(tileset.codes() == Codes{"error-vanishes"});
  }
}

TEST_CASE("faults of boxes and trees") {
  Tileset tileset;
  SECTION("boxes in y-up axes") {
    every_tile(tileset.json["root"], [](Json& tile) {
      Json& b = tile["boundingVolume"]["box"];
      const Json old = b;
      b[1] = old[2], b[2] = -old[1].get<double>();
      b[7] = old[11], b[11] = old[7];
    });
    CHECK(tileset.codes().contains("content-box"));
  }
  SECTION("a child outside its parent") {
    Json& b = tileset.chain()["boundingVolume"]["box"];
    b[0] = b[0].get<double>() + 500;
    CHECK(tileset.codes().contains("child-outside"));
  }
  SECTION("a loose leaf") {
    Json& b = tileset.leaf()["boundingVolume"]["box"];
    b[3] = 3 * b[3].get<double>();
    CHECK(tileset.codes().contains("loose-box"));
  }
  SECTION("ADD at the root") {
    tileset.json["root"]["refine"] = "ADD";
    CHECK(tileset.codes() == Codes{"refine"});
  }
  SECTION("a content that is not there") {
    tileset.chain()["content"]["uri"] = "tiles/nothing.glb";
    CHECK(tileset.codes().contains("content"));
  }
  SECTION("not JSON") {
    tileset.write("tileset.json", "{");
    tileset.json = "x";
    CHECK(tileset.codes() == Codes{"json"});
  }
}

TEST_CASE("what light falls on has normals") {
  const std::string glb =
      encode_building_glb(street(1)[0], {.compression = Compression::kNone}).bytes;
  CHECK(check(glb) == Codes{});
  const auto bare = [](bool is_unlit) {
    return [is_unlit](Json& json, std::string&) {
      for (Json& mesh : json["meshes"])
        for (Json& primitive : mesh["primitives"]) primitive["attributes"].erase("NORMAL");
      for (Json& material : json["materials"])
        if (is_unlit) material["extensions"]["KHR_materials_unlit"] = Json::object();
    };
  };
  CHECK(after(glb, bare(false)) == Codes{"normals"});
  CHECK(after(glb, bare(true)) == Codes{});
}

TEST_CASE("a tile is as large as all its primitives, each of which is looked at") {
  for (const int images : {0, 1, 3}) {
    const ContextTiles place = place_with(images);
    for (const Compression c : {Compression::kNone, Compression::kDraco}) {
      Tileset tileset;
      for (const Encoded& file :
           encode_tileset(street(3), {.compression = c, .switching = kScene, .context = &place})) {
        tileset.write(file.path, file.bytes);
        if (file.path == "tileset.json") tileset.json = Json::parse(file.bytes);
      }
      INFO(images << " images");
      CHECK(tileset.codes() == Codes{});
      const std::string glb = tileset.slurp("tiles/context/0.glb");
      CHECK(after(glb, [](Json& json, std::string&) {
              Json& last = json["meshes"][0]["primitives"].back()["attributes"]["POSITION"];
              json["accessors"][last.get<std::size_t>()]["max"][0] = 99;
            }) == Codes{"bounds"});
    }
  }
}

TEST_CASE("faults of identity") {
  Tileset tileset;
  SECTION("two buildings swapped in one tile") {
    tileset.chain()["extras"]["building"] = "someone else";
    CHECK(tileset.codes() == Codes{"identity"});
  }
  SECTION("feature ids reversed") {
    Glb glb = parse_glb(tileset.slurp("tiles/root.0.glb"));
    auto& properties =
        glb.json["extensions"]["EXT_structural_metadata"]["propertyTables"][0]["properties"];
    const auto at = [&](const char* part) {
      const int view = properties["name"][part];
      return glb.json["bufferViews"][view]["byteOffset"].get<std::size_t>();
    };
    const std::size_t values = at("values"), offsets = at("stringOffsets");
    std::vector<std::string> names = split_names(glb, values, offsets);
    std::reverse(names.begin(), names.end());
    std::string strings;
    for (std::size_t i = 0; i < names.size(); ++i) {
      strings += names[i];
      const auto end = static_cast<std::uint32_t>(strings.size());
      std::memcpy(glb.binary.data() + offsets + 4 * (i + 1), &end, 4);
    }
    glb.binary.replace(values, strings.size(), strings);
    tileset.write("tiles/root.0.glb", packed(glb.json.dump(), glb.binary));
    CHECK(tileset.codes().contains("identity"));
  }
}

TEST_CASE("faults of a GLB") {
  const std::string glb = encode_building_glb(street(1)[0]).bytes;
  const auto primitive = [](Json& json) -> Json& { return json["meshes"][0]["primitives"][0]; };
  const auto draco = [&](Json& json) -> Json& {
    return primitive(json)["extensions"]["KHR_draco_mesh_compression"];
  };
  CHECK(after(glb, [](Json&, std::string&) {}) == Codes{});
  CHECK(after(glb, [&](Json& json, std::string&) {
          draco(json)["attributes"]["POSITION"] = 1, draco(json)["attributes"]["NORMAL"] = 0;
        }).contains("bounds"));
  CHECK(after(glb, [&](Json& json, std::string&) { draco(json)["attributes"]["POSITION"] = 7; }) ==
        Codes{"draco-ids"});
  CHECK(after(glb, [&](Json& json, std::string&) { draco(json)["attributes"]["COLOR_0"] = 2; }) ==
        Codes{"draco-ids"});
  CHECK(after(glb, [](Json& json, std::string&) { json["accessors"][0]["count"] = 5; }) ==
        Codes{"draco-counts"});
  CHECK(after(glb, [](Json& json, std::string&) { json["accessors"][0]["min"][0] = -99; }) ==
        Codes{"bounds"});
  CHECK(after(glb, [](Json&, std::string& binary) { binary[0] = 'X'; }) == Codes{"draco"});
  CHECK(after(glb, [](Json&, std::string& binary) { binary.resize(8); }) != Codes{});
  CHECK(after(glb, [&](Json& json, std::string&) {
          primitive(json)["extensions"]["EXT_mesh_features"]["featureIds"][0]["featureCount"] = 1;
        }).contains("features"));
  std::vector<Finding> findings;
  check_glb(glb.substr(0, glb.size() / 2), "x.glb", findings);
  CHECK(codes_of(findings) == Codes{"glb-container"});
}

TEST_CASE("faults of MSFT_lod") {
  const std::string glb = encode_building_glb(street(1)[0]).bytes;
  const auto root = [](Json& json) -> Json& { return json["nodes"][0]; };
  CHECK(after(glb, [&](Json& json, std::string&) {
          root(json)["extensions"]["MSFT_lod"]["ids"] = {2, 1};
        }).contains("lod-order"));
  CHECK(after(glb, [&](Json& json, std::string&) {
          root(json)["extras"]["MSFT_screencoverage"] = {0.2, 0.5, 0};
        }) == Codes{"lod-coverage"});
  CHECK(after(glb, [&](Json& json, std::string&) {
          root(json)["extras"]["MSFT_screencoverage"] = {0.5, 0.2, 0.1};
        }) == Codes{"lod-coverage"});
  CHECK(after(glb, [](Json& json, std::string&) {
          json["scenes"][0]["nodes"] = {0, 1};
        }) == Codes{"lod-nodes"});
  CHECK(after(glb, [](Json& json, std::string&) { json["nodes"][1]["name"] = "x"; }) ==
        Codes{"lod-names"});
}

TEST_CASE("faults of switches") {
  const std::string glb = encode_building_glb(street(1)[0]).bytes;
  CHECK(after(glb, [](Json& json, std::string&) {
          json["nodes"][1]["extras"]["gsd"] = 0.7;
        }).contains("lod-gsd"));
  CHECK(after(glb, [](Json& json, std::string&) { json["nodes"][0]["extras"]["gsd"] = 0.1; }) ==
        Codes{"lod-gsd"});
  CHECK(after(glb, [](Json& json, std::string&) {
          Json& coverage = json["nodes"][0]["extras"]["MSFT_screencoverage"];
          coverage[0] = 1.2 * coverage[0].get<double>();
        }) == Codes{"lod-coverage"});
  ExportBuilding twice = street(1)[0];
  twice.levels[1].mesh = twice.levels[2].mesh;
  std::vector<Finding> findings;
  check_glb(encode_building_glb(twice).bytes, "twice.glb", findings);
  CHECK(codes_of(findings) == Codes{"lod-alike"});

  Tileset tileset;
  SECTION("a building that switches for itself though the scene is the scope") {
    ExportBuilding own = street(3)[2];
    own.levels[0].gsd = 0.7;
    const Encoded file = encode_building_glb(own, {.switching = kScene});
    tileset.write(file.path, file.bytes);
    CHECK(tileset.codes() == Codes{"gsd-differs"});
  }
  SECTION("another scene's plan") {
    tileset.json["asset"]["extras"]["switching"]["layers"][1]["gsd"] = 0.31;
    CHECK(tileset.codes() == Codes{"gsd-differs"});
  }
  SECTION("each building for itself is no fault where it is said") {
    ExportBuilding own = street(3)[2];
    own.levels[0].gsd = 0.7;
    std::vector<Finding> none;
    check_glb(encode_building_glb(own, {.switching = {.scope = "building", .layer_gsd = {}}}).bytes,
              "x", none);
    CHECK(codes_of(none) == Codes{});
  }
  SECTION("lods.json") {
    Json lods = Json::parse(tileset.slurp("engine/lods.json"));
    Json& levels = lods["buildings"][0]["levels"];
    levels[1]["switch_distance"] = 1.1 * levels[1]["switch_distance"].get<double>();
    tileset.write("engine/lods.json", lods.dump());
    CHECK(tileset.codes() == Codes{"lod-distance"});
    levels[2]["gsd"] = 0.1;
    tileset.write("engine/lods.json", lods.dump());
    CHECK(tileset.codes().contains("lod-gsd"));
  }
}

TEST_CASE("faults of plain GLBs") {
  const std::string glb =
      encode_building_glb(street(1)[0], {.compression = Compression::kNone}).bytes;
  CHECK(after(glb, [](Json&, std::string&) {}) == Codes{});
  CHECK(after(glb, [](Json& json, std::string& binary) {  // the finest level's winding turned
          const Json& p = json["meshes"][2]["primitives"][0];
          const Json& accessor = json["accessors"][p["indices"].get<int>()];
          const Json& view = json["bufferViews"][accessor["bufferView"].get<int>()];
          const std::size_t at = view["byteOffset"], n = accessor["count"];
          for (std::size_t i = 0; i < n; i += 3) {
            std::swap(binary[at + 2 * i], binary[at + 2 * i + 2]);
            std::swap(binary[at + 2 * i + 1], binary[at + 2 * i + 3]);
          }
        }) == Codes{"normals"});
  CHECK(after(glb, [](Json& json, std::string&) {
          json["accessors"][0]["count"] = 1000000;
        }).contains("accessor"));
}
