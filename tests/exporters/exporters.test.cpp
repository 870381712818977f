#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <set>

#include "core/error.h"
#include "exporters/files.h"
#include "exporters/gltf/draco.h"
#include "exporters/gltf/engine.h"
#include "exporters/gltf/glb.h"
#include "exporters/gltf/gltf.h"
#include "exporters/plain/obj.h"
#include "exporters/tiles3d/archive.h"
#include "exporters/tiles3d/tiles3d.h"
#include "exporters_helpers.h"
#include "read/read.h"

using namespace colod;
using namespace colod::test;
namespace fs = std::filesystem;

namespace {

const Vec3 kFar(691234.567, 5334567.891, 512.345);

/// Writes a file for read_single and reads it back.
Source read_back(const Encoded& file) {
  const fs::path folder =
      fs::temp_directory_path() / ("colod_exporters_" + std::to_string(getpid()));
  write_file(folder.string(), file);
  Source source = read_single((folder / file.path).string());
  fs::remove_all(folder);
  return source;
}

double farthest_vertex(const Mesh& from, const std::vector<Vec3>& to) {
  double worst = 0;
  for (const Vec3& p : from.vertices) {
    double best = 1e300;
    for (const Vec3& q : to) best = std::min(best, (p - q).norm());
    worst = std::max(worst, best);
  }
  return worst;
}

/// Buildings shown by a tile: names from its property table.
std::vector<std::string> names_in(const Glb& glb) {
  const auto& table = glb.json["extensions"]["EXT_structural_metadata"]["propertyTables"][0];
  const auto view = [&](const char* what) {
    return glb.json["bufferViews"][table["properties"]["name"][what].get<int>()];
  };
  const std::size_t values = view("values")["byteOffset"],
                    offsets = view("stringOffsets")["byteOffset"];
  std::vector<std::string> names;
  for (std::size_t i = 0; i < table["count"].get<std::size_t>(); ++i) {
    const std::uint32_t a = u32(glb.binary, offsets + 4 * i),
                        b = u32(glb.binary, offsets + 4 * i + 4);
    names.push_back(glb.binary.substr(values + a, b - a));
  }
  return names;
}

/// "a, b" → a and b: what a stand-in covers.
std::vector<std::string> split(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (std::string name : names) {
    for (std::size_t at; (at = name.find(", ")) != name.npos; name = name.substr(at + 2))
      out.push_back(name.substr(0, at));
    out.push_back(name);
  }
  return out;
}

/// What stands in files of their own in its place; URIs as the outermost file would say.
nlohmann::json put_together(nlohmann::json tile, const std::vector<Encoded>& files,
                            const std::string& folder = "") {
  const std::string uri = folder + tile["content"]["uri"].get<std::string>();
  if (uri.ends_with(".json")) {
    const auto inner = nlohmann::json::parse(find(files, uri).bytes);
    CHECK(inner["root"]["geometricError"] < tile["geometricError"]);
    CHECK(inner["root"]["boundingVolume"] == tile["boundingVolume"]);
    CHECK(inner["root"]["refine"] == "REPLACE");
    return put_together(inner["root"], files, uri.substr(0, uri.rfind('/') + 1));
  }
  tile["content"]["uri"] = uri;
  if (tile.contains("children"))
    for (auto& child : tile["children"]) child = put_together(child, files, folder);
  return tile;
}

/// Checks one tile against its content and children; returns the names of the buildings it covers.
std::vector<std::string> check_tile(const nlohmann::json& tile, const std::vector<Encoded>& files) {
  const Glb glb = parse_glb(find(files, tile["content"]["uri"]).bytes);
  const Decoded content = decode_mesh(glb, 0);
  Box box = box_of(tile), tight;
  for (const Vec3& p : content.mesh.vertices) tight.extend(Vec3(p.x(), -p.z(), p.y()));
  std::vector<std::string> names = split(names_in(glb)), below;
  std::sort(names.begin(), names.end());
  if (!tile.contains("children")) CHECK(tile["geometricError"] == 0);
  for (const auto& child : tile.value("children", nlohmann::json::array())) {
    CHECK(child["geometricError"].get<double>() < tile["geometricError"].get<double>());
    tight.extend(box_of(child));
    for (const std::string& name : check_tile(child, files)) below.push_back(name);
  }
  std::sort(below.begin(), below.end());
  const bool is_whole = std::none_of(names.begin(), names.end(), [](const std::string& name) {
    return name.find(" more") != name.npos;
  });
  if (!tile.contains("children")) below = names;
  if (is_whole) CHECK(below == names);
  CHECK((box.min - tight.min).norm() == 0);
  CHECK((box.max - tight.max).norm() == 0);
  return below;
}

}  // namespace

