// What a chain lost or invented, through the whole pipeline: patches of a scene are refused with a
// reason, roofs alone are not; losses stand in the report and count.
#include "pipeline/losses.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "meshes.h"
#include "publish/messages.h"
#include "publish/report.h"
#include "scene/left_out.h"

using namespace colod;
using namespace colod::test;

namespace {

/// A grid of n × m cells from `corner` along `u` and `v`; z rises by `height(s, t)`.
template <typename Height>
Mesh patch(const Vec3& corner, const Vec3& u, const Vec3& v, int n, int m, const Height& height) {
  Mesh mesh;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) {
      const double s = 1.0 * i / n, t = 1.0 * j / m;
      mesh.vertices.push_back(corner + s * u + t * v + Vec3(0, 0, height(s, t)));
    }
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      mesh.faces.push_back({a, a + 1, a + n + 2});
      mesh.faces.push_back({a, a + n + 2, a + n + 1});
    }
  return mesh;
}

Mesh flat(const Vec3& corner, const Vec3& u, const Vec3& v) {
  return patch(corner, u, v, 12, 8, [](double, double) { return 0.0; });
}

/// Rolling ground, `side` metres wide.
Mesh terrain(double side, double relief, double phase) {
  return patch({0, 0, 0}, {side, 0, 0}, {0, side, 0}, 40, 40, [=](double s, double t) {
    return relief * side *
           (std::sin(9 * s + phase) * std::cos(7 * t) + 0.5 * std::sin(13 * t + 5 * s + phase));
  });
}

/// Walls from the origin, w × h and, with a second one, d.
Mesh walls(double w, double h, double d) {
  Mesh m = flat({0, 0, 0}, {w, 0, 0}, {0, 0, h});
  return d > 0 ? join(m, flat({w, 0, 0}, {0, d, 0}, {0, 0, h})) : m;
}

Mesh gable_roof(double w, double d, double h) {
  return join(flat({0, 0, h}, {w, 0, 0}, {0, d / 2, d / 3}),
              flat({w, d, h}, {-w, 0, 0}, {0, -d / 2, d / 3}));
}

Mesh hipped_roof(double w, double d, double h) {
  Mesh m;
  m.vertices = {{0, 0, h},
                {w, 0, h},
                {w, d, h},
                {0, d, h},
                {d / 2, d / 2, h + d / 4},
                {w - d / 2, d / 2, h + d / 4}};
  m.faces = {{0, 1, 5}, {0, 5, 4}, {1, 2, 5}, {2, 3, 4}, {2, 4, 5}, {3, 0, 4}};
  return m;
}

Scene build(Source source) {
  ReadResult input;
  input.sources.push_back(std::move(source));
  Options options;
  options.ns = 24;
  options.nr = 40;
  return build_scene(std::move(input), options);
}

Scene build(Mesh mesh) { return build(as_source(std::move(mesh), "one")); }

std::string failure_of(const Mesh& mesh) { return build(mesh).buildings[0].failure; }

}  // namespace

TEST_CASE("terrain, walls and corners look like parts of a scene") {
  for (const double side : {20.0, 60.0, 200.0})
    for (const double relief : {0.015, 0.04}) {
      INFO(side << " m, relief " << relief);
      CHECK_THAT(failure_of(terrain(side, relief, side)),
                 Catch::Contains("this looks like a part of a scene: terrain"));
    }
  for (const double w : {8.0, 20.0, 60.0}) {
    INFO(w << " m wide");
    const Building wall = build(walls(w, w / 3, 0)).buildings[0];
    CHECK_THAT(wall.failure, Catch::Contains("a part of a scene: a wall"));
    CHECK(!wall.has_lost());
    CHECK_THAT(failure_of(walls(w, w / 2, 0.7 * w)), Catch::Contains("part of a scene"));
  }
}

TEST_CASE("a wall that was found is no failure, and nothing of it is written") {
  Source source = as_source(walls(20, 7, 0));
  source.is_found = true;
  Scene street = build(source);
  street.buildings.push_back(build(as_source(gable_house(12, 9, 6, 4))).buildings[0]);
  CHECK(street.buildings[0].is_dismissed);
  CHECK(street.buildings[0].layers.empty());
  CHECK(exit_code(street) == 0);
  CHECK(tally_of(street).buildings == 1);
  CHECK(problems_of(street.buildings[0])[0].level == Level::kWarning);
  leave_out_dismissed(street);
  CHECK(street.buildings.size() == 1);
  CHECK(street.warnings.size() == 1);
}

TEST_CASE("roofs alone, walls all round and whole buildings do not") {
  for (const double w : {8.0, 20.0, 60.0}) {
    INFO(w << " m wide");
    const double d = 0.7 * w, h = w / 3;
    CHECK(failure_of(gable_roof(w, d, h)) == "");
    CHECK(failure_of(hipped_roof(w, d, h)) == "");
    CHECK(failure_of(flat({0, 0, h}, {w, 0, 0}, {0, d, 0})) == "");
    CHECK(failure_of(flat({0, 0, h}, {w, 0, 0}, {0, d, d / 6})) == "");
    CHECK(failure_of(join(walls(w, h, d), join(flat({w, d, 0}, {-w, 0, 0}, {0, 0, h}),
                                               flat({0, d, 0}, {0, -d, 0}, {0, 0, h})))) == "");
    CHECK(failure_of(gable_house(w, d, h, h / 2)) == "");
  }
}

