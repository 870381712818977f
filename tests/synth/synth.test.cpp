#include "synth/synth.h"

#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <sstream>

#include "core/error.h"
#include "core/parallel.h"
#include "measure/metrics.h"

using namespace colod;

namespace {

std::vector<SynthBuilding> clean(int buildings, std::uint64_t seed) {
  return make_neighbourhood({.buildings = buildings, .seed = seed});
}

bool is_solid(const Mesh& mesh) {
  const Validity v = check_validity(mesh);
  return v.is_watertight && v.is_manifold && v.self_intersections == 0 && v.degenerate_faces == 0 &&
         v.components == 1 && v.volume > 100;
}

bool is_equal(const SynthBuilding& a, const SynthBuilding& b) {
  return a.source.mesh.vertices == b.source.mesh.vertices &&
         a.source.mesh.faces == b.source.mesh.faces && a.source.face_object == b.source.face_object;
}

}  // namespace

TEST_CASE("every clean building is a closed manifold without self-intersections") {
  for (std::uint64_t seed : {1, 2, 3, 4})
    for (const SynthBuilding& b : clean(20, seed)) {
      INFO("seed " << seed << " " << b.source.name << " " << b.style);
      CHECK(is_solid(b.source.mesh));
      CHECK(b.source.mesh.faces.size() >= 100);
      CHECK(b.source.mesh.faces.size() <= 6000);
    }
}

TEST_CASE("faces point to parts, and parts are as large as their faces") {
  for (const SynthBuilding& b : clean(10, 5)) {
    REQUIRE(b.source.face_object.size() == b.source.mesh.faces.size());
    std::vector<Box> boxes(b.parts.size());
    for (std::size_t f = 0; f < b.source.mesh.faces.size(); ++f)
      for (int v : b.source.mesh.faces[f])
        boxes.at(b.source.face_object[f]).extend(b.source.mesh.vertices[v]);
    for (const SynthPart& p : b.parts) {
      CHECK(&p == &b.parts[p.instance]);
      CHECK_FALSE(p.box.is_empty());
      CHECK(p.box.min == boxes[p.instance].min);
      CHECK(p.box.max == boxes[p.instance].max);
    }
  }
}

TEST_CASE("levels follow the size rule") {
  std::map<std::string, std::set<int>> levels;
  for (const SynthBuilding& b : clean(28, 1))
    for (const SynthPart& p : b.parts) levels[name_of(p.kind)].insert(p.level);
  const std::map<std::string, std::set<int>> expected = {
      {"body", {0}},   {"roof", {0}},    {"tower", {0}},    {"window", {2}},
      {"door", {2}},   {"balcony", {1}}, {"bay", {1}},      {"recess", {1}},
      {"dormer", {1}}, {"chimney", {2}}, {"stairhead", {1}}};
  CHECK(levels == expected);
}

TEST_CASE("a model has the same height wherever it repeats, and many do") {
  std::map<std::string, std::set<int>> heights, buildings;
  const auto all = clean(20, 3);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const SynthPart& p : all[i].parts) {
      if (p.kind != ElementKind::kWindow || p.model == "roof_window") continue;
      heights[p.model].insert(static_cast<int>(std::lround(p.box.size().z() * 1e4)));
      buildings[p.model].insert(static_cast<int>(i));
    }
  for (const auto& [model, values] : heights) CHECK(values.size() == 1);
  CHECK(buildings["window_single"].size() >= 3);
}

TEST_CASE("houses do not run into each other") {
  const auto all = clean(20, 2);
  Mesh together;
  for (const SynthBuilding& b : all) {
    const int base = static_cast<int>(together.vertices.size());
    together.vertices.insert(together.vertices.end(), b.source.mesh.vertices.begin(),
                             b.source.mesh.vertices.end());
    for (const Face& f : b.source.mesh.faces)
      together.faces.push_back({f[0] + base, f[1] + base, f[2] + base});
  }
  CHECK(check_validity(together).self_intersections == 0);
  CHECK(check_validity(together, false).components == 20);
}

TEST_CASE("the seed decides, threads do not; names are the buildings' numbers") {
  limit_threads(1);
  const auto one = clean(6, 9);
  limit_threads(2);
  const auto two = clean(6, 9);
  limit_threads(0);
  for (std::size_t i = 0; i < one.size(); ++i) CHECK(is_equal(one[i], two[i]));
  CHECK_FALSE(is_equal(one[0], clean(6, 10)[0]));
  CHECK(one[3].source.name == "house_03");
}

TEST_CASE("the OBJ text holds every vertex, face and group") {
  const SynthBuilding b = clean(1, 1)[0];
  std::istringstream lines(synth_obj(b));
  std::size_t vertices = 0, faces = 0;
  std::set<std::string> groups;
  for (std::string word, line; std::getline(lines, line);) {
    std::istringstream in(line);
    in >> word;
    if (word == "v") {
      Vec3 p;
      in >> p.x() >> p.y() >> p.z();
      CHECK(p == b.source.mesh.vertices[vertices]);
    }
    vertices += word == "v";
    faces += word == "f";
    if (word == "g") groups.insert(line);
  }
  CHECK(vertices == b.source.mesh.vertices.size());
  CHECK(faces == b.source.mesh.faces.size());
  CHECK(groups.size() == b.parts.size());
  CHECK(groups.count("g body__0") == 1);
}

