// Whole scenes through the program: footprints in, buildings out, at the source's place.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "place/place.h"
#include "program.h"
#include "row_scene.h"
#include "scenes.h"

using namespace colod;
using test::slurp;
using namespace colod::test;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

/// With few voxels: what a scene is taken apart into does not hang on them.
Ended build(const TempFolder& folder, const std::string& rest) {
  return run_colod(folder.path, "build " + rest + " -o " + (folder.path / "out").string() +
                                    " --ns 24 --nr 24 --no-report-html");
}

Json report(const TempFolder& folder) {
  return Json::parse(slurp(folder.path / "out" / "report.json"));
}

}  // namespace

TEST_CASE("each house of a row is a building of its own, closed, in its own volume") {
  const TempFolder folder;
  write_row(folder);
  const std::string plans = folder.write("plan.geojson", kPlan);
  const Ended run = build(folder, folder.path.string() + " --footprints " + plans);
  INFO(run.err);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.err, Contains("taken for a scene") && Contains("4 tiles"));
  const Json buildings = report(folder)["buildings"];
  REQUIRE(buildings.size() == 2);
  const double volumes[] = {8 * 10 * 6, 8 * 10 * 9};
  for (int i = 0; i < 2; ++i) {
    const Json& b = buildings[static_cast<std::size_t>(i)];
    INFO(b.dump(1));
    CHECK(b["name"] == (i ? "right" : "left"));
    CHECK(b["attributes"]["use"] == "flats");
    const Json& finest = b["layers"].back();
    CHECK(finest["watertight"] == true);
    CHECK(finest["volume"].get<double>() == Approx(volumes[i]).epsilon(0.08));
  }
  const std::string tiles = slurp(folder.path / "out" / "buildings" / "left.glb");
  CHECK(tiles.find("\"use\"") != std::string::npos);  // a column of the property table
}

TEST_CASE("a scene in Earth-centred coordinates ends at its place again") {
  const TempFolder folder;
  const Georeference place{"ENU:47.5,8.5,400", Vec3::Zero(), "test"};
  const Eigen::Matrix4d to_ecef = local_from_ecef(place).inverse();
  std::string transform = R"(,"transform":[)";
  for (int i = 0; i < 16; ++i) {
    char text[40];
    std::snprintf(text, sizeof text, "%s%.17g", i ? "," : "", to_ecef(i));
    transform += text;
  }
  write_row(folder, transform + "]");
  const std::string plans = folder.write("plan.geojson", R"({"type":"FeatureCollection",
    "crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32632"}},"features":[)" +
                                                             std::string("]}"));
  const Ended empty = build(folder, folder.path.string() + " --footprints " + plans);
  CHECK(empty.exit_code == 3);
  CHECK_THAT(empty.err, Contains("holds no polygon"));
  // Degrees: 1 m is 1 / 111,170 of latitude and 1 / 75,340 of longitude here.
  const auto degrees = [](double x, double y) {
    char text[80];
    std::snprintf(text, sizeof text, "[%.10f,%.10f]", 8.5 + x / 75342.0, 47.5 + y / 111177.0);
    return std::string(text);
  };
  const std::string ring = degrees(12, 14) + "," + degrees(28, 14) + "," + degrees(28, 24) + "," +
                           degrees(12, 24) + "," + degrees(12, 14);
  const std::string good = folder.write("good.geojson", plan({{"row", ring}}));
  const Ended run = build(folder, folder.path.string() + " --footprints " + good);
  INFO(run.err);
  CHECK(run.exit_code == 0);
  const Json tileset = Json::parse(slurp(folder.path / "out" / "tileset.json"));
  Eigen::Matrix4d root;
  for (int i = 0; i < 16; ++i) root(i) = tileset["root"]["transform"][static_cast<std::size_t>(i)];
  const Json offset = tileset["asset"]["extras"]["offset"];
  const Json b = report(folder)["buildings"][0];
  Box box;  // of the finest mesh, in the result's frame
  for (int k = 0; k < 3; ++k) CHECK(b["origin"][static_cast<std::size_t>(k)].is_number());
  const Vec3 origin(b["origin"][0], b["origin"][1], b["origin"][2]);
  const Vec3 shift(offset[0], offset[1], offset[2]);
  const Vec3 there = (root * Vec3(origin - shift).homogeneous()).head<3>();
  const Vec3 middle = place_on_earth(place, Vec3::Zero()).to_ecef({20, 19, 0});
  CHECK((there - middle).norm() < 0.5);  // the frame's origin is at the box's middle
  const Vec3 back = (local_from_ecef(place) * there.homogeneous()).head<3>();
  CHECK(std::abs(back.z()) < 0.01);
}

