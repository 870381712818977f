// The tree, stand-ins, cells and places of tilesets; exporters.test.cpp looks into single tiles.
#include "exporters/tiles3d/tiles3d.h"

#include <catch2/catch.hpp>
#include <functional>
#include <map>
#include <mutex>
#include <numeric>
#include <set>

#include "exporters/tiles3d/standins.h"
#include "exporters/tiles3d/tree.h"
#include "exporters_helpers.h"
#include "measure/deviation.h"

using namespace colod;
using namespace colod::test;
using Json = nlohmann::json;

namespace {

using Transform = std::array<double, 16>;
constexpr Transform kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Transform product(const Transform& a, const Transform& b) {
  Transform out{};
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      for (int k = 0; k < 4; ++k) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
  return out;
}

Vec3 apply(const Transform& t, const Vec3& p) {
  Vec3 out;
  for (int r = 0; r < 3; ++r)
    out[r] = t[r] * p.x() + t[4 + r] * p.y() + t[8 + r] * p.z() + t[12 + r];
  return out;
}

/// A tile as a client meets it: external tilesets opened, transforms multiplied.
struct Met {
  Json tile;
  Transform transform;
  std::string folder;
  double above;  // the parent's error
  int depth;
};

std::vector<Met> walk(const std::vector<Encoded>& files) {
  std::vector<Met> out;
  std::vector<Met> open = {{Json::parse(files.front().bytes)["root"], kIdentity, "", 1e300, 0}};
  while (!open.empty()) {
    Met met = open.back();
    open.pop_back();
    if (met.tile.contains("transform"))
      met.transform = product(met.transform, met.tile["transform"].get<Transform>());
    out.push_back(met);
    const double error = met.tile["geometricError"];
    const std::string uri = met.tile["content"]["uri"];
    if (uri.ends_with(".json")) {
      const std::string path =
          std::filesystem::path(met.folder + uri).lexically_normal().generic_string();
      const std::string folder = path.substr(0, path.rfind('/') + 1);
      open.push_back({Json::parse(find(files, path).bytes)["root"], met.transform, folder, error,
                      met.depth + 1});
    }
    for (const Json& child : met.tile.value("children", Json::array()))
      open.push_back({child, met.transform, met.folder, error, met.depth + 1});
  }
  return out;
}

std::size_t triangles_of(const Encoded& file) {
  const Json json = parse_glb(file.bytes).json;
  return json["accessors"][json["meshes"][0]["primitives"][0]["indices"].get<int>()]["count"]
             .get<std::size_t>() /
         3;
}

/// A street of closed terraces with more detail than boxes have.
std::vector<ExportBuilding> detailed_street(int n) {
  std::vector<ExportBuilding> buildings = street(n);
  for (ExportBuilding& b : buildings) {
    Mesh mesh = gable_house(12.3, 8.1, 5.7, 3.3);
    for (int k = 0; k < 40; ++k)
      mesh = join(mesh, box_mesh({0.3 * k, 8.2, 1}, {0.3 * k + 0.2, 8.4, 2}));
    b.levels.back().mesh = as_polygons(mesh);
  }
  return buildings;
}

/// A tree with nothing taken away.
struct WholePlan {
  explicit WholePlan(const std::vector<ExportBuilding>& buildings,
                     std::size_t most_entries = kMostEntries) {
    std::vector<TileOutline> outlines;
    for (const ExportBuilding& b : buildings) outlines.push_back(outline_of(b));
    root = plan_tiles(outlines,
                      {.open = [](const std::vector<int>&) {},
                       .at = [&](int b) -> const ExportBuilding& { return buildings[b]; },
                       .finish = [](PlannedTile&) {}},
                      {}, most_entries);
    show_boxes(root, meshes);
  }

  PlannedTile root;
  std::deque<PolygonMesh> meshes;
};

}  // namespace

