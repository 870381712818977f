// Files between the stages of a plan that are cut, changed or gone: named, and made anew.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "plan/plan.h"
#include "store/shelf.h"
#include "temporary_folder.h"

using namespace colod;
using test::slurp;
namespace fs = std::filesystem;

namespace {

void write(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

void cut(const fs::path& path) { write(path, slurp(path).substr(0, slurp(path).size() / 2)); }

/// One byte at `at`; the length stays.
void change(const fs::path& path, std::size_t at) {
  std::string bytes = slurp(path);
  REQUIRE(at < bytes.size());
  bytes[at] = static_cast<char>(bytes[at] ^ 0x15);
  write(path, bytes);
}

void change(const fs::path& path) { change(path, slurp(path).size() / 2); }

/// A plan of three houses in two cells.
class Work {
 public:
  Work() {
    REQUIRE(call("synth -o " + in() + " --buildings 3"));
    REQUIRE(replan());
    for (const char* stage : {"segment", "analyze", "mesh"}) REQUIRE(stage_of(stage));
    REQUIRE(finish());
    expected_ = files();
    CHECK(expected_.size() > 7);
  }

  const fs::path& folder() const { return folder_.path(); }
  std::string plan() const { return (folder_ / "w/plan.json").string(); }
  std::string out(const std::string& path) const { return (folder_ / "out" / path).string(); }

  bool replan() { return call("plan " + in() + " -o " + plan() + " --cells 2 --ns 12 --nr 8"); }
  bool stage_of(const std::string& stage) { return call(stage + " --plan " + plan()); }
  bool merge() { return stage_of("merge -o " + out("") + kOutput); }
  /// All shards' exports and the merge; what they said together.
  bool finish() {
    std::string all;
    bool is_done = true;
    for (const char* stage : {"export --shard 0/2 -o ", "export --shard 1/2 -o ", "merge -o "}) {
      is_done = stage_of(stage + out("") + kOutput) && is_done;
      all += said_;
    }
    said_ = all;
    return is_done;
  }
  bool has_said(const std::string& text) const { return said_.find(text) != said_.npos; }

  void check_same() const {
    const auto now = files();
    REQUIRE(now.size() == expected_.size());
    for (const auto& [path, bytes] : expected_) {
      INFO(path);
      CHECK(now.at(path) == bytes);
    }
  }

 private:
  static constexpr const char* kOutput = " --format glb,3dtiles,engine --no-report-html";

  std::string in() const { return (folder_ / "in").string(); }

  bool call(const std::string& arguments) {
    const fs::path log = folder_ / "log";
    const int status = std::system((std::string(COLOD_BINARY) + " " + arguments +
                                    " --threads 1 > /dev/null 2> " + log.string())
                                       .c_str());
    said_ = "";
    for (const char c : slurp(log)) said_ += c;
    INFO(said_);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

  /// All but the report, which tells times.
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(out("")))
      if (entry.is_regular_file() && entry.path().stem() != "report")
        all[fs::relative(entry.path(), out("")).string()] = slurp(entry.path());
    return all;
  }

  test::TemporaryFolder folder_;
  std::string said_;
  std::map<std::string, std::string> expected_;
};

std::string some_file(const std::string& folder, const std::string& end) {
  std::string found;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().string().ends_with(end)) found = std::max(found, entry.path().string());
  REQUIRE(!found.empty());
  return found;
}

}  // namespace

TEST_CASE("what is damaged between export and merge is named and made anew") {
  Work work;
  const std::string glb = some_file(work.out("buildings"), ".glb"),
                    tile = work.out("tiles/root.0.glb"),
                    plain = some_file(work.out("engine"), ".glb");
  for (int damage = 0; damage < 4; ++damage) {  // of buildings' files
    INFO("building " << damage);
    if (damage == 0) cut(glb);
    if (damage == 1) change(glb);
    if (damage == 2) fs::remove(glb);
    if (damage == 3) change(glb, 0), change(plain);
    CHECK_FALSE(work.merge());
    CHECK(work.has_said("is missing or damaged: run colod export"));
    CHECK(work.finish());
    CHECK(work.has_said("is missing or damaged: made anew"));
    work.check_same();
  }
  for (int damage = 0; damage < 3; ++damage) {  // of tiles
    INFO("tile " << damage);
    if (damage == 0) cut(tile);
    if (damage > 0) change(tile);
    if (damage == 2) change(work.out("tiles/root.glb"), 30), cut(work.out("tileset.json"));
    CHECK(work.merge());
    CHECK(work.has_said(fs::path(tile).filename().string()));
    CHECK(work.has_said(damage == 2 ? "2 tiles" : "1 tiles"));
    work.check_same();
  }
  const std::string kept = kept_tiles_file(work.plan());
  for (int damage = 0; damage < 5; ++damage) {  // of what a merge remembers
    INFO("memory " << damage);
    if (damage == 0) cut(kept);
    if (damage == 1) change(kept, 3);
    if (damage == 2) write(kept, "this was a database, and is none");
    if (damage == 3) write(kept, slurp(kept).substr(0, 70));
    if (damage == 4) change(kept, slurp(kept).rfind("tiles/root.glb") + 2);
    CHECK(work.merge());
    CHECK(work.has_said(damage == 4 ? "damaged" : "merge.tiles: is damaged"));
    CHECK(work.merge());
    CHECK_FALSE(work.has_said("damaged"));
    work.check_same();
  }
}

