// Stages that are killed and started again, and scenes that have next to nothing in them.
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

#include "meshes.h"
#include "plan/cell_lock.h"
#include "plan/plan.h"
#include "read/read.h"
#include "store/store.h"
#include "temporary_folder.h"

using namespace colod;
using test::slurp;
namespace fs = std::filesystem;

namespace {

struct Folder : test::TemporaryFolder {
  std::string operator/(const std::string& name) const { return (path() / name).string(); }
};

int count_of(const std::string& text, const std::string& word) {
  int n = 0;
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++n;
  return n;
}

/// Runs colod, its messages to `log`; kills it (-9) after that many milliseconds unless 0. Whether
/// it ended by itself, and well.
bool run(std::vector<std::string> arguments, const std::string& log, int kill_after_ms = 0) {
  arguments.insert(arguments.begin(), COLOD_BINARY);
  std::vector<char*> argv;
  for (std::string& a : arguments) argv.push_back(a.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    if (!freopen(log.c_str(), "w", stderr) || !freopen("/dev/null", "w", stdout)) _exit(9);
    execv(argv[0], argv.data());
    _exit(9);
  }
  int status = 0;
  if (kill_after_ms > 0) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(kill_after_ms);
    while (std::chrono::steady_clock::now() < end) {
      if (waitpid(child, &status, WNOHANG) == child)
        return WIFEXITED(status) && WEXITSTATUS(status) == 0;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    kill(child, SIGKILL);
  }
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void write_off(const fs::path& path, const Mesh& m) {
  std::ofstream out(path);
  out << "OFF\n" << m.vertices.size() << " " << m.faces.size() << " 0\n";
  for (const Vec3& v : m.vertices) out << v.x() << " " << v.y() << " " << v.z() << "\n";
  for (const Face& f : m.faces) out << "3 " << f[0] << " " << f[1] << " " << f[2] << "\n";
}

Mesh house(int i) {
  return test::join(test::gable_house(9 + 0.5 * i, 8, 6, 3 + 0.1 * i),
                    test::box_mesh({2, 3, 7}, {3, 4.2, 11}));
}

/// Two kinds of part, so that the layers beyond the first have something to tell apart.
Mesh house_with_porch(int i) {
  return test::join(house(i), test::box_mesh({3, -3, 0}, {7, 0.2, 3}));
}

int segmented(const std::string& scene) {
  if (!fs::exists(scene)) return 0;
  try {
    return static_cast<int>(Store(scene, true).names().size());
  } catch (const std::exception&) {
    return -1;
  }
}

int meshed(const std::string& scene) {
  Store store(scene, false);
  int n = 0;
  for (const std::string& name : store.names()) n += store.has_meshes(name);
  return n;
}

}  // namespace

TEST_CASE("kill -9 at any point of segment and mesh: the rest is done, the bytes are the same") {
  Folder f;
  fs::create_directories(f / "in");
  for (int i = 0; i < 20; ++i)
    write_off(f.path() / "in" / ("h" + std::to_string(10 + i) + ".off"), house(i));
  const std::string scene = f / "s.colod", log = f / "log";
  const std::vector<std::string> small{"--ns", "10", "--nr", "12", "--threads", "2"};
  std::vector<std::string> segment{"segment", f / "in", "-o", scene, "--log-json"};
  segment.insert(segment.end(), small.begin(), small.end());

  int kills = 0;
  for (int ms = 15;; ms += ms / 3) {
    const int before = segmented(scene);
    REQUIRE(before >= 0);
    const bool is_done = run(segment, log, ms);
    const std::string messages = slurp(log);
    CHECK(count_of(messages, "already there") <= before);  // fewer only where it was killed early
    if (is_done) {
      CHECK(count_of(messages, "already there") == before);
      break;
    }
    ++kills;
    REQUIRE(ms < 600000);
  }
  CHECK(segmented(scene) == 20);
  REQUIRE(run({"analyze", scene}, log));
  for (int ms = 15;; ms += ms / 3) {
    const int before = meshed(scene);
    if (run({"mesh", scene, "--threads", "2", "--log-json"}, log, ms)) {
      CHECK(count_of(slurp(log), "\"layers\"") == 20 - before);
      break;
    }
    ++kills;
    REQUIRE(ms < 600000);
  }
  CHECK(kills >= 2);
  REQUIRE(run({"export", scene, "-o", f / "stages", "--quiet"}, log));
  std::vector<std::string> build{"build", f / "in", "-o", f / "whole", "--quiet"};
  build.insert(build.end(), small.begin(), small.end());
  REQUIRE(run(build, log));
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(f.path() / "whole"))
    if (entry.is_regular_file() && entry.path().stem() != "report") {
      const fs::path name = fs::relative(entry.path(), f.path() / "whole");
      INFO(name.string());
      CHECK(slurp(entry.path()) == slurp(f.path() / "stages" / name));
      ++files;
    }
  CHECK(files > 20);
}

