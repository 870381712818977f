// What one input, or a file beside it, may do to a whole run: nothing but fail by name.
#include <sys/stat.h>
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "meshes.h"
#include "program.h"
#include "temporary_folder.h"

using namespace colod;
using Catch::Contains;
using test::slurp;
namespace fs = std::filesystem;

namespace {

/// With `colod build in -o out` run in it.
class Folder : public test::TemporaryFolder {
 public:
  Folder() { fs::create_directories(path() / "in"); }
  fs::path in(const std::string& name) const { return path() / "in" / name; }
  fs::path out(const std::string& name) const { return path() / "out" / name; }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories(in(name).parent_path());
    std::ofstream(in(name), std::ios::binary) << text;
  }
  test::Ended build(const std::string& options = "") const {
    fs::remove_all(path() / "out");
    return test::run_colod(path(),
                           "build " + (path() / "in").string() + " -o " +
                               (path() / "out").string() + " --ns 16 --nr 10 " + options,
                           "timeout 120");
  }
  nlohmann::json report() const {
    return nlohmann::json::parse(slurp(out("report.json")), nullptr, false);
  }
};

std::string obj(const Mesh& m) {
  std::string text;
  for (const Vec3& v : m.vertices)
    text += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " +
            std::to_string(v.z()) + "\n";
  for (const Face& f : m.faces)
    text += "f " + std::to_string(f[0] + 1) + " " + std::to_string(f[1] + 1) + " " +
            std::to_string(f[2] + 1) + "\n";
  return text;
}

Mesh house_at(const Vec3& at) {
  Mesh m = test::gable_house(12, 8, 6, 3);
  for (Vec3& v : m.vertices) v += at;
  return m;
}

const Vec3 kUtm(691000, 5334000, 500);

}  // namespace

TEST_CASE("a stray triangle or vertex costs neither its building nor the others") {
  Mesh piece = house_at(kUtm + Vec3(30, 0, 0)), sliver = house_at(kUtm + Vec3(60, 0, 0));
  const Vec3 there = kUtm + Vec3(30, 700, 0);
  piece.vertices.insert(piece.vertices.end(),
                        {there, there + Vec3(1, 0, 0), there + Vec3(0, 1, 0)});
  piece.faces.push_back({10, 11, 12});
  sliver.vertices.emplace_back(0, 0, 0);
  sliver.faces.push_back({4, 5, 10});
  const Folder f;
  f.write("good.obj", obj(house_at(kUtm)));
  f.write("piece.obj", obj(piece));
  f.write("sliver.obj", obj(sliver));
  const test::Ended r = f.build("--quiet");
  INFO(r.err);
  CHECK(r.exit_code == 0);
  CHECK(fs::exists(f.out("tileset.json")));
  const auto report = f.report();
  for (const auto& b : report["buildings"]) {
    CHECK(b["layers"].back()["volume"].get<double>() == Approx(720).epsilon(0.02));
    CHECK(b["left_out"].size() == (b["name"] == "good" ? 0 : 1));
  }
}

TEST_CASE("a bad file beside the input leaves the tileset local, with a line") {
  const Folder f;
  f.write("good.obj", obj(house_at({0, 0, 0})));
  const auto check = [&](const std::string& what) {
    const test::Ended r = f.build();
    INFO(what << ": " << r.err);
    CHECK(r.exit_code == 0);
    CHECK_THAT(r.err, Contains("metadata.xml") && Contains("stays local"));
    CHECK(r.err.size() < 2000);
    CHECK(fs::exists(f.out("tileset.json")));
    CHECK(fs::exists(f.out("report.json")));
  };
  const std::string origin = "<SRSOrigin>0,0,0</SRSOrigin></M>";
  for (const std::string& text :
       {"<M><SRS>EPSG:4326</SRS>" + origin, "<M><SRS>nonsense</SRS>" + origin,
        std::string("<M><SRS>EPSG:25832</SRS><SRSOrigin>1e9,1e9,0</SRSOrigin></M>"),
        std::string("\1\2 no XML"), "<SRS>" + std::string(60000, 'A') + "</SRS>",
        "<M><SRS>EPSG:25832</SRS><SRSOrigin>" + std::string(60000, '1') + "</SRSOrigin></M>"}) {
    f.write("metadata.xml", text);
    check(text.substr(0, 60));
  }
  fs::remove(f.in("metadata.xml"));
  REQUIRE(mkfifo(f.in("metadata.xml").c_str(), 0600) == 0);
  check("a pipe");
}

TEST_CASE("a place that is none is refused before the work") {
  const Folder f;
  f.write("good.obj", obj(house_at(kUtm)));
  for (const char* options : {"--crs EPSG:4326", "--crs nonsense", "--origin 1"}) {
    const test::Ended r = f.build(options);
    INFO(options << ": " << r.err);
    CHECK(r.exit_code == 2);
    CHECK(!fs::exists(f.out("buildings")));
  }
}

TEST_CASE("a tileset that has no place fails alone: buildings and report are written") {
  const Folder f;
  f.write("good.obj", obj(house_at({1e9, 1e9, 0})));
  const test::Ended r = f.build("--crs EPSG:25832");
  INFO(r.err);
  CHECK(r.exit_code == 1);
  CHECK_THAT(r.err, Contains("tileset.json"));
  CHECK(fs::exists(f.out("buildings/good.glb")));
  CHECK(f.report()["failures"][0]["source"] == "tileset.json");
}

TEST_CASE("odd entries of a folder fail by name, the rest is built") {
  const Folder f;
  f.write("a.obj", obj(house_at({0, 0, 0})));
  fs::create_symlink("loop.obj", f.in("loop.obj"));
  fs::create_symlink("/dev/zero", f.in("z.obj"));
  REQUIRE(mkfifo(f.in("f.obj").c_str(), 0600) == 0);
  f.write("deep/b.obj", obj(house_at({20, 0, 0})));
  const test::Ended r = f.build();
  INFO(r.err);
  CHECK(r.exit_code == 1);
  CHECK(fs::exists(f.out("buildings/a.glb")));
  CHECK(f.report()["failures"].size() == 3);
  CHECK_THAT(r.err, Contains("loop.obj") && Contains("z.obj") && Contains("f.obj"));
  CHECK_THAT(f.report()["warnings"].dump(), Contains("--recursive"));
  CHECK(f.build("--recursive --quiet").exit_code == 1);
  CHECK(f.report()["buildings"].size() == 2);
}

TEST_CASE("axes and units that look wrong are named with their option, degrees refused") {
  Mesh lying = house_at({0, 0, 0}), large = lying, degrees = lying;
  for (Vec3& v : lying.vertices) v = Vec3(v.x(), v.z(), -v.y());
  for (Vec3& v : large.vertices) v *= 1000;
  for (Vec3& v : degrees.vertices)
    v = Vec3(11.5761 + v.x() / 74000, 48.1372 + v.y() / 111000, v.z());
  const Folder f;
  f.write("a.obj", obj(lying));
  CHECK_THAT(f.build().err, Contains("--up y"));
  CHECK_THAT(f.build("--up auto").err, Contains("taken as y up"));
  f.write("a.obj", obj(large));
  CHECK_THAT(f.build().err, Contains("--unit mm"));
  CHECK(f.build("--unit mm --quiet").err == "");
  f.write("a.obj", obj(degrees));
  const test::Ended r = f.build();
  CHECK(r.exit_code == 3);
  CHECK_THAT(r.err, Contains("degrees"));
}