TEST_CASE("a deviation is that of every point of the lattice, though few are asked") {
  const Mesh house = test::gable_house(12, 9, 6, 4), ball = test::sphere_mesh(2);
  Mesh far_ball = ball;
  for (Vec3& p : far_ball.vertices) p = 3 * p + Vec3(5, 4, 7);
  const Mesh scene = test::join(house, far_ball);
  for (const auto& [from, to] :
       {std::pair{&house, &scene}, {&scene, &house}, {&far_ball, &house}}) {
    const RayScene target(*to);
    double worst = 0;
    for (const Face& f : from->faces) {
      const Vec3 &a = from->vertices[f[0]], u = from->vertices[f[1]] - a,
                 v = from->vertices[f[2]] - a;
      const int n = std::ceil(std::max({u.norm(), v.norm(), (u - v).norm()}) / 0.3);
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n - i; ++j)
          worst =
              std::max(worst, target.nearest(a + (1.0 * i / n) * u + (1.0 * j / n) * v).distance);
    }
    CHECK(one_sided_deviation(*from, target, 0.3) == Approx(worst).margin(1e-5));
    CHECK(one_sided_deviation(*from, target, 0.3, 99) == 99);
  }
}

TEST_CASE("a box stands for a box without deviation, wherever it is turned") {
  for (const double angle : {0.0, 0.4, 1.2}) {
    Mesh mesh = box_mesh({-6, -4, 0}, {6, 4, 7});
    for (Vec3& p : mesh.vertices) p = Eigen::AngleAxisd(angle, Vec3::UnitZ()) * p;
    const ExportBuilding b{"box", "", {100, 200, 3}, {{{0}, as_polygons(mesh), 0, 0}}, ""};
    const StandInBox box = stand_in_for(b, 5);
    CHECK(box.buildings == std::vector<int>{5});
    CHECK(box.error == Approx(0).margin(1e-5));
    CHECK((box.origin - Vec3(100, 200, 3)).norm() < 1e-6);
    CHECK(box.half.x() * box.half.y() == Approx(24));
    CHECK(box.half.z() == Approx(7));
  }
}

TEST_CASE("no vertex of a building is farther from its stand-in than the error says") {
  const ExportBuilding house = three_layers("house", Vec3::Zero());
  const StandInBox box = stand_in_for(house, 0);
  const RayScene scene(mesh_of(box).mesh());
  for (const Vec3& p : house.levels.back().mesh.vertices)
    if (p.z() > 0.1) CHECK(scene.nearest(p - box.origin).distance <= box.error);
  CHECK(box.error < 4);
  const RayScene finest(house.levels.back().mesh.mesh());
  for (const Vec3& p : mesh_of(box).vertices)
    CHECK(finest.nearest(p + box.origin).distance <= box.error);
}

TEST_CASE("a box is shown from farther away than the level that it stands for, and by one gsd") {
  std::vector<ExportBuilding> buildings = street(5);
  for (ExportLevel& level : buildings[1].levels)
    for (Vec3& p : level.mesh.vertices) p *= 1.5;
  for (const std::string measure : {"visual", "deviation"}) {
    std::vector<StandInBox> boxes;
    for (const ExportBuilding& b : buildings) {
      boxes.push_back(stand_in_for(b, static_cast<int>(boxes.size()),
                                   {.measure = measure, .visual_error = 2, .layer_gsd = {}}));
      CHECK(boxes.back().gsd > 1.15 * b.levels.front().gsd);
    }
    std::vector<double> own;
    for (const StandInBox& box : boxes) own.push_back(box.gsd);
    CHECK(std::set<double>(own.begin(), own.end()).size() > 1);
    CHECK_FALSE(shared_gsd(own, {.scope = "building", .layer_gsd = {}}));
    const std::optional<double> shared = shared_gsd(own, {.layer_gsd = {0.6, 0.3, 0}});
    REQUIRE(shared);
    CHECK(*shared >= *std::min_element(own.begin(), own.end()));
    CHECK(*shared > 0.7);
  }
}

