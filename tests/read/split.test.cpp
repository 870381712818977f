// What `--split` takes for a building.
#include "read/split.h"

#include <catch2/catch.hpp>

#include "read_helpers.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;

namespace {

using Names = std::vector<std::string>;

Mesh moved(Mesh m, const Vec3& by) {
  for (Vec3& p : m.vertices) p += by;
  return m;
}

Mesh turned(Mesh m, double angle_deg) {
  const Eigen::AngleAxisd turn(angle_deg * M_PI / 180, Vec3::UnitZ());
  for (Vec3& p : m.vertices) p = turn * p;
  return m;
}

/// The same surface, each triangle in four.
Mesh quartered(const Mesh& m) {
  Mesh out;
  for (const Face& f : m.faces) {
    const int first = static_cast<int>(out.vertices.size());
    for (int k = 0; k < 3; ++k) out.vertices.push_back(m.vertices[f[k]]);
    for (int k = 0; k < 3; ++k)
      out.vertices.push_back(0.5 * (m.vertices[f[k]] + m.vertices[f[(k + 1) % 3]]));
    for (const Face& g : {Face{0, 3, 5}, Face{3, 1, 4}, Face{5, 4, 2}, Face{3, 4, 5}})
      out.faces.push_back({first + g[0], first + g[1], first + g[2]});
  }
  return out;
}

/// Named meshes of one file.
struct Objects {
  std::string text;
  int base = 0;

  Objects& add(const char* key, const std::string& name, const Mesh& m) {
    text += std::string(key) + " " + name + "\n" + obj_text(m, base);
    base += static_cast<int>(m.vertices.size());
    return *this;
  }
};

Names names(const ReadResult& result) {
  Names out;
  for (const Source& s : result.sources) out.push_back(s.name);
  return out;
}

/// All that the reader says of the file.
std::string said(const ReadResult& result) {
  std::string all;
  for (const Source& s : result.sources)
    for (const std::string& w : s.warnings) all += w + "\n";
  return all;
}

double volume(const ReadResult& result) {
  double sum = 0;
  for (const Source& s : result.sources) sum += signed_volume(s.mesh);
  return sum;
}

/// A house as BIM converters write it: walls, slabs, a roof and a table, none of them a building.
Objects elements(double scale, double angle) {
  const auto box = [&](double x0, double y0, double z0, double x1, double y1, double z1) {
    return turned(box_mesh(scale * Vec3(x0, y0, z0), scale * Vec3(x1, y1, z1)), angle);
  };
  Objects o;
  o.add("o", "a1", box(0, 0, 0, 12, 0.3, 6)).add("o", "a2", box(0, 7.7, 0, 12, 8, 6));
  o.add("o", "a3", box(0, 0.3, 0, 0.3, 7.7, 6)).add("o", "a4", box(11.7, 0.3, 0, 12, 7.7, 6));
  o.add("o", "b", box(0, 0, -0.3, 12, 8, 0)).add("o", "c", box(5, 3, 0, 6, 4, 0.8));
  o.add("o", "d", box(0, 0, 6, 12, 8, 6.4));
  return o;
}

}  // namespace

TEST_CASE("elements of one house are one building, whatever its size and direction") {
  for (const double scale : {0.7, 1.0, 3.0})
    for (const double angle : {0.0, 31.0, 45.0}) {
      INFO(scale << " " << angle);
      const ReadResult r = read_bytes("house.obj", elements(scale, angle).text);
      CHECK(names(r) == Names{"house"});
      CHECK_THAT(said(r), Contains("house.obj: 7 parts touch") && Contains("1 building "));
      CHECK(read_bytes("house.obj", elements(scale, angle).text, {.split = Split::kObject})
                .sources.size() == 7);
    }
}

TEST_CASE("houses of a row stay buildings, and parts on them join the one that carries them") {
  Objects row;
  const Mesh house = gable_house(8, 10, 6, 3);
  for (int i = 0; i < 6; ++i) {
    row.add("o", "no" + std::to_string(i), moved(house, {8.0 * i, 0, 0.5 * i}));
    row.add("o", "chimney" + std::to_string(i),
            box_mesh({8.0 * i + 3, 4, 7}, {8.0 * i + 3.6, 4.6, 10}));
  }
  const ReadResult r = read_bytes("row.obj", row.text);
  CHECK(names(r) == Names{"row_no0", "row_no1", "row_no2", "row_no3", "row_no4", "row_no5"});
  for (const Source& s : r.sources) CHECK(s.mesh.vertices.size() == 18);
  CHECK_THAT(said(r), Contains("12 parts") && Contains("6 buildings"));
}