TEST_CASE("a plan's cells want all their buildings, and say which run brings them") {
  Folder f;
  fs::create_directories(f / "in");
  for (int i = 0; i < 6; ++i)
    write_off(f.path() / "in" / ("h" + std::to_string(i) + ".off"), house(i));
  const std::string plan = f / "w/plan.json", log = f / "log";
  REQUIRE(run({"plan", f / "in", "-o", plan, "--cells", "3", "--ns", "10", "--nr", "12"}, log));
  CHECK_FALSE(run({"analyze", "--plan", plan}, log));
  CHECK(count_of(slurp(log), "0 of the 2 buildings") == 1);
  REQUIRE(run({"segment", "--plan", plan, "--shard", "0/2"}, log));
  CHECK_FALSE(run({"analyze", "--plan", plan}, log));
  CHECK(count_of(slurp(log), "--shard 1/3") == 1);
  {  // what another run is filling is not looked at, whole or not
    const CellLock other(cell_scene(plan, 1));
    CHECK_FALSE(run({"analyze", "--plan", plan}, log));
    CHECK(count_of(slurp(log), "another run is at work") == 1);
  }
  REQUIRE(run({"segment", "--plan", plan, "--shard", "1/2"}, log));
  REQUIRE(run({"analyze", "--plan", plan}, log));
  REQUIRE(run({"mesh", "--plan", plan}, log));
  REQUIRE(run({"export", "--plan", plan, "-o", f / "out", "--quiet"}, log));

  // A building goes: its cell alone lets it go, and the others' meshes stay.
  fs::remove(f.path() / "in" / "h3.off");
  REQUIRE(run({"plan", f / "in", "-o", plan, "--cells", "3", "--ns", "10", "--nr", "12"}, log));
  CHECK_FALSE(run({"export", "--plan", plan, "-o", f / "out", "--quiet"}, log));
  CHECK(count_of(slurp(log), "run colod segment --plan") == 1);
  REQUIRE(run({"segment", "--plan", plan}, log));
  REQUIRE(run({"analyze", "--plan", plan}, log));
  REQUIRE(run({"mesh", "--plan", plan, "--log-json"}, log));
  REQUIRE(run({"export", "--plan", plan, "-o", f / "fewer", "--quiet"}, log));
  CHECK(!fs::exists(f.path() / "fewer/buildings/h3.glb"));
  REQUIRE(run({"build", f / "in", "-o", f / "whole", "--ns", "10", "--nr", "12", "--quiet"}, log));
  for (const char* file : {"tileset.json", "buildings/h0.glb", "buildings/h5.glb"})
    CHECK(slurp(f.path() / "fewer" / file) == slurp(f.path() / "whole" / file));

  // A scene file that was cut off, and options that stand in the plan.
  fs::resize_file(f / "w/cell-0001.colod", 3000);
  CHECK_FALSE(run({"mesh", "--plan", plan}, log));
  CHECK(count_of(slurp(log), "cell-0001.colod") >= 1);
  CHECK_FALSE(run({"segment", "--plan", plan, "--ns", "20"}, log));
  CHECK(count_of(slurp(log), "--ns: stands in the plan") == 1);
  CHECK_FALSE(run({"segment", "--plan", plan, f / "in"}, log));
  CHECK_FALSE(run({"segment", "--shard", "0/2", f / "in", "-o", f / "x.colod"}, log));
  CHECK_FALSE(run({"segment", "--plan", plan, "--shard", "3/3"}, log));
  CHECK(count_of(slurp(log), "3/3") == 1);
}

