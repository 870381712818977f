// The program itself, from outside: exit codes, files, messages.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "meshes.h"

using namespace colod;
namespace fs = std::filesystem;

namespace {

struct Result {
  int exit_code;
  std::string out, err;
};

std::string slurp(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A folder of its own that goes away with the test.
class Folder {
 public:
  Folder() {
    char name[] = "/tmp/colod-test-XXXXXX";
    path_ = mkdtemp(name);
  }
  ~Folder() { fs::remove_all(path_); }
  fs::path operator/(const std::string& name) const { return path_ / name; }
  std::string write(const std::string& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return (path_ / name).string();
  }
  Result colod(const std::string& arguments) const {
    const std::string command = std::string(COLOD_BINARY) + " " + arguments + " >" +
                                (path_ / "stdout").string() + " 2>" + (path_ / "stderr").string();
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(path_ / "stdout"),
            slurp(path_ / "stderr")};
  }

 private:
  fs::path path_;
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

const std::string kSmall = " --ns 24 --nr 40 --quiet ";

}  // namespace

TEST_CASE("build writes every file of the contract and eval finds each layer watertight") {
  Folder f;
  f.write("in/a.off", off(test::gable_house(12, 9, 6, 4)));
  f.write("in/b.off", off(test::gable_house(10, 8, 5, 3)));
  const Result r = f.colod("build " + (f / "in").string() + " -o " + (f / "out").string() + kSmall +
                           "--format glb,3dtiles,obj,ply");
  INFO(r.err);
  REQUIRE(r.exit_code == 0);
  CHECK(fs::exists(f / "out/tileset.json"));
  for (const std::string name : {"a", "b"}) {
    CHECK(fs::exists(f / ("out/buildings/" + name + ".glb")));
    for (const std::string ext : {"obj", "ply"})
      for (int k = 0; k < 3; ++k) {
        const fs::path layer =
            f / ("out/buildings/" + name + ".layer" + std::to_string(k) + "." + ext);
        const Result e =
            f.colod("eval " + (f / ("in/" + name + ".off")).string() + " " + layer.string());
        REQUIRE(e.exit_code == 0);
        const auto json = nlohmann::json::parse(e.out);
        CHECK(json["watertight"] == true);
        CHECK(json["hausdorff"]["relative"] < 0.05);
      }
  }
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
  const Result r = f.colod("build " + (f / "in").string() + " -o " + (f / "out").string() + kSmall);
  CHECK(r.exit_code == 1);
  CHECK_THAT(r.err, Catch::Contains("bad.off"));
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
  const Result bad = f.colod("build " + (f / "nothing.obj").string() + out);
  CHECK_THAT(bad.err, Catch::Contains("nothing.obj"));
  CHECK(std::count(bad.err.begin(), bad.err.end(), '\n') == 1);
}

TEST_CASE("a config file sets options, the command line wins") {
  Folder f;
  const std::string house = f.write("house.off", off(test::gable_house(12, 9, 6, 4)));
  const std::string config =
      f.write("colod.toml", "ns = 30\nnr = 32\nlayers = 2\nmin-points = 1\nrules = \"paper\"\n");
  const Result r = f.colod("build " + house + " -o " + (f / "out").string() + " --quiet --config " +
                           config + " --ns 20");
  INFO(r.err);
  REQUIRE(r.exit_code == 0);
  const auto p = nlohmann::json::parse(slurp(f / "out/report.json"))["parameters"];
  CHECK(p["ns"] == 20);
  CHECK(p["nr"] == 32);
  CHECK(p["layers"] == 2);
  CHECK(p["rules"] == "paper");
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
  REQUIRE(f.colod("build " + house + kSmall + " -o " + (f / "out").string()).exit_code == 0);
  CHECK(nlohmann::json::parse(f.colod("info " + (f / "out").string()).out)["contents"] >= 3);
  CHECK(f.colod("info " + (f / "out/buildings/house.glb").string()).exit_code == 0);
}
