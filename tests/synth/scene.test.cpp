// Made-up scenes: one surface in tiles, and what is true of it.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "exporters/files.h"
#include "measure/metrics.h"
#include "read/airborne.h"
#include "read/tileset.h"
#include "synth/scene_files.h"
#include "tests/temporary_folder.h"

using namespace colod;
using test::TemporaryFolder;

namespace {

using Edge = std::array<double, 6>;

/// Edges that one face has, as places from start to end.
std::set<Edge> open_edges(const Mesh& mesh, bool is_reversed = false) {
  std::map<std::pair<int, int>, int> count;
  for (const Face& f : mesh.faces)
    for (int k = 0; k < 3; ++k) ++count[{f[k], f[(k + 1) % 3]}];
  std::set<Edge> out;
  for (const auto& [edge, n] : count) {
    if (count.count({edge.second, edge.first})) continue;
    const Vec3 a = mesh.vertices[is_reversed ? edge.second : edge.first];
    const Vec3 b = mesh.vertices[is_reversed ? edge.first : edge.second];
    out.insert({a.x(), a.y(), a.z(), b.x(), b.y(), b.z()});
  }
  return out;
}

double area_of(const std::vector<Vec2>& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

/// Cells of each building in all tiles.
std::map<int, int> truth_cells(const SynthScene& scene) {
  std::map<int, int> cells;
  for (int t = 0; t < scene.tile_count(); ++t) {
    const Raster truth = scene.tile(t).truth;
    for (int y = 0; y < truth.height; ++y)
      for (int x = 0; x < truth.width; ++x) {
        const std::uint8_t* p = truth.at(x, y);
        const int number = 256 * p[1] + p[2];
        CHECK((number > 0) == (p[0] == static_cast<int>(SynthClass::kBuilding)));
        if (number > 0) ++cells[number];
      }
  }
  return cells;
}

}  // namespace

TEST_CASE("a scene's tiles are the same each time and with any number of threads") {
  const SynthScene scene({.buildings = 6, .seed = 3, .texel = 0.4});
  const SynthTile a = scene.tile(0);
  SynthTile b;
  in_threads(1, [&] { b = SynthScene({.buildings = 6, .seed = 3, .texel = 0.4}).tile(0); });
  CHECK(a.mesh.vertices == b.mesh.vertices);
  CHECK(a.mesh.faces == b.mesh.faces);
  CHECK(a.picture.rgb == b.picture.rgb);
  CHECK(a.truth.rgb == b.truth.rgb);
  CHECK(a.face_class == b.face_class);
  CHECK(a.face_class.size() == a.mesh.faces.size());
  CHECK(SynthScene({.buildings = 6, .seed = 5, .texel = 0.4}).tile(0).mesh.vertices !=
        a.mesh.vertices);
}

TEST_CASE("neighbouring tiles of a scene share their border, edge by edge") {
  const SynthScene scene({.buildings = 12, .seed = 1, .texel = 0.4});
  REQUIRE(scene.tile_count() >= 2);
  const Mesh a = scene.tile(0).mesh, b = scene.tile(1).mesh;
  const std::set<Edge> left = open_edges(a), right = open_edges(b, true);
  const double border = scene.box().min.x() + 128 * 0.48;
  int near = 0, shared = 0;
  for (const Edge& e : left) {
    if (std::abs(e[0] - border) > 0.5 || std::abs(e[3] - border) > 0.5) continue;
    ++near;
    shared += right.count(e) > 0;
  }
  CHECK(near > 100);
  CHECK(shared >= 0.98 * near);  // torn holes may reach it
}

TEST_CASE("a scene has as many buildings as were asked for, of all kinds, each closed") {
  const SynthScene scene({.buildings = 100, .seed = 1});
  REQUIRE(scene.building_count() == 100);
  std::map<std::string, int> kinds;
  int in_rows = 0;
  for (int i = 0; i < 100; ++i) {
    const SynthSceneBuilding b = scene.building(i);
    INFO(b.id << " " << b.kind);
    ++kinds[b.kind];
    in_rows += b.row != 0;
    CHECK(b.height > 2);
    const Validity v = check_validity(b.model.source.mesh);
    CHECK(v.is_watertight);
    CHECK(v.volume > 15);
  }
  for (const char* kind : {"house", "row_house", "court", "hall", "office", "shed"}) {
    INFO(kind);
    CHECK(kinds[kind] > 0);
  }
  CHECK(in_rows == kinds["row_house"]);
  CHECK_THROWS_AS(SynthScene({.buildings = 0}), Error);
}

TEST_CASE("a scene's footprints are where its truth has buildings") {
  const SynthScene scene({.buildings = 14, .seed = 3, .texel = 0.8});
  const std::map<int, int> cells = truth_cells(scene);
  const double cell = scene.truth_cell() * scene.truth_cell();
  double all = 0, seen = 0;
  for (int i = 0; i < scene.building_count(); ++i) {
    const SynthSceneBuilding b = scene.building(i);
    double area = 0;
    for (const auto& ring : b.rings) area += area_of(ring);  // courts turn the other way
    INFO(b.id << " " << b.kind << " " << area);
    REQUIRE(cells.count(i + 1) == 1);
    // Trees cover some of it; balconies and bays reach beyond.
    CHECK(cells.at(i + 1) * cell > 0.6 * area);
    CHECK(cells.at(i + 1) * cell < 1.25 * area);
    all += area, seen += cells.at(i + 1) * cell;
  }
  CHECK(seen > 0.85 * all);
  CHECK(seen < 1.08 * all);
}

TEST_CASE("a scene's tiles come back through the reader in each layout") {
  const TemporaryFolder folder;
  const SynthTile tile = SynthScene({.buildings = 2, .seed = 1, .texel = 0.8}).tile(0);
  const std::string out = folder.path().string();
  ObjCount count;
  write_file(out,
             {"obj/Data/Tile_0/Tile_0.obj", "mtllib Tile_0.mtl\n" + tile_obj(tile, "one", count)});
  write_file(out, {"obj/Data/Tile_0/Tile_0.mtl", tile_mtl("one", "Tile_0_0.jpg")});
  write_file(out, {"obj/Data/Tile_0/Tile_0_0.jpg", tile_jpeg(tile)});
  CHECK(count.vertices == tile.mesh.vertices.size());
  write_file(out, {"tiles3d/Tiles/" + tile.name + ".b3dm", tile_b3dm(tile)});
  write_file(
      out, {"tiles3d/tileset.json", tileset_json({tile.name}, {bounding_box(tile.mesh.vertices)})});
  for (const char* input : {"/obj", "/tiles3d/tileset.json"}) {
    INFO(input);
    std::string why;
    CHECK(is_tiled_scene(out + input, why));
    const TileTree tree = list_tiles(out + input);
    const std::vector<int> nodes = finest_nodes(tree);
    REQUIRE(nodes.size() == 1);
    const TileNode& node = tree.nodes[nodes[0]];
    const Source read = read_tile(node, node.contents[0], Eigen::Matrix4d::Identity());
    CHECK(read.mesh.faces.size() > 0.999 * tile.mesh.faces.size());
    CHECK(read.look.images.size() == 1);
    const Box a = bounding_box(read.mesh.vertices), b = bounding_box(tile.mesh.vertices);
    CHECK((a.min - b.min).norm() < 1e-3);
    CHECK((a.max - b.max).norm() < 1e-3);
  }
}

TEST_CASE(
    "an airborne cloud of a scene comes back through the reader, on roofs and on the ground") {
  const double density = GENERATE(2, 9);
  const SynthScene scene({.buildings = 3, .seed = 1, .density = density});
  std::vector<SynthPoint> points;
  for (int i = 0; i < scene.tile_count(); ++i)
    for (const SynthPoint& p : scene.points(i)) points.push_back(p);
  Box box;
  for (const SynthPoint& p : points) box.extend(p.at);
  const Vec3 size = scene.box().size();
  CHECK(static_cast<double>(points.size()) == Approx(density * size.x() * size.y()).epsilon(0.02));
  const TemporaryFolder folder;
  write_file(folder.path().string(),
             {"a.las", las_header(points.size(), box) + las_points(points)});
  std::size_t i = 0;
  bool is_right = true;
  AirborneCloud((folder / "a.las").string(), {}).visit([&](const AirbornePoint& p) {
    is_right &= (p.at - points[i].at).norm() < 1e-3 && p.kind == points[i].kind;
    ++i;
  });
  CHECK(i == points.size());
  CHECK(is_right);
  double built = 0, plan = 0;
  for (const SynthPoint& p : points) built += p.kind == 6 ? 1 / density : 0;
  for (int b = 0; b < 3; ++b) {
    const auto rings = scene.building(b).rings;
    for (const auto& ring : rings) {
      double twice = 0;
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const Vec2 &p = ring[k], &q = ring[(k + 1) % ring.size()];
        twice += p.x() * q.y() - p.y() * q.x();
      }
      plan += (&ring == &rings[0] ? 0.5 : -0.5) * std::abs(twice);
    }
  }
  CHECK(built == Approx(plan).epsilon(0.06));
}

TEST_CASE("a scene's footprints are a collection in its own metres") {
  const SynthScene scene({.buildings = 9, .seed = 1});
  std::vector<SynthSceneBuilding> buildings;
  for (int i = 0; i < 9; ++i) buildings.push_back(scene.building(i));
  const auto json = nlohmann::json::parse(scene_footprints(scene, buildings));
  CHECK(json.contains("frame"));
  REQUIRE(json["features"].size() == 9);
  const auto& ring = json["features"][0]["geometry"]["coordinates"][0];
  CHECK(ring.front() == ring.back());
  CHECK(json["features"][0]["properties"]["id"] == "b0001");
}
