// The program itself, from outside: exit codes, files, messages.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "meshes.h"
#include "program.h"
#include "temporary_folder.h"

using namespace colod;
using test::slurp;
namespace fs = std::filesystem;

namespace {

/// With colod run in it.
class Folder : public test::TemporaryFolder {
 public:
  std::string write(const std::string& name, const std::string& text) const {
    fs::create_directories((path() / name).parent_path());
    std::ofstream(path() / name, std::ios::binary) << text;
    return (path() / name).string();
  }
  test::Ended colod(const std::string& arguments) const {
    return test::run_colod(path(), arguments);
  }
};

std::string off(const Mesh& m) {
  std::string text =
      "OFF\n" + std::to_string(m.vertices.size()) + " " + std::to_string(m.faces.size()) + " 0\n";
  for (const Vec3& v : m.vertices)
    text +=
        std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z()) + "\n";
  for (const Face& f : m.faces)
    text += "3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) +
            "\n";
  return text;
}

/// Every file of two folders alike, but for the report's seconds.
bool is_same(const fs::path& a, const fs::path& b) {
  std::map<std::string, std::string> files[2];
  for (const int side : {0, 1})
    for (const auto& entry : fs::recursive_directory_iterator(side == 0 ? a : b))
      if (entry.is_regular_file() && entry.path().stem() != "report")
        files[side][fs::relative(entry.path(), side == 0 ? a : b).string()] = slurp(entry.path());
  return !files[0].empty() && files[0] == files[1];
}

const std::string kSmall = " --ns 24 --nr 40 --quiet ";

}  // namespace

TEST_CASE("build writes every file of the contract and eval finds each layer watertight") {
  Folder f;
  f.write("in/a.off", off(test::gable_house(12, 9, 6, 4)));
  f.write("in/b.off", off(test::gable_house(10, 8, 5, 3)));
  const test::Ended r = f.colod("build " + (f / "in").string() + " -o " + (f / "out").string() +
                                kSmall + "--format glb,3dtiles,obj,ply");
  INFO(r.err);
  REQUIRE(r.exit_code == 0);
  CHECK(fs::exists(f / "out/tileset.json"));
  for (const std::string name : {"a", "b"}) {
    CHECK(fs::exists(f / ("out/buildings/" + name + ".glb")));
    for (const std::string ext : {"obj", "ply"})
      for (int k = 0; k < 3; ++k) {
        const fs::path layer =
            f / ("out/buildings/" + name + ".layer" + std::to_string(k) + "." + ext);
        const test::Ended e =
            f.colod("eval " + (f / ("in/" + name + ".off")).string() + " " + layer.string());
        REQUIRE(e.exit_code == 0);
        const auto json = nlohmann::json::parse(e.out);
        CHECK(json["watertight"] == true);
        CHECK(json["hausdorff"]["relative"] < 0.05);
      }
  }
  CHECK_THAT(slurp(f / "out/report.html"), Catch::Contains("data:image/png;base64,"));
  const auto report = nlohmann::json::parse(slurp(f / "out/report.json"));
  CHECK(report["buildings"].size() == 2);
  CHECK(report["parameters"]["ns"] == 24);
  for (const auto& entry : fs::recursive_directory_iterator(f / "out"))
    CHECK(entry.path().extension() != ".tmp");
}

