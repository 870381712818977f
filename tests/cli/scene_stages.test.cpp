// A scene in stages: the files of `build`, whatever happens between them.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "program.h"
#include "row_scene.h"
#include "scenes.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const std::string kFew = " --ns 24 --nr 24";

Ended run(const TempFolder& folder, const std::string& command) {
  return run_colod(folder.path, command);
}

/// segment, analyze and mesh into `file`.
void mesh_scene(const TempFolder& folder, const std::string& input, const std::string& file) {
  REQUIRE(run(folder, "segment " + input + kFew + " -o " + file).exit_code == 0);
  REQUIRE(run(folder, "analyze " + file).exit_code == 0);
  REQUIRE(run(folder, "mesh " + file).exit_code == 0);
}

std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) out.insert(fs::relative(entry.path(), folder).generic_string());
  return out;
}

}  // namespace

TEST_CASE("stages make of a scene the files that build makes, with what is around the buildings") {
  const TempFolder folder;
  write_row(folder);
  const std::string plans = folder.write("plan.geojson", kPlan), f = folder.path.string();
  const std::string rest =
      GENERATE(as<std::string>(), " --footprints PLANS", "", " --context ground --footprints PLANS",
               " --context none --footprints PLANS");
  std::string input = f + rest;
  if (const auto at = input.find("PLANS"); at != std::string::npos) input.replace(at, 5, plans);
  CAPTURE(rest);
  REQUIRE(run(folder, "build " + input + kFew + " -o " + f + "/out").exit_code == 0);
  mesh_scene(folder, input, f + "/s.colod");
  REQUIRE(run(folder, "export " + f + "/s.colod -o " + f + "/out2").exit_code == 0);
  const std::set<std::string> files = files_in(folder.path / "out");
  CHECK(files == files_in(folder.path / "out2"));
  CHECK(files.contains("footprints.geojson") == (rest.find("PLANS") == std::string::npos));
  CHECK(files.contains("tiles/context/0.glb") == (rest.find("none") == std::string::npos));
  for (const std::string& file : files) {
    if (file.starts_with("report.")) continue;  // times
    INFO(file);
    CHECK(slurp(folder.path / "out" / file) == slurp(folder.path / "out2" / file));
  }
}

TEST_CASE(
    "a place that is gone or has other buildings now costs what is around them, and says so") {
  const TempFolder folder;
  write_row(folder);
  const std::string plans = folder.write("plan.geojson", kPlan), f = folder.path.string();
  mesh_scene(folder, f + " --footprints " + plans, f + "/s.colod");
  const std::string kind = GENERATE(as<std::string>(), "tileset", "plans", "renamed", "grown");
  std::string says = "plan.geojson";
  if (kind == "tileset") fs::remove(folder.path / "tileset.json"), says = "cannot be opened again";
  if (kind == "plans") fs::remove(folder.path / "plan.geojson");
  if (kind == "renamed") {
    folder.write("plan.geojson", plan({{"east", square(12, 14, 8, 10)}}));
    says = "no building left any more: run colod segment again";
  }
  if (kind == "grown") {  // by a house that is none of the place
    fs::create_directory(folder.path / "more");
    const std::string house = folder.write("more/house.obj", obj_text(gable_house(10, 8, 5, 3)));
    mesh_scene(folder, house, f + "/s.colod");
    says = "no building house any more";
  }
  const Ended ended = run(folder, "export " + f + "/s.colod -o " + f + "/out");
  INFO(kind << ended.err);
  CHECK(ended.exit_code == 1);
  CHECK_THAT(ended.err, Contains(says) && Contains("what is around its buildings is left out"));
  CHECK(fs::exists(folder.path / "out/buildings/left.glb"));
  CHECK(!fs::exists(folder.path / "out/tiles/context"));
}

TEST_CASE("kill -9 during any stage of a scene: the same command goes on, the bytes are the same") {
  const TempFolder folder;
  write_row(folder);
  const std::string plans = folder.write("plan.geojson", kPlan);
  const std::string colod = COLOD_BINARY, f = folder.path.string();
  const auto stages = [&](const std::string& name) {
    const std::string file = f + "/" + name + ".colod";
    return std::vector<std::string>{
        "segment " + f + " --footprints " + plans + " --ns 24 --nr 24 -o " + file,
        "analyze " + file, "mesh " + file,
        "export " + file + " --no-report-html -o " + f + "/" + name};
  };
  const auto run = [&](const std::string& before, const std::string& stage) {
    return std::system((before + colod + " " + stage + " > " + f + "/log 2>&1").c_str());
  };
  for (const std::string& stage : stages("whole")) REQUIRE(run("", stage) == 0);
  for (const std::string& stage : stages("killed")) {
    for (int ms = 10; ms < 3000; ms += ms / 2 + 10)  // sooner and later, and at last not at all
      run("timeout -s KILL " + std::to_string(ms / 1000.0) + " ", stage);
    INFO(stage << slurp(folder.path / "stderr"));
    REQUIRE(run("", stage) == 0);
  }
  for (const char* file : {"tileset.json", "buildings/left.glb", "buildings/right.glb"}) {
    INFO(file);
    CHECK(slurp(folder.path / "whole" / file) == slurp(folder.path / "killed" / file));
  }
}
