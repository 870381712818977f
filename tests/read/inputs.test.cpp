// What stands in folders and on command lines, and what files of another place or scale hold.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "core/error.h"
#include "read_helpers.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const Mesh kHouse = gable_house(12, 8, 6, 3);

std::vector<std::string> names(const ReadResult& result) {
  std::vector<std::string> out;
  for (const Source& s : result.sources) out.push_back(s.name);
  return out;
}

using Names = std::vector<std::string>;

std::string joined(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& l : lines) all += l + "\n";
  return all;
}

Mesh mapped(Mesh m, const std::function<Vec3(const Vec3&)>& map) {
  for (Vec3& p : m.vertices) p = map(p);
  return m;
}

Source only(const ReadResult& result) {
  for (const ReadFailure& f : result.failures) UNSCOPED_INFO(f.path << ": " << f.message);
  REQUIRE(result.sources.size() == 1);
  return result.sources.front();
}

std::string warnings_of(const std::string& name, const std::string& bytes,
                        const ReadOptions& options = {}) {
  return joined(only(read_bytes(name, bytes, options)).warnings);
}

Vec3 to_y_up(const Vec3& p) { return {p.x(), p.z(), -p.y()}; }

/// A box without a slope.
Mesh block(double w, double d, double h) { return box_mesh({0, 0, 0}, {w, d, h}); }

/// A block as PLY with more lines in its header.
std::string ply_with_head(const std::string& lines) {
  std::string text = ply_bytes<double>(block(12, 6, 8), false);
  return text.insert(text.find("element"), lines);
}

Mesh turned(const Mesh& m, double angle) {
  return mapped(m, [angle](const Vec3& p) {
    return Vec3(std::cos(angle) * p.x() - std::sin(angle) * p.y(),
                std::sin(angle) * p.x() + std::cos(angle) * p.y(), p.z());
  });
}

/// Every vertex moved by up to `size`, at random.
Mesh noisy(const Mesh& m, double size) {
  std::mt19937_64 random(9);
  const auto draw = [&] { return size * (2 * static_cast<double>(random() >> 11) * 0x1p-53 - 1); };
  return mapped(m, [&](const Vec3& p) { return Vec3(p + Vec3(draw(), draw(), draw())); });
}

}  // namespace

TEST_CASE("one odd entry of a folder fails alone") {
  const TempFolder folder;
  folder.write("a.obj", obj_text(kHouse));
  fs::create_symlink("loop.obj", folder.path / "loop.obj");
  fs::create_symlink("nowhere.obj", folder.path / "dangling.obj");
  fs::create_symlink("/dev/zero", folder.path / "z.obj");
  REQUIRE(mkfifo((folder.path / "f.obj").c_str(), 0600) == 0);
  const ReadResult r = read_sources({folder.path.string()});
  CHECK(names(r) == Names{"a"});
  REQUIRE(r.failures.size() == 4);
  for (const ReadFailure& f : r.failures) {
    CHECK(f.message.size() > 10);
    CHECK(f.message.find('\n') == std::string::npos);
  }
  CHECK_THAT(r.failures[1].message, Contains("pipe"));
}

TEST_CASE("a file is read once, whatever links lead to it, and that is said") {
  const TempFolder folder;
  folder.write("real.obj", obj_text(kHouse));
  fs::create_symlink("real.obj", folder.path / "a.obj");
  fs::create_directories(folder.path / "other");
  fs::create_symlink("../real.obj", folder.path / "other" / "b.obj");
  const Inventory all = take_inventory({folder.path.string(), (folder.path / "other").string()});
  REQUIRE(all.files.size() == 1);
  CHECK(all.files[0].names == Names{"real"});
  CHECK_THAT(joined(all.warnings), Contains("a.obj") && Contains("b.obj") && Contains("same file"));
}

