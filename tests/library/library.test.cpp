// The shared library as a program that only has its header sees it.
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <regex>
#include <thread>

#include "colod/colod.h"

namespace fs = std::filesystem;

namespace {

const std::string kAssets = std::string(COLOD_SOURCE_DIR) + "/assets/neighbourhood-clean/";
const colod::Options kQuick = {{"ns", "24"}, {"layers", "2"}, {"no-report-html", "true"}};

colod::Options quick(const colod::Options& more) {
  colod::Options all = more;
  all.insert(kQuick.begin(), kQuick.end());
  return all;
}

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "colod-library-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path_ = name;
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// A box on the ground; `w` × `d` × `h` metres about (x, y).
colod::NamedMesh box(const std::string& name, double w, double d, double h, double x = 0) {
  colod::NamedMesh m;
  m.name = name;
  for (const double z : {0.0, h})
    for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
      m.points.push_back({x + i * w, j * d, z});
  m.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (int k = 0; k < 4; ++k) {
    const int n = (k + 1) % 4;
    m.triangles.push_back({k, n, n + 4});
    m.triangles.push_back({k, n + 4, k + 4});
  }
  return m;
}

double volume(const colod::Mesh& m) {
  double sum = 0;
  for (const colod::Triangle& t : m.triangles) {
    const auto &a = m.points[t[0]], &b = m.points[t[1]], &c = m.points[t[2]];
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}

std::map<std::string, std::string> by_path(const colod::Scene& scene) {
  std::map<std::string, std::string> all;
  for (colod::File& f : scene.files()) all[f.path] = std::move(f.bytes);
  return all;
}

std::map<std::string, std::string> files_below(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    all[fs::relative(entry.path(), folder).string()] = {std::istreambuf_iterator<char>(in), {}};
  }
  return all;
}

/// Reports differ in times and memory only.
std::map<std::string, std::string> timeless(std::map<std::string, std::string> files) {
  static const std::regex times(
      "\"timings\": *\\{[^}]*\\}|\"[a-z_]*(seconds?|memory_bytes)\": *[^,}\\n]*");
  auto report = files.find("report.json");
  REQUIRE(report != files.end());
  report->second = std::regex_replace(report->second, times, "");
  return files;
}

template <typename Body>
colod::Fault fault_of(const Body& body) {
  try {
    body();
  } catch (const colod::Error& e) {
    CHECK(std::string(e.what()).rfind(e.item() + ": ", 0) == 0);
    return e.fault();
  }
  FAIL("nothing was thrown");
  return {};
}

}  // namespace

TEST_CASE("arrays go in, meshes come out") {
  const colod::Scene scene =
      colod::build_meshes({box("B", 12, 8, 6, 100), box("a/b", 10, 9, 5)}, kQuick);
  CHECK(scene.status() == 0);
  REQUIRE(scene.buildings().size() == 2);
  const colod::Building& b = scene.buildings()[0];
  CHECK(b.name == "B");
  CHECK(b.source.empty());
  CHECK(b.origin[0] == Approx(106).margin(0.01));
  CHECK(scene.buildings()[1].name == "a_b");
  CHECK(scene.buildings()[1].given_name == "a/b");
  REQUIRE(b.layers.size() == 2);
  CHECK(b.layers[1].layer == 1);
  CHECK(b.layers[1].gsd == 0);
  const colod::Mesh mesh = scene.mesh(0, 1);
  CHECK(volume(mesh) == Approx(12 * 8 * 6).epsilon(1e-3));
  CHECK(mesh.normals.size() == 6);
  REQUIRE(mesh.polygon_rings.size() == 7);
  CHECK(mesh.polygon_rings.back() + 1 == static_cast<int>(mesh.ring_offsets.size()));
  CHECK(mesh.ring_offsets.back() == static_cast<int>(mesh.ring_points.size()));
  CHECK(mesh.ring_points.size() == 24);
  CHECK(mesh.polygon_of_triangle.size() == mesh.triangles.size());
  CHECK(fault_of([&] { scene.mesh(0, 2); }) == colod::Fault::kUsage);
  CHECK(fault_of([&] { scene.mesh(2, 0); }) == colod::Fault::kUsage);
}

