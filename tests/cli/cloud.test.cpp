// Airborne clouds of places through the program.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "cloud_files.h"
#include "las_files.h"
#include "place/place.h"
#include "program.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

/// With few voxels: what a scene is taken apart into does not hang on them.
Ended build(const TemporaryFolder& folder, const std::string& rest,
            const std::string& out = "out") {
  return run_colod(folder.path(), "build " + rest + " -o " + (folder / out).string() +
                                      " --ns 24 --nr 24 --no-report-html");
}

Json report(const TemporaryFolder& folder) {
  return Json::parse(slurp(folder / "out" / "report.json"));
}

/// Gabled houses of 10 by 12 m, so many along each side of a gentle slope, 9 points a m².
std::vector<LasPoint> place_of(int houses) {
  std::vector<LasPoint> out;
  for (int i = 0; i < 30 * houses * 3; ++i)
    for (int j = 0; j < 30 * houses * 3; ++j) {
      const double x = (i + 0.4 * std::sin(i * 7 + j)) / 3, y = (j + 0.4 * std::sin(j * 5 + i)) / 3;
      const double u = std::fmod(x, 30) - 15, v = std::fmod(y, 30) - 15;
      const bool is_house = std::abs(u) < 5 && std::abs(v) < 6;
      const double noise = 0.02 * std::sin(i * 13 + j * 29);
      const double z = 0.03 * x + noise + (is_house ? 5 + 0.6 * (5 - std::abs(u)) : 0);
      out.push_back({{x, y, z}, is_house ? 6 : 2});
    }
  return out;
}

std::string write_place(const TemporaryFolder& folder, int houses, int format = 0) {
  const std::string path = (folder / "block.las").string();
  std::ofstream(path, std::ios::binary) << las(place_of(houses), format > 5 ? 4 : 2, format);
  return path;
}

}  // namespace

TEST_CASE("a cloud of several houses is a place, one of a single house with its plot a building") {
  const TemporaryFolder folder;
  const int houses = GENERATE(1, 2, 3);
  const int format = GENERATE(0, 7);  // without and with colours
  const Ended run = build(folder, write_place(folder, houses, format));
  INFO(run.err);
  CHECK(run.exit_code == 0);
  const std::string says = std::to_string(houses * houses) + " buildings stand apart";
  CHECK((run.err.find("taken for a scene, since " + says) != std::string::npos) == (houses > 1));
  const Json buildings = report(folder)["buildings"];
  REQUIRE(buildings.size() == static_cast<std::size_t>(houses) * houses);
  for (const Json& b : buildings) {
    CHECK(b["layers"].back()["watertight"] == true);
    if (houses > 1) CHECK(b["layers"].back()["volume"] == Approx(10 * 12 * 6.5).epsilon(0.15));
  }
  CHECK(std::filesystem::exists(folder / "out" / "footprints.geojson") == (houses > 1));
  CHECK(std::filesystem::exists(folder / "out" / "tiles" / "context") == (houses > 1));
  const std::string check =
      std::string(COLOD_BINARY) + " info --check " + (folder / "out").string() + " > /dev/null";
  CHECK(std::system(check.c_str()) == 0);
}

TEST_CASE("a cloud takes footprints, a place on Earth, and gives the same bytes on more threads") {
  const TemporaryFolder folder;
  const std::string path = write_place(folder, 2);
  const double x = kLasOffset.x() + 10, y = kLasOffset.y() + 9;
  Json ring = Json::array();
  for (const auto& [u, v] : {std::pair{0, 0}, {10, 0}, {10, 12}, {0, 12}, {0, 0}})
    ring.push_back({x + u, y + v});
  const Json plan = {
      {"type", "FeatureCollection"},
      {"crs", {{"type", "name"}, {"properties", {{"name", "urn:ogc:def:crs:EPSG::25832"}}}}},
      {"features",
       {{{"type", "Feature"},
         {"properties", {{"id", "mine"}}},
         {"geometry", {{"type", "Polygon"}, {"coordinates", {ring}}}}}}}};
  std::ofstream(folder / "plan.geojson") << plan.dump();
  const std::string rest =
      path + " --crs EPSG:25832 --footprints " + (folder / "plan.geojson").string();
  std::map<std::string, std::string> files[2];
  for (const int i : {0, 1}) {
    const Ended run = build(folder, rest + " --threads " + (i == 0 ? "1" : "4"));
    INFO(run.err);
    CHECK(run.exit_code == 0);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "out"))
      if (entry.path().extension() == ".glb" || entry.path().filename() == "tileset.json")
        files[i][entry.path().string()] = slurp(entry.path());
  }
  CHECK(files[0] == files[1]);
  const Json all = report(folder)["buildings"];
  REQUIRE(all.size() == 1);
  CHECK(all[0]["name"] == "mine");
  const Json tileset = Json::parse(slurp(folder / "out" / "tileset.json"));
  const auto at = tileset["root"]["transform"].get<std::vector<double>>();
  CHECK(std::hypot(at[12], at[13], at[14]) == Approx(6.37e6).epsilon(0.01));
}