TEST_CASE("a bad building among good ones: exit 1, the others complete, one line says why") {
  Folder f;
  f.write("in/good.off", off(test::gable_house(12, 9, 6, 4)));
  f.write("in/bad.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  const test::Ended r =
      f.colod("build " + (f / "in").string() + " -o " + (f / "out").string() + kSmall);
  CHECK(r.exit_code == 1);
  CHECK_THAT(r.err, Catch::Contains("bad.off"));
  CHECK_THAT(slurp(f / "out/report.html"), Catch::Contains("bad.off"));
  CHECK(fs::exists(f / "out/buildings/good.glb"));
  CHECK(fs::exists(f / "out/tileset.json"));
}

TEST_CASE("exit codes say what kind of thing went wrong") {
  Folder f;
  const std::string house = f.write("house.off", off(test::gable_house(12, 9, 6, 4)));
  const std::string out = " -o " + (f / "out").string();
  CHECK(f.colod("").exit_code == 2);
  CHECK(f.colod("frobnicate").exit_code == 2);
  CHECK(f.colod("--help").exit_code == 0);
  CHECK(f.colod("build " + house).exit_code == 2);
  CHECK(f.colod("build " + house + out + " --ns 3").exit_code == 2);
  CHECK(f.colod("build " + house + out + " --ns 40.5").exit_code == 2);
  CHECK(f.colod("build " + house + out + " --beta nan").exit_code == 2);
  CHECK(f.colod("build " + house + out + " --format docx").exit_code == 2);
  CHECK(f.colod("build " + (f / "nothing.obj").string() + out).exit_code == 3);
  CHECK(f.colod("build " + f.write("empty.obj", "") + out).exit_code == 3);
  CHECK(f.colod("build " + f.write("nan.off", "OFF\n3 1 0\nnan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n") + out)
            .exit_code == 3);
  CHECK(f.colod("eval " + house + " " + (f / "nothing.obj").string()).exit_code == 3);
  CHECK(f.colod("build " + house + kSmall + " -o /proc/no/such/place").exit_code == 5);
  const test::Ended bad = f.colod("build " + (f / "nothing.obj").string() + out);
  CHECK_THAT(bad.err, Catch::Contains("nothing.obj"));
  CHECK(std::count(bad.err.begin(), bad.err.end(), '\n') == 1);
}

TEST_CASE("a config file sets options, the command line wins") {
  Folder f;
  const std::string house = f.write("house.off", off(test::gable_house(12, 9, 6, 4)));
  const std::string config =
      f.write("colod.toml",
              "ns = 30\nnr = 32\nlayers = 2\nmin-points = 1\nrules = \"paper\"\n"
              "visibility = \"sweep\"\n");
  const test::Ended r = f.colod("build " + house + " -o " + (f / "out").string() +
                                " --quiet --config " + config + " --ns 20");
  INFO(r.err);
  REQUIRE(r.exit_code == 0);
  const auto p = nlohmann::json::parse(slurp(f / "out/report.json"))["parameters"];
  CHECK(p["ns"] == 20);
  CHECK(p["nr"] == 32);
  CHECK(p["layers"] == 2);
  CHECK(p["rules"] == "paper");
  CHECK(p["visibility"] == "sweep");
  CHECK(f.colod("build " + house + " -o " + (f / "out").string() + " --config " +
                f.write("bad.toml", "nonsense = 3\n"))
            .exit_code == 2);
}

TEST_CASE("info tells what a mesh and a folder of ours hold") {
  Folder f;
  const std::string house = f.write("house.off", off(test::gable_house(12, 9, 6, 4)));
  const auto json = nlohmann::json::parse(f.colod("info " + house).out);
  CHECK(json["watertight"] == true);
  CHECK(json["faces"] == 16);
  REQUIRE(f.colod("build " + house + kSmall + " -o " + (f / "out").string() + " --no-report-html")
              .exit_code == 0);
  CHECK(!fs::exists(f / "out/report.html"));
  CHECK(nlohmann::json::parse(f.colod("info " + (f / "out").string()).out)["contents"] >= 2);
  CHECK(f.colod("info " + (f / "out/buildings/house.glb").string()).exit_code == 0);
}

TEST_CASE("threads and stages do not change a byte, and a stage goes on where it was killed") {
  Folder f;
  for (const int i : {0, 1, 2})
    f.write("in/h" + std::to_string(i) + ".off", off(test::gable_house(10 + 2 * i, 9, 6, 3 + i)));
  const std::string in = (f / "in").string(), scene = (f / "s.colod").string();
  const std::string small = " --ns 12 --nr 16 --quiet ";
  REQUIRE(f.colod("build " + in + small + "--threads 1 -o " + (f / "one").string()).exit_code == 0);
  REQUIRE(f.colod("build " + in + small + "--threads 2 -o " + (f / "two").string()).exit_code == 0);
  CHECK(is_same(f / "one", f / "two"));
  REQUIRE(f.colod("segment " + in + small + "-o " + scene).exit_code == 0);
  REQUIRE(f.colod("analyze " + scene).exit_code == 0);
  [[maybe_unused]] const int killed = std::system(
      ("timeout -s KILL 0.3 " COLOD_BINARY " mesh --threads 1 " + scene + " 2>&1 | cat >/dev/null")
          .c_str());
  REQUIRE(f.colod("mesh --quiet " + scene).exit_code == 0);
  REQUIRE(f.colod("export --quiet " + scene + " -o " + (f / "stages").string()).exit_code == 0);
  CHECK(is_same(f / "one", f / "stages"));
}

TEST_CASE("an interrupted run leaves whole files only") {
  Folder f;
  const std::string house = f.write("h.off", off(test::gable_house(12, 9, 6, 4)));
  const std::string scene = (f / "s.colod").string();
  REQUIRE(f.colod("segment " + house + " --ns 12 --nr 16 -o " + scene).exit_code == 0);
  REQUIRE(f.colod("analyze " + scene).exit_code == 0);
  REQUIRE(f.colod("mesh " + scene).exit_code == 0);
  for (int i = 1; i <= 10; ++i)
    [[maybe_unused]] const int status = std::system(
        ("timeout -s INT 0.0" + std::to_string(10 + 2 * i) + " " COLOD_BINARY " export " + scene +
         " --quiet --format glb,3dtiles,obj,ply -o " + (f / "out").string())
            .c_str());
  if (!fs::exists(f / "out")) return;  // a slow machine
  for (const auto& entry : fs::recursive_directory_iterator(f / "out"))
    CHECK(entry.path().string().find(".tmp") == std::string::npos);
}

TEST_CASE("all buildings of a scene switch alike, or each for itself, as asked") {
  Folder f;
  const std::string assets = std::string(COLOD_SOURCE_DIR) + "/assets/neighbourhood/";
  const std::string scene_file = (f / "s.colod").string(), out = (f / "out").string();
  REQUIRE(f.colod("segment " + assets + "house_02.ply " + assets + "house_03.ply " + assets +
                  "house_04.ply --ns 40 --nr 40 -o " + scene_file)
              .exit_code == 0);
  REQUIRE(f.colod("analyze " + scene_file).exit_code == 0);
  REQUIRE(f.colod("mesh " + scene_file).exit_code == 0);
  const auto gsds = [&](const std::string& options) {
    REQUIRE(f.colod("export " + scene_file + " --format glb,3dtiles,engine --no-report-html " +
                    options + " -o " + out)
                .exit_code == 0);
    CHECK(f.colod("info --check " + out).exit_code == 0);
    std::set<double> found;
    const auto report = nlohmann::json::parse(slurp(out + "/report.json"));
    for (const auto& b : report["buildings"]) found.insert(b["layers"][1]["gsd"].get<double>());
    return found;
  };
  const std::set<double> scene = gsds(""), own = gsds("--switch-scope building");
  REQUIRE(scene.size() == 1);
  CHECK(own.size() == 3);
  CHECK(*scene.begin() == *own.rbegin());  // of three buildings nine in ten are all
  CHECK(*gsds("--switch-share 0.1").begin() == *own.begin());
  CHECK(*gsds("--visual-error 16").begin() < *scene.begin());
  CHECK(*gsds("--switch deviation").begin() > *scene.begin());
  CHECK(gsds("--visual-error 16 --prior " + scene_file) == gsds("--visual-error 16"));
  CHECK(f.colod("export " + scene_file + " --switch loud -o " + out).exit_code == 2);
  CHECK(f.colod("export " + scene_file + " --visual-error 0 -o " + out).exit_code == 2);
}

TEST_CASE("stages refuse what is newer than their input, and what is damaged") {
  Folder f;
  const std::string house = f.write("a.off", off(test::gable_house(12, 9, 6, 4)));
  const std::string scene = (f / "s.colod").string(), out = " -o " + (f / "out").string();
  const std::string segment = "segment --ns 12 --nr 16 --quiet -o " + scene + " ";
  REQUIRE(f.colod(segment + house).exit_code == 0);
  CHECK(f.colod("mesh " + scene).exit_code == 3);
  REQUIRE(f.colod("analyze " + scene).exit_code == 0);
  CHECK(f.colod("export " + scene + out).exit_code == 3);
  f.write("a.off", off(test::gable_house(12, 9, 7, 4)));
  REQUIRE(f.colod(segment + house).exit_code == 0);
  CHECK(f.colod("mesh " + scene).exit_code == 3);
  CHECK(f.colod("analyze " + scene + " " + scene).exit_code == 3);
  REQUIRE(f.colod(segment + house + " --layers 2").exit_code == 0);
  CHECK(f.colod("mesh " + scene).exit_code == 3);
  CHECK(f.colod("analyze " + house).exit_code == 3);
  std::string bytes = slurp(scene);
  CHECK(f.colod("analyze " + f.write("cut.colod", bytes.substr(0, bytes.size() / 2))).exit_code ==
        3);
}

TEST_CASE("odd names, odd bytes and an output that cannot be: no half of anything") {
  Folder f;
  const std::string house = off(test::gable_house(12, 9, 6, 4));
  f.write("in/with blank \xC3\xBC.off", house);
  f.write("in/latin \xFC.off", house);
  f.write("in/" + std::string(240, 'x') + ".off", house);
  f.write("in/bad \xFC\n.off", "OFF\n\xFF\x01 3 0\n");
  const std::string in = " '" + (f / "in").string() + "' ", small = " --ns 12 --nr 16 --quiet ";
  const test::Ended r = f.colod("build" + in + small + "-o " + (f / "out").string());
  CHECK(r.exit_code == 1);
  CHECK(std::count(r.err.begin(), r.err.end(), '\n') == 1);
  CHECK(nlohmann::json::parse(slurp(f / "out/report.json"))["buildings"].size() == 3);
  for (const auto& entry : fs::recursive_directory_iterator(f / "out"))
    CHECK(entry.path().string().find(".tmp") == std::string::npos);
  f.write("file", "kept");
  CHECK(f.colod("build" + in + "-o " + (f / "file").string()).exit_code == 5);
  CHECK(slurp(f / "file") == "kept");
  CHECK(f.colod("build" + in + "-o ''").exit_code == 5);
  for (const std::string text : {"{}", "[", "{\"root\":[1]}"})
    CHECK(f.colod("info " + f.write("tileset.json", text)).exit_code == 3);
  CHECK(f.colod("info " + f.write("t.json", R"({"root":{"children":[{},5]}})")).exit_code == 0);
}

TEST_CASE("place, winding and repetition of faces do not matter") {
  Folder f;
  Mesh house = test::gable_house(12, 9, 6, 4);
  const Mesh plain = house;
  for (Vec3& v : house.vertices) v += Vec3(1e7, -1e7, 100);
  for (std::size_t i = 0; i < house.faces.size(); i += 2)
    std::swap(house.faces[i][1], house.faces[i][2]);
  house.faces.insert(house.faces.end(), plain.faces.begin(), plain.faces.end());
  house.faces.push_back({0, 0, 1});
  const std::string path = f.write("h.off", off(house));
  REQUIRE(f.colod("build " + path + kSmall + "--format ply -o " + (f / "o").string()).exit_code ==
          0);
  const test::Ended e = f.colod("eval " + f.write("p.off", off(house)) + " " +
                                (f / "o/buildings/h.layer2.ply").string());
  const auto json = nlohmann::json::parse(e.out);
  CHECK(json["watertight"] == true);
  CHECK(json["volume"].get<double>() == Approx(12 * 9 * 8).epsilon(0.01));
}

TEST_CASE(
    "no option takes what is no number, or more than its range, and says so before the work") {
  Folder f;
  const std::string in = f.write("a.off", off(test::gable_house(12, 9, 6, 4)));
  const std::string build = "build " + in + " -o " + (f / "out").string() + kSmall;
  for (const std::string option :
       {"ns", "nr", "layers", "alcove-area", "beta", "lambda", "eta", "gap", "distance", "angle",
        "min-points", "seed", "quantization", "target-sse", "visual-error", "pixel-error",
        "switch-share", "input-memory", "threads"})
    for (const char* value : {"nan", "-nan", "inf", "-inf", "1e300", "-1", "x", "''"}) {
      INFO(option << " " << value);
      const test::Ended result = f.colod(build + "--" + option + "=" + value);
      CHECK(result.exit_code == 2);
      CHECK_THAT(result.err, Catch::Contains("--" + option));
      CHECK_FALSE(fs::exists(f / "out"));
    }
  for (const char* value : {"nan,1", "48,11,1e300", "1,inf", "48", "a,b"})
    CHECK(f.colod(build + "--origin=" + value).exit_code == 2);
}

TEST_CASE("an option that takes more than the machine has is refused with the most that fits") {
  Folder f;
  for (int i = 0; i < 64; ++i)
    f.write("in/" + std::to_string(i) + ".off", off(test::gable_house(12, 9, 6, 4)));
  const test::Ended result = f.colod("build " + (f / "in").string() + " -o " +
                                     (f / "out").string() + " --ns 1000 --threads 4096");
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.err, Catch::Contains("--ns: 1000 takes about 14.9 GiB a building") &&
                             Catch::Contains("at most"));
}

