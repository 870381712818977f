#include "rounds/rounds.h"

#include <catch2/catch.hpp>
#include <random>

#include "rounds/reduce.h"
#include "rounds_helpers.h"

using namespace colod;
using namespace colod::test;

namespace {

std::vector<RoundShape> rounds_of(Mesh mesh) { return find_rounds(as_source(std::move(mesh))); }

/// Corners of the faces of all sides, from the planes of these.
double farthest_corner(const Mesh& mesh, const RoundShape& shape) {
  double most = 0;
  for (const RoundShape::Side& side : shape.sides)
    for (const int f : side.faces)
      for (const int v : mesh.faces[f])
        most = std::max(most, std::abs(shape.normal(side.row, side.column).dot(mesh.vertices[v]) -
                                       shape.offset(side.row, side.column)));
  return most;
}

Mesh moved(Mesh mesh, double turn, const Vec3& by) {
  const Eigen::AngleAxisd rotation(turn, Vec3::UnitZ());
  for (Vec3& v : mesh.vertices) v = rotation * v + by;
  return mesh;
}

}  // namespace

TEST_CASE("a dome is rows and columns of sides, whatever its size and where it stands") {
  struct Case {
    double radius;
    int sides, rows;
  };
  for (const Case c : {Case{2, 12, 4}, {5, 24, 8}, {8, 32, 9}, {20, 64, 24}}) {
    INFO(c.radius << " m, " << c.sides << " sides");
    const Mesh mesh =
        moved(dome_mesh(c.radius, c.sides, c.rows, 0.5 * c.radius), 0.3, {20, -30, 5});
    const std::vector<RoundShape> shapes = rounds_of(mesh);
    REQUIRE(shapes.size() == 1);
    CHECK(shapes[0].is_closed);
    CHECK(shapes[0].columns == c.sides);
    CHECK(shapes[0].rows.size() == static_cast<std::size_t>(c.rows + 1));
    CHECK(shapes[0].sides.size() == static_cast<std::size_t>(c.sides * (c.rows + 1)));
    CHECK((shapes[0].center - Vec3(20, -30, 0)).head<2>().norm() < 1e-6);
    CHECK(farthest_corner(mesh, shapes[0]) < 1e-6);
  }
}

TEST_CASE("spires, towers and vaults are round, too") {
  CHECK(rounds_of(onion_mesh(3, 20, 14)).size() == 1);
  CHECK(rounds_of(turned_mesh({{4, 0}, {4, 3}, {0, 9}}, 16)).size() == 1);
  const std::vector<RoundShape> vault = rounds_of(vault_mesh(10, 18, 4, 20));
  REQUIRE(vault.size() == 1);
  CHECK_FALSE(vault[0].is_closed);
  CHECK(vault[0].columns == 20);
  CHECK(std::abs(vault[0].axis.y()) == Approx(1));
}

TEST_CASE("elliptical domes are round ones that were narrowed, however they are turned") {
  for (const double narrow : {0.95, 0.75, 0.5, 0.35})
    for (const double turn : {0.0, 0.4}) {
      INFO(narrow << " of the length, turned by " << turn);
      Mesh mesh = dome_mesh(8, 32, 9, 4, 0.05);
      for (Vec3& v : mesh.vertices) v.y() *= narrow;
      mesh = join(moved(mesh, turn, {20, -30, 5}), gable_house(12, 9, 6, 4));
      const std::vector<RoundShape> shapes = rounds_of(mesh);
      REQUIRE(shapes.size() == 1);
      CHECK(shapes[0].is_closed);
      CHECK(shapes[0].sides.size() == 320);
      CHECK(farthest_corner(mesh, shapes[0]) < 0.003);
      const RoundShape fewer = reduce_round(shapes[0], 0.8);
      CHECK(fewer.columns == 8);
      double most = 0;
      for (const RoundShape::Side& side : fewer.sides)
        for (const Vec3& corner : fewer.corners(side.row, side.column))
          most = std::max(most, std::abs(fewer.normal(side.row, side.column).dot(corner) -
                                         fewer.offset(side.row, side.column)));
      CHECK(most < 1e-9);
    }
}

TEST_CASE("millimetres of a file do not hide a dome") {
  Mesh mesh = dome_mesh(6, 32, 9, 4);
  for (Vec3& v : mesh.vertices) v = (1000 * v).array().round() / 1000;
  const std::vector<RoundShape> shapes = rounds_of(mesh);
  REQUIRE(shapes.size() == 1);
  CHECK(shapes[0].sides.size() == 320);
}

TEST_CASE("houses, octagons, pipes and scans are not round") {
  CHECK(rounds_of(gable_house(12, 9, 6, 4)).empty());
  CHECK(rounds_of(turned_mesh({{4, 0}, {4, 6}, {0, 9}}, 8)).empty());
  CHECK(rounds_of(join(gable_house(12, 9, 6, 4), turned_mesh({{0.05, 0}, {0.05, 6}}, 16))).empty());
  Mesh scan = dome_mesh(8, 96, 32, 5);
  std::mt19937 rng(5);
  for (Vec3& v : scan.vertices)
    for (int i = 0; i < 3; ++i) v[i] += 0.02 * (static_cast<double>(rng()) / rng.max() - 0.5);
  CHECK(rounds_of(scan).empty());
}

TEST_CASE("a reduced dome is regular, has fewer sides and the same cross-section") {
  const RoundShape shape = rounds_of(dome_mesh(8, 32, 9, 4)).front();
  const RoundShape few = reduce_round(shape, std::numbers::pi / 4);
  CHECK(few.columns == 8);
  CHECK(few.rows.size() == 3);
  CHECK(few.sides.size() == 24);
  const auto area = [](const RoundShape& s, std::size_t row) {
    const double x = s.rows[row].from.x();
    return s.columns * x * x * std::tan(s.step / 2);
  };
  CHECK(area(few, 0) == Approx(area(shape, 0)));
  std::size_t faces = 0, before = 0;
  for (const RoundShape::Side& side : few.sides) faces += side.faces.size();
  for (const RoundShape::Side& side : shape.sides) before += side.faces.size();
  CHECK(faces == before);
  for (const RoundShape::Side& side : few.sides)
    for (const Vec3& x : few.corners(side.row, side.column))
      CHECK(few.normal(side.row, side.column).dot(x) ==
            Approx(few.offset(side.row, side.column)).margin(1e-9));
  CHECK(reduce_round(shape, shape.step).sides.size() == shape.sides.size());
}

TEST_CASE("a reduced vault keeps its ends") {
  const RoundShape shape = rounds_of(vault_mesh(10, 18, 4, 20)).front();
  const RoundShape few = reduce_round(shape, std::numbers::pi / 4);
  CHECK(few.columns == 4);
  double low = 1e9, high = -1e9;
  for (const RoundShape::Side& side : few.sides)
    for (const Vec3& x : few.corners(side.row, side.column))
      low = std::min(low, x.x()), high = std::max(high, x.x());
  CHECK(low == Approx(-5).margin(1e-6));
  CHECK(high == Approx(5).margin(1e-6));
}