TEST_CASE("a prior gives a single building the layers of a city, in build and in stages") {
  Folder f;
  fs::create_directories(f / "city");
  for (int i = 0; i < 4; ++i)
    write_off(f.path() / "city" / ("h" + std::to_string(i) + ".off"), house_with_porch(i));
  fs::create_directories(f / "alone");
  write_off(f.path() / "alone" / "h2.off", house_with_porch(2));
  const std::string log = f / "log", city = f / "city.colod", one = f / "one.colod";
  const std::vector<std::string> small{"--ns", "32", "--nr", "40", "--quiet"};
  const auto with = [&](std::vector<std::string> a) {
    a.insert(a.end(), small.begin(), small.end());
    return a;
  };
  REQUIRE(run(with({"segment", f / "city", "-o", city}), log));
  CHECK(!run(with({"build", f / "alone/h2.off", "-o", f / "x", "--prior", city}), log));
  CHECK(slurp(log).find("not analysed") != std::string::npos);
  REQUIRE(run({"analyze", city}, log));
  REQUIRE(run(with({"build", f / "alone/h2.off", "-o", f / "out", "--prior", city}), log));
  CHECK(slurp(f.path() / "out" / "report.json").find("\"prior\": true") != std::string::npos);
  CHECK(!run(with({"build", f / "alone/h2.off", "-o", f / "x", "--prior", city, "--layers", "4"}),
             log));

  REQUIRE(run(with({"segment", f / "alone/h2.off", "-o", one}), log));
  REQUIRE(run({"analyze", one, "--prior", city}, log));
  // The same house stands in the city: its segments lie where they lie there.
  const Building alone = Store(one, false).building("h2");
  const Building there = Store(city, false).building("h2");
  CHECK(alone.layer_of_segment == there.layer_of_segment);
  CHECK(alone.layer_of_segment.back() > 0);
  REQUIRE(run({"mesh", one}, log));
  REQUIRE(run({"export", one, "-o", f / "stages", "--quiet"}, log));
  CHECK(slurp(f.path() / "out" / "buildings" / "h2.glb") ==
        slurp(f.path() / "stages" / "buildings" / "h2.glb"));
  CHECK(slurp(f.path() / "stages" / "report.json").find("\"prior\": true") != std::string::npos);
}

TEST_CASE("cells that are exported apart and merged give what one run gives") {
  Folder f;
  const std::string plan = f / "w/plan.json", log = f / "log", out = f / "out", one = f / "one";
  REQUIRE(
      run({"synth", "-o", f / "in", "--buildings", "3", "--texture", "--texel-size", "0.2"}, log));
  REQUIRE(run({"plan", f / "in", "-o", plan, "--cells", "2", "--ns", "12", "--nr", "16"}, log));
  for (const char* stage : {"segment", "analyze", "mesh"})
    REQUIRE(run({stage, "--plan", plan}, log));
  const std::vector<std::string> output{"--quiet", "--format", "glb,3dtiles,engine"};
  const auto call = [&](std::vector<std::string> a) {
    a.insert(a.end(), output.begin(), output.end());
    return run(a, log);
  };
  REQUIRE(call({"export", "--plan", plan, "-o", one}));
  const std::vector<std::string> first{"export", "--plan", plan, "--shard", "0/2", "-o", out};
  const std::vector<std::string> second{"export", "--plan", plan, "--shard", "1/2", "-o", out};
  const std::vector<std::string> merge{"merge", "--plan", plan, "-o", out};
  REQUIRE(call(first));
  CHECK_FALSE(call(merge));  // a cell is missing
  CHECK(count_of(slurp(log), "run colod export --plan " + plan + " --shard 1/2") == 1);
  REQUIRE(call(second));
  CHECK_FALSE(run({"merge", "--plan", plan, "-o", out, "--quiet"}, log));  // other formats
  CHECK(count_of(slurp(log), "other options") == 1);
  CHECK_FALSE(fs::exists(fs::path(out) / "tileset.json"));
  REQUIRE(call(merge));
  const auto check_same = [&] {
    std::size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(one)) {
      const fs::path path = fs::relative(entry.path(), one);
      if (!entry.is_regular_file() || path.stem() == "report") continue;
      INFO(path);
      CHECK(slurp(entry.path()) == slurp(out / path));
      ++files;
    }
    CHECK(files > 10);
  };
  check_same();

  // A file that was cut, and what was exported of a cell that was damaged: made again, the rest
  // left as it is.
  fs::path glb;
  for (const auto& entry : fs::directory_iterator(fs::path(out) / "buildings")) glb = entry.path();
  std::ofstream(glb, std::ios::trunc) << "cut";
  CHECK_FALSE(call(merge));
  CHECK(count_of(slurp(log), "missing or damaged") == 1);
  REQUIRE(call(first));
  REQUIRE(call(second));
  REQUIRE(call(merge));
  check_same();
  std::ofstream(cell_export(plan, 0), std::ios::trunc) << "this was a database, and is none";
  CHECK_FALSE(call(merge));
  CHECK(count_of(slurp(log), "run colod export --plan " + plan + " --shard 0/2") == 1);
  REQUIRE(call(first));
  REQUIRE(call(merge));
  check_same();
  {
    const CellLock other(cell_scene(plan, 1));
    CHECK_FALSE(call(second));
    CHECK(count_of(slurp(log), "another run is at work") == 1);
  }

  // An archive alone: the tiles that it shows lie beside the plan.
  const std::vector<std::string> archive{"--quiet", "--format", "3tz", "--no-report-html"};
  const auto pack = [&](std::vector<std::string> a) {
    a.insert(a.end(), archive.begin(), archive.end());
    return run(a, log);
  };
  const std::string packed = f / "packed";
  REQUIRE(pack({"export", "--plan", plan, "-o", f / "one_packed"}));
  for (const char* shard : {"0/2", "1/2"})
    REQUIRE(pack({"export", "--plan", plan, "--shard", shard, "-o", packed}));
  for (int twice = 0; twice < 2; ++twice) {
    REQUIRE(pack({"merge", "--plan", plan, "-o", packed}));
    CHECK(slurp(fs::path(packed) / "tileset.3tz") == slurp(f.path() / "one_packed/tileset.3tz"));
    CHECK_FALSE(fs::exists(fs::path(packed) / "tiles"));
  }
}

