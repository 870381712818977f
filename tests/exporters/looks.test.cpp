// What exporters write of looks, read back by room `read`.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "exporters/gltf/engine.h"
#include "exporters/gltf/glb.h"
#include "exporters/plain/obj.h"
#include "exporters/tiles3d/tiles3d.h"
#include "exporters_helpers.h"
#include "image/cache.h"
#include "read/read.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;

namespace {

constexpr int kSide = 64;

/// Where a place of a house lies on its image.
Vec2 on_image(const Vec3& p) { return {(p.x() + 1) / 20, (p.y() + p.z() / 2 + 1) / 20}; }

LevelLook look_for(const PolygonMesh& mesh, std::uint8_t shade, ImageFormat format) {
  LevelLook look;
  look.raster = Raster(kSide, kSide);
  std::fill(look.raster.rgb.begin(), look.raster.rgb.end(), shade);
  look.width = look.height = kSide;
  look.format = format;
  look.image = encode_image(look.raster, format, 90);
  for (const Face& f : mesh.triangles)
    look.uvs.push_back({on_image(mesh.vertices[f[0]]).cast<float>(),
                        on_image(mesh.vertices[f[1]]).cast<float>(),
                        on_image(mesh.vertices[f[2]]).cast<float>()});
  look.facet_colors.assign(mesh.facets.size(), Rgb{shade, 10, 20});
  return look;
}

ExportBuilding dressed(ExportBuilding building, ImageFormat format = ImageFormat::kPng) {
  for (ExportLevel& level : building.levels)
    level.look =
        look_for(level.mesh, static_cast<std::uint8_t>(50 * (1 + level.layers[0])), format);
  return building;
}

/// The only source of a file that was written.
Source written(const TemporaryFolder& folder, const std::vector<Encoded>& files, int coarser = 0) {
  for (const Encoded& file : files) {
    std::filesystem::create_directories((folder / file.path).parent_path());
    std::ofstream(folder / file.path, std::ios::binary) << file.bytes;
  }
  const ReadResult result = read_sources({(folder / files[0].path).string()},
                                         {.split = Split::kNone, .coarser = coarser});
  for (const ReadFailure& f : result.failures) UNSCOPED_INFO(f.message);
  REQUIRE(result.sources.size() == 1);
  return result.sources[0];
}

/// Largest distance of a corner's coordinates from where they belong, in texels.
double farthest(const Source& s, const Vec3& origin) {
  REQUIRE(s.look.uvs.size() == s.mesh.faces.size());
  double most = 0;
  for (std::size_t f = 0; f < s.mesh.faces.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec2 wanted = on_image(s.mesh.vertices[s.mesh.faces[f][c]] - origin);
      most = std::max(most, kSide * (s.look.uvs[f][c].cast<double>() - wanted).norm());
    }
  return most;
}

std::uint8_t shade(const Source& s) {
  const ImageCache::Entry entry = ImageCache(1 << 20).get(s.look.images.at(0));
  REQUIRE(entry.pyramid);
  return entry.pyramid->levels[0].at(3, 3)[0];
}

const Vec3 kOrigin(10, 20, 30);

}  // namespace

TEST_CASE("each level of a building's GLB has its own image, in its place to half a texel") {
  const TemporaryFolder folder;
  for (const Compression c : {Compression::kNone, Compression::kDraco, Compression::kMeshopt})
    for (int coarser = 0; coarser < 3; ++coarser) {
      const ExportBuilding house = dressed(three_layers("house", kOrigin));
      const Source s = written(folder, {encode_building_glb(house, {.compression = c})}, coarser);
      INFO("compression " << static_cast<int>(c) << ", " << coarser << " levels down");
      CHECK(farthest(s, kOrigin) < 0.5);
      CHECK(shade(s) == 50 * (3 - coarser));
    }
}

