#include "store/store.h"

#include <sqlite3.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "core/hash.h"
#include "meshes.h"
#include "pipeline/switches.h"
#include "publish/report.h"
#include "store/shelf.h"
#include "temporary_folder.h"

using namespace colod;

namespace {

/// A path that is free and is removed with the test.
struct TemporaryFile {
  test::TemporaryFolder folder;
  std::string path = (folder / "scene.colod").string();
};

Options small_options() {
  Options o;
  o.ns = 24;
  o.nr = 40;
  o.lambda = 0.123;
  o.visibility = Visibility::kEmbree;
  return o;
}

/// With a chimney, a bay and a step before its door.
Source house(const std::string& name, double w) {
  Mesh m = test::join(test::gable_house(w, 9, 6, 4), test::box_mesh({2, 3, 7}, {3, 4.2, 11}));
  m = test::join(m, test::box_mesh({4, -0.8, 2}, {6.5, 0.1, 4.5}));
  return test::as_source(test::join(m, test::box_mesh({1, -0.5, 0}, {2.2, 0.1, 0.35})), name);
}

}  // namespace

TEST_CASE("stages through a scene file give the report of a build in one go") {
  TemporaryFile file;
  const Options options = small_options();
  Scene direct = build_scene({{house("a", 12), house("b", 10)}, {}}, options);
  {
    Store store(file.path, true);
    store.put_options(options);
    int order = 0;
    for (const auto& [name, w] : {std::pair("a", 12.0), std::pair("b", 10.0)})
      store.put_segments(segment_building({house(name, w), 0, {}}, options), order++,
                         segments_key(house(name, w), options));
  }
  Store store(file.path, false);
  CHECK(store.options().lambda == options.lambda);
  CHECK(store.options().visibility == Visibility::kEmbree);
  REQUIRE(store.names() == std::vector<std::string>{"a", "b"});
  Scene staged;
  for (const std::string& name : store.names()) staged.buildings.push_back(store.building(name));
  analyze_scene(staged, store.options());
  store.put_coanalysis(staged);
  for (Building& b : staged.buildings) {
    CHECK(!store.has_layers_of_segments(b.source.name));
    store.put_layers_of_segments(b);
    Building again = store.building(b.source.name);
    mesh_building(again, store.options());
    store.put_meshes(again);
    CHECK(store.has_meshes(b.source.name));
    b = store.building(b.source.name);
  }
  for (Scene* s : {&direct, &staged}) {
    s->coanalysis_seconds = 0;
    for (Building& b : s->buildings) b.timings = {}, b.segments.visibility_seconds = 0;
    decide_switches(*s, options.layers, {});
  }
  CHECK(direct.switching.layers[0].gsd > direct.switching.layers[1].gsd);
  CHECK(report_json(staged, options, {}) == report_json(direct, options, {}));
}

TEST_CASE("the key follows content and the options that segments depend on, and no other") {
  const Options options = small_options();
  const std::string key = segments_key(house("a", 12), options);
  CHECK(key == segments_key(house("another name", 12), options));
  CHECK(key != segments_key(house("a", 12.001), options));
  Options other = options;
  other.ns = 25;
  CHECK(key != segments_key(house("a", 12), other));
  other = options;
  other.beta = 0.7;
  CHECK(key == segments_key(house("a", 12), other));
  other = options;
  other.rules = options.rules.without(Rule::kVolume);
  CHECK(key == segments_key(house("a", 12), other));
  other.rules = options.rules.without(Rule::kFloaters);
  CHECK(key != segments_key(house("a", 12), other));
}

