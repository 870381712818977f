#include "measure/looks.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "meshes.h"

using namespace colod;

namespace {

const Mesh kBox = test::box_mesh({0, 0, 0}, {10, 8, 6});

Looks look(const Mesh& source, const Mesh& layer) {
  return LookGauge(test::as_source(source)).look_at(layer);
}

/// A box whose top is moved sideways, so that two walls of 8 m lean.
Mesh leaning_box(double sideways) {
  Mesh m = kBox;
  for (Vec3& v : m.vertices)
    if (v.z() > 0) v.x() += sideways;
  return m;
}

double worst(const Looks& looks, LookFault fault) {
  return looks.worst[static_cast<int>(fault)].size;
}

}  // namespace

TEST_CASE("what a person would draw has no fault") {
  for (const Mesh& m : {kBox, test::gable_house(10, 8, 5, 4)}) {
    const Looks looks = look(m, m);
    CHECK(looks.triangles_ratio == 1);
    CHECK(looks.upright == 1);
    CHECK(looks.aligned == Approx(1));
    CHECK(looks.level_eaves == 1);
    CHECK(looks.narrow == 0);
    CHECK(looks.flaps == 0);
    CHECK(looks.unsupported == 0);
    for (const FaultPlace& place : looks.worst) CHECK(place.size == 0);
  }
  CHECK(look(kBox, kBox).wall_area == Approx(2 * 6 * 18));
}

TEST_CASE("walls lean from one degree on, and steep roofs are no walls") {
  const double leaning = 2 * 8 * std::hypot(6, 1.5), all = leaning + 2 * 10 * 6;
  const Looks by_14_deg = look(kBox, leaning_box(1.5));
  CHECK(by_14_deg.wall_area == Approx(all));
  CHECK(by_14_deg.upright == Approx(1 - leaning / all));
  CHECK(worst(by_14_deg, LookFault::kLeaning) == Approx(leaning / 2));
  CHECK(look(kBox, leaning_box(0.09)).upright == 1);  // 0.9°
  CHECK(look(kBox, leaning_box(0.12)).upright < 1);   // 1.1°
  CHECK(look(kBox, leaning_box(5)).upright < 0.6);    // 40°, on the ground
  CHECK(look(kBox, leaning_box(6.5)).upright == 1);   // 47°: a slope
  const Mesh steep = test::gable_house(10, 8, 5, 8);  // 63°
  CHECK(look(steep, steep).upright == 1);
  CHECK(look(steep, steep).wall_area == Approx(2 * 5 * 18 + 8 * 8));  // gables are walls
}

TEST_CASE("edges count by the directions that a plan has") {
  Mesh turned = kBox;
  for (Vec3& v : turned.vertices) v = Eigen::AngleAxisd(0.3, Vec3::UnitZ()) * v;
  CHECK(look(turned, turned).aligned == Approx(1));
  Mesh bent = kBox;  // one upper corner moved: two edges of the top and a wall's diagonal
  bent.vertices[7] += Vec3(1.5, 0, 0);
  CHECK(look(kBox, bent).aligned < 0.95);
  CHECK(look(kBox, bent).aligned > 0.7);
}

TEST_CASE("eaves are level or not; gables count for nothing") {
  Mesh house = test::gable_house(10, 8, 5, 4);
  CHECK(look(house, house).level_eaves == 1);
  house.vertices[4].z() += 0.5;  // one end of an eave
  CHECK(look(house, house).level_eaves < 0.6);
  Mesh tilted = kBox;  // a flat roof that falls by 2.9°
  for (const int v : {5, 7}) tilted.vertices[v].z() += 0.5;
  CHECK(look(kBox, tilted).level_eaves == Approx(16 / (16 + 2 * std::hypot(10, 0.5))));
}

TEST_CASE("a fin, a spike and a brim are flaps; what the source shows from both sides is none") {
  const Mesh fin = test::box_mesh({10, 4, 2}, {12, 4.1, 5});
  const Looks with_fin = look(kBox, test::join(kBox, fin));
  CHECK(with_fin.flaps == Approx(2 * 1.7 * 3).margin(0.4));  // 0.3 m from the wall it is the wall's
  CHECK((with_fin.worst[0].place - Vec3(11, 4, 3.5)).norm() < 0.5);
  const Mesh brim = test::box_mesh({-2, -2, 0}, {12, 10, 0.15});
  CHECK(look(kBox, test::join(kBox, brim)).flaps > 100);
  const Mesh plate = test::join(kBox, fin);
  CHECK(look(plate, plate).flaps == 0);
  const Mesh thick = test::join(kBox, test::box_mesh({10, 4, 2}, {12, 4.5, 5}));
  CHECK(look(kBox, thick).flaps == 0);
}