TEST_CASE("a GLB begins with the coarsest level's image, unlit, and WebP is named") {
  const ExportBuilding house = dressed(three_layers("house", kOrigin), ImageFormat::kWebp);
  const Glb glb = parse_glb(encode_building_glb(house).bytes);
  REQUIRE(glb.json["images"].size() == 3);
  CHECK(glb.json["materials"].size() == 3);
  for (const auto& m : glb.json["materials"])
    CHECK(m["extensions"].contains("KHR_materials_unlit"));
  CHECK(glb.json["images"][0]["mimeType"] == "image/webp");
  CHECK(glb.json["textures"][1]["extensions"]["EXT_texture_webp"]["source"] == 1);
  const auto& required = glb.json["extensionsRequired"];
  CHECK(std::count(required.begin(), required.end(), "EXT_texture_webp") == 1);
  const int first = glb.json["images"][0]["bufferView"];
  CHECK(glb.json["bufferViews"][first]["byteOffset"] <
        glb.json["bufferViews"][first + 1]["byteOffset"]);
}

TEST_CASE("a fallback is what a client reads that does not know the other format") {
  for (const ImageFormat format : {ImageFormat::kWebp, ImageFormat::kKtx2}) {
    const TemporaryFolder folder;
    ExportBuilding house = dressed(three_layers("house", kOrigin));
    for (ExportLevel& level : house.levels) {
      level.look.fallback = encode_image(level.look.raster, ImageFormat::kJpeg, 90);
      level.look.format = format;
      level.look.image = format == ImageFormat::kWebp ? encode_image(level.look.raster, format, 90)
                                                      : std::string("\xABKTX 20\xBB\r\n\x1A\n");
    }
    const Encoded file = encode_building_glb(house);
    const Glb glb = parse_glb(file.bytes);
    const char* extension =
        format == ImageFormat::kWebp ? "EXT_texture_webp" : "KHR_texture_basisu";
    REQUIRE(glb.json["images"].size() == 6);
    REQUIRE(glb.json["textures"].size() == 3);
    for (int i = 0; i < 3; ++i) {
      const auto& texture = glb.json["textures"][i];
      CHECK(glb.json["images"][texture["source"].get<int>()]["mimeType"] == "image/jpeg");
      CHECK(glb.json["images"][texture["extensions"][extension]["source"].get<int>()]["mimeType"] ==
            mime_of(format));
      CHECK(glb.json["materials"][i]["pbrMetallicRoughness"]["baseColorTexture"]["index"] == i);
    }
    const auto& used = glb.json["extensionsUsed"];
    CHECK(std::count(used.begin(), used.end(), extension) == 1);
    const auto required = glb.json.value("extensionsRequired", nlohmann::json::array());
    CHECK(std::count(required.begin(), required.end(), extension) == 0);
    std::vector<Encoded> files = {encode_obj(house, house.levels[1], 1)};
    for (Encoded& more : encode_obj_material(house, house.levels[1], 1)) files.push_back(more);
    CHECK_THAT(files[2].path, Catch::EndsWith(".jpg"));
    CHECK(std::abs(shade(written(folder, files)) - 100) <= 1);
    const Source s = written(folder, {file});
    CHECK(farthest(s, kOrigin) < 0.5);
    if (format == ImageFormat::kWebp) CHECK(std::abs(shade(s) - 150) <= 2);
  }
}

TEST_CASE("colours of facets come back as colours of vertices") {
  const TemporaryFolder folder;
  ExportBuilding house = dressed(three_layers("house", kOrigin));
  for (ExportLevel& level : house.levels) {
    level.look.uvs.clear(), level.look.image.clear();
    for (std::size_t f = 0; f < level.look.facet_colors.size(); ++f)
      level.look.facet_colors[f] = {static_cast<std::uint8_t>(3 + f), 200, 90};
  }
  for (const Compression c : {Compression::kNone, Compression::kDraco, Compression::kMeshopt}) {
    const Source s = written(folder, {encode_building_glb(house, {.compression = c})});
    std::set<int> reds;
    for (const auto& corners : s.look.colors) {
      CHECK((corners[0] == corners[1] && corners[0][1] == 200));
      reds.insert(corners[0][0]);
    }
    CHECK(reds.size() == house.levels.back().look.facet_colors.size());
    CHECK(*reds.begin() == 3);
  }
}