TEST_CASE("other rules, and a colod with other ones, throw the meshes away") {
  TemporaryFile file;
  Options options = small_options();
  Scene scene = build_scene({{house("a", 12)}, {}}, options);
  const auto put = [&](Store& store) {
    store.put_segments(scene.buildings[0], 0, "key");
    store.put_layers_of_segments(scene.buildings[0]);
    store.put_meshes(scene.buildings[0]);
  };
  {
    Store store(file.path, true);
    store.put_options(options);
    put(store);
    store.put_options(options);
    CHECK(store.has_meshes("a"));
    options.rules = options.rules.without(Rule::kVolume);
    store.put_options(options);
    CHECK(!store.has_meshes("a"));
    CHECK(store.options().rules == options.rules);
    CHECK_NOTHROW(store.check_rules());
    put(store);
  }
  sqlite3* db = nullptr;
  REQUIRE(sqlite3_open(file.path.c_str(), &db) == SQLITE_OK);
  const std::string older = "an older colod", seal = hash_of(std::string("rules") + '\0' + older);
  sqlite3_exec(
      db,
      ("UPDATE meta SET value = '" + older + "', seal = '" + seal + "' WHERE key = 'rules'")
          .c_str(),
      nullptr, nullptr, nullptr);
  sqlite3_close(db);
  Store store(file.path, false);
  CHECK_THROWS_WITH(store.check_rules(), Catch::Contains("colod segment"));
  store.put_options(options);
  CHECK(!store.has_meshes("a"));
}

TEST_CASE("changed layers throw the meshes away, unchanged ones keep them") {
  TemporaryFile file;
  Scene scene = build_scene({{house("a", 12)}, {}}, small_options());
  Building& b = scene.buildings[0];
  Store store(file.path, true);
  store.put_segments(b, 0, "key");
  store.put_layers_of_segments(b);
  store.put_meshes(b);
  store.put_layers_of_segments(b);
  CHECK(store.has_meshes("a"));
  b.layer_of_segment.back() = 1 - std::min(b.layer_of_segment.back(), 1);
  store.put_layers_of_segments(b);
  CHECK(!store.has_meshes("a"));
}

TEST_CASE("what is no scene file is refused by name") {
  TemporaryFile file;
  CHECK_THROWS_WITH(Store(file.path, false), Catch::Contains(file.path));
  std::ofstream(file.path)
      << "this is text, and long enough to be read as a header of something else entirely";
  CHECK_THROWS_AS(Store(file.path, false), Error);
  CHECK_THROWS_AS(Store("/proc/no/such/place", true), Error);
}

TEST_CASE("a scene file of an older format is refused with what to do") {
  TemporaryFile file;
  sqlite3* db = nullptr;
  REQUIRE(sqlite3_open(file.path.c_str(), &db) == SQLITE_OK);
  sqlite3_exec(db, "PRAGMA user_version = 4; CREATE TABLE meta(key TEXT)", nullptr, nullptr,
               nullptr);
  sqlite3_close(db);
  CHECK_THROWS_WITH(Store(file.path, false),
                    Catch::Contains("format 4") && Catch::Contains("colod segment"));
}

TEST_CASE("numbers that are none, and tables that are none of ours, are refused") {
  TemporaryFile file;
  {
    Scene scene = build_scene({{house("a", 12)}, {}}, small_options());
    Store store(file.path, true);
    store.put_segments(scene.buildings[0], 0, "key");
    store.put_layers_of_segments(scene.buildings[0]);
    store.put_meshes(scene.buildings[0]);
  }
  const std::string good = file.path + ".good";
  std::filesystem::copy_file(file.path, good);
  const auto after = [&](const std::string& sql) {
    std::filesystem::copy_file(good, file.path, std::filesystem::copy_options::overwrite_existing);
    sqlite3* db = nullptr;
    REQUIRE(sqlite3_open(file.path.c_str(), &db) == SQLITE_OK);
    INFO(sql);
    REQUIRE(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK);
    sqlite3_close(db);
    CHECK_THROWS_WITH(Store(file.path, false).building("a"), Catch::Contains("damaged"));
  };
  for (const char* number : {"9e999", "-9e999", "1e308", "-1e300"})
    for (const char* column :
         {"building SET origin_x", "building SET origin_z", "building SET yaw",
          "building SET total_area", "plane SET normal_x", "plane SET plane_offset",
          "segment SET volume", "segment SET extent", "layer SET deviation"})
      after(std::string("UPDATE ") + column + " = " + number);
  const std::string nan = "X'000000000000F87F'", huge = "X'000000000000F07F'";
  for (const std::string& number : {nan, huge})
    for (const char* column : {"building SET vertices", "layer SET vertices",
                               "plane SET outline_vertices", "segment SET eigenvalues"})
      after(std::string("UPDATE ") + column + " = CAST(" + number + " || substr(" +
            std::string(column).substr(std::string(column).rfind(' ') + 1) + ", 9) AS BLOB)");
  after("CREATE VIEW v AS SELECT 1");
  after("CREATE TRIGGER t AFTER DELETE ON layer BEGIN DELETE FROM plane; END");
  after("ALTER TABLE plane ADD COLUMN more AS (1)");
  after(
      "DROP TABLE layer; CREATE VIEW layer AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT "
      "x + 1 FROM c) SELECT * FROM c");
}

