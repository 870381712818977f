#include "measure/consistency.h"

#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>

#include "core/error.h"
#include "meshes.h"

using namespace colod;

namespace {

const Mesh kBody = test::box_mesh({0, 0, 0}, {10, 8, 6});
const Mesh kBay = test::box_mesh({2, -1, 1}, {4, 0, 3});

/// A body (object 0) with a bay of 1 m (object 1).
Source house() {
  Source s = test::as_source(test::join(kBody, kBay), "house");
  s.face_object.assign(12, 0);
  s.face_object.resize(24, 1);
  return s;
}

TruthBuilding truth(double depth = 1) { return {"house", {{ElementKind::kBay, 1, 1, depth}}, {0}}; }

PlacedPart placed(const std::string& building, ElementKind kind, int first) {
  PlacedPart p;
  p.building = building, p.kind = kind, p.first = first, p.is_seen = true, p.depth = 1;
  p.present.assign(3, 0);
  for (int k = std::max(0, first); first >= 0 && k < 3; ++k) p.present[k] = 1;
  return p;
}

}  // namespace

TEST_CASE("a part appears on the first layer that reaches it and from which on it stays") {
  const Mesh both = test::join(kBody, kBay);
  const auto first = [&](const std::vector<Mesh>& layers) {
    return place_parts(house(), truth(), layers).at(0).first;
  };
  CHECK(first({kBody, both, both}) == 1);
  CHECK(first({both, both, both}) == 0);
  CHECK(first({both, kBody, both}) == 2);
  CHECK(first({kBody, kBody, kBody}) == -1);
  // Half its relief is not enough, nearly all of it is.
  CHECK(first({kBody, test::join(kBody, test::box_mesh({2, -0.4, 1}, {4, 0, 3}))}) == -1);
  CHECK(first({kBody, test::join(kBody, test::box_mesh({2, -0.9, 1}, {4, 0, 3}))}) == 1);
}

TEST_CASE(
    "relief that the truth does not tell is measured; what the mesh does not show is unseen") {
  const auto parts = place_parts(house(), truth(-1), {kBody});
  CHECK(parts.at(0).depth == Approx(1).margin(0.1));
  Source bare = house();
  for (int& object : bare.face_object) object = 0;
  CHECK(!place_parts(bare, truth(), {kBody}).at(0).is_seen);
  CHECK_THROWS_AS(place_parts(test::as_source(kBody), truth(), {kBody}), Error);
}

TEST_CASE("the tally counts instances, those that never appear, and buildings that agree") {
  std::vector<PlacedPart> parts;
  for (const char* b : {"a", "b", "c"})
    for (int i = 0; i < 3; ++i) parts.push_back(placed(b, ElementKind::kDormer, 1));
  parts[8].first = 2, parts.push_back(placed("d", ElementKind::kDormer, -1));
  const auto types = tally_parts(parts, 3);
  REQUIRE(types.size() == 1);
  const TypeConsistency& t = types[0];
  CHECK(t.seen == 10);
  CHECK(t.never == 1);
  CHECK(t.first == std::vector<int>{0, 8, 1});
  CHECK(t.majority_layer == 1);
  CHECK(t.on_majority_layer == Approx(0.8));
  CHECK(t.of_appearing == Approx(8 / 9.0));
  CHECK(t.buildings == 4);
  CHECK(t.buildings_agreeing == Approx(0.5));
  CHECK(tally_parts({}, 3).empty());
}

TEST_CASE("truth files: synth's, labels, and what is neither") {
  const std::string path = "/tmp/colod-truth-test.json";
  const auto read = [&](const std::string& text) {
    std::ofstream(path) << text;
    return read_truth(path);
  };
  const Truth synth = read(R"({"buildings": [{"name": "a", "parts": [
    {"type": "body", "instance": 0, "level": 0, "depth": 0},
    {"type": "bay", "instance": 1, "level": 1, "depth": 0.8}]}]})");
  CHECK(synth.at(0).main_building == std::vector<int>{0});
  CHECK(synth.at(0).parts.at(0).depth == 0.8);
  CHECK(synth.at(0).parts.at(0).kind == ElementKind::kBay);
  const Truth labels = read(R"({"a": {"objects": [{"index": 4, "type": "WallSurface"},
    {"index": 2, "type": "BuildingInstallation", "function_guess_from_geometry": "chimney?"}]}})");
  CHECK(labels.at(0).main_building == std::vector<int>{4});
  CHECK(labels.at(0).parts.at(0).kind == ElementKind::kChimney);
  CHECK_THROWS_AS(read("{}"), Error);
  CHECK_THROWS_AS(read("[1"), Error);
  CHECK_THROWS_AS(read(R"({"buildings": [{"parts": 3}]})"), Error);
  std::remove(path.c_str());
  CHECK_THROWS_AS(read_truth(path), Error);
}