TEST_CASE("storeys on one another and dormers are one building, terrain joins none") {
  Objects tower;
  for (int i = 0; i < 4; ++i)
    tower.add("o", "part" + std::to_string(i), box_mesh({0, 0, 3.0 * i}, {14, 9, 3.0 * i + 3}));
  tower.add("o", "left", box_mesh({1, 1, 12}, {4, 4, 15}));
  tower.add("o", "right", box_mesh({8, 1, 12}, {11, 4, 15}));
  CHECK(names(read_bytes("tower.obj", tower.text)) == Names{"tower"});
  Objects plot;
  plot.add("o", "land", box_mesh({-20, -20, -2}, {60, 40, 0}));
  plot.add("o", "a", gable_house(10, 8, 6, 3));
  plot.add("o", "b", moved(gable_house(10, 8, 6, 3), {25, 0, 0}));
  CHECK(names(read_bytes("plot.obj", plot.text)) == Names{"plot_a", "plot_b", "plot_land"});
}

TEST_CASE("of levels of detail on one place the finest stays") {
  const Mesh coarse = box_mesh({0, 0, 0}, {12, 8, 7.5}), middle = gable_house(12, 8, 6, 3);
  const Mesh fine = join(middle, box_mesh({3, 2, 7}, {4, 3, 10.5}));
  const std::vector<Names> styles = {{"House_LOD0", "House_LOD1", "House_LOD2"},
                                     {"house.lod2.2", "house.lod1.3", "house.lod1.2"},
                                     {"LOD0", "LOD1", "LOD2"},
                                     {"lod 0 House", "lod 1 House", "lod 2 House"}};
  for (const Names& style : styles) {
    INFO(style[0]);
    const std::string text = Objects()
                                 .add("o", style[2], coarse)
                                 .add("o", style[0], fine)
                                 .add("o", style[1], middle)
                                 .text;
    const ReadResult r = read_bytes("h.obj", text);
    CHECK(names(r) == Names{"h"});
    CHECK(volume(r) == Approx(signed_volume(fine)));
    CHECK_THAT(said(r), Contains("2 coarser levels") && Contains(style[0]));
    CHECK(read_bytes("h.obj", text, {.split = Split::kObject}).sources.size() == 3);
  }
  const std::string street = Objects()
                                 .add("o", "A_LOD0", fine)
                                 .add("o", "A_LOD1", coarse)
                                 .add("o", "B_LOD0", moved(fine, {30, 0, 0}))
                                 .add("o", "B_LOD1", moved(coarse, {30, 0, 0}))
                                 .text;
  CHECK(names(read_bytes("s.obj", street)) == Names{"s_A", "s_B"});
}

TEST_CASE("of parts that show the same thing under any names the finest stays, shells are two") {
  for (const double size : {0.7, 1.0, 5.0})
    for (const double angle : {0.0, 31.0}) {
      INFO(size << " " << angle);
      const auto placed = [&](Mesh m) {
        for (Vec3& p : m.vertices) p *= size;
        return turned(m, angle);
      };
      const Mesh fine =
          placed(join(quartered(gable_house(12, 8, 6, 3)), box_mesh({3, 2, 7}, {3.4, 2.4, 9.2})));
      const Mesh coarse = placed(gable_house(12, 8, 6, 3));
      const ReadResult r =
          read_bytes("h.obj", Objects().add("o", "a", coarse).add("o", "b", fine).text);
      CHECK(names(r) == Names{"h"});
      CHECK(volume(r) == Approx(signed_volume(fine)));
      CHECK_THAT(said(r), Contains("finer ones") && Contains("'b'"));
      // An inner shell 30 cm off is no level, nor is a house as large beside it.
      Mesh inner = placed(gable_house(12, 8, 6, 3));
      const Vec3 middle = bounding_box(inner.vertices).center();
      for (Vec3& p : inner.vertices) p = middle + (1 - 0.075 / size) * (p - middle);
      const std::string shells = Objects()
                                     .add("o", "in", inner)
                                     .add("o", "out", placed(quartered(gable_house(12, 8, 6, 3))))
                                     .text;
      CHECK(volume(read_bytes("h.obj", shells)) ==
            Approx(signed_volume(inner) + signed_volume(coarse)));
    }
}