TEST_CASE("what is lost is said first, weighed by volume, and counts") {
  Scene scene = build(gable_house(12, 9, 6, 4));
  Building& b = scene.buildings[0];
  CHECK(b.solid == Approx(864).epsilon(0.03));
  CHECK(!b.has_lost());
  CHECK(loss_warnings(b).empty());
  b.warnings = {"an ordinary one"};
  b.left_out = {{LeftOut::Reason::kFloater, 30, 0.05, 2, -1, -1},
                {LeftOut::Reason::kLost, 200, 0.2, 6, 216, 0.25},
                {LeftOut::Reason::kGround, 100, 0.1, 9, -1, -1}};
  CHECK(b.has_lost());
  CHECK(!b.has_failed());
  const auto report = nlohmann::json::parse(report_json(scene, {}, {}));
  const auto& json = report["buildings"][0];
  CHECK(json["lost"] == true);
  CHECK(json["heavy_warnings"] == 2);  // the ground is no more than usual
  REQUIRE(json["warnings"].size() == 3);
  CHECK_THAT(json["warnings"][0].get<std::string>(), Catch::Contains("25 % of the volume"));
  CHECK_THAT(json["warnings"][1].get<std::string>(), Catch::Contains("afloat"));
  CHECK(json["left_out"][0]["volume"].is_null());
  CHECK(json["left_out"][1]["volume_share"] == 0.25);
  CHECK(json["left_out_total"]["area"] == 330);
  CHECK(report["totals"]["lost_bodies"] == 1);
}

TEST_CASE("a finest layer with little of the source behind it counts as lost, a coarser one not") {
  Scene scene = build(gable_house(12, 9, 6, 4));
  Building& b = scene.buildings[0];
  b.layers[0].looks.ragged = b.layers[0].looks.wall_area;
  CHECK(!b.has_lost());
  Looks& finest = b.layers.back().looks;
  finest.ragged = 0.9 * kMostRagged * finest.wall_area;
  CHECK(!b.has_lost());
  CHECK(loss_warnings(b).empty());
  finest.ragged = 1.1 * kMostRagged * finest.wall_area;
  CHECK(b.has_lost());
  REQUIRE(loss_warnings(b).size() == 1);
  CHECK_THAT(loss_warnings(b)[0], Catch::Contains("m2 of walls: is this a building, and whole?"));
  b.layers.back().failure = "none";  // which is told of by itself
  CHECK(loss_warnings(b).empty());
}

TEST_CASE("a roof alone is as thin as it is low, and nothing is lost of it") {
  for (const double w : {8.0, 20.0, 60.0}) {
    INFO(w << " m wide");
    CHECK(!build(hipped_roof(w, 0.7 * w, w / 3)).buildings[0].has_lost());
    CHECK(!build(gable_roof(w, 0.7 * w, w / 3)).buildings[0].has_lost());
  }
}

TEST_CASE(
    "a layer whose mesh is another's for a failure counts, one that is only simpler does not") {
  Scene scene = build(gable_house(12, 9, 6, 4));
  Building& b = scene.buildings[0];
  b.layers[0].stand_in = StandIn::kRicher;
  CHECK(!b.has_lost());
  b.layers[1].stand_in = StandIn::kVolume;
  CHECK(b.has_lost());
  const auto report = nlohmann::json::parse(report_json(scene, {}, {}));
  const auto& layers = report["buildings"][0]["layers"];
  CHECK(layers[0]["stand_in"]["failure"] == false);
  CHECK(layers[1]["stand_in"]["reason"] == "volume");
  CHECK(layers[1]["stand_in"]["failure"] == true);
  CHECK(!layers[2].contains("stand_in"));
  CHECK(layers[2]["invented"] == 0);
  CHECK(report["totals"]["stand_in_layers"] == 1);
}

TEST_CASE("pieces afloat have the volume of those that are closed") {
  const Mesh box = box_mesh({0, 0, 0}, {10, 8, 6}), cube = box_mesh({12, 3, 1}, {14, 5, 3});
  const Mesh scrap = flat({16, 3, 1}, {1, 0, 0}, {0, 1, 0});
  const Source source = as_source(join(join(box, cube), scrap), "box");
  std::vector<char> flags(source.mesh.faces.size(), 1);
  std::fill(flags.begin(), flags.begin() + 12, 0);
  CHECK(measure_left_out(source, flags, LeftOut::Reason::kFloater, {}).volume == Approx(8));
  std::fill(flags.begin() + 12, flags.begin() + 24, 0);
  CHECK(measure_left_out(source, flags, LeftOut::Reason::kFloater, {}).volume == -1);
}