TEST_CASE("what of a cloud cannot work is said in one line, and --scene buildings is believed") {
  const TemporaryFolder folder;
  const std::string path = write_place(folder, 2);
  const Ended one = build(folder, path + " --scene buildings");
  INFO(one.err);
  CHECK(report(folder)["buildings"].size() == 1);
  CHECK(one.err.find("taken for a scene") == std::string::npos);
  std::vector<LasPoint> roofs, bare;
  for (const LasPoint& p : place_of(2)) (p.kind == 6 ? roofs : bare).push_back(p);
  const std::string of_roofs = (folder / "roofs.las").string(),
                    of_ground = (folder / "ground.las").string();
  std::ofstream(of_roofs, std::ios::binary) << las(roofs, 2, 0);
  std::ofstream(of_ground, std::ios::binary) << las(bare, 2, 0);
  const Ended no_ground = build(folder, of_roofs + " --scene scene", "a");
  CHECK(no_ground.exit_code == 3);
  CHECK_THAT(no_ground.err, Contains("no ground that they stand on: --scene buildings"));
  const Ended no_building = build(folder, of_ground + " --scene scene", "b");
  CHECK(no_building.exit_code == 3);
  CHECK_THAT(no_building.err, Contains("no building was found on it"));
}

namespace {

/// Flat-roofed houses on level ground, 9 points a m²; each from (x, y), 10 by 12 m.
std::vector<LasPoint> place_with(double width, double depth,
                                 const std::vector<std::pair<double, double>>& houses) {
  std::vector<LasPoint> out;
  for (int i = 0; i < 3 * width; ++i)
    for (int j = 0; j < 3 * depth; ++j) {
      const double x = (i + 0.4 * std::sin(i * 7 + j)) / 3, y = (j + 0.4 * std::sin(j * 5 + i)) / 3;
      bool is_house = false;
      for (const auto& [u, v] : houses) is_house |= x > u && x < u + 10 && y > v && y < v + 12;
      const double noise = 0.02 * std::sin(i * 13 + j * 29);
      out.push_back({{x, y, noise + (is_house ? 6 : 0)}, is_house ? 6 : 2});
    }
  return out;
}

}  // namespace

TEST_CASE("two houses on a cut block are a place, one on a wide block is a word's worth") {
  const TemporaryFolder folder;
  const double width = GENERATE(55, 90);
  const bool has_two = GENERATE(true, false);
  CAPTURE(width, has_two);
  std::vector<std::pair<double, double>> houses = {{8, 20}};
  if (has_two) houses.push_back({width - 20, 20});
  const std::string path = (folder / "block.las").string();
  std::ofstream(path, std::ios::binary) << las(place_with(width, 55, houses), 2, 0);
  const Ended run = build(folder, path);
  INFO(run.err);
  CHECK(run.exit_code == (has_two ? 0 : 1));  // one flat roof without its ground is a plate
  CHECK((run.err.find("or are thin sheets") != std::string::npos) == !has_two);
  CHECK(report(folder)["buildings"].size() == houses.size());
  CHECK((run.err.find("taken for a scene, since 2 buildings") != std::string::npos) == has_two);
  CHECK((run.err.find("it is taken for one building: --scene scene takes it apart") !=
         std::string::npos) == !has_two);
}

TEST_CASE("of several clouds one that is a place is told of") {
  const TemporaryFolder folder;
  const std::string path = write_place(folder, 2);
  const std::string house = (folder / "house.las").string();
  std::ofstream(house, std::ios::binary) << las(place_of(1), 2, 0);
  const Ended run = build(folder, path + " " + house);
  INFO(run.err);
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.err, Contains("block.las: looks like a scene: 4 buildings"));
  CHECK(report(folder)["buildings"].size() == 2);
}

