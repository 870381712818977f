#include "pipeline/pipeline.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <set>

#include "core/parallel.h"
#include "exporters/gltf/glb.h"
#include "exporters/tiles3d/tiles3d.h"
#include "meshes.h"
#include "pipeline/switches.h"
#include "publish/publish.h"
#include "publish/report.h"
#include "shared_data.h"
#include "synth/synth.h"

using namespace colod;

namespace {

/// A gable house with a chimney that stands on the roof, a porch and an extension: closed pieces
/// that overlap.
Source house(const std::string& name, double w = 12, double d = 9) {
  Mesh m = test::gable_house(w, d, 6, 4);
  m = test::join(m, test::box_mesh({w * 0.2, d * 0.3, 7}, {w * 0.2 + 1, d * 0.3 + 1.2, 11}));
  m = test::join(m, test::box_mesh({w - 0.5, 1, 0}, {w + 4, d * 0.5, 3}));
  m = test::join(m, test::box_mesh({w * 0.6, -2, 2.5}, {w * 0.6 + 3, 0.2, 3.6}));
  return test::as_source(m, name);
}

Source transformed(Source s, double yaw_deg, const Vec3& by) {
  const Eigen::AngleAxisd turn(yaw_deg * std::numbers::pi / 180, Vec3::UnitZ());
  for (Vec3& p : s.mesh.vertices) p = turn * p + by;
  return s;
}

Options small_options() {
  Options o;
  o.ns = 40;
  o.nr = 60;
  return o;
}

Scene build(std::vector<Source> sources, const Options& options = small_options()) {
  return build_scene({std::move(sources), {}}, options);
}

void check_chain(const Building& b, int layers) {
  INFO(b.source.name << " " << b.failure);
  REQUIRE(b.layers.size() == static_cast<std::size_t>(layers));
  for (std::size_t k = 0; k < b.layers.size(); ++k) {
    INFO("layer " << k << " " << b.layers[k].failure);
    CHECK(b.layers[k].validity.is_watertight);
    CHECK(b.layers[k].validity.enclosed_components == 0);
    CHECK(b.layers[k].validity.volume > 0);
    if (k == 0) continue;
    CHECK(b.layers[k].validity.faces >= b.layers[k - 1].validity.faces);
    CHECK(b.layers[k].validity.vertices >= b.layers[k - 1].validity.vertices);
    CHECK(b.layers[k].validity.polygons >= b.layers[k - 1].validity.polygons);
    CHECK(b.layers[k].segments >= b.layers[k - 1].segments);
    CHECK(b.layers[k].sight.deviation <= b.layers[k - 1].sight.deviation);
  }
}

/// Segment sizes and the layers' counts: what must not depend on where a building stands.
std::vector<double> signature(const Building& b) {
  std::vector<double> s;
  for (std::size_t i = 0; i < b.segments.segments.size(); ++i) {
    s.push_back(static_cast<double>(b.segments.segments[i].planes.size()));
    s.push_back(b.layer_of_segment[i]);
  }
  for (const Layer& l : b.layers) s.push_back(l.validity.faces), s.push_back(l.validity.vertices);
  return s;
}

std::string report_without_times(const Scene& scene, const Options& options) {
  auto json = nlohmann::json::parse(report_json(scene, options, {}));
  json["totals"].clear();
  json["coanalysis"]["seconds"] = 0;
  for (auto& b : json["buildings"]) b["timings"].clear();
  return json.dump();
}

std::string all_bytes(Scene scene) {
  std::string bytes;
  std::vector<ExportBuilding> buildings;
  decide_switches(scene, 3, {});
  for (const Building& b : scene.buildings) {
    buildings.push_back(export_building(b));
    bytes += encode_building_glb(buildings.back()).bytes;
  }
  for (const Encoded& file : encode_tileset(buildings)) bytes += file.path + file.bytes;
  return bytes;
}

}  // namespace

TEST_CASE("houses become chains of watertight layers whose detail does not decrease") {
  const Scene scene = build({house("a"), house("b", 14, 8), house("c", 11, 10)});
  for (const Building& b : scene.buildings) {
    check_chain(b, 3);
    CHECK(b.layers.back().validity.volume == Approx(12 * 9 * 8).epsilon(0.5));
  }
  CHECK(scene.selection.bound >= scene.selection.objective - 1e-9);
}

