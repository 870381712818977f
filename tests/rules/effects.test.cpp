// What rules do from end to end: each alone can be switched off, and does something.
#include <algorithm>
#include <catch2/catch.hpp>

#include "meshes.h"
#include "pipeline/pipeline.h"
#include "rules/rules.h"
#include "synth/synth.h"

using namespace colod;

namespace {

std::vector<Source> neighbourhood(int buildings, bool is_scan, double density = 8) {
  std::vector<Source> sources;
  for (SynthBuilding& b :
       make_neighbourhood({.buildings = buildings, .is_scan = is_scan, .density = density}))
    sources.push_back(std::move(b.source));
  return sources;
}

/// The house of four that takes least time.
Source small_house(bool is_scan) {
  std::vector<Source> sources = neighbourhood(4, is_scan);
  return *std::min_element(sources.begin(), sources.end(), [](const Source& a, const Source& b) {
    return a.mesh.faces.size() < b.mesh.faces.size();
  });
}

Options with_rules(const RuleSet& rules, int ns) {
  Options options;
  options.rules = rules;
  options.ns = ns, options.nr = 40;
  return options;
}

Scene build(std::vector<Source> sources, const RuleSet& rules, int ns = 24) {
  return build_scene({std::move(sources), {}}, with_rules(rules, ns));
}

/// Nothing that is open is handed on as a layer.
void check_closed(const Scene& scene) {
  for (const Building& b : scene.buildings) {
    INFO(b.source.name);
    if (!b.failure.empty()) continue;
    CHECK(b.layers.size() == 3);
    for (const Layer& layer : b.layers)
      if (layer.failure.empty()) CHECK(layer.validity.is_watertight);
  }
}

bool is_same(const Planes& a, const Planes& b) {
  return a.plane_of_item == b.plane_of_item && a.box.min == b.box.min &&
         std::equal(a.planes.begin(), a.planes.end(), b.planes.begin(), b.planes.end(),
                    [](const Plane& p, const Plane& q) {
                      return p.normal == q.normal && p.offset == q.offset &&
                             p.outline.vertices == q.outline.vertices;
                    });
}

bool changes_planes(Rule rule, const Source& source) {
  return !is_same(detect_planes(source),
                  detect_planes(source, {.rules = RuleSet::all().without(rule)}));
}

/// What an airborne scanner sees of a large gable house: its roof, one side of which has its
/// normals turned down, and four points at the foot of a wall.
Source airborne_cloud() {
  Source s;
  s.name = "airborne";
  for (double x = 0; x <= 40; x += 0.2)
    for (double y = 0.1; y < 26; y += 0.2) {
      const bool is_front = y < 13;
      s.cloud.points.emplace_back(x, y, 8 + 0.5 * (is_front ? y : 26 - y));
      const Vec3 up = Vec3(0, is_front ? -0.5 : 0.5, 1).normalized();
      s.cloud.normals.push_back(is_front ? up : Vec3(-up));
    }
  for (int i = 0; i < 4; ++i) {
    s.cloud.points.emplace_back(10 + 0.2 * i, 0, 0.1 * i);
    s.cloud.normals.emplace_back(0, -1, 0);
  }
  return s;
}

/// Up to its layers' segments.
Building segmented(Source source) {
  Scene scene;
  scene.buildings.push_back(
      segment_building({std::move(source), 0, {}}, with_rules(RuleSet::all(), 24)));
  analyze_scene(scene, with_rules(RuleSet::all(), 24));
  return scene.buildings[0];
}

bool has_same_layers(const Building& a, const Building& b) {
  return std::equal(a.layers.begin(), a.layers.end(), b.layers.begin(), b.layers.end(),
                    [](const Layer& x, const Layer& y) {
                      return x.mesh.vertices == y.mesh.vertices &&
                             x.mesh.triangles == y.mesh.triangles;
                    });
}

bool has_stand_in(const Scene& scene, StandIn reason) {
  return std::any_of(scene.buildings.begin(), scene.buildings.end(), [&](const Building& b) {
    return std::any_of(b.layers.begin(), b.layers.end(),
                       [&](const Layer& l) { return l.stand_in == reason; });
  });
}

}  // namespace

TEST_CASE("each rule alone can be switched off, on clean models and on scans") {
  std::vector<Source> sources{small_house(false), small_house(true)};
  sources[1].name += "_scan";
  for (const RuleInfo& info : rule_table()) {
    INFO("without " << info.id);
    check_closed(build(sources, with_needs_met(RuleSet::all().without(info.rule)), 16));
  }
}

TEST_CASE("each rule alone can be switched on") {
  const std::vector<Source> sources{small_house(true)};
  for (const RuleInfo& info : rule_table()) {
    INFO(info.id << " alone");
    check_closed(build(sources, RuleSet::none().with(info.rule), 16));
  }
}

TEST_CASE("each rule of planes changes a source that was made for it") {
  const Source cloud = airborne_cloud();
  const Planes robust = detect_planes(cloud);
  for (const Plane& p : robust.planes) CHECK(p.normal.z() > 0.5);
  const Planes without = detect_planes(cloud, {.rules = RuleSet::all().without(Rule::kAirborne)});
  CHECK(std::any_of(without.planes.begin(), without.planes.end(),
                    [](const Plane& p) { return p.normal.z() < 0; }));
  const std::vector<Source> scans = neighbourhood(4, true, 15);
  for (const Rule rule :
       {Rule::kFloaters, Rule::kFaces, Rule::kNoise, Rule::kSmoothNormals, Rule::kGrowing,
        Rule::kRegionArea, Rule::kCoplanar, Rule::kUpright, Rule::kFamilies, Rule::kTilts,
        Rule::kNarrowStrips, Rule::kOffsets, Rule::kAbsorb, Rule::kHoles, Rule::kBorders}) {
    INFO(info_of(rule).id);
    CHECK(std::any_of(scans.begin(), scans.end(),
                      [&](const Source& s) { return changes_planes(rule, s); }));
  }
}

TEST_CASE("each rule of extraction changes a layer of a source made for it") {
  const std::vector<Building> houses{segmented(neighbourhood(2, false)[0]),
                                     segmented(neighbourhood(4, true, 15)[3])};
  std::vector<Building> before = houses;
  for (Building& b : before) mesh_building(b, with_rules(RuleSet::all(), 24));
  for (const Rule rule : {Rule::kSides, Rule::kElementCuts, Rule::kReach, Rule::kLeaders,
                          Rule::kPruning, Rule::kRings, Rule::kMinCut, Rule::kFacetPrice}) {
    INFO(info_of(rule).id);
    bool is_changed = false;
    for (std::size_t i = 0; i < houses.size() && !is_changed; ++i) {
      Building b = houses[i];
      mesh_building(b, with_rules(RuleSet::all().without(rule), 24));
      is_changed = !has_same_layers(before[i], b);
    }
    CHECK(is_changed);
  }
}

TEST_CASE("a layer that lost its building is replaced only by the rule for it") {
  RuleSet rules = RuleSet::all();  // without what keeps the main roof of a house on layer 0
  for (const Rule rule :
       {Rule::kFidelity, Rule::kStrictBound, Rule::kAreaShares, Rule::kMissingPlanes,
        Rule::kPartyWalls, Rule::kWideOutlines, Rule::kHistograms, Rule::kBehind, Rule::kFloaters})
    rules = rules.without(rule);
  const std::vector<Source> scans = neighbourhood(8, true, 8);
  CHECK(has_stand_in(build(scans, rules), StandIn::kVolume));
  CHECK(!has_stand_in(build(scans, rules.without(Rule::kVolume)), StandIn::kVolume));
}