TEST_CASE("subfolders are counted, and read when asked for") {
  const TempFolder folder;
  folder.write("a.obj", obj_text(kHouse));
  for (const char* name : {"north/b.obj", "north/old/c.obj", "south/d.ply.obj"}) {
    fs::create_directories((folder.path / name).parent_path());
    folder.write(name, obj_text(kHouse));
  }
  fs::create_directory_symlink("..", folder.path / "north" / "up");
  const Inventory flat = take_inventory({folder.path.string()});
  CHECK(flat.building_count() == 1);
  CHECK_THAT(joined(flat.warnings), Contains("3 files") && Contains("--recursive"));
  const Inventory deep = take_inventory({folder.path.string()}, {.is_recursive = true});
  CHECK(deep.building_count() == 4);
  CHECK(deep.warnings.empty());
  fs::remove(folder.path / "a.obj");
  CHECK_THROWS_WITH(take_inventory({folder.path.string()}), Contains("--recursive"));
}

TEST_CASE("shadows of macOS, texts and offsets in a folder are no buildings") {
  const TempFolder folder;
  folder.write("x.obj", obj_text(kHouse));
  folder.write("._x.obj", std::string("\0\5\26\7", 4));
  folder.write("readme.txt", "Houses of 1990\n1 2 3\n");
  folder.write("p_offset.xyz", "691000 5334000 500\n");
  std::string rows;
  for (int i = 0; i < 50; ++i) rows += std::to_string(i % 7) + ";" + std::to_string(i) + ";1\n";
  folder.write("scan.txt", "x;y;z\n" + rows);
  const ReadResult r = read_sources({folder.path.string()});
  CHECK(names(r) == Names{"scan", "x"});
  CHECK(r.failures.empty());
}

TEST_CASE("what colod itself wrote is not read again with a folder") {
  const TempFolder folder;
  folder.write("a.obj", obj_text(kHouse));
  for (const char* name : {"out/buildings/a.layer0.obj", "out/engine/a_LOD0.obj"}) {
    fs::create_directories((folder.path / name).parent_path());
    folder.write(name, obj_text(kHouse));
  }
  folder.write("out/report.json", "{\n  \"colod\": \"0.1.0\"");
  const Inventory all = take_inventory({folder.path.string()}, {.is_recursive = true});
  CHECK(all.building_count() == 1);
  CHECK_THAT(joined(all.warnings), Contains("out: what colod itself wrote, not read again"));
  for (const char* own : {"out", "out/buildings"})
    CHECK_THROWS_WITH(take_inventory({(folder.path / own).string()}),
                      Contains("colod itself wrote"));
  CHECK(take_inventory({(folder.path / "out/buildings/a.layer0.obj").string()}).files.size() == 1);
}

TEST_CASE(
    "files that are not read stand in a warning, and larger ones than the budget fail unread") {
  const TempFolder folder;
  folder.write("a.obj", obj_text(kHouse));
  folder.write("b.e57", "ASTM-E57");
  folder.write("c.ifc", "ISO-10303-21;");
  const Inventory all = take_inventory({folder.path.string()});
  CHECK_THAT(joined(all.warnings), Contains("pdal") && Contains("1 more file"));
  const std::string large = folder.write("d.obj", "");
  fs::resize_file(large, std::uintmax_t{3} << 30);  // a hole: takes no room
  const ReadResult r = read_sources({folder.path.string()});
  CHECK(names(r) == Names{"a"});
  REQUIRE(r.failures.size() == 1);
  CHECK_THAT(r.failures[0].message, Contains("3072 MiB") && Contains("--input-memory"));
  fs::resize_file(large, 3 << 20);
  CHECK_THAT(read_sources({large}, {.input_memory = 2}).failures.at(0).message, Contains("3 MiB"));
}

TEST_CASE("a stray piece or vertex far away is left out with a figure, at any size") {
  for (const double size : {0.5, 1.0, 8.0})
    for (const Vec3& at : {Vec3(0, 0, 0), Vec3(691000, 5334000, 500)}) {
      Mesh house = mapped(kHouse, [&](const Vec3& p) { return Vec3(size * p + at); });
      const double far = 60 * size * 12;
      const Vec3 there = at + Vec3(far, -far, 0);
      Mesh piece = house;
      piece.vertices.insert(piece.vertices.end(),
                            {there, there + Vec3(0, 1, 0), there + Vec3(0.5, 0, 0)});
      piece.faces.push_back({10, 11, 12});
      INFO("size " << size << " at " << at.transpose());
      const Source s = only(read_bytes("a.obj", obj_text(piece)));
      CHECK(s.mesh.faces == house.faces);
      CHECK(s.mesh.vertices.size() == 10);
      CHECK_THAT(joined(s.warnings), Contains("away from all the rest"));
      REQUIRE(s.left_out.size() == 1);
      CHECK(s.left_out[0].area == Approx(0.25));
      CHECK(s.left_out[0].farthest > 0.8 * far);
    }
}