TEST_CASE("an exact model of few planes gives nothing away on coarse layers") {
  // A step of ten centimetres and a wall that bulges by one; the first corner sees all others.
  const std::vector<Vec2> plan = {{0, 8}, {0, 0}, {6, 0}, {6, 0.1}, {10, 0.1}, {10.01, 4}, {10, 8}};
  Source step = house("step");
  step.mesh = {};
  const int n = static_cast<int>(plan.size());
  for (const double z : {0.0, 6.0})
    for (const Vec2& p : plan) step.mesh.vertices.emplace_back(p.x(), p.y(), z);
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    step.mesh.faces.push_back({i, j, j + n});
    step.mesh.faces.push_back({i, j + n, i + n});
    if (i > 0 && j > 0)  // both fans about the first corner
      step.mesh.faces.push_back({0, j, i}), step.mesh.faces.push_back({n, i + n, j + n});
  }
  const Scene scene = build({step});
  for (const Layer& layer : scene.buildings[0].layers) CHECK(layer.validity.polygons == n + 2);
}

TEST_CASE("stacked boxes keep their ground floor, on every layer") {
  for (const double over : {0.1, 0.3, 0.6})
    for (const double height : {2.6, 3.2, 4.5}) {
      Mesh m = test::box_mesh({0, 0, 0}, {14, 9, height});
      m = test::join(m,
                     test::box_mesh({-over, -over, height}, {14 + over, 9 + over, height + 0.3}));
      m = test::join(m, test::box_mesh({5, 2, height + 0.3}, {9, 6, height + 2.6}));
      const double volume = 126 * height + 0.3 * (14 + 2 * over) * (9 + 2 * over) + 16 * 2.3;
      const Scene scene = build({test::as_source(m)});
      for (const Layer& layer : scene.buildings[0].layers)
        CHECK(layer.validity.volume == Approx(volume).epsilon(0.05));
    }
}

TEST_CASE("the paper's rules run through the same rooms") {
  Options options = small_options();
  options.rules = RuleSet::none();
  for (const Building& b : build({house("a"), house("b", 14, 8)}, options).buildings)
    for (const Layer& layer : b.layers) CHECK(layer.validity.is_watertight);
}

TEST_CASE("moving by 1e6 m, permuting triangles and quarter turns change no segment and no layer") {
  const std::vector<double> reference = signature(build({house("a")}).buildings[0]);
  CHECK(signature(build({transformed(house("a"), 0, {1e6, -1e6, 50})}).buildings[0]) == reference);
  CHECK(signature(build({transformed(house("a"), 90, {0, 0, 0})}).buildings[0]) == reference);
  Source permuted = house("a");
  std::mt19937 random(3);
  std::shuffle(permuted.mesh.faces.begin(), permuted.mesh.faces.end(), random);
  CHECK(signature(build({permuted}).buildings[0]) == reference);
}

TEST_CASE("turned by any angle, a building keeps its segments and its layers") {
  const Building reference = build({house("a")}).buildings[0];
  for (const double yaw : {17.0, 45.0, 201.5}) {
    const Building turned = build({transformed(house("a"), yaw, {10, 20, 0})}).buildings[0];
    CHECK(signature(turned) == signature(reference));
    CHECK(turned.layers[2].validity.volume ==
          Approx(reference.layers[2].validity.volume).epsilon(1e-6));
  }
}

TEST_CASE("1 and 2 threads give the same bytes and the same report") {
  limit_threads(1);
  const Scene one = build({house("a"), house("b", 14, 8)});
  limit_threads(2);
  const Scene two = build({house("a"), house("b", 14, 8)});
  limit_threads(0);
  CHECK(all_bytes(one) == all_bytes(two));
  CHECK(report_without_times(one, small_options()) == report_without_times(two, small_options()));
}

TEST_CASE("one bad building does not end a scene") {
  const Scene scene = build(
      {house("a"), test::as_source({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}, "line")});
  check_chain(scene.buildings[0], 3);
  CHECK(scene.buildings[1].has_failed());
  CHECK(!scene.buildings[1].failure.empty());
  CHECK(scene.buildings[1].source.name == "line");
}

