// However a file spells the same thing, the same building comes out.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "read/frame.h"
#include "read_helpers.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;

namespace {

Source only(const ReadResult& result) {
  for (const ReadFailure& f : result.failures) UNSCOPED_INFO(f.path << ": " << f.message);
  REQUIRE(result.sources.size() == 1);
  return result.sources.front();
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string as_utf16(const std::string& text, bool is_big_endian) {
  std::string out = is_big_endian ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) out += is_big_endian ? std::string{'\0', c} : std::string{c, '\0'};
  return out;
}

std::string stl_text(const Mesh& m) {
  std::ostringstream out;
  out.precision(17);
  out << "solid house\n";
  for (const Face& f : m.faces) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const int v : f)
      out << "vertex " << m.vertices[v].x() << ' ' << m.vertices[v].y() << ' ' << m.vertices[v].z()
          << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid house\n";
  return out.str();
}

std::string ply_text(const Mesh& m) {
  std::ostringstream out;
  out.precision(17);
  out << "ply\nformat ascii 1.0\nelement vertex " << m.vertices.size()
      << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
      << m.faces.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& p : m.vertices) out << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for (const Face& f : m.faces) out << "3 " << f[0] << ' ' << f[1] << ' ' << f[2] << '\n';
  return out.str();
}

using Change = std::function<std::string(std::string)>;

/// What no text format minds.
const std::vector<std::pair<std::string, Change>> kAnyText = {
    {"CR LF", [](const std::string& t) { return replaced(t, "\n", "\r\n"); }},
    {"CR", [](const std::string& t) { return replaced(t, "\n", "\r"); }},
    {"UTF-8 mark", [](const std::string& t) { return "\xEF\xBB\xBF" + t; }},
    {"UTF-16 little", [](const std::string& t) { return as_utf16(t, false); }},
    {"UTF-16 big", [](const std::string& t) { return as_utf16(t, true); }},
    {"tabs", [](const std::string& t) { return replaced(t, " ", "\t"); }},
    {"blanks", [](const std::string& t) { return replaced(replaced(t, " ", "  "), "\n", " \n"); }},
    {"mark and CR LF",
     [](const std::string& t) { return "\xEF\xBB\xBF" + replaced(t, "\n", "\r\n"); }}};

const std::vector<std::pair<std::string, Change>> kBlankLines = {
    {"blank lines", [](const std::string& t) { return "\n \n" + replaced(t, "\n", "\n\n"); }}};

const std::vector<std::pair<std::string, Change>> kHashes = {
    {"comments", [](const std::string& t) { return replaced(t, "\n", " # c\\\n# x\\\n"); }}};

/// The house of every change of the text is that of the text, at sizes that a class may have.
void check_changes(const std::string& name, const std::function<std::string(const Mesh&)>& write,
                   std::vector<std::pair<std::string, Change>> changes) {
  changes.insert(changes.end(), kAnyText.begin(), kAnyText.end());
  for (const double size : {1.0, 7.5, 40.0}) {
    const Mesh house = gable_house(12 * size, 8 * size, 6 * size, 3 * size);
    const Source plain = only(read_bytes(name, write(house), {.up = Up::kZ, .unit = 1.0}));
    for (const auto& [what, change] : changes) {
      INFO(name << ", " << what << ", size " << size);
      const Source s = only(read_bytes(name, change(write(house)), {.up = Up::kZ, .unit = 1.0}));
      CHECK(s.mesh.vertices == plain.mesh.vertices);
      CHECK(s.mesh.faces == plain.mesh.faces);
      CHECK(signed_volume(s.mesh) == Approx(signed_volume(house)));
    }
  }
}

/// Points of a box's five faces above ground, evenly at random, with their normals.
PointCloud box_points(int n, const Vec3& size, const Vec3& at) {
  PointCloud cloud;
  std::mt19937_64 random(5);
  const auto draw = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int i = 0; i < n; ++i) {
    Vec3 p(draw() * size.x(), draw() * size.y(), draw() * size.z()), normal = Vec3::Zero();
    const int side = static_cast<int>(random() % 5);
    const int axis = side / 2;
    p[axis] = side % 2 == 1 || axis == 2 ? size[axis] : 0;
    normal[axis] = p[axis] > 0 ? 1 : -1;
    cloud.points.push_back(p + at);
    cloud.normals.push_back(normal);
  }
  return cloud;
}

