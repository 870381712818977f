#include "plan/plan.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <set>

#include "core/error.h"
#include "plan/cell_lock.h"
#include "temporary_folder.h"

using namespace colod;
using Catch::Matchers::Contains;

namespace {

/// Files of about `bytes` each, no two alike; nothing of colod is in them.
Inventory files_in(const test::TemporaryFolder& folder, int count, int bytes) {
  Inventory inventory;
  for (int i = 0; i < count; ++i) {
    const std::string name = "house_" + std::to_string(100 + i);
    const std::string path = (folder.path() / (name + ".obj")).string();
    std::ofstream(path) << std::string(bytes / 2 + bytes * ((7 * i) % 10) / 10, 'a' + i % 26);
    inventory.files.push_back({path, {name, name + "_annex"}});
  }
  return inventory;
}

std::vector<std::uint64_t> loads(const Plan& plan) {
  std::vector<std::uint64_t> bytes;
  for (const auto& cell : plan.cells) {
    bytes.push_back(0);
    for (const PlannedFile& f : cell) bytes.back() += f.bytes;
  }
  return bytes;
}

/// Sets a variable of the environment while it lives.
struct Variable {
  Variable(const char* which, const char* value) : name(which) { setenv(which, value, 1); }
  ~Variable() { unsetenv(name); }
  const char* name;
};

}  // namespace

TEST_CASE("cells have about equal bytes, and every file once") {
  const test::TemporaryFolder folder;
  const int cells = GENERATE(1, 3, 8, 50);
  const Inventory inventory = files_in(folder, 40, 1000);
  const Plan plan = make_plan(inventory, {}, {}, cells);
  CHECK(plan.cells.size() == static_cast<std::size_t>(cells));
  CHECK(plan.building_count() == 80);
  std::set<std::string> paths;
  for (const auto& cell : plan.cells)
    for (const PlannedFile& f : cell) CHECK(paths.insert(f.file.path).second);
  CHECK(paths.size() == 40);
  const std::vector<std::uint64_t> bytes = loads(plan);
  const auto [least, most] = std::minmax_element(bytes.begin(), bytes.end());
  CHECK(*most - *least <= 1500);  // no more than the largest file
}

TEST_CASE("a scene that grows leaves what was planned in its cells") {
  const test::TemporaryFolder folder;
  Inventory inventory = files_in(folder, 30, 1000);
  const Inventory all = inventory;
  inventory.files.resize(20);
  const Plan first = make_plan(inventory, {}, {}, 4);
  const Plan grown = make_plan(all, {}, {}, 4, &first);
  for (std::size_t c = 0; c < 4; ++c)
    for (const PlannedFile& f : first.cells[c])
      CHECK(std::any_of(grown.cells[c].begin(), grown.cells[c].end(),
                        [&](const PlannedFile& g) { return g.file.path == f.file.path; }));
  CHECK(grown.building_count() == 60);
  // One file changes: its cell's stamp alone does.
  std::ofstream(first.cells[2][0].file.path, std::ios::app) << "more";
  const Plan changed = make_plan(inventory, {}, {}, 4, &first);
  for (std::size_t c = 0; c < 4; ++c)
    CHECK((cell_stamp(changed, c) == cell_stamp(first, c)) == (c != 2));
  Options other;
  other.ns = 33;
  CHECK(cell_stamp(make_plan(inventory, {}, other, 4, &first), 0) != cell_stamp(first, 0));
  CHECK(make_plan(inventory, {}, {}, 5, &first).cells.size() == 5);  // shared out anew
}

TEST_CASE("a plan's text holds all of it") {
  const test::TemporaryFolder folder;
  Inventory inventory = files_in(folder, 5, 100);
  inventory.failures.push_back({"broken.obj", "broken.obj: no faces"});
  inventory.warnings.emplace_back("2 files passed over");
  ReadOptions read;
  read.split = Split::kGroup;
  read.up = Up::kY;
  read.unit = 0.001;
  Options options;
  options.ns = 40;
  options.lambda = 1.25;
  const Plan plan = make_plan(inventory, read, options, 2);
  const std::string text = plan_text(plan);
  const Plan again = parse_plan(text, "plan.json");
  CHECK(plan_text(again) == text);
  CHECK(again.read.split == Split::kGroup);
  CHECK(again.read.up == Up::kY);
  CHECK(again.read.unit == 0.001);
  CHECK(again.options.lambda == 1.25);
  CHECK(again.failures[0].message == "broken.obj: no faces");
  CHECK(inventory_of(again, 0).files.size() + inventory_of(again, 1).files.size() == 5);
}

TEST_CASE("what is no plan is refused by name") {
  for (const char* text : {"", "{", "[]", "{\"format\": 99}", "{\"format\": 1}", "null"})
    CHECK_THROWS_WITH(parse_plan(text, "w/plan.json"), Contains("w/plan.json"));
  const test::TemporaryFolder folder;
  std::string text = plan_text(make_plan(files_in(folder, 3, 100), {}, {}, 2));
  text.replace(text.find("\"auto\""), 6, "\"what\"");
  CHECK_THROWS_WITH(parse_plan(text, "w/plan.json"), Contains("what"));
  CHECK_THROWS_WITH(read_plan("not/there.json"), Contains("colod plan writes it"));
}

TEST_CASE("shards share the cells out") {
  for (const std::size_t cells : {1, 7, 100})
    for (const std::size_t count : {1, 3, 8, 200}) {
      std::vector<std::size_t> all;
      for (std::size_t i = 0; i < count; ++i)
        for (const std::size_t c : cells_of({i, count}, cells)) all.push_back(c);
      std::sort(all.begin(), all.end());
      REQUIRE(all.size() == cells);
      for (std::size_t c = 0; c < cells; ++c) CHECK(all[c] == c);
    }
}

TEST_CASE("a shard is said by hand, by Slurm, or by Kubernetes") {
  CHECK(shard_of("", 8).count == 1);
  CHECK(shard_of("2/5", 8).index == 2);
  CHECK(shard_of("2/5", 8).count == 5);
  for (const char* wrong : {"5/5", "-1/5", "1", "1/", "/5", "a/b", "1/0", "1/5x", "1//5"})
    CHECK_THROWS_WITH(shard_of(wrong, 8), Contains("--shard"));
  {
    const Variable task("SLURM_ARRAY_TASK_ID", "7"), first("SLURM_ARRAY_TASK_MIN", "3");
    CHECK_THROWS_WITH(shard_of("", 8), Contains("SLURM_ARRAY_TASK_ID"));
    const Variable last("SLURM_ARRAY_TASK_MAX", "9"), step("SLURM_ARRAY_TASK_STEP", "2");
    CHECK(shard_of("", 8).index == 2);
    CHECK(shard_of("", 8).count == 4);
    CHECK(shard_of("0/1", 8).count == 1);  // what is said goes before
  }
  const Variable job("JOB_COMPLETION_INDEX", "6");
  CHECK(shard_of("", 8).index == 6);
  CHECK(shard_of("", 8).count == 8);
  CHECK_THROWS_WITH(shard_of("", 6), Contains("JOB_COMPLETION_INDEX"));
}

TEST_CASE("one run at a time works on a cell") {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "cell-0000.colod").string();
  {
    const CellLock held(path);
    CHECK_THROWS_WITH(CellLock(path), Contains("another run is at work"));
  }
  CHECK_NOTHROW(CellLock(path));
  CHECK_THROWS_WITH(CellLock((folder.path() / "no" / "such").string()), Contains("no/such"));
}