TEST_CASE("what a damaged export handed over is named and made anew") {
  Work work;
  for (int damage = 0; damage < 5; ++damage) {
    INFO("export " << damage);
    for (int cell = 0; cell < (damage == 3 ? 2 : 1); ++cell) {
      const std::string path = cell_export(work.plan(), cell);
      if (damage == 0) cut(path);
      if (damage == 1) change(path, 5);
      if (damage == 2) write(path, slurp(path).substr(0, 70));
      if (damage == 3) write(path, "this was a database, and is none");
      if (damage == 4) change(path, slurp(path).rfind("timings") + 2);  // in a row of the report
    }
    CHECK_FALSE(work.merge());
    CHECK(work.has_said("damaged"));
    CHECK(work.has_said("run colod export --plan " + work.plan() + " --shard 0/2"));
    CHECK(work.finish());
    CHECK(work.has_said(damage == 4 ? "what was exported of it is damaged: made anew"
                                    : "cell-0000.export: is damaged"));
    work.check_same();
  }
}

TEST_CASE("a damaged plan and a damaged scene file are named and made anew") {
  Work work;
  const std::string scene = cell_scene(work.plan(), 1);
  for (int damage = 0; damage < 4; ++damage) {
    INFO("scene " << damage);
    if (damage != 1) cut(scene);
    if (damage == 1) change(scene, 5);
    if (damage == 2) write(cell_scene(work.plan(), 0), "no database");
    if (damage == 3) cut(work.plan()), cut(cell_stamp_file(work.plan(), 1));
    CHECK_FALSE(work.stage_of("mesh"));
    CHECK(work.has_said("colod segment --plan") != (damage == 3));
    CHECK(work.replan());
    CHECK(work.has_said("plan.json: is no plan") == (damage == 3));
    CHECK(work.stage_of("segment"));
    CHECK(work.has_said("cell-0001.colod: is damaged"));
    for (const char* stage : {"analyze", "mesh"}) CHECK(work.stage_of(stage));
    CHECK(work.finish());
    work.check_same();
  }
}

TEST_CASE("a changed number of a scene file is named and made anew") {
  Work work;
  const std::string scene = cell_scene(work.plan(), 1);
  const struct {
    const char* before;  ///< a text that a number lies beside
    std::ptrdiff_t offset;
    const char* made;
  } places[] = {{"{\"images\":", -30, "segmented, analysed and meshed anew"},
                {"{\"images\":", 6, "segmented, analysed and meshed anew"},
                {"\"rms_a_to_b\"", 14, "are damaged: made anew"},
                {"\"objective\"", 13, "analysed and meshed anew"}};
  for (const auto& place : places) {
    INFO(place.before << ' ' << place.offset);
    const std::size_t found = slurp(scene).rfind(place.before);
    REQUIRE(found != std::string::npos);
    change(scene, found + static_cast<std::size_t>(place.offset));
    const bool is_of_meshes = std::string(place.made).starts_with("are");
    CHECK(work.stage_of("mesh") == is_of_meshes);
    CHECK(work.has_said("cell-0001.colod: "));
    CHECK(work.has_said("damaged"));
    if (!is_of_meshes) {
      CHECK(work.stage_of("segment"));
      CHECK(work.has_said(place.made));
      for (const char* stage : {"analyze", "mesh"}) CHECK(work.stage_of(stage));
    }
    CHECK(work.finish());
    work.check_same();
  }
}

TEST_CASE("a shelf knows any byte of its pieces that changed") {
  const test::TemporaryFolder folder;
  const std::string path = (folder / "shelf").string();
  for (const std::size_t size : {std::size_t{1}, std::size_t{300}, std::size_t{70000}}) {
    fs::remove(path);
    Shelf(path, true).put("a", {{"one", std::string(size, 'x')}, {"two", "2"}});
    const std::string whole = slurp(path);
    CHECK(Shelf(path, false).state("a") == Shelf::State::kWhole);
    CHECK(Shelf(path, false).state("b") == Shelf::State::kAbsent);
    int noticed = 0;
    const std::size_t first =
        size == 1 ? whole.find("atwo") - 8 : whole.find(std::string(200, 'x'));
    for (std::size_t at = first; at < first + 120; ++at) {
      write(path, whole);
      change(path, at);
      bool is_told = false;
      Shelf shelf = Shelf::open_or_renew(path, [&](const std::string&) { is_told = true; });
      const bool is_lost = shelf.state("a") != Shelf::State::kWhole;
      if (is_lost || is_told) ++noticed;
      if (!is_lost) {  // a byte that nothing is kept in
        CHECK(shelf.get("a", "one") == std::string(size, 'x'));
        CHECK(shelf.get("a", "two") == "2");
      }
    }
    CHECK(noticed > (size == 1 ? 60 : 119));
  }
}