/// A point a line: coordinates and what `more` adds, with a separator and a decimal sign.
std::string table(const PointCloud& cloud, const std::string& separator, char decimal,
                  const std::function<std::string(std::size_t)>& more = {}) {
  std::string text;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      std::string number = std::to_string(cloud.points[i][k]);
      std::replace(number.begin(), number.end(), '.', decimal);
      text += (k > 0 ? separator : "") + number;
    }
    text += (more ? more(i) : "") + "\n";
  }
  return text;
}

bool is_same_cloud(const Source& s, const PointCloud& cloud) {
  if (s.cloud.points.size() != cloud.points.size()) return false;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if ((s.cloud.points[i] - cloud.points[i]).norm() > 1e-5) return false;
  return true;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& l : lines) all += l + "\n";
  return all;
}

}  // namespace

TEST_CASE("OBJ: line ends, marks, blanks, comments, case and continuations change nothing") {
  auto changes = kBlankLines;
  changes.insert(changes.end(), kHashes.begin(), kHashes.end());
  changes.emplace_back("capitals", upper);
  for (const std::string end : {"\\\n", "\\\r\n", " \\ \r\n", "\\\r"})
    changes.emplace_back("continued by " + end,
                         [end](const std::string& t) { return replaced(t, " ", " " + end); });
  for (const std::string line : {"# C:\\maps\\", "usemtl C:\\stone\\", "mtllib ..\\", "g a\\"})
    changes.emplace_back("before faces: " + line,
                         [line](const std::string& t) { return replaced(t, "f ", line + "\nf "); });
  check_changes(
      "a.obj", [](const Mesh& m) { return obj_text(m); }, changes);
}

TEST_CASE("an OBJ whose numbers are continued names the true line of a fault") {
  CHECK_THAT(failure("a.obj", "v 0 0 \\\r\n0\r\nv 1 0 0\r\nv 0 1 \\\r\nx\r\nf 1 2 3\r\n"),
             Contains("line 5"));
}

TEST_CASE("a mark before an object's name leaves it its name") {
  Mesh b = gable_house(10, 7, 3, 1);
  for (Vec3& p : b.vertices) p.x() += 30;
  const std::string text =
      "o tower\n" + obj_text(gable_house(12, 8, 6, 3)) + "o shed\n" + obj_text(b, 10);
  const ReadResult r = read_bytes("a.obj", "\xEF\xBB\xBF" + text);
  REQUIRE(r.sources.size() == 2);
  CHECK_THAT(r.sources[0].name + r.sources[1].name, Contains("tower") && Contains("shed"));
}

TEST_CASE("OFF: line ends, marks, blanks, comments and broken lines change nothing") {
  auto changes = kBlankLines;
  changes.insert(changes.end(), kHashes.begin(), kHashes.end());
  changes.emplace_back("small letters",
                       [](const std::string& t) { return replaced(t, "OFF", "off"); });
  changes.emplace_back("a number a line",
                       [](const std::string& t) { return replaced(t, " ", "\n"); });
  check_changes("a.off", off_text, changes);
}

TEST_CASE("PLY: line ends, marks, capitals and comments change nothing") {
  std::vector<std::pair<std::string, Change>> changes;
  changes.emplace_back("comments", [](const std::string& t) {
    return replaced(t, "element", "comment x \\\nobj_info y\nelement");
  });
  changes.emplace_back("X Y Z", [](std::string t) {
    for (const std::string axis : {"x", "y", "z"})
      t = replaced(t, "double " + axis, "double " + upper(axis));
    return t;
  });
  changes.emplace_back("capitals", upper);
  check_changes("a.ply", ply_text, changes);
}