TEST_CASE("a vertex left at 0,0,0 of a model in projected coordinates goes with its slivers") {
  for (const double size : {1.0, 5.0}) {
    Mesh house = mapped(gable_house(12, 8, 6, 3),
                        [&](const Vec3& p) { return Vec3(size * p + Vec3(691000, 5334000, 500)); });
    house.vertices.emplace_back(0, 0, 0);
    house.faces.push_back({4, 5, 10});
    house.faces.push_back({5, 9, 10});
    const Source s = only(read_bytes("a.obj", obj_text(house)));
    CHECK(s.mesh.faces.size() == 16);
    CHECK(signed_volume(s.mesh) ==
          Approx(size * size * size * signed_volume(kHouse)).epsilon(1e-4));
  }
}

TEST_CASE("a large triangle left at 0,0,0 of projected coordinates is listed as left out") {
  for (const double size : {0.8, 1.0, 2.0})
    for (const double side : {1.0, 10.0}) {
      Mesh house = mapped(
          kHouse, [&](const Vec3& p) { return Vec3(size * p + Vec3(691000, 5334000, 500)); });
      house.vertices.insert(house.vertices.end(),
                            {Vec3::Zero(), Vec3(side, 0, 0), Vec3(0, side, 0)});
      house.faces.push_back({10, 11, 12});
      INFO(size << " " << side);
      const Source s = only(read_bytes("a.obj", obj_text(house)));
      CHECK(s.mesh.faces.size() == kHouse.faces.size());
      REQUIRE(s.left_out.size() == 1);
      CHECK(s.left_out[0].area == Approx(0.5 * side * side));
      CHECK(s.left_out[0].farthest > 5e6);
    }
}

TEST_CASE("nothing that may belong to a building is a stray") {
  const ReadOptions whole{.split = Split::kNone};  // auto would part the village, too
  Mesh village;                                    // houses of 12 m on 3 km, one of them far off
  for (int i = 0; i < 40; ++i)
    village = join(village, mapped(kHouse, [&](const Vec3& p) {
                     return Vec3(p + Vec3(75.0 * i, 300 * (i % 3), 0));
                   }));
  CHECK(only(read_bytes("a.obj", obj_text(village), whole)).mesh.faces.size() == 640);
  const Mesh pair =
      join(kHouse, mapped(kHouse, [](const Vec3& p) { return Vec3(p + Vec3(5000, 0, 0)); }));
  CHECK(only(read_bytes("a.obj", obj_text(pair), whole)).mesh.faces.size() == 32);
  // A hall of 900 m with a small fine thing in its middle.
  const Mesh thing = mapped(kHouse, [](const Vec3& p) { return Vec3(0.1 * p + Vec3(450, 30, 8)); });
  CHECK(only(read_bytes("a.obj", obj_text(join(block(900, 60, 8), thing)), whole))
            .mesh.faces.size() == 28);
  // A spire of 150 m on a base of 8.
  CHECK(only(read_bytes("a.obj", obj_text(gable_house(8, 8, 10, 150)), whole)).mesh.faces.size() ==
        16);
}

TEST_CASE("a cloud's single points far away are left out before normals are estimated") {
  std::string text;
  std::mt19937_64 random(5);
  for (int i = 0; i < 2000; ++i)
    text += std::to_string(0.01 * (random() % 1000)) + " " +
            std::to_string(0.01 * (random() % 800)) + " 5\n";
  const Source s = only(read_bytes("a.xyz", text + "0 0 -9000\n70000 1 1\n"));
  CHECK(s.cloud.points.size() == 2000);
  CHECK(s.cloud.normals.size() == 2000);
  CHECK_THAT(joined(s.warnings), Contains("2 points left out"));
}