TEST_CASE("a cloud goes in without triangles, and units and axes count for arrays") {
  colod::NamedMesh cloud{"cloud", {}, {}, {}};
  for (int i = 0; i <= 40; ++i)
    for (int j = 0; j <= 40; ++j) {
      const double u = i * 200.0, v = j * 200.0;  // millimetres, y up
      cloud.points.insert(cloud.points.end(),
                          {{u, 8000, v}, {u, v, 0}, {u, v, 8000}, {0, u, v}, {8000, u, v}});
    }
  const colod::Scene scene = colod::build_meshes({cloud}, quick({{"unit", "mm"}, {"up", "y"}}));
  REQUIRE(scene.buildings().size() == 1);
  REQUIRE(scene.buildings()[0].failure == "");
  CHECK(volume(scene.mesh(0, 1)) == Approx(512).epsilon(0.02));
}

TEST_CASE("what is wrong with one building is told of it alone") {
  colod::NamedMesh wild = box("wild", 10, 10, 5), flat = box("flat", 10, 10, 5);
  wild.triangles.push_back({0, 1, 99});
  flat.points[0][0] = std::numeric_limits<double>::quiet_NaN();
  const colod::Scene scene = colod::build_meshes({box("good", 10, 10, 5), wild, flat}, kQuick);
  CHECK(scene.status() == 1);
  CHECK(scene.buildings().size() == 2);
  std::string all;
  for (const colod::Message& m : scene.messages()) all += m.text + '\n';
  CHECK(all.find("wild: face 12 of 13 names vertex 99") != all.npos);
  CHECK(all.find("flat: ") != all.npos);
  CHECK(colod::build_meshes({wild}, kQuick).status() == 3);
}

TEST_CASE("a job that cannot be is an Error of its kind") {
  const std::vector<colod::NamedMesh> one = {box("a", 10, 9, 5)};
  CHECK(fault_of([&] { colod::build({"/nowhere/at/all"}); }) == colod::Fault::kInput);
  CHECK(fault_of([&] { colod::build_meshes(one, {{"nss", "3"}}); }) == colod::Fault::kUsage);
  CHECK(fault_of([&] { colod::build_meshes(one, {{"help", ""}}); }) == colod::Fault::kUsage);
  CHECK(fault_of([&] { colod::build_meshes(one, {{"ns", "3"}}); }) == colod::Fault::kUsage);
  CHECK(fault_of([&] { colod::build_meshes(one, {{"ns", "many"}}); }) == colod::Fault::kUsage);
  CHECK(fault_of([&] { colod::build_meshes(one, {{"format", "dwg"}}); }) == colod::Fault::kUsage);
  CHECK(fault_of([&] { colod::build_meshes(one, {{"split", "none"}}); }) == colod::Fault::kUsage);
  CHECK(fault_of([&] {
          colod::build_meshes(one, {{"crs", "EPSG:nonsense"}, {"origin", "1,2"}});
        }) == colod::Fault::kUsage);
  const colod::Scene scene = colod::build_meshes(one, kQuick);
  CHECK(fault_of([&] { scene.write("/proc/colod"); }) == colod::Fault::kOutput);
}

TEST_CASE("every listed option is one, with its help") {
  const std::vector<colod::OptionInfo> all = colod::list_options();
  CHECK(all.size() > 30);
  for (const colod::OptionInfo& o : all) {
    INFO(o.name);
    CHECK(!o.help.empty());
    CHECK(o.is_flag ==
          (o.name == "recursive" || o.name == "no-report-html" || o.name == "normal-map"));
  }
}