TEST_CASE("a binary PLY is read whatever ends the lines of its header") {
  const Mesh house = gable_house(10, 8, 6, 3);
  const std::string bytes = ply_bytes<double>(house, false);
  const std::size_t body = bytes.find("end_header\n") + 11;
  for (const std::string end : {"\r\n", "\r"}) {
    const std::string file = replaced(bytes.substr(0, body), "\n", end) + bytes.substr(body);
    CHECK(only(read_bytes("a.ply", file)).mesh.vertices == house.vertices);
  }
}

TEST_CASE("text STL: line ends, marks, capitals, blank lines and any line breaks change nothing") {
  auto changes = kBlankLines;
  changes.emplace_back("capitals", upper);
  changes.emplace_back("no name",
                       [](const std::string& t) { return replaced(t, "solid house", "solid"); });
  changes.emplace_back("a facet a line", [](std::string t) {
    for (const std::string word : {"outer", "vertex", "endloop", "endfacet"})
      t = replaced(t, "\n" + word, " " + word);
    return t;
  });
  check_changes("a.stl", stl_text, changes);
}

TEST_CASE("the solids of one text STL are objects, and a facet has three corners") {
  Mesh b = gable_house(6, 5, 3, 1);
  for (Vec3& p : b.vertices) p.x() += 40;
  const std::string two = stl_text(gable_house(12, 8, 6, 3)) + "\n" + stl_text(b);
  double volume = 0;
  for (const Source& s : read_bytes("a.stl", two).sources) volume += signed_volume(s.mesh);
  CHECK(volume == Approx(signed_volume(gable_house(12, 8, 6, 3)) + signed_volume(b)));
  CHECK_THAT(failure("a.stl", "solid\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\n"),
             Contains("line 5") && Contains("3 corners"));
}

TEST_CASE("a binary STL whose header begins with solid is binary") {
  std::string bytes = stl_bytes(gable_house(10, 8, 6, 3));
  bytes.replace(0, 5, "solid");
  CHECK(only(read_bytes("a.stl", bytes)).mesh.faces.size() == 16);
  bytes += std::string(7, '\0');  // some writers leave more
  CHECK(only(read_bytes("a.stl", bytes)).mesh.faces.size() == 16);
}

TEST_CASE("point tables: any separator, decimal sign, header, line end and mark") {
  for (const Vec3& at : {Vec3(0, 0, 0), Vec3(694392.5, 5155487.25, 382.5)}) {
    const PointCloud cloud = box_points(300, {12, 8, 6}, at);
    const std::string plain = table(cloud, " ", '.');
    std::vector<std::pair<std::string, std::string>> files = {
        {"commas", table(cloud, ",", '.')},
        {"commas and blanks", table(cloud, ", ", '.')},
        {"semicolons", table(cloud, ";", '.')},
        {"semicolons, decimal commas", table(cloud, ";", ',')},
        {"blanks, decimal commas", table(cloud, " ", ',')},
        {"tabs, decimal commas", table(cloud, "\t", ',')},
        {"header", "x y z\n" + plain},
        {"header of CloudCompare", "//X Y Z\n" + plain},
        {"header with quotes", "\"X\";\"Y\";\"Z\"\n" + table(cloud, ";", ',')},
        {"header with units", "X [m],Y [m],Z [m]\n" + table(cloud, ",", '.')},
        {"count", "300\n" + plain},
        {"comment", "# points\n" + replaced(plain, "\n", "\n# c\n")}};
    for (const auto& [what, change] : kAnyText) files.emplace_back(what, change(plain));
    for (const std::string ending : {"xyz", "pts", "asc", "csv", "txt"})
      for (const auto& [what, text] : files) {
        INFO(ending << ", " << what);
        CHECK(is_same_cloud(only(read_bytes("a." + ending, text)), cloud));
      }
  }
}

TEST_CASE("a header says which columns are what") {
  const PointCloud cloud = box_points(200, {10, 7, 5}, {0, 0, 0});
  std::string text = "id;z;Nx;Ny;Nz;x;y\n";
  for (std::size_t i = 0; i < 200; ++i) {
    const Vec3 &p = cloud.points[i], &n = cloud.normals[i];
    for (const double v : {double(i), p.z(), n.x(), n.y(), n.z(), p.x()})
      text += std::to_string(v) + ";";
    text += std::to_string(p.y()) + "\n";
  }
  const Source s = only(read_bytes("a.csv", text));
  CHECK(is_same_cloud(s, cloud));
  CHECK(s.cloud.normals == cloud.normals);
}