TEST_CASE("a model that lies on its side is told by its slopes, whatever its size and turn") {
  for (const double size : {0.6, 1.0, 4.0})
    for (const double angle : {0.0, 0.4, 1.2})
      for (const double noise : {0.0, 0.02}) {
        const Mesh house = noisy(
            turned(gable_house(12 * size, 8 * size, 6 * size, 3 * size), angle), noise * size);
        INFO(size << " " << angle << " " << noise);
        CHECK(warnings_of("a.obj", obj_text(house)) == "");
        const std::string lying = obj_text(mapped(house, to_y_up));
        CHECK_THAT(warnings_of("a.obj", lying), Contains("--up y"));
        CHECK(warnings_of("a.obj", lying, {.up = Up::kZ}) == "");
        CHECK(warnings_of("a.obj", lying, {.up = Up::kY}) == "");
        const Source s = only(read_bytes("a.obj", lying, {.up = Up::kAuto}));
        CHECK(bounding_box(s.mesh.vertices).size().z() > 8.5 * size);
        CHECK_THAT(joined(s.warnings), Contains("taken as y up"));
        CHECK(warnings_of("a.obj", obj_text(house), {.up = Up::kAuto}) == "");
      }
}

TEST_CASE(
    "a glTF whose content is z up is told by its slopes, and turned where that is asked for") {
  const auto glb = [](const Mesh& m) { return glb_bytes(m, R"([{"mesh":0}])", "[0]"); };
  for (const double size : {0.6, 1.0, 4.0})
    for (const double angle : {0.0, 0.4, 1.2}) {
      const Mesh house = turned(gable_house(12 * size, 8 * size, 6 * size, 3 * size), angle);
      INFO(size << " " << angle);
      CHECK(warnings_of("a.glb", glb(mapped(house, to_y_up))) == "");
      CHECK(warnings_of("a.glb", glb(mapped(house, to_y_up)), {.up = Up::kAuto}) == "");
      CHECK_THAT(warnings_of("a.glb", glb(house)), Contains("--up auto"));
      CHECK(warnings_of("a.glb", glb(house), {.up = Up::kY}) == "");
      CHECK(warnings_of("a.glb", glb(house), {.up = Up::kZ}) == "");
      const Source told = only(read_bytes("a.glb", glb(house), {.up = Up::kZ}));
      CHECK((bounding_box(told.mesh.vertices).max - bounding_box(house.vertices).max).norm() <
            1e-5);
      CHECK(signed_volume(told.mesh) == Approx(signed_volume(house)).epsilon(1e-5));
      const Source lying = only(read_bytes("a.glb", glb(house), {.up = Up::kY}));
      CHECK(bounding_box(lying.mesh.vertices).size().z() ==
            Approx(bounding_box(house.vertices).size().y()));
      const Source s = only(read_bytes("a.glb", glb(house), {.up = Up::kAuto}));
      CHECK_THAT(joined(s.warnings), Contains("taken as z up"));
      CHECK((bounding_box(s.mesh.vertices).max - bounding_box(house.vertices).max).norm() < 1e-5);
      CHECK(signed_volume(s.mesh) == Approx(signed_volume(house)).epsilon(1e-5));
    }
}

TEST_CASE("a program that writes y up is believed unless the slopes tell otherwise") {
  const std::string blender = "# Blender 4.2.0\n# www.blender.org\n";
  const std::string sketchup = "# Exported from SketchUp\n# File units = meters\n";
  for (const std::string& head : {blender, sketchup}) {
    CHECK_THAT(warnings_of("a.obj", head + obj_text(block(12, 6, 8))), Contains("--up y"));
    CHECK(warnings_of("a.obj", head + obj_text(kHouse)) == "");
  }
  CHECK(warnings_of("a.ply", ply_with_head("comment Created in Blender 4.2\n")) == "");  // z up
  CHECK(warnings_of("a.obj", "# Rhino\n" + obj_text(block(12, 8, 6))) == "");
}