TEST_CASE(
    "a group's buildings share one image and one draw call, a stand-in has its sides' colours") {
  std::vector<ExportBuilding> buildings;
  for (const ExportBuilding& b : street(6)) buildings.push_back(dressed(b));
  buildings[2].levels.front().look = {};  // one without appearance among them
  const std::vector<Encoded> files = encode_tileset(buildings);
  const Glb root = parse_glb(find(files, "tiles/root.glb").bytes);
  CHECK(root.json["meshes"][0]["primitives"].size() == 1);
  CHECK(root.json["meshes"][0]["primitives"][0]["attributes"].contains("COLOR_0"));
  int groups = 0;
  for (const Encoded& file : files) {
    if (!file.path.ends_with(".glb")) continue;
    const Glb glb = parse_glb(file.bytes);
    if (!glb.json.contains("images")) continue;
    CHECK(glb.json["images"].size() == 1);
    CHECK(glb.json["materials"].size() == 1);
    const auto& table = glb.json["extensions"]["EXT_structural_metadata"]["propertyTables"][0];
    groups += table["count"] == 6;
  }
  CHECK(groups == 1);
}

TEST_CASE(
    "mip levels are made of what is seen ever so small, not of tiles that coarser ones replace") {
  std::vector<ExportBuilding> buildings;
  for (const ExportBuilding& b : street(6)) buildings.push_back(dressed(b));
  ContextTiles place{{{}, {.parent = 0, .is_farthest = false}}, [](std::size_t i) {
                       ContextMesh mesh;
                       mesh.mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
                       mesh.mesh.faces = {{0, 1, 2}};
                       mesh.uvs = {{Vec2f(0, 0), Vec2f(1, 0), Vec2f(0, 1)}};
                       mesh.face_image = {0}, mesh.colors.resize(1);
                       mesh.images = {{std::to_string(i), ImageFormat::kJpeg}};
                       return mesh;
                     }};
  std::vector<Encoded> files = encode_tileset(buildings, {.context = &place});
  files.push_back(encode_building_glb(buildings[0]));
  constexpr int kLinear = 9729, kTrilinear = 9987;
  int seen = 0;
  for (const Encoded& file : files) {
    if (!file.path.ends_with(".glb")) continue;
    const Glb glb = parse_glb(file.bytes);
    if (!glb.json.contains("samplers")) continue;
    ++seen;
    CAPTURE(file.path);
    const bool is_far = file.path == "tiles/context/0.glb" || file.path.starts_with("buildings/");
    CHECK(glb.json["samplers"][0]["minFilter"] == (is_far ? kTrilinear : kLinear));
  }
  CHECK(seen > 6);
}

TEST_CASE("tiles have normals where light falls on them, and columns with the same bytes once") {
  enum class Wear { kNothing, kColors, kImages };
  const Wear wear = GENERATE(Wear::kNothing, Wear::kColors, Wear::kImages);
  std::vector<ExportBuilding> buildings;
  for (const ExportBuilding& b : street(6)) {
    buildings.push_back(wear == Wear::kNothing ? b : dressed(b));
    if (wear == Wear::kColors)
      for (ExportLevel& level : buildings.back().levels) level.look.uvs.clear();
  }
  for (const Encoded& file : encode_tileset(buildings)) {
    if (!file.path.ends_with(".glb")) continue;
    const Glb glb = parse_glb(file.bytes);
    CAPTURE(file.path);
    const auto& primitive = glb.json["meshes"][0]["primitives"][0];
    CHECK(primitive["attributes"].contains("NORMAL") == (wear == Wear::kNothing));
    const auto& columns =
        glb.json["extensions"]["EXT_structural_metadata"]["propertyTables"][0]["properties"];
    std::map<std::string, std::set<int>> views;  // by bytes
    for (const auto& column : columns)
      for (const char* part : {"values", "stringOffsets"})
        if (column.contains(part)) {
          const auto& view = glb.json["bufferViews"][column[part].get<int>()];
          views[glb.binary.substr(view["byteOffset"], view["byteLength"])].insert(
              column[part].get<int>());
        }
    CHECK(views.size() > 4);
    for (const auto& [bytes, same] : views) CHECK(same.size() == 1);
  }
}

