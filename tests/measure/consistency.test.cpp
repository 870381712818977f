#include "measure/consistency.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <fstream>

#include "core/error.h"
#include "meshes.h"
#include "temporary_folder.h"

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

/// A quad as two faces.
void add_quad(Mesh& m, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const int base = static_cast<int>(m.vertices.size());
  m.vertices.insert(m.vertices.end(), {a, b, c, d});
  m.faces.push_back({base, base + 1, base + 2});
  m.faces.push_back({base, base + 2, base + 3});
}

/// An opening in the front (y = 0) of a body of 10 × 8 × 6 m; the pane is `depth` behind it.
struct Opening {
  double x0, x1, z0, z1, depth;
};

/// What is left of the front, then reveals, then the pane.
std::array<Mesh, 3> front_of(const Opening& o) {
  std::array<Mesh, 3> m;
  const auto at = [](double x, double y, double z) { return Vec3(x, y, z); };
  add_quad(m[0], at(0, 0, 0), at(o.x0, 0, 0), at(o.x0, 0, 6), at(0, 0, 6));
  add_quad(m[0], at(o.x1, 0, 0), at(10, 0, 0), at(10, 0, 6), at(o.x1, 0, 6));
  add_quad(m[0], at(o.x0, 0, o.z1), at(o.x1, 0, o.z1), at(o.x1, 0, 6), at(o.x0, 0, 6));
  if (o.z0 > 0)
    add_quad(m[0], at(o.x0, 0, 0), at(o.x1, 0, 0), at(o.x1, 0, o.z0), at(o.x0, 0, o.z0));
  const double d = o.depth;
  add_quad(m[1], at(o.x0, 0, o.z0), at(o.x0, d, o.z0), at(o.x0, d, o.z1), at(o.x0, 0, o.z1));
  add_quad(m[1], at(o.x1, 0, o.z0), at(o.x1, 0, o.z1), at(o.x1, d, o.z1), at(o.x1, d, o.z0));
  add_quad(m[1], at(o.x0, 0, o.z0), at(o.x1, 0, o.z0), at(o.x1, d, o.z0), at(o.x0, d, o.z0));
  add_quad(m[1], at(o.x0, 0, o.z1), at(o.x0, d, o.z1), at(o.x1, d, o.z1), at(o.x1, 0, o.z1));
  add_quad(m[2], at(o.x0, d, o.z0), at(o.x1, d, o.z0), at(o.x1, d, o.z1), at(o.x0, d, o.z1));
  return m;
}

Mesh without_front() {
  Mesh m = kBody;
  std::erase_if(m.faces, [&](const Face& f) {
    return std::all_of(f.begin(), f.end(), [&](int v) { return m.vertices[v].y() == 0; });
  });
  return m;
}

/// Body is object 0, the opening 1; whose the reveals are is not the same in all models.
Source house_with(const Opening& o, bool has_own_reveals) {
  const auto front = front_of(o);
  Mesh mesh = test::join(without_front(), front[0]);
  if (!has_own_reveals) mesh = test::join(mesh, front[1]);
  const std::size_t body = mesh.faces.size();
  if (has_own_reveals) mesh = test::join(mesh, front[1]);
  Source s = test::as_source(test::join(mesh, front[2]), "house");
  s.face_object.assign(body, 0);
  s.face_object.resize(s.mesh.faces.size(), 1);
  return s;
}

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

TEST_CASE("a recess is shown where its pane is, not where a wall closes it") {
  const std::vector<Opening> openings = {{4, 4.5, 2, 2.5, 0},
                                         {3, 4, 1, 2.5, 0},
                                         {2, 5, 0.5, 3, 0},
                                         {1, 9, 3, 3.6, 0},
                                         {4, 5, 0, 2, 0}};  // the last: a door
  for (Opening o : openings)
    for (const double depth : {0.05, 0.1, 0.3, 0.6})
      for (const double said : {-1.0, depth})
        for (const bool has_own_reveals : {true, false}) {
          o.depth = depth;
          CAPTURE(o.x0, o.z0, depth, said, has_own_reveals);
          const TruthBuilding windows{"house", {{ElementKind::kWindow, 1, 1, said}}, {0}};
          const Source source = house_with(o, has_own_reveals);
          const auto part_on = [&](const Mesh& layer) {
            return place_parts(source, windows, {layer}).at(0);
          };
          Opening shallow = o, deep = o;
          shallow.depth = 0.4 * depth, deep.depth = 1.2 * depth;
          const PlacedPart closed = part_on(kBody);
          CHECK(closed.is_seen);
          CHECK(closed.depth == Approx(depth));
          CHECK(closed.first == -1);
          CHECK(closed.near.at(0) < 0.05);
          CHECK(part_on(source.mesh).first == 0);
          CHECK(part_on(source.mesh).near.at(0) > 0.95);
          CHECK(part_on(house_with(shallow, true).mesh).first == -1);
          if (depth < 0.3) CHECK(part_on(house_with(deep, true).mesh).near.at(0) > 0.6);
        }
}

TEST_CASE("a pane that is flush with the wall is unseen; one in a bay is closed by the bay") {
  const TruthBuilding flush{"house", {{ElementKind::kWindow, 1, 1, -1}}, {0}};
  CHECK(!place_parts(house_with({3, 4, 1, 2.5, 0.01}, true), flush, {kBody}).at(0).is_seen);
  // The house of the opening stands as a bay (object 2) before a long wall (object 0).
  Source bay = house_with({3, 4, 1, 2.5, 0.1}, true);
  for (int& object : bay.face_object) object = object == 0 ? 2 : 1;
  const Mesh wall = test::box_mesh({-20, 8, 0}, {30, 9, 12});
  bay.mesh = test::join(bay.mesh, wall);
  bay.face_object.resize(bay.mesh.faces.size(), 0);
  const TruthBuilding truth{
      "house", {{ElementKind::kWindow, 1, 1, -1}, {ElementKind::kBay, 2, 1, -1}}, {0}};
  const auto parts = place_parts(bay, truth, {test::join(kBody, wall)});
  CHECK(parts.at(0).depth == Approx(0.1));
  CHECK(parts.at(0).first == -1);
  CHECK(parts.at(1).first == 0);
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
  const test::TemporaryFolder folder;
  const std::string path = (folder / "truth.json").string();
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
  CHECK_THROWS_AS(read_truth((folder / "none.json").string()), Error);
}