TEST_CASE("a single triangle and two coplanar ones are answered, not crashed on") {
  const Source one = test::as_source({{{0, 0, 0}, {4, 0, 0}, {0, 3, 0}}, {{0, 1, 2}}}, "one");
  const Source two = test::as_source(
      {{{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 0, 3}}, {{0, 1, 2}, {0, 2, 3}}}, "two");
  for (const Building& b : build({one, two}).buildings) {
    for (const Layer& l : b.layers)
      if (l.failure.empty()) CHECK(l.validity.is_watertight);
    if (b.has_failed()) CHECK(!report_json(Scene{}, Options{}, {}).empty());
  }
}

TEST_CASE("any number of layers, one included") {
  for (const int layers : {1, 2, 5}) {
    Options options = small_options();
    options.layers = layers;
    check_chain(build({house("a")}, options).buildings[0], layers);
  }
}

TEST_CASE("one segment, twins, parts all alike: any number of layers") {
  const Source box = test::as_source(test::box_mesh({0, 0, 0}, {10, 8, 7}), "box");
  Source row = box;  // twelve parts on the roof, of one size
  row.name = "row";
  for (int i = 0; i < 12; ++i) {
    const Vec3 at(0.8 + 2.2 * (i % 4), 1 + 2.4 * (i / 4), 6.9);
    row.mesh = test::join(row.mesh, test::box_mesh(at, at + Vec3(1, 1, 2)));
  }
  Source twin = house("twin");
  twin.name = "other twin";
  for (const int layers : {1, 2, 3, 5}) {
    Options options = small_options();
    options.layers = layers;
    INFO(layers << " layers");
    const Scene lone = build({box}, options);  // nothing beyond layer 0
    check_chain(lone.buildings[0], layers);
    CHECK(lone.buildings[0].layer_of_segment == std::vector<int>{0});
    CHECK(lone.buildings[0].layers.back().validity.faces == 12);
    const Scene twins = build({house("twin"), twin}, options);
    for (const Building& b : twins.buildings) check_chain(b, layers);
    CHECK(signature(twins.buildings[0]) == signature(twins.buildings[1]));
    const Building alike = std::move(build({row}, options).buildings[0]);
    check_chain(alike, layers);
    std::vector<int> of_parts = alike.layer_of_segment;
    std::erase(of_parts, 0);
    CHECK(std::set(of_parts.begin(), of_parts.end()).size() <= 1);
  }
}

TEST_CASE("an empty scene has a report") {
  const auto json = nlohmann::json::parse(report_json(build({}), Options{}, {}));
  CHECK(json["buildings"].empty());
  CHECK(json["coanalysis"]["segments"] == 0);
}

TEST_CASE("a procedural neighbourhood, clean and scanned, becomes watertight layers") {
  for (const bool is_scan : {false, true}) {
    std::vector<Source> sources;
    for (SynthBuilding& b : make_neighbourhood({.buildings = 4, .is_scan = is_scan, .density = 15}))
      sources.push_back(std::move(b.source));
    const Scene scene = build(std::move(sources));
    for (const Building& b : scene.buildings) {
      check_chain(b, 3);
      CHECK(b.layers[0].validity.volume == Approx(b.layers[2].validity.volume).epsilon(0.2));
      CHECK(b.layers[2].distances.mean_a_to_b < 0.006 * b.planes.box.diagonal());
    }
  }
}

TEST_CASE("the scan of assets becomes watertight layers near to it") {
  const Scene scene = build(read_sources({COLOD_SOURCE_DIR "/assets/scan/house_00.ply"}).sources);
  REQUIRE(scene.buildings.size() == 1);
  const Building& b = scene.buildings[0];
  check_chain(b, 3);
  CHECK(b.layers[2].distances.mean_a_to_b < 0.006 * b.planes.box.diagonal());
}

TEST_CASE("real photogrammetry and airborne points become watertight layers") {
  const std::filesystem::path data = test::shared_data();
  COLOD_SKIP_WITHOUT(data);
  const std::vector<std::string> files = {data / "mvs/house_a.obj", data / "mvs/arc.off",
                                          data / "als/block-a/16722.ply"};
  const Scene scene = build(read_sources(files).sources);
  REQUIRE(scene.buildings.size() == 3);
  for (const Building& b : scene.buildings) check_chain(b, 3);
}
