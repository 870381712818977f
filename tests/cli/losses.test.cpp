// The program from outside: exit code 0 means that nothing is lost.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cmath>
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

class Folder : public test::TemporaryFolder {
 public:
  void write(const std::string& name, const Mesh& m) const {
    fs::create_directories((path() / name).parent_path());
    std::ofstream out(path() / name);
    for (const Vec3& v : m.vertices) out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    for (const Face& f : m.faces)
      out << "f " << f[0] + 1 << ' ' << f[1] + 1 << ' ' << f[2] + 1 << '\n';
  }
  int build(const std::string& input, const std::string& options = "") const {
    return test::run_colod(path(), "build " + (path() / input).string() + " -o " +
                                       (path() / "out").string() + " --ns 24 --nr 40 " + options)
        .exit_code;
  }
  std::string err() const { return slurp(path() / "stderr"); }
  nlohmann::json report() const { return nlohmann::json::parse(slurp(path() / "out/report.json")); }
};

Mesh rolling_ground() {
  constexpr int kSide = 30;
  Mesh m;
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x)
      m.vertices.emplace_back(2 * x, 2 * y, 1.5 * std::sin(0.3 * x) * std::cos(0.25 * y + 1));
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const int a = y * (kSide + 1) + x;
      m.faces.push_back({a, a + 1, a + kSide + 2});
      m.faces.push_back({a, a + kSide + 2, a + kSide + 1});
    }
  return m;
}

}  // namespace

TEST_CASE("a patch of ground fails with its reason: alone the run, among houses itself") {
  Folder f;
  f.write("in/ground.obj", rolling_ground());
  CHECK(f.build("in") == 4);
  CHECK_THAT(f.err(), Contains("ground: this looks like a part of a scene: terrain"));
  f.write("in/house.obj", test::gable_house(12, 9, 6, 4));
  CHECK(f.build("in") == 1);
  CHECK(fs::exists(f.path() / "out/buildings/house.glb"));
  CHECK(!fs::exists(f.path() / "out/buildings/ground.glb"));
  CHECK_THAT(slurp(f.path() / "out/report.html"), Contains("this looks like a part of a scene"));
}

TEST_CASE("a small body beside a large one is there, or the exit code says that it is not") {
  for (const double side : {3.0, 6.0}) {
    Folder f;
    f.write("yard.obj", test::join(test::box_mesh({0, 0, 0}, {20, 20, 6}),
                                   test::box_mesh({26, 4, 0}, {26 + side, 4 + side, 3})));
    const int code = f.build("yard.obj", "--split none");
    const auto building = f.report()["buildings"][0];
    const bool is_there = building["layers"].back()["components"] == 2;
    const bool is_much = side * side * 3 > 0.02 * 20 * 20 * 6;
    INFO(f.err());
    CHECK(code == (is_there || !is_much ? 0 : 1));
    CHECK(building["lost"] == (!is_there && is_much));
    if (!is_there) CHECK_THAT(f.err(), Contains("is on no layer"));
  }
}