TEST_CASE("what merging adds to a box counts by its pixels") {
  const std::vector<ExportBuilding> two = {three_layers("a", Vec3::Zero()),
                                           three_layers("b", {40, 0, 0})};
  const StandInBox a = stand_in_for(two[0], 0), b = stand_in_for(two[1], 1);
  const StandInBox merged = merge_stand_ins({a, b}, 1)[0];
  CHECK(merged.gsd == Approx((merged.error - std::max(a.error, b.error)) / 2));
  CHECK(merged.gsd > std::max(a.gsd, b.gsd));
}

TEST_CASE("merging stand-ins keeps every building and adds up errors") {
  std::vector<StandInBox> boxes;
  for (const ExportBuilding& b : street(12))
    boxes.push_back(stand_in_for(b, static_cast<int>(boxes.size())));
  const double before = boxes[0].error;
  for (const std::size_t most : {7u, 3u, 1u}) {
    boxes = merge_stand_ins(std::move(boxes), most);
    CHECK(boxes.size() == most);
    std::vector<int> all;
    for (const StandInBox& box : boxes)
      all.insert(all.end(), box.buildings.begin(), box.buildings.end());
    std::sort(all.begin(), all.end());
    std::vector<int> expected(12);
    std::iota(expected.begin(), expected.end(), 0);
    CHECK(all == expected);
    CHECK(
        std::max_element(boxes.begin(), boxes.end(), [](const StandInBox& a, const StandInBox& b) {
          return a.error < b.error;
        })->error > before);
  }
}

TEST_CASE("a stand-in's walls and top face outwards") {
  const StandInBox box{{0}, Vec3::Zero(), 0.3, {3, 2, 5}, 0};
  const PolygonMesh mesh = mesh_of(box);
  CHECK(mesh.triangles.size() == kStandInTriangles);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 n = face_cross(mesh.mesh(), mesh.triangles[t]);
    CHECK(n.dot(mesh.vertices[mesh.triangles[t][0]] - Vec3(0, 0, 2.5)) > 0);
    CHECK(n.normalized().dot(mesh.facets[mesh.facet_of_triangle[t]].normal) > 0.999);
  }
}

TEST_CASE("what a mesh adds to another counts as deviation as much as what it lacks") {
  const Mesh gable = gable_house(12.3, 8.1, 5.7, 3.3);
  const Mesh with_chimney = join(gable, box_mesh({2.1, 2.2, 7.5}, {2.9, 3.1, 10.4}));
  const RayScene less(gable), more(with_chimney);
  CHECK(two_sided_deviation(gable, less, with_chimney, more) == Approx(2.25).margin(0.1));
  CHECK(two_sided_deviation(with_chimney, more, gable, less) == Approx(2.25).margin(0.1));
  CHECK(two_sided_deviation(gable, less, gable, less) == Approx(0).margin(1e-5));
  CHECK(two_sided_deviation(gable, less, gable, less, 3) == 3);
}

TEST_CASE("at the far end stand at most 5 % of the finest triangles and bytes") {
  constexpr double kLeastFile = 2800;  // bytes of the GLB of one box, with names
  for (const int n : {1, 2, 6, 16, 25, 40}) {
    const std::vector<Encoded> files = encode_tileset(detailed_street(n));
    double triangles = 0, bytes = 0;
    for (const Met& met : walk(files)) {
      CHECK(met.tile["geometricError"].get<double>() < met.above);
      if (met.tile["geometricError"] != 0) continue;
      const Encoded& file = find(files, met.folder + met.tile["content"]["uri"].get<std::string>());
      triangles += static_cast<double>(triangles_of(file));
      bytes += static_cast<double>(file.bytes.size());
    }
    const Encoded& root = find(files, "tiles/root.glb");
    INFO(n << " buildings, " << bytes << " bytes");
    CHECK(triangles_of(root) <= 0.05 * triangles);
    if (0.05 * bytes >= kLeastFile) CHECK(root.bytes.size() <= 0.05 * bytes);
    if (0.05 * bytes < 2000)
      CHECK(triangles_of(root) == static_cast<std::size_t>(kStandInTriangles * n));
  }
}