TEST_CASE("footprints that meet no surface say so and cost themselves only") {
  const TempFolder folder;
  write_row(folder);
  const std::string far = folder.write("far.geojson", plan({{"a", square(500, 500, 9, 9)}}));
  const Ended none = build(folder, folder.path.string() + " --footprints " + far);
  CHECK(none.exit_code == 3);
  CHECK_THAT(none.err,
             Contains("none of 1 footprints lies on the scene") && Contains("nowhere on Earth"));
  std::filesystem::remove(folder.path / "tile3.b3dm");
  const std::string some = folder.write("some.geojson", plan({{"left", square(12, 14, 8, 10)},
                                                              {"gap", square(30, 30, 8, 8)},
                                                              {"wide", square(12, 14, 5e6, 10)},
                                                              {"away", square(500, 500, 9, 9)}}));
  const Ended run = build(folder, folder.path.string() + " --footprints " + some);
  INFO(run.err);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.err, Contains("'tile3.b3dm' is missing") && Contains("1 of 4 footprints") &&
                          Contains("'wide' reaches more than a kilometre") &&
                          Contains("gap: no surface of the scene"));
  CHECK(report(folder)["buildings"].size() == 2);
}

TEST_CASE("a tile that a wrong vertex or transform takes out of the world costs itself only") {
  const TempFolder folder;
  const double far = GENERATE(3e6, -4e8, 3e12);
  const bool is_vertex = far < 1e9 && GENERATE(true, false);
  CAPTURE(far, is_vertex);
  Mesh mesh = terrain_with_boxes(10, 1, {});
  if (is_vertex) mesh.vertices[0].x() = far;
  folder.write("stray.b3dm", b3dm_of(glb_of(y_up(mesh))));
  const std::string moved =
      R"(,"transform":[1,0,0,0,0,1,0,0,0,0,1,0,)" + std::to_string(far) + ",0,0,1]";
  write_row(folder, "", {}, "," + tile_of("stray.b3dm", is_vertex ? "" : moved));
  const std::string plans = folder.write("plan.geojson", kPlan);
  const Ended run = build(folder, folder.path.string() + " --footprints " + plans);
  INFO(run.err);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.err, Contains("stray.b3dm: "));
  CHECK_THAT(run.err, Contains(far < 1e9 ? "km: a transform or a vertex of it is wrong"
                                         : "200 faces left out: a coordinate is not finite"));
  for (const Json& b : report(folder)["buildings"]) CHECK(b["layers"][0]["watertight"] == true);
}

TEST_CASE("what goes not together is told before the work") {
  const TempFolder folder;
  write_row(folder);
  const std::string plans = folder.write("plan.geojson", kPlan);
  const std::string mesh = folder.write("house.obj", obj_text(gable_house(12, 8, 6, 3)));
  const Ended single = build(folder, mesh + " --footprints " + plans);
  CHECK(single.exit_code == 2);
  CHECK_THAT(single.err, Contains("--scene scene"));
  const Ended two = build(folder, folder.path.string() + " " + mesh + " --footprints " + plans);
  CHECK(two.exit_code == 2);
  CHECK_THAT(two.err, Contains("built alone"));
  const Ended id = build(folder, folder.path.string() + " --footprint-id nr --footprints " + plans);
  CHECK(id.exit_code == 2);
  CHECK_THAT(id.err, Contains("'nr' is no attribute") && Contains("id, use"));
}

TEST_CASE("a coarse tile that is broken or missing is told of once, and costs only itself") {
  const TempFolder folder;
  const std::size_t broken = GENERATE(1, 3);
  std::vector<std::string> coarse = {"whole.b3dm"};
  folder.write("whole.b3dm", b3dm_of(glb_of(y_up(terrain_with_boxes(40, 4, kRow)))));
  for (std::size_t i = 0; i < broken; ++i) {
    coarse.push_back("broken" + std::to_string(i) + ".b3dm");
    folder.write(coarse.back(), "b3dm, but not for long");
  }
  coarse.push_back("missing.b3dm");
  write_row(folder, "", coarse);
  const std::string plans = folder.write("plan.geojson", kPlan);
  const Ended run = build(folder, folder.path.string() + " --footprints " + plans);
  INFO(run.err);
  CHECK(run.exit_code == 0);  // nothing of the place is lost
  for (std::size_t i = 1; i < coarse.size(); ++i) {
    const std::size_t first = run.err.find(coarse[i]);
    REQUIRE(first != std::string::npos);
    CHECK(run.err.find(coarse[i], first + 1) == std::string::npos);
    CHECK(report(folder)["warnings"].dump().find(coarse[i]) != std::string::npos);
  }
  CHECK(run.err.find("whole.b3dm") == std::string::npos);
}