TEST_CASE("a sharp edge of a thick body is no flap, a sheet of that angle's sides is") {
  for (const double rise : {1.0, 2.0, 4.0}) {  // a lean-to: its upper edge has 83 to 63 degrees
    Mesh lean_to = kBox;
    for (Vec3& v : lean_to.vertices)
      if (v.z() > 0 && v.y() > 0) v.z() += rise;
    CHECK(look(lean_to, lean_to).flaps == 0);
    CHECK(look(kBox, lean_to).flaps == 0);
  }
  Mesh blade = test::box_mesh({10, 4, 2}, {12, 4.2, 5});  // its sides are 9 degrees off parallel
  for (Vec3& v : blade.vertices)
    if (v.x() > 11) v.y() = v.y() > 4.1 ? 4.2 : 3.7;
  // Both sides, where it is thinner than 0.3 m and farther than that from the wall.
  CHECK(look(kBox, test::join(kBox, blade)).flaps == Approx(2 * 0.37 * 3).margin(0.4));
}

TEST_CASE("tops in the air are unsupported; bases, floors and walls under a roof are not") {
  const Mesh tower = test::join(kBox, test::box_mesh({2, 2, 6}, {4, 4, 9}));
  const double air = 2 * 2 + 4 * 2 * 2.5;  // half a metre is near
  const Looks alone = look(kBox, tower);
  CHECK(alone.unsupported == Approx(air).margin(1));
  CHECK(worst(alone, LookFault::kUnsupported) > 3);
  CHECK(alone.ragged == alone.unsupported);
  for (const double width : {0.1, 0.25}) {  // a sheet in the air is both, and counts once
    const Looks sheet = look(kBox, test::join(kBox, test::box_mesh({2, 2, 6}, {8, 2 + width, 9})));
    CHECK(sheet.ragged < sheet.unsupported + sheet.flaps - 5);
    CHECK(sheet.ragged >= std::max(sheet.unsupported, sheet.flaps));
  }
  Mesh roof = kBox;  // all that a flight from above shows
  roof.faces = {kBox.faces[2], kBox.faces[3]};
  CHECK(look(roof, kBox).unsupported == 0);
  Source points = test::as_source({}, "cloud");
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 16; ++j) points.cloud.points.emplace_back(0.5 * i, 0.5 * j, 6);
  const LookGauge gauge(points);
  CHECK(gauge.look_at(kBox).unsupported == 0);
  CHECK(gauge.look_at(kBox).triangles_ratio == -1);
  CHECK(gauge.look_at(tower).unsupported > 10);
}

TEST_CASE("noise decides which facets are narrow") {
  const Mesh stepped = test::join(kBox, test::box_mesh({12, 0, 0}, {12.05, 8, 6}));
  CHECK(look(stepped, stepped).narrow == 0);
  Mesh rough = test::sphere_mesh(5);  // bumps of 0.2 m on a ball of 10 m
  for (std::size_t i = 0; i < rough.vertices.size(); ++i)
    rough.vertices[i] *= 10 + 0.2 * std::sin(37.0 * static_cast<double>(i));
  const LookGauge gauge(test::as_source(rough));
  CHECK(gauge.source().noise > 0.05);
  CHECK(gauge.source().noise < 0.3);
  CHECK(gauge.look_at(stepped).narrow > 0);
  CHECK(LookGauge(test::as_source(kBox)).source().noise < 1e-6);
  CHECK(LookGauge(test::as_source(kBox)).source().edge == Approx(9).margin(1.1));
}

TEST_CASE("the verdict counts the faults that one sees, the heaviest first") {
  CHECK(judge_looks(look(kBox, kBox)).points == 0);
  Looks looks;
  looks.flaps = 0.4, looks.triangles_ratio = 1;
  CHECK(judge_looks(looks).faults.empty());
  looks.flaps = 100, looks.upright = 0.9, looks.triangles_ratio = 1.5;
  const LookVerdict verdict = judge_looks(looks);
  CHECK(verdict.faults ==
        std::vector<LookFault>{LookFault::kFlap, LookFault::kLeaning, LookFault::kTriangles});
  CHECK(verdict.points == Approx(10 + 2 + 1.5));
}

TEST_CASE("looks: what has no surface, and threads") {
  CHECK_THROWS_AS(LookGauge(test::as_source({})), Error);
  CHECK(look(kBox, {}).upright == 1);
  const Mesh tower = test::join(kBox, test::box_mesh({2, 2, 6}, {4, 2.2, 9}));
  std::string alone;
  in_threads(1, [&] { alone = looks_json(look(kBox, tower)); });
  CHECK(alone == looks_json(look(kBox, tower)));
  const Source source = test::as_source(kBox);
  CHECK(alone == looks_json(LookGauge(source, Surface(kBox)).look_at(tower)));
  const auto json = nlohmann::json::parse(alone);
  CHECK(json.at("flaps") > 0);
  CHECK(json.at("worst").contains("flap"));
  CHECK(!json.at("worst").contains("leaning"));
}