namespace {

/// Metres between where the tileset has the first building's origin and where the system puts it.
double off_by(const TemporaryFolder& folder, const std::string& crs) {
  const Json tileset = Json::parse(slurp(folder / "out" / "tileset.json"));
  const Json& shift = tileset["asset"]["extras"]["offset"];
  const Json origin = report(folder)["buildings"][0]["origin"];
  Eigen::Matrix4d root;
  for (int i = 0; i < 16; ++i) root(i) = tileset["root"]["transform"][static_cast<std::size_t>(i)];
  Vec3 local, at;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    at[k] = origin[i];
    local[k] = at[k] - shift[i].get<double>();
  }
  const Vec3 there = (root * local.homogeneous()).head<3>();
  return (there - place_on_earth({crs, Vec3::Zero(), "test"}, at).to_ecef(at)).norm();
}

/// The same place in feet, by its offset and by each point.
std::string in_feet(std::vector<LasPoint> points) {
  constexpr double kFoot = 0.3048;
  for (LasPoint& p : points) p.at /= kFoot;
  std::string bytes = las(points, 2, 0);
  for (int k = 0; k < 3; ++k)
    set_at(bytes, 155 + 8 * static_cast<std::size_t>(k), kLasOffset[k] / kFoot);
  return bytes;
}

}  // namespace

TEST_CASE("a cloud's own system places its tileset, to a centimetre; an option wins and is told") {
  const TemporaryFolder folder;
  const std::string path = (folder / "block.las").string();
  const bool is_feet = GENERATE(false, true);
  const LasRecord keys = geokeys({{3072, 32632}, {3076, is_feet ? 9002 : 9001}});
  std::ofstream(path, std::ios::binary)
      << with_records(is_feet ? in_feet(place_of(2)) : las(place_of(2), 2, 0), {keys});
  const Ended own = build(folder, path);
  INFO(own.err);
  CHECK(own.exit_code == 0);
  CHECK_THAT(own.err, Contains("placed on Earth: WGS 84 / UTM zone 32N, from " + path));
  CHECK((own.err.find("read in foot") != std::string::npos) == is_feet);
  CHECK(off_by(folder, "EPSG:32632") < 0.01);
  CHECK(report(folder)["buildings"].size() == 4);
  CHECK(report(folder)["buildings"][0]["layers"].back()["volume"] ==
        Approx(10 * 12 * 6.5).epsilon(0.15));
  const std::string tileset = slurp(folder / "out" / "tileset.json");
  const Ended same = build(folder, path + " --crs EPSG:32632");
  CHECK(same.err.find("m away from where") == std::string::npos);
  CHECK(slurp(folder / "out" / "tileset.json") == tileset);
  const Ended other = build(folder, path + " --crs EPSG:32633");
  INFO(other.err);
  CHECK(other.exit_code == 0);
  CHECK_THAT(other.err, Contains("--crs is taken, which puts it") && Contains(path));
  CHECK(off_by(folder, "EPSG:32633") < 0.01);
}

TEST_CASE("a cloud whose own system is of no use stays local, with one warning") {
  const TemporaryFolder folder;
  const std::string path = (folder / "block.las").string();
  const auto [record, says] = GENERATE(
      table<LasRecord, std::string>({{geokeys({{3072, 29999}}), "EPSG:29999"},
                                     {geokeys({{1024, 2}, {2048, 4326}}), "is in degrees"}}));
  std::ofstream(path, std::ios::binary) << las(place_of(2), 2, 0);
  REQUIRE(build(folder, path).exit_code == 0);
  const std::string tileset = slurp(folder / "out" / "tileset.json");
  std::ofstream(path, std::ios::binary) << with_records(las(place_of(2), 2, 0), {record});
  const Ended run = build(folder, path);
  INFO(run.err);
  CHECK(run.exit_code == 0);
  const std::size_t at = run.err.find(says);
  CHECK(at != std::string::npos);
  CHECK(run.err.find(says, at + 1) == std::string::npos);
  CHECK_THAT(run.err, Contains("the tileset stays local: use --crs and --origin"));
  CHECK(slurp(folder / "out" / "tileset.json") == tileset);
}

