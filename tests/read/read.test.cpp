#include "read/read.h"

#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "core/error.h"
#include "read_helpers.h"
#include "shared_data.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;

namespace {

const Vec3 kFar(691234.56789012, 5334567.8912345, 512.3456789);
const Mesh kHouse = gable_house(10, 8, 6, 3);

Mesh moved(Mesh m, const Vec3& by) {
  for (Vec3& p : m.vertices) p += by;
  return m;
}

/// The one source that reading must give.
Source only(const ReadResult& result) {
  for (const ReadFailure& f : result.failures) UNSCOPED_INFO(f.path << ": " << f.message);
  REQUIRE(result.sources.size() == 1);
  return result.sources.front();
}

std::vector<std::string> names(const ReadResult& result) {
  std::vector<std::string> out;
  for (const Source& s : result.sources) out.push_back(s.name);
  return out;
}

using Names = std::vector<std::string>;

/// A unit sphere's points, outward normals known: the points themselves.
std::string sphere_xyz(int n, bool has_normals) {
  std::ostringstream out;
  std::mt19937_64 random(7);
  const auto draw = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int i = 0; i < n; ++i) {
    const double z = 2 * draw() - 1, a = 2 * M_PI * draw(), r = std::sqrt(1 - z * z);
    out << r * std::cos(a) << ' ' << r * std::sin(a) << ' ' << z;
    if (has_normals) out << ' ' << r * std::cos(a) << ' ' << r * std::sin(a) << ' ' << z;
    out << '\n';
  }
  return out.str();
}

}  // namespace

TEST_CASE("every format gives the house back") {
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.off", off_text(kHouse)},
      {"a.obj", obj_text(kHouse)},
      {"a.stl", stl_bytes(kHouse)},
      {"a.PLY", ply_bytes<float>(kHouse, false)},
      {"a.ply", ply_bytes<double>(kHouse, true)}};
  for (const auto& [name, bytes] : files) {
    INFO(name);
    const Source s = only(read_bytes(name, bytes));
    CHECK(s.name == "a");
    CHECK(s.mesh.vertices.size() == 10);
    CHECK(s.mesh.faces.size() == 16);
    CHECK(signed_volume(s.mesh) == Approx(signed_volume(kHouse)));
    CHECK(s.warnings.empty());
  }
}

TEST_CASE("coordinates of 10^6 metres lose no digit") {
  const Mesh far = moved(kHouse, kFar);
  CHECK(only(read_bytes("a.off", off_text(far))).mesh.vertices == far.vertices);
  CHECK(only(read_bytes("a.obj", obj_text(far))).mesh.vertices == far.vertices);
  CHECK(only(read_bytes("a.ply", ply_bytes<double>(far, false))).mesh.vertices == far.vertices);
  CHECK(only(read_bytes("a.ply", ply_bytes<double>(far, true))).mesh.vertices == far.vertices);
}

TEST_CASE("the PLY property object is kept per face") {
  const Source s = only(read_bytes("a.ply", ply_bytes<float>(kHouse, false)));
  REQUIRE(s.face_object.size() == 16);
  CHECK(s.face_object[5] == 5);
}

TEST_CASE("text PLY reads lists, negative objects and other elements") {
  const Source s = only(read_bytes(
      "a.ply",
      "ply\r\nformat ascii 1.0\r\ncomment x\r\nelement camera 1\r\nproperty list uchar float v\r\n"
      "element vertex 4\r\nproperty double x\r\nproperty double y\r\nproperty double z\r\n"
      "element face 1\r\nproperty int object\r\nproperty list uchar uint vertex_index\r\n"
      "end_header\r\n2 0.5 0.5\r\n0 0 0\r\n1 0 0\r\n1 1 0\r\n0 1 0\r\n-1 4 0 1 2 3\r\n"));
  CHECK(s.mesh.faces.size() == 2);
  CHECK(s.face_object == std::vector<int>{-1, -1});
}