TEST_CASE("a building GLB has its finest mesh on the root and the others in MSFT_lod") {
  const Glb glb = parse_glb(encode_building_glb(three_layers("house", kFar)).bytes);
  const auto& nodes = glb.json["nodes"];
  CHECK(glb.json["scenes"][0]["nodes"] == nlohmann::json{0});
  CHECK(nodes[0]["extensions"]["MSFT_lod"]["ids"] == nlohmann::json{1, 2});
  for (int lod = 0; lod < 3; ++lod) {
    CHECK(nodes[lod]["name"] == "house_LOD" + std::to_string(lod));
    CHECK(glb.json["meshes"][nodes[lod]["mesh"].get<int>()]["name"] == nodes[lod]["name"]);
    CHECK(nodes[lod]["extras"]["layer"] == 2 - lod);
    CHECK(!nodes[lod].contains("children"));
  }
  CHECK(glb.json["extensionsRequired"] == nlohmann::json{"KHR_draco_mesh_compression"});
  CHECK(glb.json["asset"]["extras"]["origin"][1] == kFar.y());
}

TEST_CASE("coverage is the diameter over what a viewport sees at the next level's gsd, then 0") {
  const ExportBuilding house = three_layers("house", kFar);
  const Glb glb = parse_glb(encode_building_glb(house).bytes);
  const std::vector<double> c = glb.json["nodes"][0]["extras"]["MSFT_screencoverage"];
  REQUIRE(c.size() == 3);
  CHECK(c[0] <= 1);
  CHECK(c[0] > c[1]);
  CHECK(c[1] > c[2]);
  CHECK(c[2] == 0);
  const double diameter = bounding_box(house.levels[2].mesh.vertices).diagonal();
  CHECK(glb.json["nodes"][1]["extras"]["gsd"] == 0.3);
  CHECK(c[0] == Approx(diameter / (0.3 * 1080)));
  CHECK(c[1] == Approx(diameter / (0.6 * 1080)));
}

TEST_CASE("coverage falls strictly even when levels switch on one's nose") {
  ExportBuilding house = three_layers("house", kFar);
  house.levels[0].gsd = 2e-4, house.levels[1].gsd = 1e-4;
  const Glb glb = parse_glb(encode_building_glb(house).bytes);
  const std::vector<double> c = glb.json["nodes"][0]["extras"]["MSFT_screencoverage"];
  CHECK((1 >= c[0] && c[0] > c[1] && c[1] > c[2] && c[2] == 0));
}

TEST_CASE("layers that are alike are one level, and say so") {
  ExportBuilding house = three_layers("house", kFar);
  house.levels.erase(house.levels.begin());
  house.levels[0].layers = {0, 1};
  const Glb glb = parse_glb(encode_building_glb(house).bytes);
  REQUIRE(glb.json["nodes"].size() == 2);
  CHECK(glb.json["nodes"][1]["extras"]["layers"] == std::vector{0, 1});
  CHECK(glb.json["nodes"][1]["extras"]["layer"] == 1);
  CHECK(encode_engine_levels(house).size() == 2);
  const auto lods = nlohmann::json::parse(encode_lods_json({house}).bytes);
  CHECK(lods["buildings"][0]["levels"][1]["layers"] == std::vector{0, 1});
}

TEST_CASE("a level's bytes are those of its mesh in the file") {
  const BuildingGlb glb = encode_building_glb(three_layers("house", kFar));
  const auto views = parse_glb(glb.bytes).json["bufferViews"];
  REQUIRE(glb.level_bytes.size() == 3);
  for (int level = 0; level < 3; ++level)
    CHECK(glb.level_bytes[level] >= views[level]["byteLength"].get<std::size_t>());
}