TEST_CASE("the PLY has the length that its header promises") {
  const SynthBuilding b = clean(1, 1)[0];
  const std::string ply = synth_ply(b);
  const std::size_t header = ply.find("end_header\n") + 11;
  CHECK(ply.size() ==
        header + 24 * b.source.mesh.vertices.size() + 17 * b.source.mesh.faces.size());
}

TEST_CASE("the truth names buildings and parts") {
  const SynthOptions options = {.buildings = 2, .seed = 4};
  const auto all = make_neighbourhood(options);
  const std::string truth = truth_json(all, options);
  CHECK(truth == truth_json(make_neighbourhood(options), options));
  for (const char* key : {"\"house_01\"", "\"style\": \"row_house\"", "\"type\": \"chimney\"",
                          "\"level\": 0", "\"box\"", "\"density\""})
    CHECK(truth.find(key) != std::string::npos);
}

TEST_CASE("a long street comes a few houses at a time, in order, and the truth in pieces") {
  const SynthOptions options = {.buildings = 70, .seed = 4};
  const auto all = make_neighbourhood(options);
  std::string truth = truth_before(options);
  std::size_t next = 0, largest = 0;
  stream_neighbourhood(options, [&](const SynthBatch& batch) {
    largest = std::max(largest, batch.buildings.size());
    CHECK(batch.clean.empty());
    for (const SynthBuilding& b : batch.buildings) {
      REQUIRE(is_equal(b, all.at(next)));
      truth += (next++ > 0 ? ",\n" : "") + truth_entry(b);
    }
  });
  CHECK(next == all.size());
  CHECK(largest < 20);
  CHECK(truth + truth_after() == truth_json(all, options));
}

TEST_CASE("a scan comes with the models that were scanned") {
  const auto models = clean(2, 3);
  for (const bool is_drone : {false, true}) {
    const SynthOptions options = {
        .buildings = 2, .seed = 3, .is_scan = !is_drone, .is_drone = is_drone, .density = 6};
    int batches = 0;
    stream_neighbourhood(options, [&](const SynthBatch& batch) {
      ++batches;
      REQUIRE(batch.clean.size() == 2);
      for (std::size_t i = 0; i < 2; ++i) {
        CHECK(is_equal(batch.clean[i], models[i]));
        CHECK_FALSE(is_equal(batch.buildings[i], models[i]));
      }
    });
    CHECK(batches == 1);
  }
}

TEST_CASE("a scan follows its building, open below, with holes and floaters") {
  const SynthOptions options = {.buildings = 3, .seed = 2, .is_scan = true, .density = 25};
  const auto scans = make_neighbourhood(options), models = clean(3, 2);
  int floaters = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Mesh &scan = scans[i].source.mesh, &model = models[i].source.mesh;
    const Validity v = check_validity(scan, false);
    CHECK(v.boundary_edges > 0);
    CHECK(v.components > 1);
    CHECK(v.nonmanifold_edges == 0);
    CHECK(v.area < 1.1 * surface_area(model));
    CHECK(v.area > 0.4 * surface_area(model));
    const Distances d = measure_distances(scan, model, {.samples = 20000});
    CHECK(d.mean_a_to_b > 0.01);
    CHECK(d.mean_a_to_b < 0.1);
    REQUIRE(scans[i].source.face_object.size() == scan.faces.size());
    for (int object : scans[i].source.face_object) {
      CHECK(object < static_cast<int>(scans[i].parts.size()));
      floaters += object < 0;
    }
    CHECK(scans[i].parts.size() == models[i].parts.size());
  }
  CHECK(floaters > 50);
}

TEST_CASE("a scan's roof faces the sky and there is no floor") {
  const auto scan = make_neighbourhood({.buildings = 1, .seed = 6, .is_scan = true, .density = 20});
  const Mesh& mesh = scan[0].source.mesh;
  double up = 0, down = 0, floor = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Vec3 cross = face_cross(mesh, mesh.faces[f]);
    if (scan[0].source.face_object[f] == 1) (cross.z() > 0 ? up : down) += cross.norm() / 2;
    if (std::abs(cross.z()) > 0.9 * cross.norm() && mesh.vertices[mesh.faces[f][0]].z() < 0.05)
      floor += cross.norm() / 2;
  }
  CHECK(up > 20 * down);
  CHECK(floor < 1);
}

TEST_CASE("a scan is the same with one thread and two") {
  const SynthOptions options = {.buildings = 2, .seed = 3, .is_scan = true, .density = 12};
  limit_threads(1);
  const auto one = make_neighbourhood(options);
  limit_threads(2);
  const auto two = make_neighbourhood(options);
  limit_threads(0);
  for (std::size_t i = 0; i < one.size(); ++i) CHECK(is_equal(one[i], two[i]));
}

TEST_CASE("nothing to build is an error") {
  CHECK_THROWS_AS(make_neighbourhood({.buildings = 0}), Error);
  CHECK_THROWS_AS(make_neighbourhood({.buildings = 1, .density = 0}), Error);
}