struct FileState {
  std::string bytes;
  ino_t inode;
  fs::file_time_type time;
  bool operator==(const FileState&) const = default;
};

std::map<std::string, FileState> files_of(const std::string& folder) {
  std::map<std::string, FileState> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    struct stat facts {};
    if (!entry.is_regular_file() || stat(entry.path().c_str(), &facts) != 0) continue;
    files[fs::relative(entry.path(), folder).string()] = {slurp(entry.path()), facts.st_ino,
                                                          entry.last_write_time()};
  }
  return files;
}

TEST_CASE(
    "an update writes what changed and its cell's pieces, moves no other layer, and says so") {
  Folder f;
  const std::string plan = f / "w/plan.json", log = f / "log", out = f / "out";
  fs::create_directories(f / "in");
  constexpr int kHouses = 20;  // two groups of tiles
  const auto path = [&](int i) { return f.path() / "in" / ("h" + std::to_string(i) + ".off"); };
  const auto place = [](Mesh mesh, int i) {
    for (Vec3& v : mesh.vertices) v += Vec3(30 * i, 0, 0);
    return mesh;
  };
  for (int i = 0; i < kHouses; ++i)
    write_off(path(i), place(i % 2 ? house(i % 5) : house_with_porch(i % 5), i));
  const auto call = [&](std::vector<std::string> a) {
    a.insert(a.begin() + 1, {"--plan", plan});
    return run(a, log);
  };
  const auto replan = [&] {
    return run({"plan", f / "in", "-o", plan, "--cells", "3", "--ns", "12", "--nr", "8"}, log);
  };
  const auto finish = [&] {
    REQUIRE(call({"mesh"}));
    for (const char* shard : {"0/3", "1/3", "2/3"})
      REQUIRE(call({"export", "--shard", shard, "-o", out}));
    REQUIRE(call({"merge", "-o", out}));
  };
  REQUIRE(replan());
  REQUIRE(call({"segment"}));
  CHECK_FALSE(call({"analyze", "--update"}));
  CHECK(count_of(slurp(log), "without --update") == 1);
  REQUIRE(call({"analyze"}));
  finish();
  const auto before = files_of(out), work = files_of(f / "w");
  REQUIRE(call({"analyze", "--update"}));
  CHECK(count_of(slurp(log), "nothing is new") == 1);

  // Half a metre higher, and inside of all that is planned by boxes.
  Mesh changed = place(house_with_porch(2), 12);
  for (Vec3& v : changed.vertices)
    if (v.z() == 3) v.z() = 2.5;
  write_off(path(12), changed);
  REQUIRE(replan());
  REQUIRE(call({"segment"}));
  CHECK_FALSE(call({"mesh"}));  // no layers yet
  REQUIRE(call({"analyze", "--update"}));
  CHECK(count_of(slurp(log), "segments lie where") == 1);
  CHECK(count_of(slurp(log), "h12: ") == 1);
  finish();
  CHECK(count_of(slurp(log), "1 buildings have changed since the last merge: h12") == 1);
  const auto after = files_of(out), later = files_of(f / "w");

  REQUIRE(before.size() == after.size());
  CHECK(before.at("buildings/h12.glb").bytes != after.at("buildings/h12.glb").bytes);
  int same_tiles = 0, new_tiles = 0;
  for (const auto& [name, state] : before) {
    INFO(name);
    const bool is_same = state == after.at(name);
    const bool is_tile = name.starts_with("tiles/") && name.ends_with(".glb");
    if (is_tile) ++(is_same ? same_tiles : new_tiles);
    if (name.starts_with("buildings/") && name != "buildings/h12.glb") CHECK(is_same);
  }
  CHECK(new_tiles > 0);
  CHECK(same_tiles > new_tiles);
  int same_cells = 0;
  for (int cell = 0; cell < 3; ++cell)
    for (const char* end : {".colod", ".export"}) {
      const std::string name = "cell-000" + std::to_string(cell) + end;
      same_cells += work.at(name) == later.at(name);
    }
  CHECK(same_cells == 4);  // two cells' files of both kinds
  CHECK(count_of(after.at("report.json").bytes, "\"prior\": true") == 1);

  // The same as one process makes of it, and analysed anew nothing is left of the update.
  REQUIRE(call({"export", "-o", f / "one"}));
  for (const auto& [name, state] : files_of(f / "one"))
    if (!name.starts_with("report")) {
      INFO(name);
      CHECK(state.bytes == after.at(name).bytes);
    }
  REQUIRE(call({"analyze"}));
  finish();
  CHECK(count_of(slurp(fs::path(out) / "report.json"), "\"prior\": true") == 0);
}