TEST_CASE("a place is the same footprints and buildings from LAS, PLY and tables of points") {
  const TemporaryFolder folder;
  const bool has_kinds = GENERATE(true, false);
  CAPTURE(has_kinds);
  auto points = place_of(2);
  if (!has_kinds)
    for (LasPoint& p : points) p.kind = 1;
  const auto built = [&](const std::string& name, const std::string& bytes) {
    const std::string path = (folder / name).string();
    std::ofstream(path, std::ios::binary) << bytes;
    const Ended run = build(folder, path + " --context none");
    INFO(run.err);
    CHECK(run.exit_code == 0);
    CHECK_THAT(run.err, Contains("taken for a scene, since 4 buildings stand apart"));
    CHECK((run.err.find("the ground is found by its shape") == std::string::npos) == has_kinds);
    return slurp(folder / "out" / "footprints.geojson");
  };
  const std::string expected = built("block.las", las(points, 2, 0));
  const PlyCoding coding = has_kinds ? PlyCoding::kText : PlyCoding::kBig;
  CHECK(built("points.ply", ply_of(points, coding, has_kinds)) == expected);
  CHECK(built("rows.xyz", table_of(points, has_kinds, has_kinds ? "x y z class" : "")) == expected);
  if (has_kinds) return;
  const std::string single = (folder / "single.ply").string();  // half a metre coarse at 5,330 km
  std::ofstream(single, std::ios::binary) << ply_of(points, PlyCoding::kLittle, false, "float");
  const Ended run = build(folder, single + " --scene scene --context none");
  CHECK_THAT(run.err, Contains("single.ply: its coordinates are of single precision"));
}

TEST_CASE("a cloud of one house in other formats is a building, and told of where it may be none") {
  const TemporaryFolder folder;
  const std::string path = (folder / "house.xyz").string();
  std::ofstream(path) << table_of(place_of(1), false);
  const Ended house = build(folder, path);
  INFO(house.err);
  CHECK(house.exit_code == 1);  // nothing tells its plot from it, which is told
  CHECK_THAT(house.err, Contains("--scene scene takes a file for a place"));
  CHECK(house.err.find("taken for a scene") == std::string::npos);
  const std::string block = (folder / "block.ply").string();
  std::ofstream(block, std::ios::binary) << ply_of(place_of(2), PlyCoding::kBig, false);
  const Ended two = build(folder, path + " " + block);
  INFO(two.err);
  CHECK(two.exit_code == 1);
  CHECK_THAT(two.err, Contains("block.ply: looks like a scene: 4 buildings"));
  std::ofstream(path) << "11.5001 48.1 5\n11.5002 48.1 5\n11.5003 48.1001 6\n11.5 48.1 7\n";
  const Ended degrees = build(folder, path + " --scene scene");
  CHECK(degrees.exit_code == 3);
  CHECK_THAT(degrees.err, Contains("coordinates in degrees must be projected first"));
}

TEST_CASE("info tells where on Earth a cloud says that it is, and why it cannot") {
  const TemporaryFolder folder;
  std::vector<LasPoint> points;
  for (int i = 0; i < 20; ++i)
    points.push_back({{500000.0 + i, 5500000.0 + i % 5, 300.0 + i % 3}, 1});
  const auto info = [&](const std::vector<LasRecord>& records) {
    std::ofstream(folder / "cloud.las", std::ios::binary)
        << with_records(las(points, 2, 0), records);
    const Ended run = run_colod(folder.path(), "info cloud.las");
    INFO(run.err);
    REQUIRE(run.exit_code == 0);
    return Json::parse(run.out);
  };
  const Json told = info({geokeys({{1024, 1}, {3072, 32632}})});
  CHECK(told["place"]["crs"] == "EPSG:32632");
  CHECK_THAT(told["place"]["name"].get<std::string>(), Contains("UTM zone 32N"));
  CHECK_THAT(told["place"]["said_by"].get<std::string>(), Contains("cloud.las"));
  const auto says = [](const Json& json, const std::string& word) {
    for (const Json& warning : json["warnings"])
      if (warning.get<std::string>().find(word) != std::string::npos) return true;
    return false;
  };
  CHECK(!says(told, "degrees"));
  const Json degrees = info({geokeys({{1024, 2}, {2048, 4326}})});
  CHECK(degrees["place"].is_null());
  CHECK(says(degrees, "degrees"));
  const Json nowhere = info({});
  CHECK(nowhere["place"].is_null());
  CHECK(!says(nowhere, "degrees"));
}