TEST_CASE("a building that looks the same on all levels wears no more in its group than is seen") {
  const int side = GENERATE(64, 128, 512, 1024);  // texels of 0.31 m, 0.16 m … of its image
  std::vector<ExportBuilding> buildings;
  for (const ExportBuilding& b : street(6)) buildings.push_back(dressed(b));
  ExportBuilding& plain = buildings[3];
  plain.levels.erase(plain.levels.begin(), plain.levels.end() - 1);
  plain.levels[0].layers = {0, 1, 2};
  LevelLook& look = plain.levels[0].look;
  look.raster = Raster(side, side);
  std::fill(look.raster.rgb.begin(), look.raster.rgb.end(), std::uint8_t{50});
  look.width = look.height = side;
  look.image = encode_image(look.raster, look.format, 90);
  int groups = 0, own = 0;
  for (const Encoded& file : encode_tileset(buildings)) {
    if (!file.path.ends_with(".glb")) continue;
    const Glb glb = parse_glb(file.bytes);
    const auto& table = glb.json["extensions"]["EXT_structural_metadata"]["propertyTables"][0];
    if (!glb.json.contains("images")) continue;
    const TemporaryFolder folder;
    const Source s = written(folder, {{"tile.glb", file.bytes}});
    const ImageCache images(std::size_t{1} << 28);
    const ImageCache::Facts facts = images.facts(s.look.images.at(0));
    CAPTURE(side, file.path, facts.width, facts.height);
    if (table["count"] == 6) {
      ++groups;  // pixels of 0.6 m: each has 64 texels a side
      CHECK(facts.width * facts.height <= 8 * kSide * kSide);
      CHECK(std::abs(shade(s) - 50) <= 1);
    } else if (file.path.find(plain.name + ".layer") != std::string::npos) {
      ++own;
      CHECK(facts.width == side);
    }
  }
  CHECK(groups == 1);
  CHECK(own == 1);
}

TEST_CASE("atlases of a group that do not fit into one are halved until they do") {
  std::vector<ExportBuilding> buildings;
  for (const ExportBuilding& b : street(6)) buildings.push_back(dressed(b));
  const int largest =
      GENERATE(512, 128, 64);  // six of 64 texels: all fit, half as large, a quarter
  INFO(largest);
  TilesOptions options;
  options.largest_texture = largest;
  int shared = 0;
  for (const Encoded& file : encode_tileset(buildings, options)) {
    if (!file.path.ends_with(".glb")) continue;
    const Glb glb = parse_glb(file.bytes);
    if (!glb.json.contains("images")) continue;
    if (glb.json["extensions"]["EXT_structural_metadata"]["propertyTables"][0]["count"] != 6)
      continue;
    ++shared;
    const TemporaryFolder folder;
    const Source s = written(folder, {{"tile.glb", file.bytes}});
    const ImageCache images(std::size_t{1} << 28);
    const ImageCache::Facts facts = images.facts(s.look.images.at(0));
    CHECK(facts.width <= largest);
    CHECK(facts.height <= largest);
    CHECK(facts.width * facts.height >= std::min(6 * kSide * kSide, largest * largest / 4));
    CHECK(std::abs(shade(s) - 50) <= 1);
  }
  CHECK(shared == 1);
}

TEST_CASE("an engine's image has sides that are powers of two, an OBJ names its material") {
  const TemporaryFolder folder;
  ExportBuilding house = dressed(three_layers("house", kOrigin));
  LevelLook& look = house.levels.back().look;
  look.raster = Raster(60, 36);
  look.width = 60, look.height = 36;
  look.image = encode_image(look.raster, look.format, 90);
  const Source engine = written(folder, encode_engine_levels(house));
  const ImageCache::Facts facts = ImageCache(1 << 20).facts(engine.look.images.at(0));
  CHECK((facts.width == 64 && facts.height == 64));
  const ExportLevel& level = house.levels[1];
  std::vector<Encoded> files = {encode_obj(house, level, 1)};
  for (Encoded& file : encode_obj_material(house, level, 1)) files.push_back(std::move(file));
  REQUIRE(files.size() == 3);
  const Source obj = written(folder, files);
  CHECK(farthest(obj, kOrigin) < 0.01);
  CHECK(shade(obj) == 100);
  const Source ply = written(folder, {encode_ply(house, level, 1)});
  CHECK(ply.look.colors.empty());  // one colour everywhere tells nothing
}