TEST_CASE("levels that come cell by cell give the tileset that levels in memory give") {
  std::vector<ExportBuilding> all = detailed_street(300);
  for (std::size_t i = 0; i < all.size(); ++i) {  // colours reach up to the root's boxes
    LevelLook& look = all[i].levels.front().look;
    look.facet_colors.assign(all[i].levels.front().mesh.facets.size(),
                             {static_cast<std::uint8_t>(i), 120, 60});
  }
  std::vector<Encoded> expected = encode_tileset(all);
  std::vector<TileOutline> outlines;
  std::vector<ExportBuilding> bare = all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    outlines.push_back(outline_of(all[i]));
    for (ExportLevel& level : bare[i].levels) level.mesh = {}, level.look = {};
  }
  std::mutex mutex;
  int there = 0, most = 0;
  std::vector<Encoded> made;
  const LevelDepot depot{.open = [](const std::vector<int>&) {},
                         .close = [] {},
                         .at = [&](int b) -> const ExportBuilding& { return bare[b]; },
                         .get =
                             [&](int b) {
                               for (std::size_t k = 0; k < all[b].levels.size(); ++k)
                                 bare[b].levels[k] = all[b].levels[k];
                               const std::lock_guard lock(mutex);
                               most = std::max(most, ++there);
                             },
                         .drop =
                             [&](int b) {
                               for (ExportLevel& level : bare[b].levels)
                                 level.mesh = {}, level.look = {};
                               const std::lock_guard lock(mutex);
                               --there;
                             },
                         .named = [&](int b) { return bare[b]; },
                         .coarsest = [&](int b) { return coarsest_look(all[b].levels.front()); }};
  const std::vector<Encoded> rest =
      encode_tileset(outlines, depot, {}, [&](const Encoded& f) { made.push_back(f); });
  REQUIRE(!made.empty());
  CHECK(rest.front().path == "tileset.json");
  CHECK(there == 0);
  CHECK(most < 256);  // of 300: never all at once
  made.push_back(rest.front());
  REQUIRE(rest.size() == expected.size());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    CHECK(rest[i].path == expected[i].path);
    CHECK(rest[i].bytes.empty() == (i > 0));
  }
  const auto by_path = [](const Encoded& a, const Encoded& b) { return a.path < b.path; };
  std::sort(made.begin(), made.end(), by_path);
  std::sort(expected.begin(), expected.end(), by_path);
  REQUIRE(made.size() == expected.size());
  for (std::size_t i = 0; i < made.size(); ++i) {
    INFO(made[i].path);
    CHECK(made[i].path == expected[i].path);
    CHECK(made[i].bytes == expected[i].bytes);
  }
}