TEST_CASE("normals are taken where they stand, behind an intensity or a colour") {
  const PointCloud cloud = box_points(400, {10, 7, 5}, {0, 0, 0});
  const auto vector = [&](std::size_t i) {
    const Vec3& n = cloud.normals[i];
    return " " + std::to_string(n.x()) + " " + std::to_string(n.y()) + " " + std::to_string(n.z());
  };
  for (const std::string before : {"", " 17", " 12 200 31"}) {
    INFO("before: " << before);
    const Source s = only(
        read_bytes("a.xyz", table(cloud, " ", '.', [&](auto i) { return before + vector(i); })));
    CHECK(s.cloud.normals == cloud.normals);
    CHECK(s.warnings.empty());
  }
}

TEST_CASE("colours and classes are never normals, of whatever kind they are") {
  std::mt19937_64 random(3);
  const auto any = [&](int n) { return static_cast<int>(random() % n); };
  const std::vector<std::pair<std::string, std::function<std::string(std::size_t)>>> kinds = {
      {"pure colours",
       [&](auto) {
         const int c = any(3);
         return c == 0 ? " 1 0 0" : c == 1 ? " 0 1 0" : " 0 0 1";
       }},
      {"one class", [](auto) { return " 0 1 0"; }},
      {"bytes",
       [&](auto) { return " " + std::to_string(any(256)) + " 0 " + std::to_string(any(256)); }},
      {"nought and one", [&](auto) { return " " + std::to_string(any(2)) + " 0 1"; }},
      {"unit greys", [](auto) { return " 0.577 0.577 0.578"; }}};
  for (const int n : {500, 3000}) {
    const PointCloud cloud = box_points(n, {12, 8, 6}, {694392, 5155487, 380});
    for (const auto& [what, more] : kinds) {
      INFO(what << ", " << n << " points");
      const Source s = only(read_bytes("a.xyz", table(cloud, " ", '.', more)));
      REQUIRE(s.cloud.points.size() == cloud.points.size());
      int outward = 0;
      for (int i = 0; i < n; ++i) outward += s.cloud.normals[i].dot(cloud.normals[i]) > 0.9;
      CHECK(outward > 0.75 * n);  // a sparse cloud's edges and corners are hard to tell
      CHECK_THAT(joined(s.warnings), Contains("estimated"));
    }
  }
}

TEST_CASE("true normals of a roof alone, all up, stay") {
  PointCloud roof;
  for (int i = 0; i < 400; ++i) roof.points.emplace_back(0.5 * (i % 20), 0.5 * (i / 20), 5);
  const Source s = only(read_bytes("a.xyz", table(roof, " ", '.', [](auto) { return " 0 0 1"; })));
  CHECK(s.warnings.empty());
  for (const Vec3& n : s.cloud.normals) REQUIRE(n == Vec3(Vec3::UnitZ()));
}

TEST_CASE("PLY normals of no length are estimated") {
  const PointCloud cloud = box_points(500, {12, 8, 6}, {0, 0, 0});
  std::string text = "ply\nformat ascii 1.0\nelement vertex 500\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
    text += std::string("property double ") + name + "\n";
  text += "end_header\n" + table(cloud, " ", '.', [](auto) { return " 0 0 0"; });
  const Source s = only(read_bytes("a.ply", text));
  CHECK(is_same_cloud(s, cloud));
  CHECK_THAT(joined(s.warnings), Contains("no length") && Contains("estimated"));
}