TEST_CASE("an image that is lost beside the buildings is told of and makes the exit code 1") {
  const TempFolder folder;
  const std::string plans = folder.write("plan.geojson", kPlan);
  folder.write("wall.jpg", "no image");
  const Mesh whole = terrain_with_boxes(40, 1, kRow);
  std::string text = "mtllib scene.mtl\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl wall\n";
  for (const Vec3& p : whole.vertices)
    text += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
            std::to_string(p.z()) + "\n";
  for (const Face& f : whole.faces) {
    text += "f";
    for (int k = 0; k < 3; ++k)
      text +=
          " " + std::to_string(f[static_cast<std::size_t>(k)] + 1) + "/" + std::to_string(k + 1);
    text += "\n";
  }
  folder.write("scene.mtl", "newmtl wall\nmap_Kd wall.jpg\n");
  const std::string scene = folder.write("scene.obj", text);
  const Ended run = build(folder, scene + " --scene scene --footprints " + plans);
  INFO(run.err);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.err, Contains("wall.jpg") && Contains("its look is lost beside the buildings"));
  CHECK_THAT(run.err, Contains("2 of 2 buildings") && Contains("inputs have 1 failures"));
  CHECK(report(folder)["failures"].size() == 1);
}

TEST_CASE("of a tileset's coarser level what is finer is left out of the context, too") {
  const TempFolder folder;
  folder.write("whole.b3dm", b3dm_of(glb_of(y_up(terrain_with_boxes(40, 2, kRow)))));
  write_row(folder, "", {"whole.b3dm"});
  const std::string plans = folder.write("plan.geojson", kPlan);
  for (const int level : {0, 1}) {
    const Ended run = build(folder, folder.path.string() + " --source-level " +
                                        std::to_string(level) + " --footprints " + plans);
    INFO(run.err);
    CHECK(run.exit_code == 0);
    std::size_t tiles = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(folder.path / "out" / "tiles" / "context"))
      tiles += entry.is_regular_file();
    // The five of the source, in which the ground below the houses is; or the coarse one and one
    // above it, since nothing coarser stands in the source.
    CHECK(tiles == (level == 0 ? 5 : 2));
    std::filesystem::remove_all(folder.path / "out");
  }
}

namespace {

/// Level ground of `side` metres with the row, as an OBJ tile each 20 m.
void write_tiles(const TempFolder& folder, int side) {
  const Mesh whole = terrain_with_boxes(side, 1, kRow);
  std::map<std::pair<int, int>, Mesh> tiles;
  for (const Face& f : whole.faces) {
    Vec3 middle = Vec3::Zero();
    for (const int v : f) middle += whole.vertices[static_cast<std::size_t>(v)] / 3;
    Mesh& tile = tiles[{static_cast<int>(middle.x() / 20), static_cast<int>(middle.y() / 20)}];
    tile.vertices = whole.vertices;
    tile.faces.push_back(f);
  }
  for (const auto& [at, tile] : tiles) {
    const std::string name = "Tile_" + std::to_string(at.first) + "_" + std::to_string(at.second);
    std::filesystem::create_directories(folder.path / "Data" / name);
    folder.write("Data/" + name + "/" + name + ".obj", obj_text(tile));
  }
}

/// Errors fall from each tile to its children; returns how many tiles show something.
int count_tiles(const Json& tile, double above) {
  CHECK(tile["geometricError"].get<double>() < above);
  int count = tile.contains("content") &&
              tile["content"]["uri"].get<std::string>().starts_with("tiles/context/");
  if (tile.contains("children"))
    for (const Json& child : tile["children"]) count += count_tiles(child, tile["geometricError"]);
  return count;
}

int context_tiles(const TempFolder& folder) {
  return count_tiles(Json::parse(slurp(folder.path / "out" / "tileset.json"))["root"], 1e9);
}

}  // namespace

TEST_CASE("a folder of tiles gets coarser ones of its own, in one chain") {
  const TempFolder folder;
  const int side = GENERATE(40, 60, 100);
  write_tiles(folder, side);
  const std::string plans = folder.write("plan.geojson", kPlan);
  const Ended run = build(folder, folder.path.string() + " --footprints " + plans);
  INFO(run.err);
  CHECK(run.exit_code == 0);
  const int tiles = side / 20;
  CHECK(context_tiles(folder) > tiles * tiles);
  const std::string check = std::string(COLOD_BINARY) + " info --check " +
                            (folder.path / "out").string() + " > /dev/null 2>&1";
  CHECK(std::system(check.c_str()) == 0);
}