TEST_CASE("names tell levels of detail only where a number follows") {
  using mesh_io::name_without_level;
  CHECK(name_without_level("House_LOD1") == "House");
  CHECK(name_without_level("HouseLOD1") == "House");
  CHECK(name_without_level("lod2.2") == "");
  CHECK(name_without_level("Lod 3 - Turm") == "Turm");
  CHECK(!name_without_level("melod1"));
  CHECK(!name_without_level("Lodge"));
  CHECK(!name_without_level("House"));
}

TEST_CASE("groups are buildings where all of them look like one and stand apart") {
  for (const double gap : {2.5, 8.0, 40.0}) {
    INFO(gap);
    Objects street;
    for (int i = 0; i < 5; ++i)
      street.add("g", "bldg_" + std::to_string(i),
                 moved(gable_house(12, 8, 6, 3), {(12 + gap) * i, 0, 0}));
    const Names five = {"s_bldg_0", "s_bldg_1", "s_bldg_2", "s_bldg_3", "s_bldg_4"};
    for (const Split how : {Split::kAuto, Split::kObject, Split::kGroup})
      CHECK(names(read_bytes("s.obj", street.text, {.split = how})) == five);
    CHECK(names(read_bytes("s.obj", street.text, {.split = Split::kNone})) == Names{"s"});
    CHECK_THAT(said(read_bytes("s.obj", street.text)), Contains("5 buildings (--split none"));
  }
  Objects parts;
  parts.add("g", "body", box_mesh({0, 0, 0}, {12, 8, 6}));
  parts.add("g", "top", moved(gable_house(12, 8, 0.2, 3), {0, 0, 6}));
  CHECK(names(read_bytes("s.obj", parts.text)) == Names{"s"});
  CHECK(said(read_bytes("s.obj", parts.text)).empty());
  CHECK(names(read_bytes("s.obj", parts.text, {.split = Split::kGroup})) ==
        Names{"s_body", "s_top"});
}

TEST_CASE("groups that are open to one another are one building, closed neighbours are two") {
  const double scale = GENERATE(0.8, 1.0, 2.5);
  const auto quad = [&](Mesh& m, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const int first = static_cast<int>(m.vertices.size());
    for (const Vec3& p : {a, b, c, d}) m.vertices.push_back(scale * p);
    m.faces.push_back({first, first + 1, first + 2});
    m.faces.push_back({first, first + 2, first + 3});
  };
  Mesh body, tower;  // 12 x 8 x 6, and 3 x 3 x 9 before a gap in its wall at x = 12
  quad(body, {0, 0, 0}, {12, 0, 0}, {12, 0, 6}, {0, 0, 6});
  quad(body, {12, 8, 0}, {0, 8, 0}, {0, 8, 6}, {12, 8, 6});
  quad(body, {0, 8, 0}, {0, 0, 0}, {0, 0, 6}, {0, 8, 6});
  quad(body, {12, 0, 0}, {12, 2, 0}, {12, 2, 6}, {12, 0, 6});
  quad(body, {12, 5, 0}, {12, 8, 0}, {12, 8, 6}, {12, 5, 6});
  for (const auto& [from, to] : {std::pair{0.0, 2.0}, {2.0, 5.0}, {5.0, 8.0}})
    quad(body, {0, from, 6}, {12, from, 6}, {12, to, 6}, {0, to, 6});
  for (const auto& [low, high] : {std::pair{0.0, 6.0}, {6.0, 9.0}}) {
    quad(tower, {12, 2, low}, {15, 2, low}, {15, 2, high}, {12, 2, high});
    quad(tower, {15, 5, low}, {12, 5, low}, {12, 5, high}, {15, 5, high});
  }
  quad(tower, {15, 2, 0}, {15, 5, 0}, {15, 5, 9}, {15, 2, 9});
  quad(tower, {12, 5, 6}, {12, 2, 6}, {12, 2, 9}, {12, 5, 9});
  quad(tower, {12, 2, 9}, {15, 2, 9}, {15, 5, 9}, {12, 5, 9});
  Objects open, closed;
  open.add("g", "body", body), open.add("g", "tower", tower);
  CHECK(names(read_bytes("s.obj", open.text)) == Names{"s"});
  CHECK(names(read_bytes("s.obj", open.text, {.split = Split::kGroup})) ==
        Names{"s_body", "s_tower"});
  for (int i = 0; i < 3; ++i)  // a row, wall on wall, without floors
    closed.add("g", "nr" + std::to_string(i), [&] {
      Mesh m =
          moved(gable_house(8 * scale, 8 * scale, 5 * scale, 3 * scale), {8 * scale * i, 0, 0});
      std::erase_if(m.faces,
                    [&](const Face& f) { return face_cross(m, f).normalized().z() < -0.99; });
      return m;
    }());
  CHECK(names(read_bytes("s.obj", closed.text)) == Names{"s_nr0", "s_nr1", "s_nr2"});
}