TEST_CASE("formats that are not read say in one line how to convert them") {
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.e57", "pdal"},   {"a.PNTS", "pdal"},         {"a.ifc", "IfcConvert"}, {"a.dae", "assimp"},
      {"a.fbx", "assimp"}, {"a.gml", "citygml-tools"}, {"a.city.json", "cjio"}, {"a.json", "cjio"}};
  for (const auto& [name, tool] : files) {
    const std::string message = failure(name, R"({"type":"CityJSON","version":"2.0"})");
    INFO(name << ": " << message);
    CHECK_THAT(message, Contains(tool) && Contains("not read"));
    CHECK(message.find('\n') == message.npos);
  }
  CHECK_THAT(failure("a.asc", "ncols 4\nnrows 4\nxllcorner 0\n1 2 3 4\n"), Contains("gdal"));
}

TEST_CASE("points keep their colours, by a header's names or as bytes, and classes are none") {
  const PointCloud cloud = box_points(400, {12, 8, 6}, {100, 200, 5});
  const auto shade = [](std::size_t i, int k) { return static_cast<int>((37 * i + 80 * k) % 256); };
  const auto three = [&](std::size_t i, double scale) {
    std::string text;
    for (int k = 0; k < 3; ++k) text += " " + std::to_string(std::lround(scale * shade(i, k)));
    return text;
  };
  const auto normal = [&](std::size_t i) {
    std::string text;
    for (int k = 0; k < 3; ++k) text += " " + std::to_string(std::lround(cloud.normals[i][k]));
    return text;
  };
  struct Way {
    const char *name, *head;
    std::function<std::string(std::size_t)> more;
    bool has_colors = true;
  };
  const Way ways[] = {
      {"a.xyz", "", [&](std::size_t i) { return three(i, 1); }},
      {"a.pts", "400\n",
       [&](std::size_t i) { return " -" + std::to_string(i + 900) + three(i, 1); }},
      {"a.pwn", "", [&](std::size_t i) { return normal(i) + three(i, 1); }},
      {"a.csv", "x y z R G B\n", [&](std::size_t i) { return three(i, 257); }},
      {"a.csv", "x y z class red green blue\n", [&](std::size_t i) { return " 6" + three(i, 1); }},
      {"a.xyz", "", [&](std::size_t i) { return " " + std::to_string(i % 7) + " 1 2"; }, false},
      {"a.xyz", "", [&](std::size_t) { return " 255 255 255"; }, false},
      {"a.xyz", "", [&](std::size_t i) { return " " + std::to_string(i * 9) + " 7 40"; }, false}};
  for (const Way& way : ways) {
    INFO(way.name << " " << way.head << way.more(1));
    const Source s = only(read_bytes(way.name, way.head + table(cloud, " ", '.', way.more)));
    REQUIRE(s.cloud.points.size() == 400);
    REQUIRE(s.look.colors.size() == (way.has_colors ? 400 : 0));
    for (std::size_t i = 0; i < s.look.colors.size(); ++i)
      for (int k = 0; k < 3; ++k) CHECK(s.look.colors[i][0][k] == shade(i, k));
  }
}

TEST_CASE("a point keeps its colour in its building's frame") {
  const PointCloud cloud = box_points(300, {12, 8, 6}, {100, 200, 5});
  const Source s =
      only(read_bytes("a.xyz", table(cloud, " ", '.', [](std::size_t i) {
                        return " " + std::to_string(i % 200) + " 40 " + std::to_string(i / 2);
                      })));
  CHECK(s.look.colors.empty());  // the second column does not vary
  Source colored = s;
  for (std::size_t i = 0; i < s.cloud.points.size(); ++i) {
    const Rgb rgb = {static_cast<std::uint8_t>(i % 256), static_cast<std::uint8_t>(i / 256), 7};
    colored.look.colors.push_back({rgb, rgb, rgb});
  }
  const Frame frame = main_frame(colored);
  const Source local = localize(colored, frame);
  REQUIRE(local.look.colors.size() == local.cloud.points.size());
  for (std::size_t i = 0; i < local.cloud.points.size(); ++i) {
    const Rgb& rgb = local.look.colors[i][0];
    const Vec3& before = s.cloud.points[static_cast<std::size_t>(rgb[0] + 256 * rgb[1])];
    CHECK((local.cloud.points[i] - frame.to_local(before)).norm() < 1e-4);
  }
}