TEST_CASE("accessors say what a Draco decoder finds") {
  const Glb glb = parse_glb(encode_building_glb(three_layers("house", kFar)).bytes);
  for (int m = 0; m < 3; ++m) {
    const Decoded decoded = decode_mesh(glb, m);
    const auto& primitive = glb.json["meshes"][m]["primitives"][0];
    const auto& position = glb.json["accessors"][primitive["attributes"]["POSITION"].get<int>()];
    CHECK(position["count"] == decoded.mesh.vertices.size());
    CHECK(!position.contains("bufferView"));
    CHECK(glb.json["accessors"][primitive["indices"].get<int>()]["count"] ==
          3 * decoded.mesh.faces.size());
    const Box box = bounding_box(decoded.mesh.vertices);
    for (int k = 0; k < 3; ++k) CHECK(position["min"][k] == box.min[k]);
    for (int k = 0; k < 3; ++k) CHECK(position["max"][k] == box.max[k]);
  }
}

TEST_CASE("the coarsest level comes first in the binary chunk") {
  const Glb glb = parse_glb(encode_building_glb(three_layers("house", kFar)).bytes);
  std::size_t end = 0;
  for (int lod = 2; lod >= 0; --lod) {
    const auto& primitive =
        glb.json["meshes"][glb.json["nodes"][lod]["mesh"].get<int>()]["primitives"][0];
    const auto& view =
        glb.json["bufferViews"]
                [primitive["extensions"]["KHR_draco_mesh_compression"]["bufferView"].get<int>()];
    CHECK(view["byteOffset"].get<std::size_t>() >= end);
    end = view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>();
  }
}

TEST_CASE("every level stays within the bound, closed, and lit by its facets' normals") {
  const ExportBuilding house = three_layers("house", kFar);
  const Glb glb = parse_glb(encode_building_glb(house, {.quantization = 0.02}).bytes);
  for (int layer = 0; layer < 3; ++layer) {
    const Decoded decoded = decode_mesh(glb, layer);
    std::vector<Vec3> expected;
    for (const Vec3& p : house.levels[layer].mesh.vertices)
      expected.emplace_back(p.x(), p.z(), -p.y());
    CHECK(farthest_vertex(decoded.mesh, expected) <= 0.02);
    CHECK(farthest_vertex({expected, {}}, decoded.mesh.vertices) <= 0.02);
    CHECK(is_watertight(decoded.mesh));
    CHECK(signed_volume(decoded.mesh) ==
          Approx(signed_volume(house.levels[layer].mesh.mesh())).epsilon(0.02));
    for (const Face& f : decoded.mesh.faces)
      for (const int v : f)
        CHECK(face_cross(decoded.mesh, f).normalized().dot(decoded.normals[v]) > 0.999);
  }
}

TEST_CASE("a wall thinner than the grid makes the grid finer instead of opening the mesh") {
  ExportBuilding house = three_layers("house", kFar);
  const Mesh fin = box_mesh({2, 8.102, 1}, {3, 8.104, 2});
  house.levels[2].mesh = as_polygons(join(gable_house(12.3, 8.1, 5.7, 3.3), fin));
  const Glb glb = parse_glb(encode_building_glb(house, {.quantization = 0.05}).bytes);
  CHECK(is_watertight(decode_mesh(glb, 2).mesh));
}

TEST_CASE("reading a building GLB gives its finest layer in world coordinates") {
  for (const Compression compression : {Compression::kDraco, Compression::kNone}) {
    const ExportBuilding house = three_layers("house", kFar);
    const Source s = read_back(encode_building_glb(house, {.compression = compression}));
    Mesh world = house.levels[2].mesh.mesh();
    for (Vec3& p : world.vertices) p += kFar;
    CHECK(farthest_vertex(s.mesh, world.vertices) <= 0.01);
    CHECK(s.mesh.faces.size() == world.faces.size());
    CHECK(is_watertight(s.mesh));
    CHECK(signed_volume(s.mesh) == Approx(signed_volume(world)).epsilon(0.01));
  }
}

TEST_CASE("OBJ and PLY give back every double at 10^6 metres") {
  const ExportBuilding house = three_layers("house", kFar);
  for (const ExportLevel& level : house.levels)
    for (const Encoded& file : {encode_obj(house, level, 1), encode_ply(house, level, 1)}) {
      const Source s = read_back(file);
      REQUIRE(s.mesh.vertices.size() == level.mesh.vertices.size());
      for (std::size_t i = 0; i < s.mesh.vertices.size(); ++i)
        CHECK(s.mesh.vertices[i] == level.mesh.vertices[i] + kFar);
      CHECK(is_watertight(s.mesh));
      CHECK(signed_volume(s.mesh) == Approx(signed_volume(level.mesh.mesh())));
    }
}