TEST_CASE("a scene file tells what its buildings bring to the switches") {
  TemporaryFile file;
  Scene scene = build_scene({{house("a", 12), house("b", 10)}, {}}, small_options());
  Store store(file.path, true);
  for (const Building& b : scene.buildings) store.put_segments(b, 0, "key");
  CHECK(store.sights().empty());
  for (const Building& b : scene.buildings) store.put_meshes(b);
  const std::vector<BuildingSights> sights = store.sights();
  REQUIRE(sights.size() == 2);
  decide_switches(scene, 3, {});
  Scene later = build_scene({{house("c", 17)}, {}}, small_options());
  decide_switches(later, 3, {}, sights);
  CHECK(later.switching.is_from_prior);
  for (int k = 0; k < 3; ++k) CHECK(later.switching.layers[k].gsd == scene.switching.layers[k].gsd);
  CHECK(later.buildings[0].layers[0].gsd == scene.buildings[0].layers[0].gsd);
}

TEST_CASE("a scene is the same with its buildings in a temporary store") {
  const Options options = small_options();
  const std::vector<std::pair<std::string, double>> houses = {{"b", 10}, {"a", 12}};
  Inventory inventory;
  for (const auto& [name, w] : houses) inventory.files.push_back({name + ".ply", {name}});
  inventory.files.push_back({"gone.ply", {"gone"}});
  const Reader read = [&](std::size_t i) {
    if (i == houses.size()) throw Error(Stage::kInput, "gone.ply", "cannot be opened");
    std::vector<Source> one;
    one.push_back(house(houses[i].first, houses[i].second));
    return one;
  };
  TemporaryStore disk;
  const Scene kept = build_scene(inventory, read, options);
  const Scene parked = build_scene(inventory, read, options, {.depot = &disk});
  REQUIRE(parked.buildings.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const Building &a = kept.buildings[i], &b = parked.buildings[i];
    CHECK(a.source.name == std::vector<std::string>{"a", "b", "gone"}[i]);
    CHECK(b.source.mesh.faces.empty());
    CHECK(b.planes.planes.empty());
    CHECK(b.counts.faces == a.source.mesh.faces.size());
    CHECK(b.failure == a.failure);
    REQUIRE(a.layers.size() == b.layers.size());
    for (std::size_t k = 0; k < a.layers.size(); ++k) {
      CHECK(a.layers[k].mesh.vertices == b.layers[k].mesh.vertices);
      CHECK(a.layers[k].mesh.triangles == b.layers[k].mesh.triangles);
      CHECK(a.layers[k].sight.deviation == b.layers[k].sight.deviation);
    }
  }
  CHECK(kept.buildings[2].failure == "gone.ply: cannot be opened");
}

TEST_CASE("a shelf keeps pieces by name, and refuses what is none") {
  const TemporaryFile file;
  const std::string bytes("a\0b", 3);
  {
    Shelf shelf(file.path, true);
    shelf.put("one", {{"x", bytes}, {"y", "1"}});
    shelf.put("two", {{"x", "2"}});
    shelf.put("one", {{"x", bytes}});  // replaces all of a name
  }
  Shelf shelf(file.path, false);
  CHECK(shelf.names() == std::vector<std::string>{"one", "two"});
  CHECK(shelf.get("one", "x") == bytes);
  CHECK(shelf.get("one", "y").empty());
  shelf.keep_only({"two"});
  CHECK(shelf.names() == std::vector<std::string>{"two"});
  CHECK_THROWS_AS(Store(file.path, false), Error);
  const TemporaryFile scene;
  Store(scene.path, true);
  CHECK_THROWS_AS(Shelf(scene.path, false), Error);
  std::ofstream(file.path, std::ios::trunc) << "no database at all, but long enough to be read";
  CHECK_THROWS_AS(Shelf(file.path, false), Error);
}