TEST_CASE("files are those that write writes, and those of the program") {
  const std::vector<std::string> paths = {kAssets + "house_00.obj", kAssets + "house_01.obj"};
  const colod::Scene scene =
      colod::build(paths, quick({{"format", "glb,3dtiles,3tz,engine,obj,ply"}, {"threads", "1"}}));
  const auto files = timeless(by_path(scene));
  CHECK(files.count("tileset.json") == 1);
  CHECK(files.at("report.json").find("\"bytes\"") != std::string::npos);
  const Folder ours, program;
  scene.write(ours.path().string());
  CHECK(timeless(files_below(ours.path())) == files);
  const std::string command = std::string(COLOD_BINARY) + " build " + paths[0] + " " + paths[1] +
                              " --ns 24 --layers 2 --no-report-html --quiet --format "
                              "glb,3dtiles,3tz,engine,obj,ply -o " +
                              program.path().string();
  REQUIRE(std::system(command.c_str()) == 0);
  CHECK(timeless(files_below(program.path())) == files);
}

TEST_CASE("the report is the same before files were made and after") {
  const colod::Scene scene = colod::build_meshes({box("a", 10, 9, 5)}, kQuick);
  const std::string early = scene.report_json();
  CHECK(timeless({{"report.json", early}}).at("report.json") ==
        timeless(by_path(scene)).at("report.json"));
}

TEST_CASE("progress is told, and cancelling ends the job with nothing written") {
  const std::vector<colod::NamedMesh> two = {box("a", 10, 9, 5), box("b", 12, 8, 6)};
  std::map<std::string, int> told;
  colod::build_meshes(two, kQuick,
                      {[&](const colod::Progress& p) {
                         ++told[p.stage];
                         CHECK(p.done == told[p.stage]);
                         CHECK(p.total == 2);
                       },
                       {}});
  CHECK(told == std::map<std::string, int>{{"layers", 2}, {"segments", 2}});
  // Cancelled at each of the places where it is asked, until it is asked no more.
  int asked_in_all = 0;
  for (int patience = 0; patience < 100; ++patience) {
    std::atomic<int> asked = 0;
    colod::Options options = kQuick;
    options["threads"] = "1";
    const auto job = [&] {
      colod::build_meshes(two, options, {{}, [&] { return ++asked > patience; }});
    };
    try {
      job();
      asked_in_all = asked;
      break;
    } catch (const colod::Error& e) {
      CHECK(e.fault() == colod::Fault::kCancelled);
    }
  }
  CHECK(asked_in_all >= 8);  // two buildings, two stages, two layers each
}

TEST_CASE("what a callback throws reaches the caller") {
  const std::vector<colod::NamedMesh> two = {box("a", 10, 9, 5), box("b", 12, 8, 6)};
  CHECK_THROWS_AS(
      colod::build_meshes(two, kQuick,
                          {[](const colod::Progress&) { throw std::domain_error("x"); }, {}}),
      std::domain_error);
  CHECK_THROWS_AS(
      colod::build_meshes(two, kQuick, {{}, []() -> bool { throw std::domain_error("x"); }}),
      std::domain_error);
}

TEST_CASE("two scenes at once give the bytes that they give one after the other") {
  const std::vector<std::string> paths[2] = {{kAssets + "house_00.obj", kAssets + "house_02.obj"},
                                             {kAssets + "house_01.obj", kAssets + "house_04.obj"}};
  const colod::Options options[2] = {quick({{"threads", "1"}}), quick({{"threads", "2"}})};
  std::map<std::string, std::string> serial[2], parallel[2];
  for (int i = 0; i < 2; ++i) serial[i] = timeless(by_path(colod::build(paths[i], options[i])));
  for (int round = 0; round < 2; ++round) {
    std::vector<std::thread> threads;
    for (int i = 0; i < 2; ++i)
      threads.emplace_back([&, i] { parallel[i] = by_path(colod::build(paths[i], options[i])); });
    for (std::thread& t : threads) t.join();
    for (int i = 0; i < 2; ++i) CHECK(timeless(parallel[i]) == serial[i]);
  }
}