TEST_CASE("OBJ writes a convex facet as one polygon, and one with a straight corner as triangles") {
  ExportBuilding house = three_layers("house", kFar);
  const auto faces = [&] {
    const std::string text = encode_obj(house, house.levels[0], 0).bytes;
    int count = 0;
    for (std::size_t at = 0; (at = text.find("\nf ", at)) != text.npos; ++at) ++count;
    return count;
  };
  CHECK(faces() == 6);
  PolygonMesh& mesh = house.levels[0].mesh;
  std::vector<int>& ring = mesh.facets[0].rings[0];
  mesh.vertices.push_back((mesh.vertices[ring[0]] + mesh.vertices[ring[1]]) / 2);
  ring.insert(ring.begin() + 1, static_cast<int>(mesh.vertices.size()) - 1);
  CHECK(faces() == 7);
}

TEST_CASE("a tileset's tiles hold their boxes, errors and buildings") {
  for (const int n : {1, 5, 40}) {
    const std::vector<Encoded> files = encode_tileset(street(n));
    REQUIRE(files.front().path == "tileset.json");
    const auto tileset = nlohmann::json::parse(files.front().bytes);
    CHECK(tileset["asset"]["version"] == "1.1");
    CHECK(tileset["root"]["refine"] == "REPLACE");
    CHECK(!tileset["root"].contains("transform"));
    CHECK(tileset["geometricError"].get<double>() >=
          4 * tileset["root"]["geometricError"].get<double>());
    CHECK(tileset["geometricError"].get<double>() >=
          16 * box_of(tileset["root"]).diagonal());  // in sight until it is a pixel
    const auto root = put_together(tileset["root"], files);
    CHECK(check_tile(root, files).size() == static_cast<std::size_t>(n));
  }
}

TEST_CASE("no tile has more than 16 children") {
  const std::vector<Encoded> files = encode_tileset(street(70));
  const auto tileset = nlohmann::json::parse(files.front().bytes);
  std::vector<nlohmann::json> open = {put_together(tileset["root"], files)};
  while (!open.empty()) {
    const auto tile = open.back();
    open.pop_back();
    const auto children = tile.value("children", nlohmann::json::array());
    CHECK(children.size() <= 16);
    open.insert(open.end(), children.begin(), children.end());
  }
}

TEST_CASE("a tile's geometric error is the target SSE times its content's gsd") {
  const auto files = encode_tileset({three_layers("house", kFar)}, {.target_sse = 12});
  const auto root = nlohmann::json::parse(files.front().bytes)["root"];
  const auto coarsest = root["children"][0], middle = coarsest["children"][0];
  CHECK(coarsest["geometricError"].get<double>() == Approx(12 * 0.6));
  CHECK(middle["geometricError"].get<double>() == Approx(12 * 0.3));
}

TEST_CASE("a building that may stay coarse for longer than its group gets a tile for it") {
  std::vector<ExportBuilding> buildings = {three_layers("a", kFar), three_layers("b", kFar)};
  buildings[1].levels.erase(buildings[1].levels.begin() + 1);  // {0, 1} and {2}
  buildings[1].levels[0].layers = {0, 1};
  buildings[1].levels[0].gsd = 0.3;
  const auto files = encode_tileset(buildings);
  const auto boxes = nlohmann::json::parse(files.front().bytes)["root"]["children"][0];
  const auto group = boxes["children"][0];
  const auto &a = group["children"][0], &b = group["children"][1];
  CHECK(a["extras"] == nlohmann::json{{"building", "a"}, {"layer", 1}, {"coarsestLayer", 1}});
  CHECK(b["extras"] == nlohmann::json{{"building", "b"}, {"layer", 1}, {"coarsestLayer", 0}});
  CHECK(a["geometricError"] == b["geometricError"]);
  CHECK(b["children"][0]["extras"]["layer"] == 2);
}

