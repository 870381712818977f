#include "../src/partition.h"

#include <catch2/catch.hpp>

using namespace colod;

namespace {
CutPlane whole_plane(const Vec3& normal, const Vec3& through, int source = -1) {
  const Vec3 n = normal.normalized();
  return {n, n.dot(through), {}, source};
}
Box cube(double half) { return {Vec3::Constant(-half), Vec3::Constant(half)}; }
}  // namespace

TEST_CASE("without planes the box is the one cell") {
  const Partition p = partition_space({}, cube(4));
  REQUIRE(p.cells.size() == 1);
  CHECK(p.pieces.size() == 6);
  CHECK(p.cells[0].volume == Approx(512).epsilon(1e-12));
}

TEST_CASE("three planes through the middle make eight cells") {
  std::vector<CutPlane> planes;
  for (int k = 0; k < 3; ++k) planes.push_back(whole_plane(Vec3::Unit(k), Vec3::Zero()));
  const Partition p = partition_space(planes, cube(4));
  REQUIRE(p.cells.size() == 8);
  CHECK(p.pieces.size() == 12 + 24);
  for (const Partition::Cell& cell : p.cells) CHECK(cell.volume == Approx(64));
}
