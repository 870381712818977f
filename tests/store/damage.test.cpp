// Bytes of a scene file that changed by themselves: none passes unnoticed.
#include <sqlite3.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "meshes.h"
#include "store/store.h"
#include "temporary_folder.h"

using namespace colod;
namespace fs = std::filesystem;

namespace {

using Texts = std::vector<std::string>;

/// Rows of a query, columns as SQLite writes them in SQL.
Texts rows(const std::string& path, const std::string& sql) {
  sqlite3* db = nullptr;
  REQUIRE(sqlite3_open(path.c_str(), &db) == SQLITE_OK);
  Texts all;
  const auto add = [](void* list, int count, char** values, char**) {
    std::string row;
    for (int i = 0; i < count; ++i) row += std::string(values[i] ? values[i] : "NULL") + '|';
    static_cast<Texts*>(list)->push_back(row);
    return 0;
  };
  INFO(sql);
  CHECK(sqlite3_exec(db, sql.c_str(), add, &all, nullptr) == SQLITE_OK);
  sqlite3_close(db);
  return all;
}

const Texts kTables = {"meta", "building", "plane", "segment", "coverage", "layer"};

Texts columns_of(const std::string& path, const std::string& table) {
  Texts names = rows(path, "SELECT name FROM pragma_table_info('" + table + "')");
  for (std::string& name : names) name.pop_back();
  return names;
}

/// Everything that a file holds, a line a row.
std::set<std::string> content(const std::string& path) {
  std::set<std::string> all;
  for (const std::string& table : kTables) {
    std::string quoted;
    for (const std::string& column : columns_of(path, table)) quoted += ", quote(" + column + ")";
    for (const std::string& row : rows(path, "SELECT '" + table + "'" + quoted + " FROM " + table))
      all.insert(row);
  }
  return all;
}

/// A scene of boxes through all stages.
void write_scene(const std::string& path, int buildings) {
  Options options;
  options.ns = 12;
  options.nr = 10;
  ReadResult input;
  for (int i = 0; i < buildings; ++i)
    input.sources.push_back(test::as_source(
        test::join(test::gable_house(9 + i, 8, 6, 4), test::box_mesh({2, 3, 7}, {3, 4, 11})),
        "house" + std::to_string(i)));
  Scene scene = build_scene(std::move(input), options);
  Store store(path, true);
  store.put_options(options);
  for (std::size_t i = 0; i < scene.buildings.size(); ++i)
    store.put_segments(scene.buildings[i], static_cast<int>(i), "key");
  store.put_coanalysis(scene);
  for (const Building& b : scene.buildings) {
    store.put_layers_of_segments(b);
    store.put_meshes(b);
  }
}

/// What all stages together read.
void read_all(const std::string& path) {
  const Store store(path, false);
  store.check_rules();
  store.options();
  Scene scene;
  store.get_coanalysis(scene);
  store.get_placed_later(scene);
  for (const std::string& name : store.names()) store.building(name);
  store.sights();
  store.prior();
}

std::string slurp_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void spill(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

}  // namespace

TEST_CASE("any value of a scene file that changed is noticed, and what is made of it let go") {
  const test::TemporaryFolder folder;
  const std::string path = (folder / "a.colod").string();
  write_scene(path, 2);
  const std::string good = slurp_file(path);
  CHECK_NOTHROW(read_all(path));
  const std::set<std::string> keys = {"name", "building", "id", "key"};
  int changed = 0;
  for (const std::string& table : kTables)
    for (const std::string& column : columns_of(path, table)) {
      if (keys.contains(column) && table != "building") continue;
      if (column == "name") continue;
      spill(path, good);
      const auto before = content(path);
      rows(path, "UPDATE " + table + " SET " + column + " = CASE typeof(" + column +
                     ") WHEN 'integer' THEN " + column + " + 97 WHEN 'real' THEN " + column +
                     " * 1.0000001 + 1e-9 WHEN 'text' THEN " + column +
                     " || ' ' WHEN 'blob' THEN " + "CAST(substr(" + column + ", 1, length(" +
                     column + ") / 2) || X'3F' || substr(" + column + ", length(" + column +
                     ") / 2 + 2) AS BLOB) ELSE " + column + " END");
      if (content(path) == before) continue;  // nothing but NULL there
      ++changed;
      INFO(table << '.' << column);
      CHECK_THROWS_WITH(read_all(path), Catch::Contains("damaged") && Catch::Contains("run colod"));
      int told = 0;
      Store::open_or_renew(path, [&](const std::string& line) {
        ++told;
        CHECK_THAT(line, Catch::Contains("damaged"));
      });
      CHECK(told > 0);
      int again = 0;
      Store::open_or_renew(path, [&](const std::string&) { ++again; });
      CHECK(again == 0);
    }
  CHECK(changed > 50);
}

TEST_CASE("no changed byte of a scene file passes, wherever it lies") {
  for (const int buildings : {1, 3}) {
    const test::TemporaryFolder folder;
    const std::string path = (folder / "a.colod").string();
    write_scene(path, buildings);
    const std::string good = slurp_file(path);
    const std::set<std::string> before = content(path);
    int noticed = 0, tried = 0;
    for (std::size_t at = 150; at < good.size(); at += good.size() / 97) {
      INFO(buildings << " buildings, byte " << at << " of " << good.size());
      std::string bad = good;
      bad[at] = static_cast<char>(bad[at] ^ (1 << at % 8));
      spill(path, bad);
      bool is_refused = false, is_told = false;
      try {
        read_all(path);
      } catch (const Error&) {
        is_refused = true;
      }
      Store::open_or_renew(path, [&](const std::string&) { is_told = true; });
      ++tried, noticed += is_told;
      CHECK((is_told || !is_refused));  // what stops a stage is mended by the first one
      if (is_told)
        CHECK_NOTHROW(Store(path, false).names());
      else  // it was one of a free place
        CHECK(content(path) == before);
    }
    CHECK(noticed > tried / 4);  // pages have room left
  }
}