TEST_CASE("feature ids lead from every vertex to its building") {
  const std::vector<ExportBuilding> buildings = street(3);
  const auto files = encode_tileset(buildings);
  const Glb glb = parse_glb(find(files, "tiles/root.0.glb").bytes);
  const auto offset = nlohmann::json::parse(files.front().bytes)["asset"]["extras"]["offset"];
  const Vec3 origin(offset[0], offset[1], offset[2]);
  const Decoded root = decode_mesh(glb, 0);
  CHECK(names_in(glb) == std::vector<std::string>{"b0", "b1", "b2"});
  for (std::size_t i = 0; i < root.features.size(); ++i) {
    const Vec3& p = root.mesh.vertices[i];
    const Vec3 local = Vec3(p.x(), -p.z(), p.y()) + origin - buildings[root.features[i]].origin;
    CHECK(bounding_box(buildings[root.features[i]].levels[0].mesh.vertices).max.x() + 0.02 >
          local.x());
    CHECK(local.x() > -0.02);
  }
  for (const auto& view : glb.json["bufferViews"]) CHECK(view["byteOffset"].get<int>() % 8 == 0);
}

TEST_CASE("the same buildings give the same bytes") {
  const auto a = encode_tileset(street(20)), b = encode_tileset(street(20));
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    CHECK((a[i].path == b[i].path && a[i].bytes == b[i].bytes));
  CHECK(encode_building_glb(street(1)[0]).bytes == encode_building_glb(street(1)[0]).bytes);
}

TEST_CASE("engine levels are plain, named _LOD<n>, and stand on the ground about their pivot") {
  const ExportBuilding house = three_layers("house", kFar);
  const std::vector<Encoded> files = encode_engine_levels(house);
  REQUIRE(files.size() == 3);
  for (int lod = 0; lod < 3; ++lod) {
    CHECK(files[lod].path == "engine/house_LOD" + std::to_string(lod) + ".glb");
    const Glb glb = parse_glb(files[lod].bytes);
    CHECK(!glb.json.contains("extensionsRequired"));
    CHECK(glb.json["nodes"][0]["name"] == "house_LOD" + std::to_string(lod));
    CHECK(glb.json["nodes"][0]["extras"]["layer"] == 2 - lod);
    CHECK(glb.json["materials"].size() == 1);
    CHECK(glb.json["materials"][0]["name"] == "house");
    const auto& position = glb.json["accessors"][0];
    CHECK(position["min"][1] == 0);
    const double left = position["min"][0], right = position["max"][0];
    CHECK(std::abs(left + right) <= 0.02);
    CHECK(glb.json["asset"]["extras"]["pivot"][2].get<double>() == Approx(kFar.z()));
  }
}

TEST_CASE("lods.json: gsds and distances rise, screen sizes fall, files exist") {
  const ExportBuilding house = three_layers("house", kFar);
  const auto json = nlohmann::json::parse(encode_lods_json({house}).bytes);
  const auto& levels = json["buildings"][0]["levels"];
  REQUIRE(levels.size() == 3);
  CHECK(levels[0]["switch_distance"] == 0);
  CHECK(levels[0]["screen_size"] == 1);
  for (std::size_t lod = 0; lod + 1 < 3; ++lod) {
    CHECK(levels[lod + 1]["gsd"].get<double>() > levels[lod]["gsd"].get<double>());
    CHECK(levels[lod + 1]["switch_distance"].get<double>() >
          levels[lod]["switch_distance"].get<double>());
    CHECK(levels[lod + 1]["screen_size"].get<double>() < levels[lod]["screen_size"].get<double>());
  }
  const double seen = levels[1]["switch_distance"].get<double>() * 2 * std::tan(M_PI / 6) / 1080;
  CHECK(seen == Approx(0.3));
}

TEST_CASE("a 3tz holds every file, and its index leads to each by the MD5 of its path") {
  const std::vector<Encoded> files = {{"tileset.json", "{}"}, {"tiles/a.glb", "glTF"}};
  const std::string zip = encode_3tz(files).bytes;
  const std::size_t name = zip.find("@3dtilesIndex1@");
  REQUIRE(name != zip.npos);
  const std::string index = zip.substr(name + 15, 48);
  // md5("tileset.json") as md5sum says
  const unsigned char digest[] = {0xc0, 0x9b, 0xde, 0xa7};
  const std::size_t at = index.find(std::string(reinterpret_cast<const char*>(digest), 4));
  REQUIRE(at % 24 == 0);
  CHECK(u32(index, at + 16) == 0);  // the first local header
  CHECK(u32(zip, u32(index, 24 - at + 16)) == 0x04034b50);
  CHECK(u32(zip, zip.size() - 22) == 0x06054b50);
}