TEST_CASE("an answer that does not arrive, and a file that may not grow, are errors") {
  Folder f;
  const std::string in = f.write("a.off", off(test::gable_house(12, 9, 6, 4)));
  REQUIRE(f.colod("build " + in + " -o " + (f / "out").string() + kSmall).exit_code == 0);
  for (const std::string& command :
       {"info " + in, "info --check " + (f / "out").string(), "eval " + in + " " + in}) {
    const std::string full =
        std::string(COLOD_BINARY) + " " + command + " >/dev/full 2>" + (f / "said").string();
    CHECK(WEXITSTATUS(std::system(full.c_str())) == 5);
    CHECK_THAT(slurp(f / "said"), Catch::Contains("stdout"));
  }
  for (const std::string blocks : {"1", "4"}) {
    const std::string out = (f / ("limited" + blocks)).string();
    const std::string limited = "ulimit -f " + blocks + "; " + COLOD_BINARY + " build " + in +
                                " -o " + out + kSmall + " 2>" + (f / "said").string();
    CHECK(WEXITSTATUS(std::system(limited.c_str())) == 5);
    CHECK_THAT(slurp(f / "said"), Catch::Contains("File too large"));
    for (const auto& entry : fs::recursive_directory_iterator(out))
      CHECK(entry.path().string().find(".tmp") == std::string::npos);
  }
}

TEST_CASE("in what order a scene file grew shows in no tile") {
  Folder f;
  const std::vector<std::string> names = {"a", "b", "c", "d", "e"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    Mesh house = test::gable_house(12 + static_cast<double>(i), 9, 6, 4);
    for (Vec3& v : house.vertices) v.x() += 30 * static_cast<double>(i);
    f.write("in/" + names[i] + ".off", off(house));
  }
  const std::string scene = (f / "s.colod").string(), grown = (f / "g.colod").string();
  REQUIRE(f.colod("segment " + (f / "in").string() + " -o " + scene + kSmall).exit_code == 0);
  for (const char* name : {"d", "a", "e", "c", "b"})
    REQUIRE(f.colod("segment " + (f / "in").string() + "/" + name + ".off -o " + grown + kSmall)
                .exit_code == 0);
  for (const std::string& file : {scene, grown}) {
    REQUIRE(f.colod("analyze " + file).exit_code == 0);
    REQUIRE(f.colod("mesh " + file).exit_code == 0);
    REQUIRE(
        f.colod("export " + file + " -o " + file + ".out --format glb,3dtiles,3tz,engine --quiet")
            .exit_code == 0);
  }
  CHECK(is_same(scene + ".out", grown + ".out"));
}