TEST_CASE("a missing input is an error, an unreadable file a failure beside the good ones") {
  CHECK_THROWS_AS(read_sources({"/nonexistent/a.obj"}), Error);
  const TempFolder folder;
  CHECK_THROWS_WITH(read_sources({folder.path.string()}), Contains("no file"));
  folder.write("good.obj", obj_text(kHouse));
  folder.write("bad.obj", "v 0 0 zero\n");
  folder.write("notes.txt", "not a mesh");
  const ReadResult r = read_sources({folder.path.string()});
  CHECK(names(r) == Names{"good"});
  REQUIRE(r.failures.size() == 1);
  CHECK_THAT(r.failures[0].path, Contains("bad.obj"));
  CHECK(r.failures[0].message == "line 1: 'zero' is not a number");
}

TEST_CASE("bad files are named with their place") {
  CHECK_THAT(failure("a.obj", ""), Contains("empty"));
  CHECK_THAT(failure("a.xml", "<a/>"), Contains("unknown format"));
  CHECK_THAT(failure("a.obj", "v 0 0\nv 1 0 0\n"), Contains("line 1"));
  CHECK_THAT(failure("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), Contains("face 0 of 1"));
  CHECK_THAT(failure("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n"), Contains("line 4"));
  CHECK_THAT(failure("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4\n"), Contains("line 4"));
  CHECK_THAT(failure("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999\n"),
             Contains("line 4"));
  CHECK_THAT(failure("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n"), Contains("2 of 3 vertices"));
  CHECK_THAT(failure("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"), Contains("face 0"));
  CHECK_THAT(failure("a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
             Contains("1 of 2 faces"));
  CHECK_THAT(failure("a.off", "PLY"), Contains("no OFF"));
  CHECK_THAT(failure("a.ply", "ply\nformat ascii 1.0\nelement vertex 9\n"), Contains("end_header"));
  CHECK_THAT(failure("a.xyz", "1 2 3\n1 2\n"), Contains("line 2"));
  CHECK_THAT(failure("a.glb", "glTF\2"), Contains("truncated"));
  CHECK_THAT(failure("a.gltf", "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[3]}]}"),
             Contains("node 3"));
}

TEST_CASE("truncated binary files name the vertex or face where they end") {
  const std::string ply = ply_bytes<float>(kHouse, false);
  CHECK_THAT(failure("a.ply", ply.substr(0, ply.size() - 3)), Contains("face 15 of 16"));
  CHECK_THAT(failure("a.ply", ply.substr(0, ply.find("end_header\n") + 11 + 14)),
             Contains("vertex 1 of 10"));
  const std::string stl = stl_bytes(kHouse);
  CHECK_THAT(failure("a.stl", stl.substr(0, stl.size() - 3)), Contains("face 15 of 16"));
  const std::string glb = glb_bytes(kHouse, R"([{"mesh":0}])", "[0]");
  CHECK_THAT(failure("a.glb", glb.substr(0, glb.size() - 3)), Contains("truncated"));
}

TEST_CASE("faces on NaN are left out with a warning, and no NaN comes in") {
  std::string text = obj_text(kHouse);
  text.replace(0, text.find('\n'), "v nan 0 0");
  const Source s = only(read_bytes("a.obj", text));
  CHECK(s.mesh.vertices.size() == 9);
  CHECK(s.mesh.faces.size() < 16);
  CHECK(bounding_box(s.mesh.vertices).diagonal() < 20);
  REQUIRE(s.warnings.size() == 1);
  CHECK_THAT(s.warnings[0], Contains("not finite"));
  CHECK(
      only(read_bytes("a.xyz", "0 0 0\n1 0 0\n0 1 0\ninf 0 0\n1e400 1 1\n")).cloud.points.size() ==
      3);
}

TEST_CASE("a single triangle is a building, no area is none, points alone are a cloud") {
  CHECK(only(read_bytes("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3")).mesh.faces.size() == 1);
  CHECK_THAT(failure("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 2\n"),
             Contains("none of 2 faces"));
  CHECK(!only(read_bytes("a.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n")).is_mesh());
  CHECK_THAT(failure("a.off", "OFF\n0 0 0\n"), Contains("neither"));
}

TEST_CASE("faces of fewer than three corners are counted, degenerate ones kept") {
  const Source s =
      only(read_bytes("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\nf 1 2 3\nf 1 1 2\n"));
  CHECK(s.mesh.faces.size() == 2);
  REQUIRE(s.warnings.size() == 1);
  CHECK_THAT(s.warnings[0], Contains("line 4"));
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n";
  const Source off = only(read_bytes("a.off", "OFF\n3 2 0\n" + corners + "2 0 1\n3 0 1 2\n"));
  REQUIRE(off.warnings.size() == 1);
  CHECK_THAT(off.warnings[0], Contains("1 faces") && Contains("line 6"));
  const Source ply = only(read_bytes(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 3\nproperty list uchar int vertex_indices\nend_header\n" +
          corners + "3 0 1 2\n2 0 1\n1 0\n"));
  REQUIRE(ply.warnings.size() == 1);
  CHECK_THAT(ply.warnings[0], Contains("2 faces") && Contains("face 1"));
}

TEST_CASE("concave polygons keep their area and winding") {
  const Source l = only(
      read_bytes("a.obj", "v 0 0 0\nv 4 0 0\nv 4 1 0\nv 1 1 0\nv 1 4 0\nv 0 4 0\nf 3 4 5 6 1 2\n"));
  CHECK(surface_area(l.mesh) == Approx(7));
  for (const Face& f : l.mesh.faces) CHECK(face_cross(l.mesh, f).z() > 0);
  std::mt19937_64 random(3);  // stars with random radii, tilted
  for (int trial = 0; trial < 50; ++trial) {
    std::string text, face = "f";
    double area = 0;
    std::vector<Vec2> p;
    const int n = 4 + static_cast<int>(random() % 30);
    for (int i = 0; i < n; ++i) {
      const double r = 1 + static_cast<double>(random() % 1000) / 100, a = 2 * M_PI * i / n;
      p.emplace_back(r * std::cos(a), r * std::sin(a));
      text += "v " + std::to_string(p[i].x()) + " " + std::to_string(p[i].y()) + " " +
              std::to_string(p[i].x() + 2 * p[i].y()) + "\n";
      face += " " + std::to_string(i + 1);
    }
    for (int i = 0; i < n; ++i)
      area += 0.5 * (p[i].x() * p[(i + 1) % n].y() - p[i].y() * p[(i + 1) % n].x());
    const Source s = only(read_bytes("a.obj", text + face + "\n"));
    CHECK(s.mesh.faces.size() == static_cast<std::size_t>(n - 2));
    CHECK(surface_area(s.mesh) == Approx(area * std::sqrt(6.0)).epsilon(1e-5));
  }
}

TEST_CASE("a polygon of more corners than are read is refused in one line, of fewer it is read") {
  const auto comb = [](int corners) {
    std::string text, face = "f";
    for (int i = 0; i < corners; ++i) {
      text += "v " + std::to_string(i) + " " + std::to_string(i % 2 * 100) + " 0\n";
      face += " " + std::to_string(i + 1);
    }
    return text + face + "\n";
  };
  CHECK(only(read_bytes("a.obj", comb(1000))).mesh.faces.size() == 998);
  for (const int corners : {5001, 20'000, 200'000}) {
    const ReadResult result = read_bytes("a.obj", comb(corners));
    REQUIRE(result.failures.size() == 1);
    CHECK_THAT(result.failures[0].message,
               Contains(std::to_string(corners) + " corners") && Contains("triangulate"));
  }
}

TEST_CASE("a polygon whose hole is cut in by a bridge keeps its area") {
  const Source s = only(read_bytes("a.obj",
                                   "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\n"
                                   "v 3 3 0\nv 3 1 0\nf 1 2 3 4 1 5 6 7 8 5\n"));
  CHECK(surface_area(s.mesh) == Approx(12));
}

TEST_CASE("OBJ groups are parts of one building, several objects are buildings") {
  const Mesh b = moved(kHouse, {20, 0, 0});
  const std::string groups =
      "g wall\n" + obj_text(kHouse) + "g roof\n" + obj_text(moved(kHouse, {0, 0, 9}), 10);
  const Source s = only(read_bytes("a.obj", groups));
  CHECK((s.face_object.front() == 0 && s.face_object.back() == 1));
  const std::string objects = "o left\n" + obj_text(kHouse) + "o right/2\n" + obj_text(b, 10);
  CHECK(names(read_bytes("a.obj", objects)) == Names{"a_left", "a_right_2"});
  CHECK(names(read_bytes("a.obj", objects, {.split = Split::kNone})) == Names{"a"});
  CHECK(names(read_bytes("a.obj", "o one\n" + obj_text(kHouse))) == Names{"a"});
  CHECK(read_bytes("a.obj", objects).sources[1].mesh.vertices == b.vertices);
}

TEST_CASE("connected components become buildings when asked") {
  const Mesh two = join(kHouse, moved(kHouse, {20, 0, 0}));
  CHECK(names(read_bytes("a.stl", stl_bytes(two), {.split = Split::kComponent})) ==
        Names{"a_1", "a_2"});
  CHECK(names(read_bytes("a.stl", stl_bytes(kHouse), {.split = Split::kComponent})) == Names{"a"});
}

TEST_CASE("names are safe, unique and do not depend on the order of inputs") {
  const TempFolder a, b;
  const std::string first = a.write("haus & hof.obj", obj_text(kHouse));
  const std::string second = b.write("haus & hof.obj", obj_text(kHouse));
  const std::string third = b.write("HAUS___HOF_2.obj", obj_text(kHouse));
  const ReadResult r = read_sources({second, third, first});
  CHECK(names(r) == Names{"HAUS___HOF_2", "haus___hof", "haus___hof_3"});
  CHECK(names(read_sources({first, second, third})) == names(r));
  CHECK(r.sources[1].path == read_sources({first, second, third}).sources[1].path);
  CHECK(read_sources({first, first}).sources.size() == 1);
  CHECK(names(read_sources({a.write("....obj", obj_text(kHouse))})) == Names{"building"});
}

TEST_CASE("units and the up axis are turned into metres and z up") {
  const Source cm = only(read_bytes("a.obj", obj_text(kHouse), {.unit = 0.01}));
  CHECK(signed_volume(cm.mesh) == Approx(1e-6 * signed_volume(kHouse)));
  const Source up =
      only(read_bytes("a.obj", "v 0 0 0\nv 1 0 0\nv 0 5 0\nf 1 2 3\n", {.up = Up::kY}));
  CHECK((up.mesh.vertices[2] - Vec3(0, 0, 5)).norm() == 0);
  CHECK(face_cross(up.mesh, up.mesh.faces[0]).y() < 0);
}

TEST_CASE("glTF nodes place, turn and mirror their meshes") {
  const std::string nodes =
      R"([{"name":"wrap","children":[1,2],"translation":[0,100,0]},{"name":"a","mesh":0},)"
      R"({"name":"b","mesh":0,"scale":[-1,1,1],"translation":[50,0,0]}])";
  const ReadResult r = read_bytes("town.glb", glb_bytes(kHouse, nodes, "[0]"));
  CHECK(names(r) == Names{"town_a", "town_b"});
  for (const Source& s : r.sources) {
    CHECK(signed_volume(s.mesh) == Approx(signed_volume(kHouse)));
    CHECK(bounding_box(s.mesh.vertices).min.z() == Approx(100));
    CHECK(s.mesh.vertices.size() == 10);
  }
  CHECK(bounding_box(r.sources[1].mesh.vertices).min.x() == Approx(40));
  const std::string one = glb_bytes(kHouse, R"([{"mesh":0},{"mesh":0}])", "[0]");
  CHECK(only(read_bytes("a.glb", one)).mesh.faces.size() == 16);  // the other is in no scene
}

TEST_CASE("a glTF whose nodes run in a circle or share a child is refused") {
  const std::string loop = R"([{"children":[1],"mesh":0},{"children":[0]}])";
  CHECK_THAT(failure("a.glb", glb_bytes(kHouse, loop, "[0]")), Contains("two places"));
  const std::string ring = R"([{"children":[1]},{"children":[0]}])";
  CHECK(!failure("a.glb", glb_bytes(kHouse, ring, "[0]")).empty());
}

TEST_CASE("glTF indices beyond the vertices are named") {
  Mesh bad = kHouse;
  bad.faces[3][1] = 77;
  CHECK_THAT(failure("a.glb", glb_bytes(bad, R"([{"mesh":0}])", "[0]")), Contains("index 10"));
}

TEST_CASE("clouds keep their normals or get outward ones with a warning") {
  const Source given = only(read_bytes("a.xyz", sphere_xyz(500, true)));
  CHECK(given.cloud.normals.size() == 500);
  CHECK(given.warnings.empty());
  const Source s = only(read_bytes("a.xyz", sphere_xyz(2000, false)));
  REQUIRE(s.cloud.normals.size() == 2000);
  REQUIRE(s.warnings.size() == 1);
  int outward = 0, seen = 0;  // what faces the ground sees no sky and is not judged
  for (std::size_t i = 0; i < 2000; ++i) {
    if (s.cloud.points[i].z() < -0.7) continue;
    ++seen;
    outward += s.cloud.points[i].dot(s.cloud.normals[i]) > 0.9;
  }
  CHECK(outward == seen);
}

TEST_CASE("read_single takes a file as one mesh") {
  const TempFolder folder;
  const std::string file = folder.write("a.obj", "o left\n" + obj_text(kHouse) + "o right\n" +
                                                     obj_text(moved(kHouse, {20, 0, 0}), 10));
  CHECK(read_single(file).mesh.faces.size() == 32);
  CHECK_THROWS_AS(read_single(folder.path.string()), Error);
  CHECK_THROWS_AS(read_single("/nonexistent.obj"), Error);
}

TEST_CASE("no truncation and no flipped byte crashes a reader") {
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.off", off_text(kHouse)},
      {"a.obj", obj_text(kHouse)},
      {"a.stl", stl_bytes(kHouse)},
      {"a.ply", ply_bytes<float>(kHouse, true)},
      {"a.xyz", sphere_xyz(30, true)},
      {"a.csv", "x;y;z\n" + sphere_xyz(30, false)},
      {"a.glb", glb_bytes(kHouse, R"([{"mesh":0}])", "[0]")}};
  const TempFolder folder;
  std::mt19937_64 random(11);
  for (const auto& [name, bytes] : files)
    for (int trial = 0; trial < 300; ++trial) {
      std::string broken = bytes.substr(0, trial % 2 ? random() % bytes.size() : bytes.size());
      for (int k = trial % 4; k > 0 && !broken.empty(); --k)
        broken[random() % broken.size()] = static_cast<char>(random());
      for (const Source& s : read_sources({folder.write(name, broken)}).sources) {
        for (const Face& f : s.mesh.faces)
          for (const int v : f) REQUIRE((v >= 0 && v < static_cast<int>(s.mesh.vertices.size())));
        for (const Vec3& p : s.mesh.vertices) REQUIRE(p.allFinite());
        for (const Vec3& n : s.cloud.normals) REQUIRE(n.norm() == Approx(1));
      }
    }
}

TEST_CASE("the scan of assets reads as its description says") {
  const Source scan = read_single(COLOD_SOURCE_DIR "/assets/scan/house_00.ply");
  CHECK(scan.mesh.vertices.size() == 5734);
  CHECK(scan.mesh.faces.size() == 11054);
  CHECK(scan.face_object.size() == scan.mesh.faces.size());
  CHECK(*std::max_element(scan.face_object.begin(), scan.face_object.end()) > 0);
}

TEST_CASE("the shared data read as their descriptions say") {
  const std::filesystem::path data = test::shared_data();
  COLOD_SKIP_WITHOUT(data);
  const ReadResult street = read_sources({(data / "ingolstadt-north").string()});
  CHECK(street.failures.empty());
  CHECK(street.sources.size() == 15);
  std::size_t faces = 0;
  for (const Source& s : street.sources) faces += s.mesh.faces.size();
  CHECK(faces == 49669);
  const Source scan = read_single((data / "ingolstadt-north-scan/4018106.ply").string());
  CHECK(scan.mesh.faces.size() == 129148);
  CHECK(*std::min_element(scan.face_object.begin(), scan.face_object.end()) == -1);
  CHECK(read_single((data / "points/facade.ply").string()).cloud.normals.size() == 100000);
}