TEST_CASE("grids nest and keep the bound") {
  for (const double bound : {0.1, 0.01, 0.003}) {
    const QuantizationGrid grid = fit_grid({Vec3(-3.3, 0, 1), Vec3(40, 20, 30)}, bound);
    CHECK(grid.error() <= bound);
    CHECK(std::exp2(std::round(std::log2(grid.step()))) == grid.step());
    CHECK((grid.round({1.234, 5.678, 9.1}) - Vec3(1.234, 5.678, 9.1)).norm() <= bound);
  }
}

TEST_CASE("decoded positions lie exactly on the grid") {
  const Box box{Vec3(-17.3, 2.1, -5.7), Vec3(21.9, 14.2, 30.8)};
  const QuantizationGrid grid = fit_grid(box, 0.003);
  FlatMesh mesh = flatten(three_layers("house", Vec3::Zero()).levels[0].mesh, box.min, grid, 0);
  const DracoContent content = decode_draco(encode_draco(mesh, grid).bytes);
  for (const double x : content.attributes.at(0).values)
    CHECK(x / grid.step() == std::round(x / grid.step()));
}

TEST_CASE("one feature or several, ids come back as they were") {
  const QuantizationGrid grid = fit_grid({Vec3::Constant(-50), Vec3::Constant(50)}, 0.01);
  for (const int second : {7, 300, 70000}) {
    const PolygonMesh house = three_layers("house", Vec3::Zero()).levels[0].mesh;
    FlatMesh mesh = flatten(house, Vec3::Zero(), grid, 7);
    append(mesh, flatten(house, Vec3(30, 0, 0), grid, second));
    const DracoResult draco = encode_draco(mesh, grid);
    const DracoContent content = decode_draco(draco.bytes);
    const std::vector<double>& values = content.attributes.at(draco.feature_id).values;
    const std::set<double> ids(values.begin(), values.end());
    CHECK(ids == std::set<double>{7.0, static_cast<double>(second)});
  }
}

TEST_CASE("a building without triangles is refused by name") {
  ExportBuilding empty = three_layers("hollow", kFar);
  empty.levels[1].mesh = {};
  CHECK_THROWS_WITH(encode_building_glb(empty), Catch::Contains("hollow"));
  CHECK_THROWS_AS(encode_tileset({empty}), Error);
  CHECK_THROWS_AS(encode_tileset({}), Error);
}

TEST_CASE("the name that the input writes stands beside the safe one") {
  ExportBuilding b = three_layers("street_1", Vec3::Zero());
  b.given_name = "教学楼";
  const Glb glb = parse_glb(encode_building_glb(b).bytes);
  CHECK(glb.json["nodes"][0]["name"] == "教学楼_LOD0");
  CHECK(glb.json["nodes"][0]["extras"]["building"] == "street_1");
  CHECK(glb.json["nodes"][0]["extras"]["given_name"] == "教学楼");
  CHECK(glb.binary.find("教学楼教学楼教学楼") != std::string::npos);  // the table's column
  CHECK(nlohmann::json::parse(encode_lods_json({b}).bytes)["buildings"][0]["given_name"] ==
        "教学楼");
}

TEST_CASE("files appear whole, below their folder, or not at all") {
  const fs::path folder = fs::temp_directory_path() / ("colod_files_" + std::to_string(getpid()));
  write_file(folder.string(), {"a/b.txt", "first"});
  write_file(folder.string(), {"a/b.txt", "second"});
  std::ifstream in(folder / "a/b.txt");
  std::string text;
  in >> text;
  CHECK(text == "second");
  CHECK(std::distance(fs::directory_iterator(folder / "a"), {}) == 1);
  CHECK_THROWS_AS(write_file(folder.string(), {"../x", ""}), Error);
  CHECK_THROWS_WITH(write_file(folder.string(), {"a/b.txt/c", "x"}), Catch::Contains("b.txt"));
  fs::remove_all(folder);
}