TEST_CASE("eval --truth reads the layers back from GLB as from OBJ, and agrees with the report") {
  Folder f;
  const std::string log = f / "log";
  REQUIRE(run({"synth", "-o", f / "synth", "--buildings", "2"}, log));
  for (const char* layers : {"3", "5"}) {  // of five some are alike and share a level
    REQUIRE(run({"build", f / "synth", "-o", f / "out", "--ns", "24", "--nr", "24", "--quiet",
                 "--truth", f / "synth/truth.json", "--layers", layers},
                log));
    const std::string out = f / "eval";
    const std::string command = std::string(COLOD_BINARY) + " eval --truth " +
                                (f / "synth/truth.json") + " " + (f / "out") + " >" + out;
    REQUIRE(std::system(command.c_str()) == 0);
    const std::string text = slurp(out), report = slurp(f.path() / "out" / "report.json");
    CHECK(text.find("\"on_majority_layer\"") != std::string::npos);
    CHECK(count_of(text, "buildings_agreeing") == count_of(report, "buildings_agreeing"));
    if (std::string(layers) == "5") CHECK(count_of(report, "\"like_finer\": true") > 0);
  }
  CHECK(!run({"eval", f / "out", "--truth", f / "out/report.json"}, log));
  CHECK(!run({"eval", f / "out"}, log));
}

TEST_CASE(
    "next to nothing to analyse: one building, twins, all alike, one segment, 1, 2, 5 layers") {
  const auto source = [](const Mesh& mesh, const std::string& name) {
    return test::as_source(mesh, name);
  };
  const Mesh block = test::box_mesh({0, 0, 0}, {10, 8, 6});
  const std::vector<std::vector<Source>> scenes{
      {source(house(1), "one")},
      {source(house(1), "a"), source(house(1), "b")},
      {source(block, "a"), source(block, "b"), source(block, "c")},
      {source(block, "bare"), source(house(3), "rich")}};
  for (const int layers : {1, 2, 5})
    for (const auto& sources : scenes) {
      Options o;
      o.ns = 16, o.nr = 24, o.layers = layers;
      const Scene scene = build_scene({sources, {}}, o);
      for (const Building& b : scene.buildings) {
        INFO(b.source.name << ", " << layers << " layers of " << sources.size() << " "
                           << b.failure);
        REQUIRE(b.layers.size() == static_cast<std::size_t>(layers));
        for (const Layer& layer : b.layers) CHECK(layer.validity.is_watertight);
        for (const int l : b.layer_of_segment) CHECK((l >= 0 && l < layers));
        CHECK(std::count(b.layer_of_segment.begin(), b.layer_of_segment.end(), 0) >= 1);
      }
      if (sources.size() == 2 && sources[0].name == "a")
        CHECK(scene.buildings[0].layer_of_segment == scene.buildings[1].layer_of_segment);
    }
}