TEST_CASE("of a scene its ground alone, in the same bytes with one thread and with several") {
  const TempFolder folder;
  write_tiles(folder, 60);
  const std::string plans = folder.write("plan.geojson", kPlan);
  const std::string rest = folder.path.string() + " --context ground --footprints " + plans;
  std::map<std::string, std::string> files[2];
  for (const int i : {0, 1}) {
    const Ended run = build(folder, rest + " --threads " + (i == 0 ? "1" : "4"));
    INFO(run.err);
    CHECK(run.exit_code == 0);
    CHECK(context_tiles(folder) >= 2);
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(folder.path / "out" / "tiles"))
      if (entry.is_regular_file()) files[i][entry.path().string()] = slurp(entry.path());
    std::filesystem::remove_all(folder.path / "out");
  }
  CHECK(files[0] == files[1]);
}

namespace {

/// As what was measured: nothing quite level or upright.
Mesh measured_place(const std::vector<Box>& houses) {
  Mesh place = terrain_with_boxes(70, 1, houses);
  for (Vec3& p : place.vertices)
    p += Vec3(0.01 * p.z(), 0.013 * p.z(), 0.02 * p.x() + 0.1 * std::sin(p.y() / 5));
  return place;
}

std::vector<Box> row_and_two() {
  std::vector<Box> houses = kRow;
  houses.push_back({{45, 14, 0}, {55, 24, 6}});
  houses.push_back({{45, 45, 0}, {55, 55, 7}});
  return houses;
}

}  // namespace

TEST_CASE("a place that is given as one mesh is taken apart, and one house on its plot is not") {
  const TempFolder folder;
  const bool is_place = GENERATE(true, false);
  const Mesh place = measured_place(is_place ? row_and_two() : kRow);
  const std::string mesh = folder.write("place.obj", obj_text(place));
  const Ended run = build(folder, mesh);
  INFO(run.err);
  CHECK((run.err.find("taken for a scene, since 3 buildings stand apart") != std::string::npos) ==
        is_place);
  CHECK(run.exit_code == 0);
  CHECK(report(folder)["buildings"].size() == (is_place ? 4 : 1));  // the row has two heights
  CHECK((context_tiles(folder) > 0) == is_place);
  const Ended told = build(folder, mesh + " --scene buildings");
  INFO(told.err);
  CHECK(told.err.find("scene, since") == std::string::npos);
  CHECK(report(folder)["buildings"].size() == 1);
}

TEST_CASE("a folder with one file is that file: a place, whatever else lies beside it") {
  const TempFolder folder;
  std::filesystem::create_directory(folder.path / "in");
  const bool is_place = GENERATE(true, false);
  folder.write("in/place.obj", obj_text(measured_place(is_place ? row_and_two() : kRow)));
  folder.write("in/readme.md", "nothing");
  const Ended run = build(folder, (folder.path / "in").string());
  INFO(run.err);
  CHECK(run.exit_code == 0);
  CHECK((run.err.find("taken for a scene, since 3 buildings stand apart") != std::string::npos) ==
        is_place);
  CHECK(report(folder)["buildings"].size() == (is_place ? 4 : 1));
}

TEST_CASE("of several meshes one that is a place is told of, and built as one building") {
  const TempFolder folder;
  const std::string mesh = folder.write("place.obj", obj_text(measured_place(row_and_two())));
  const std::string house = folder.write("house.obj", obj_text(gable_house(12, 8, 6, 3)));
  const Ended run = build(folder, mesh + " " + house);
  INFO(run.err);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.err, Contains("looks like a scene: 3 buildings"));
  CHECK(report(folder)["buildings"].size() == 2);
}

TEST_CASE("a tile of a place that is given as a mesh is told of, and terrain without a building") {
  const TempFolder folder;
  const std::string kind = GENERATE("cut", "bare", "whole", "on its side", "b3dm");
  INFO(kind);
  std::vector<Box> houses = {{{-5, 20, 0}, {12, 34, 6}}, {{40, 30, 0}, {52, 44, 7}}};
  houses.erase(kind == "cut" ? houses.begin() + 1 : houses.begin());
  if (kind == "bare" || kind == "on its side") houses.clear();
  const Mesh place = measured_place(houses);
  std::string mesh, says = "its border cuts through buildings";
  if (kind == "bare" || kind == "on its side") says = "looks like a piece of terrain";
  if (kind == "b3dm") {
    mesh = folder.write("place.b3dm", b3dm_of(glb_of(y_up(place))));
    says = "is a tile of a scene by its format";
  } else {
    mesh = kind == "on its side" ? folder.write("place.glb", glb_of(place))
                                 : folder.write("place.obj", obj_text(place));
  }
  const Ended run = build(folder, mesh);
  INFO(run.err);
  const bool is_told = kind != "whole";
  CHECK((run.err.find(says) != std::string::npos) == is_told);
  CHECK((run.exit_code != 0) == is_told);
  CHECK((run.err.find("looks z up") != std::string::npos) == (kind == "on its side"));
}
