// Whole scenes through the program: footprints in, buildings out, at the source's place.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "place/place.h"
#include "scenes.h"
#include "temporary_folder.h"

using namespace colod;
using test::slurp;
using namespace colod::test;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

struct Run {
  int code;
  std::string log;
};

/// With few voxels: what a scene is taken apart into does not hang on them.
Run build(const TempFolder& folder, const std::string& rest) {
  const std::string log = (folder.path / "log").string();
  const std::string command = std::string(COLOD_BINARY) + " build " + rest + " -o " +
                              (folder.path / "out").string() +
                              " --ns 24 --nr 24 --no-report-html > " + log + " 2>&1";
  const int status = std::system(command.c_str());
  return {WEXITSTATUS(status), slurp(log)};
}

/// Two houses of a row, 8 by 10 m, 6 and 9 m high, that share the wall at x = 20, on level ground
/// in four tiles.
const std::vector<Box> kRow = {Box{{12, 14, 0}, {20, 24, 6}}, Box{{20, 14, 0}, {28, 24, 9}}};

std::string write_row(const TempFolder& folder, const std::string& root_members = "") {
  const Mesh whole = terrain_with_boxes(40, 1, kRow);
  std::string children;
  for (int t = 0; t < 4; ++t) {
    Mesh part;
    part.vertices = whole.vertices;
    for (const Face& f : whole.faces) {
      const Vec3 middle = (whole.vertices[static_cast<std::size_t>(f[0])] +
                           whole.vertices[static_cast<std::size_t>(f[1])] +
                           whole.vertices[static_cast<std::size_t>(f[2])]) /
                          3;
      if ((middle.x() > 17.5 ? 1 : 0) + (middle.y() > 17.5 ? 2 : 0) == t) part.faces.push_back(f);
    }
    const std::string name = "tile" + std::to_string(t) + ".b3dm";
    folder.write(name, b3dm_of(glb_of(y_up(part))));
    children += (t ? "," : "") + tile_of(name);
  }
  return folder.write("tileset.json",
                      tileset_of(tile_of("", root_members + R"(,"children":[)" + children + "]")));
}

std::string square(double x, double y, double w, double h) {
  const auto point = [](double a, double b) {
    return "[" + std::to_string(a) + "," + std::to_string(b) + "]";
  };
  return point(x, y) + "," + point(x + w, y) + "," + point(x + w, y + h) + "," + point(x, y + h) +
         "," + point(x, y);
}

std::string plan(const std::vector<std::pair<std::string, std::string>>& rings) {
  std::string out = R"({"type":"FeatureCollection","features":[)";
  for (std::size_t i = 0; i < rings.size(); ++i)
    out += (i ? "," : "") + std::string(R"({"type":"Feature","properties":{"id":")") +
           rings[i].first + R"(","use":"flats"},"geometry":{"type":"Polygon","coordinates":[[)" +
           rings[i].second + "]]}}";
  return out + "]}";
}

const std::string kPlan = plan({{"left", square(12, 14, 8, 10)}, {"right", square(20, 14, 8, 10)}});

Json report(const TempFolder& folder) {
  return Json::parse(slurp(folder.path / "out" / "report.json"));
}

}  // namespace

TEST_CASE("each house of a row is a building of its own, closed, in its own volume") {
  const TempFolder folder;
  write_row(folder);
  const std::string plans = folder.write("plan.geojson", kPlan);
  const Run run = build(folder, folder.path.string() + " --footprints " + plans);
  INFO(run.log);
  CHECK(run.code == 0);
  CHECK_THAT(run.log, Contains("taken for a scene") && Contains("4 tiles"));
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
  const Run empty = build(folder, folder.path.string() + " --footprints " + plans);
  CHECK(empty.code == 3);
  CHECK_THAT(empty.log, Contains("holds no polygon"));
  // Degrees: 1 m is 1 / 111,170 of latitude and 1 / 75,340 of longitude here.
  const auto degrees = [](double x, double y) {
    char text[80];
    std::snprintf(text, sizeof text, "[%.10f,%.10f]", 8.5 + x / 75342.0, 47.5 + y / 111177.0);
    return std::string(text);
  };
  const std::string ring = degrees(12, 14) + "," + degrees(28, 14) + "," + degrees(28, 24) + "," +
                           degrees(12, 24) + "," + degrees(12, 14);
  const std::string good = folder.write("good.geojson", plan({{"row", ring}}));
  const Run run = build(folder, folder.path.string() + " --footprints " + good);
  INFO(run.log);
  CHECK(run.code == 0);
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
  const Run none = build(folder, folder.path.string() + " --footprints " + far);
  CHECK(none.code == 3);
  CHECK_THAT(none.log,
             Contains("none of 1 footprints lies on the scene") && Contains("nowhere on Earth"));
  std::filesystem::remove(folder.path / "tile3.b3dm");
  const std::string some = folder.write("some.geojson", plan({{"left", square(12, 14, 8, 10)},
                                                              {"gap", square(30, 30, 8, 8)},
                                                              {"away", square(500, 500, 9, 9)}}));
  const Run run = build(folder, folder.path.string() + " --footprints " + some);
  INFO(run.log);
  CHECK(run.code == 1);
  CHECK_THAT(run.log, Contains("'tile3.b3dm' is missing") && Contains("1 of 3 footprints") &&
                          Contains("gap: no surface of the scene"));
  CHECK(report(folder)["buildings"].size() == 2);
}

TEST_CASE("what goes not together is told before the work") {
  const TempFolder folder;
  write_row(folder);
  const std::string plans = folder.write("plan.geojson", kPlan);
  const std::string mesh = folder.write("house.obj", obj_text(gable_house(12, 8, 6, 3)));
  const Run single = build(folder, mesh + " --footprints " + plans);
  CHECK(single.code == 2);
  CHECK_THAT(single.log, Contains("--scene scene"));
  const Run two = build(folder, folder.path.string() + " " + mesh + " --footprints " + plans);
  CHECK(two.code == 2);
  CHECK_THAT(two.log, Contains("built alone"));
  const Run id = build(folder, folder.path.string() + " --footprint-id nr --footprints " + plans);
  CHECK(id.code == 2);
  CHECK_THAT(id.log, Contains("'nr' is no attribute") && Contains("id, use"));
}

TEST_CASE("stages make of a scene the files that build makes") {
  const TempFolder folder;
  write_row(folder);
  const std::string plans = folder.write("plan.geojson", kPlan);
  const std::string colod = COLOD_BINARY, f = folder.path.string(), quiet = " > /dev/null 2>&1 && ";
  REQUIRE(build(folder, f + " --context none --footprints " + plans).code == 0);
  const std::string stages = colod + " segment " + f + " --footprints " + plans +
                             " --ns 24 --nr 24 -o " + f + "/s.colod" + quiet + colod + " analyze " +
                             f + "/s.colod" + quiet + colod + " mesh " + f + "/s.colod" + quiet +
                             colod + " export " + f + "/s.colod --no-report-html -o " + f +
                             "/out2 > /dev/null 2>&1";
  REQUIRE(std::system(stages.c_str()) == 0);
  for (const char* file : {"tileset.json", "buildings/left.glb", "buildings/right.glb"}) {
    INFO(file);
    CHECK(slurp(folder.path / "out" / file) == slurp(folder.path / "out2" / file));
  }
}