TEST_CASE("tiles that would be made from the same again are left as they are") {
  std::vector<ExportBuilding> all = detailed_street(300);
  std::vector<TileOutline> outlines;
  for (const ExportBuilding& b : all) outlines.push_back(outline_of(b));
  std::map<std::string, std::string> disk;
  std::map<std::string, std::map<std::string, TileFacts>> memory;
  KeptTiles kept{
      .keys = std::vector<BuildingKey>(all.size(), {1, 2}),
      .find = [&](const std::string& folder, const std::string& path,
                  const std::string& key) -> std::optional<TileFacts> {
        const auto found = memory[folder].find(path);
        if (found == memory[folder].end() || found->second.key != key) return {};
        return found->second;
      },
      .put = [&](const std::string& folder, const auto& facts) { memory[folder] = facts; }};
  std::mutex mutex;
  std::set<int> asked;
  const LevelDepot depot{.open = [](const std::vector<int>&) {},
                         .close = [] {},
                         .at = [&](int b) -> const ExportBuilding& { return all[b]; },
                         .get =
                             [&](int b) {
                               const std::lock_guard lock(mutex);
                               asked.insert(b);
                             },
                         .drop = [](int) {},
                         .named = [&](int b) { return all[b]; },
                         .coarsest = [&](int b) { return coarsest_look(all[b].levels.front()); }};
  const auto encode = [&] {
    std::set<std::string> made;
    const auto take = [&](const Encoded& f) { disk[f.path] = f.bytes, made.insert(f.path); };
    take(encode_tileset(outlines, depot, {.kept = &kept}, take).front());
    return made;
  };
  const auto check_whole = [&] {
    const std::vector<Encoded> expected = encode_tileset(all);
    std::set<std::string> paths;
    for (const Encoded& file : expected) paths.insert(file.path);
    for (const auto& [path, bytes] : disk) {
      INFO(path);
      CHECK(paths.contains(path));
    }
    REQUIRE(disk.size() == expected.size());
    for (const Encoded& file : expected) {
      INFO(file.path);
      CHECK(disk[file.path] == file.bytes);
    }
  };
  const std::set<std::string> first = encode();
  CHECK(first.size() == disk.size());
  CHECK(asked.size() == all.size());
  check_whole();

  asked.clear();
  for (const std::string& path : encode()) CHECK(path.find(".glb") == path.npos);
  CHECK(asked.empty());
  check_whole();

  for (ExportLevel& level : all[7].levels)  // inside its box, so that all tiles keep their places
    for (Vec3& v : level.mesh.vertices)
      if (v.z() > 1 && v.z() < 2.9) v.z() -= 0.5;
  all[7].given_name = "house 7, rebuilt";
  kept.keys[7] = {1, 3};
  outlines[7] = outline_of(all[7]);
  const std::set<std::string> again = encode();
  CHECK(again.contains("tiles/root.glb"));
  CHECK(again.size() < first.size() / 4);
  CHECK(asked.size() <= 16);
  CHECK(asked.contains(7));
  check_whole();
}

TEST_CASE("a building without detail has a box far away all the same") {
  const std::vector<ExportBuilding> one = street(1);
  const std::vector<Encoded> files = encode_tileset(one);
  CHECK(triangles_of(find(files, "tiles/root.glb")) == kStandInTriangles);
  CHECK(walk(files).size() == 4);
}

TEST_CASE("below a group each finer level gets a tile, and a lone level its own again") {
  const auto levels_below_group = [](std::size_t count) {
    ExportBuilding house = three_layers("house", Vec3::Zero());
    house.levels.erase(house.levels.begin(), house.levels.end() - static_cast<long>(count));
    const std::vector<ExportBuilding> buildings = {house, three_layers("other", Vec3::Zero())};
    std::vector<int> shown;
    const WholePlan plan(buildings);
    const PlannedTile& boxes = plan.root.children.at(0);
    const PlannedTile* tile = &boxes.children.at(0).children.at(0);
    while (true) {
      shown.push_back(tile->parts.at(0).level->layers.back());
      CHECK(tile->is_finest == tile->children.empty());
      if (tile->children.empty()) return shown;
      tile = &tile->children.at(0);
    }
  };
  CHECK(levels_below_group(3) == std::vector{1, 2});
  CHECK(levels_below_group(2) == std::vector{1, 2});  // its first switches nearer than the group
  CHECK(levels_below_group(1) == std::vector{2});     // its grid is finer
}