TEST_CASE("bodies that look like buildings and stand apart are buildings of their own") {
  const Mesh hall = gable_house(60, 30, 10, 5);
  for (const double angle : {0.0, 20.0, 45.0}) {
    INFO(angle);
    const Mesh works = turned(join(join(hall, moved(gable_house(6, 5, 3, 1.5), {70, 0, 0})),
                                   box_mesh({66, 20, 0}, {72, 23, 2.5})),
                              angle);
    const ReadResult r = read_bytes("works.obj", obj_text(works));
    CHECK(names(r) == Names{"works", "works_2", "works_3"});
    CHECK(volume(r) == Approx(22500 + 112.5 + 45));
    CHECK_THAT(said(r), Contains("stand apart, 2 parted"));
    CHECK(names(read_bytes("works.obj", obj_text(works), {.split = Split::kNone})) ==
          Names{"works"});
  }
  Mesh sixteen;
  for (int i = 0; i < 16; ++i)
    sixteen =
        join(sixteen, moved(gable_house(9 + i % 3, 8, 5, 3), {15.0 * (i % 4), 15.0 * (i / 4), 0}));
  CHECK(read_bytes("s.obj", obj_text(sixteen)).sources.size() == 16);
}

TEST_CASE("floaters, lamps, trees and what touches stay with their building") {
  Mesh m = gable_house(12, 8, 6, 3);
  Mesh tree = sphere_mesh(3);
  for (Vec3& p : tree.vertices) p = 2.5 * p + Vec3(20, 4, 2.5);
  tree.faces.pop_back();  // as scans show it, open
  m = join(m, tree);
  m = join(m, box_mesh({16, 1, 0}, {16.3, 1.3, 5}));      // a lamp
  m = join(m, box_mesh({12.4, 0, 0}, {16, 5, 3}));        // a garage behind a gap of 40 cm
  m = join(m, box_mesh({40, 0, 30}, {44, 4, 34}));        // in the air
  m = join(m, box_mesh({30, 20, 0}, {30.5, 20.5, 0.5}));  // a box
  const ReadResult r = read_bytes("a.obj", obj_text(m));
  CHECK(names(r) == Names{"a"});
  CHECK(r.sources[0].mesh.faces.size() == m.faces.size());
  CHECK(said(r).empty());
}

TEST_CASE("round bodies of any number of corners are buildings, and take no square of it") {
  for (const int corners : {8, 100, 30000}) {
    Mesh towers;
    for (const double x : {0.0, 40.0}) {
      Mesh tower;
      for (int i = 0; i < corners; ++i)
        for (const double z : {0.0, 12.0})
          tower.vertices.emplace_back(x + 6 * std::cos(2 * M_PI * i / corners),
                                      6 * std::sin(2 * M_PI * i / corners), z);
      tower.vertices.insert(tower.vertices.end(), {{x, 0, 0}, {x, 0, 12}});
      for (int i = 0; i < corners; ++i) {
        const int a = 2 * i, b = 2 * ((i + 1) % corners), foot = 2 * corners;
        for (const Face& f : {Face{a, b, b + 1}, Face{a, b + 1, a + 1}, Face{b, a, foot},
                              Face{a + 1, b + 1, foot + 1}})
          tower.faces.push_back(f);
      }
      towers = join(towers, tower);
    }
    INFO(corners);
    CHECK(names(read_bytes("t.obj", obj_text(towers))) == Names{"t", "t_2"});
  }
}

TEST_CASE("names that are not Latin stay beside the safe ones") {
  Objects street;
  const Names given = {"教学楼", "Žižkov 5", "Дом", "بيت"};
  for (std::size_t i = 0; i < given.size(); ++i)
    street.add("o", given[i],
               moved(gable_house(12, 8, 6, 3), {30.0 * static_cast<double>(i), 0, 0}));
  const ReadResult r = read_bytes("街.obj", street.text);
  REQUIRE(r.sources.size() == 4);
  Names found;
  for (const Source& s : r.sources) {
    found.push_back(s.given_name);
    for (const char c : s.name) CHECK(static_cast<unsigned char>(c) < 0x80);
  }
  for (const std::string& name : given) CHECK(std::count(found.begin(), found.end(), name) == 1);
  const auto one = read_bytes("図書館.obj", obj_text(gable_house(12, 8, 6, 3)));
  CHECK(one.sources.at(0).given_name == "図書館");
}
