// Outlines from maps, good and bad ones.
#include "place/footprints.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "core/error.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;

namespace {

std::string feature(const std::string& ring, const std::string& properties = "{}") {
  return R"({"type":"Feature","properties":)" + properties +
         R"(,"geometry":{"type":"Polygon","coordinates":[[)" + ring + "]]}}";
}

std::string collection(const std::string& features, const std::string& crs = "") {
  return R"({"type":"FeatureCollection")" +
         (crs.empty() ? "" : R"(,"crs":{"type":"name","properties":{"name":")" + crs + R"("}})") +
         R"(,"features":[)" + features + "]}";
}

Footprints read(const std::string& text, const std::string& id = "",
                const std::optional<Georeference>& scene = {}) {
  const TemporaryFolder folder;
  const std::string path = (folder / "plan.geojson").string();
  std::ofstream(path) << text;
  return read_footprints(path, id, scene);
}

const std::string kSquare = "[0,0],[10,0],[10,10],[0,10],[0,0]";
constexpr double kDegree = 111319.49;  // metres of longitude on the equator, WGS 84

}  // namespace

TEST_CASE("a scene that is nowhere has footprints in its own metres, whatever the file says") {
  const Footprints f = read(collection(feature(kSquare, R"({"id":"a","floors":3,"none":null})")));
  REQUIRE(f.all.size() == 1);
  CHECK(f.all[0].id == "a");
  REQUIRE(f.all[0].parts.size() == 1);
  CHECK(f.all[0].parts[0][0].size() == 4);
  REQUIRE(f.all[0].attributes.size() == 2);
  CHECK(f.all[0].attributes[1].first == "floors");
  CHECK(f.all[0].attributes[1].second == "3");
}

TEST_CASE("degrees and projected metres come to one place on Earth") {
  const Georeference scene{"ENU:0,15,0", Vec3::Zero(), "test"};
  const std::string ring = "[15,0],[15.001,0],[15.001,0.001],[15,0.001],[15,0]";
  const Footprints degrees = read(collection(feature(ring)), "", scene);
  REQUIRE(degrees.all.size() == 1);
  double widest = 0;
  for (const Vec2& p : degrees.all[0].parts[0][0]) widest = std::max(widest, p.x());
  CHECK(widest == Approx(0.001 * kDegree).margin(0.01));
  // UTM 33N: the central meridian is 15 degrees east, scale 0.9996.
  const std::string metres = "[500000,0],[500100,0],[500100,100],[500000,100],[500000,0]";
  const Footprints utm =
      read(collection(feature(metres), "urn:ogc:def:crs:EPSG::32633"), "", scene);
  REQUIRE(utm.all.size() == 1);
  widest = 0;
  for (const Vec2& p : utm.all[0].parts[0][0]) widest = std::max(widest, p.x());
  CHECK(widest == Approx(100 / 0.9996).margin(0.01));
  CHECK(utm.crs.find("33N") != std::string::npos);
}

TEST_CASE("a projected scene takes its offset off") {
  const Georeference scene{"EPSG:32633", {500000, 0, 0}, "test"};
  const Footprints f = read(collection(feature("[500010,5],[500020,5],[500020,15],[500010,5]"),
                                       "urn:ogc:def:crs:EPSG::32633"),
                            "", scene);
  REQUIRE(f.all.size() == 1);
  Vec2 least = Vec2::Constant(INFINITY);
  for (const Vec2& p : f.all[0].parts[0][0]) least = least.cwiseMin(p);
  CHECK((least - Vec2(10, 5)).norm() < 1e-6);
}

TEST_CASE("the id is an attribute, and an unknown one is told with those that there are") {
  const std::string text = collection(feature(kSquare, R"({"id":"a","nr":"B 7"})"));
  CHECK(read(text, "nr").all.at(0).id == "B 7");
  CHECK_THROWS_WITH(read(text, "number"), Contains("'number'") && Contains("id, nr"));
  CHECK(read(collection(feature(kSquare))).all.at(0).id == "footprint-0");
}

TEST_CASE("equal ids become different, with a warning") {
  const std::string one = feature(kSquare, R"({"id":"a"})");
  const Footprints f = read(collection(one + "," + one + "," + one));
  REQUIRE(f.all.size() == 3);
  CHECK(f.all[1].id == "a_2");
  CHECK(f.all[2].id == "a_3");
  REQUIRE(f.warnings.size() == 1);
  CHECK_THAT(f.warnings[0], Contains("2 footprints have an id that others have"));
}

TEST_CASE("a polygon that crosses itself is mended, a slip of the pen is left out") {
  const Footprints f = read(collection(feature("[0,0],[10,10],[10,0],[0,10],[0,0]") + "," +
                                       feature("[0,0],[0.1,0],[0.1,0.1],[0,0]") + "," +
                                       feature("[0,0],[10,0],[20,0],[0,0]")));
  REQUIRE(f.all.size() == 1);
  CHECK(f.all[0].parts.size() == 2);  // two triangles that meet
  REQUIRE(f.warnings.size() == 1);
  CHECK_THAT(f.warnings[0], Contains("cross themselves"));
  CHECK(f.problems.size() == 2);
}

TEST_CASE("3D polygons, holes and multipolygons are plans; points and lines are left out") {
  const std::string hole =
      R"({"type":"Feature","properties":{},"geometry":{"type":"MultiPolygon","coordinates":[[
      [[0,0,5],[10,0,5],[10,10,6],[0,10,6],[0,0,5]],[[3,3,5],[6,3,5],[6,6,5],[3,6,5],[3,3,5]]],
      [[[20,0,1],[30,0,1],[30,10,1],[20,0,1]]]]}})";
  const std::string line =
      R"({"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[[0,0],[9,9]]}})";
  const Footprints f = read(collection(hole + "," + line));
  REQUIRE(f.all.size() == 1);
  CHECK(f.all[0].parts.size() == 2);
  CHECK(f.all[0].parts[0].size() == 2);
  CHECK(f.problems.size() == 1);
}

TEST_CASE("what holds no polygon, or is no map, is an error") {
  CHECK_THROWS_WITH(read(collection("")), Contains("holds no polygon"));
  CHECK_THROWS_WITH(read("no map"), Contains("GDAL cannot read it"));
}

TEST_CASE("footprints that are written are read again at the same place") {
  const Footprint f{"a", {{{{1, 2}, {11, 2}, {11, 9}, {1, 9}}}}, {{"class", "house"}}};
  for (const std::optional<Georeference>& scene :
       {std::optional<Georeference>(),
        std::optional<Georeference>({"ENU:-6.4,107.4,50", {}, "t"})}) {
    const Footprints again = read(footprints_geojson({f}, scene), "", scene);
    REQUIRE(again.all.size() == 1);
    CHECK(again.all[0].id == "a");
    REQUIRE(again.all[0].parts[0][0].size() == 4);
    for (const Vec2& p : f.parts[0][0]) {
      double least = 1;
      for (const Vec2& q : again.all[0].parts[0][0]) least = std::min(least, (p - q).norm());
      CHECK(least < 0.005);
    }
  }
}