TEST_CASE("every tile shows the buildings below it, each once, and no other") {
  const std::vector<ExportBuilding> buildings = street(300);
  const WholePlan plan(buildings);
  const std::function<std::set<int>(const PlannedTile&)> check = [&](const PlannedTile& tile) {
    std::vector<int> shown;
    for (const TilePart& part : tile.parts)
      shown.insert(shown.end(), part.buildings.begin(), part.buildings.end());
    const std::set<int> own(shown.begin(), shown.end());
    CHECK(own.size() == shown.size());
    std::set<int> below;
    for (const PlannedTile& child : tile.children) below.merge(check(child));
    CHECK((tile.children.empty() || below == own));
    return own;
  };
  CHECK(check(plan.root).size() == 300);
}

TEST_CASE("beyond 256 buildings cells are tilesets of their own; errors fall, boxes nest") {
  const std::vector<ExportBuilding> buildings = street(300);
  const std::vector<Encoded> files = encode_tileset(buildings);
  std::size_t cells = 0;
  std::set<std::string> finest;
  for (const Met& met : walk(files)) {
    const std::string uri = met.tile["content"]["uri"];
    CHECK(met.tile["geometricError"].get<double>() < met.above);
    CHECK((met.tile.contains("children") || uri.ends_with(".json") ||
           met.tile["geometricError"] == 0));
    CHECK(met.tile.value("children", Json::array()).size() <= 16);
    if (uri.ends_with("/tileset.json")) ++cells;
    for (const Json& child : met.tile.value("children", Json::array())) {
      Box inner = box_of(child), moved;
      const Transform t = child.value("transform", kIdentity);
      for (const double x : {inner.min.x(), inner.max.x()})
        for (const double y : {inner.min.y(), inner.max.y()})
          for (const double z : {inner.min.z(), inner.max.z()}) moved.extend(apply(t, {x, y, z}));
      const Box outer = box_of(met.tile);
      CHECK((moved.min - outer.min).minCoeff() >= -1e-9);
      CHECK((outer.max - moved.max).minCoeff() >= -1e-9);
    }
    if (met.tile["geometricError"] == 0 && met.tile.contains("extras"))
      finest.insert(met.tile["extras"]["building"].get<std::string>());
  }
  CHECK(cells == 4);
  CHECK(finest.size() == 300);
}

TEST_CASE("with a place on Earth every vertex lands where its world point belongs") {
  // A map with turn, scale and curvature, as a projection has.
  const auto to_ecef = [](const Vec3& p) {
    const Vec3 q = p - Vec3(691234, 5334567, 512);
    const double sag = (q.x() * q.x() + q.y() * q.y()) / 12.8e6;
    return Vec3(Vec3(3.9e6, 0.8e6, 4.9e6) + Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()) *
                                                Vec3(1.0004 * q.x(), 1.0004 * q.y(), q.z() - sag));
  };
  const std::vector<ExportBuilding> buildings = street(300);
  const auto files = encode_tileset(buildings, {.placement = {to_ecef, "test"}});
  CHECK(Json::parse(files.front().bytes)["asset"]["extras"]["crs"] == "test");
  std::map<std::string, const ExportBuilding*> by_name;
  for (const ExportBuilding& b : buildings) by_name[b.name] = &b;
  int checked = 0;
  for (const Met& met : walk(files)) {
    if (!met.tile.contains("extras") || met.tile["geometricError"] != 0) continue;
    const ExportBuilding& b = *by_name.at(met.tile["extras"]["building"]);
    const Glb glb =
        parse_glb(find(files, met.folder + met.tile["content"]["uri"].get<std::string>()).bytes);
    const Decoded decoded = decode_mesh(glb, 0);
    Box seen, expected;
    for (const Vec3& p : decoded.mesh.vertices)
      seen.extend(apply(met.transform, {p.x(), -p.z(), p.y()}));
    for (const Vec3& p : b.levels.back().mesh.vertices) expected.extend(to_ecef(p + b.origin));
    CHECK((seen.min - expected.min).norm() < 0.01);
    CHECK((seen.max - expected.max).norm() < 0.01);
    ++checked;
  }
  CHECK(checked == 300);
}