TEST_CASE("units are doubted by size and by what the head says, in one line with the option") {
  const auto scaled = [](double by) {
    return obj_text(mapped(kHouse, [by](const Vec3& p) { return Vec3(by * p); }));
  };
  CHECK_THAT(warnings_of("a.obj", scaled(1000)), Contains("--unit mm (9 m high)"));
  CHECK_THAT(warnings_of("a.obj", scaled(100)), Contains("--unit cm (9 m high)"));
  CHECK_THAT(warnings_of("a.obj", scaled(1 / 0.0254)), Contains("--unit in (9 m high)"));
  CHECK_THAT(warnings_of("a.obj", scaled(0.01)), Contains("--unit"));
  CHECK_THAT(warnings_of("a.obj", "# File units = inches\n" + scaled(10)), Contains("--unit in"));
  CHECK(warnings_of("a.obj", scaled(1000), {.unit = 1e-3}) == "");
  for (const double by : {0.3, 1.0, 3.0, 8.0}) CHECK(warnings_of("a.obj", scaled(by)) == "");
  for (const Vec3& tower : {Vec3(60, 50, 320), Vec3(80, 80, 500), Vec3(300, 200, 90)})
    CHECK(warnings_of("a.obj", obj_text(block(tower.x(), tower.y(), tower.z()))) == "");
}

TEST_CASE("glTF is in metres, is doubted by size as well, and takes an explicit unit") {
  const Mesh mm = mapped(kHouse, [](const Vec3& p) { return Vec3(1000 * to_y_up(p)); });
  const std::string glb = glb_bytes(mm, R"([{"mesh":0}])", "[0]");
  CHECK_THAT(warnings_of("a.glb", glb), Contains("--unit mm"));
  const Source s = only(read_bytes("a.glb", glb, {.unit = 1e-3}));
  CHECK(bounding_box(s.mesh.vertices).size().z() == Approx(9));
  CHECK(s.warnings.empty());
}

TEST_CASE("degrees beside a height in metres are refused, unless the unit is given") {
  for (const Vec2& place : {Vec2(11.5761, 48.1372), Vec2(-0.1276, 51.5072), Vec2(151.2, -33.86)})
    for (const double size : {1.0, 4.0, 30.0}) {
      const Mesh house = mapped(kHouse, [&](const Vec3& p) {
        return Vec3(place.x() + size * p.x() / 74000, place.y() + size * p.y() / 111000,
                    520 + size * p.z());
      });
      CHECK_THAT(failure("a.obj", obj_text(house)), Contains("degrees"));
      CHECK_THAT(failure("a.obj", obj_text(mapped(house, to_y_up))), Contains("degrees"));
      CHECK_THAT(warnings_of("a.obj", obj_text(house), {.unit = 1.0}), Contains("degrees"));
    }
  for (const Vec3& mast : {Vec3(0.3, 0.3, 30), Vec3(0.2, 0.1, 12)})  // at small local coordinates
    CHECK(failure("a.obj", obj_text(mapped(block(mast.x(), mast.y(), mast.z()), [](const Vec3& p) {
                    return Vec3(p + Vec3(15, 40, 0));
                  }))) == "");
}

TEST_CASE("a .prj beside a file tells of degrees and feet") {
  const TempFolder folder;
  const std::string file = folder.write("a.obj", obj_text(kHouse));
  folder.write("a.prj", R"(GEOGCS["WGS 84",UNIT["degree",0.0174532925199433]])");
  CHECK_THAT(read_sources({file}).failures.at(0).message, Contains("degrees"));
  folder.write("a.prj", R"(PROJCS["x",GEOGCS["y",UNIT["Degree",0.017]],UNIT["Foot_US",0.3048]])");
  CHECK_THAT(joined(only(read_sources({file})).warnings), Contains("--unit ft"));
  CHECK(only(read_sources({file}, {.unit = 0.3048})).warnings.empty());
  folder.write("a.prj", R"(PROJCS["x",GEOGCS["y",UNIT["Degree",0.017]],UNIT["metre",1]])");
  CHECK(only(read_sources({file})).warnings.empty());
}
