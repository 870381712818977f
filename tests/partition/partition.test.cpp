#include "partition/partition.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>

#include "core/error.h"
#include "partition_helpers.h"

using namespace colod;
using namespace colod::test;
using boost::multiprecision::cpp_int;

namespace {

bool is_equal(const Partition& a, const Partition& b) {
  const auto same_piece = [](const Partition::Piece& s, const Partition::Piece& t) {
    return s.plane == t.plane && s.cells == t.cells && s.polygon == t.polygon &&
           s.line_planes == t.line_planes;
  };
  return a.points == b.points && a.pieces.size() == b.pieces.size() &&
         std::equal(a.pieces.begin(), a.pieces.end(), b.pieces.begin(), same_piece);
}

int used_by(const Partition& p, int plane) {
  int count = 0;
  for (const Partition::Piece& piece : p.pieces) count += piece.plane == plane;
  return count;
}

int sign_of(const cpp_int& x) { return x.sign(); }

int oracle_side(const Partition::IntPlane& plane, const Partition::Vertex& v) {
  cpp_int value = cpp_int(plane.d) * cpp_int(v.h[3]);
  for (int k = 0; k < 3; ++k) value += cpp_int(plane.normal[k]) * cpp_int(v.h[k]);
  return sign_of(value);
}

/// (b − a) × (c − a) · normal, in full.
int oracle_orientation(const Partition& p, int plane, int a, int b, int c) {
  const auto difference = [&](int v, int w, int k) -> cpp_int {
    const auto &hv = p.vertices[v].h, &hw = p.vertices[w].h;
    return cpp_int(hw[k]) * cpp_int(hv[3]) - cpp_int(hv[k]) * cpp_int(hw[3]);
  };
  cpp_int value = 0;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    value += cpp_int(p.planes[plane].normal[k]) * (difference(a, b, i) * difference(a, c, j) -
                                                   difference(a, b, j) * difference(a, c, i));
  }
  return sign_of(value);
}

}  // namespace

TEST_CASE("without planes the box is the one cell") {
  const Partition p = partition_space({}, {Vec3(1, 2, 3), Vec3(3, 6, 11)});
  REQUIRE(p.cells.size() == 1);
  CHECK(p.pieces.size() == 6);
  CHECK(p.cells[0].volume == Approx(64).epsilon(1e-12));
  CHECK((p.cells[0].centroid - Vec3(2, 4, 7)).norm() < 1e-12);
  check_partition(p);
}

TEST_CASE("three planes through the middle make eight cells") {
  const Partition p = partition_space(lattice(0), cube(4));
  REQUIRE(p.cells.size() == 8);
  CHECK(p.pieces.size() == 12 + 24);
  for (const Partition::Cell& cell : p.cells) CHECK(cell.volume == Approx(64).epsilon(1e-12));
  check_partition(p);
}

TEST_CASE("axis-parallel planes stay exactly axis-parallel") {
  const Partition p = partition_space({whole_plane({0, -1, 0}, {1, 2, 3}, 7)}, cube(10));
  CHECK(p.planes[6].normal == std::array<std::int32_t, 3>{0, -(1 << 23), 0});
  CHECK(p.planes[6].source_plane == 7);
  CHECK(p.cells[0].box.min.y() == 2);  // behind the plane
  CHECK(p.cells[1].box.max.y() == 2);
}

TEST_CASE("nine planes through one point make 48 cells, tripled and reversed too") {
  for (const bool has_copies : {false, true}) {
    const Partition p = partition_space(star(has_copies), cube(4));
    CHECK(p.cells.size() == 48);
    CHECK(p.planes.size() == 6 + 9);
    check_partition(p);
  }
}

TEST_CASE("60 planes through a line make 120 cells") {
  const Partition p = partition_space(pencil(60), cube(4));
  CHECK(p.cells.size() == 120);
  check_partition(p);
}

TEST_CASE("a lattice has its known number of cells, pieces and vertices") {
  const Partition p = partition_space(lattice(3), cube(4));
  CHECK(p.cells.size() == 8 * 8 * 8);
  CHECK(p.pieces.size() == 3 * 9 * 8 * 8);
  CHECK(p.vertices.size() == 9 * 9 * 9);
  check_partition(p);
}

TEST_CASE("rotated arrangements no longer concur, and are closed all the same") {
  for (const auto& planes : {star(true), pencil(40), lattice(2)}) {
    const Partition p = partition_space(rotated(planes), cube(4));
    CHECK(p.cells.size() >= 48);
    check_partition(p);
  }
}

TEST_CASE("planes that are equal up to rounding become one, whatever part of them is given") {
  const Vec3 n = Vec3(1, 2, 3).normalized(), u = plane_basis(n)[0], v = plane_basis(n)[1];
  std::vector<CutPlane> planes;
  for (const double at : {-30.0, 0.0, 30.0})
    for (const double sign : {1.0, -1.0})
      planes.push_back(
          {sign * n, sign * 1.0, {n + at * u - v, n + at * u + v, n + (at + 5) * u}, 3});
  const Partition p = partition_space(planes, cube(50));
  CHECK(p.planes.size() == 7);
  CHECK(p.cells.size() == 2);
  CHECK_FALSE(p.cuts[0].is_reversed);
  CHECK(p.cuts[1].is_reversed);
  CHECK(p.cuts[5].plane == 6);
}

TEST_CASE("parallel planes a millimetre apart both cut") {
  const Vec3 n = Vec3(1, 2, 3).normalized();
  const Partition p =
      partition_space({whole_plane(n, Vec3::Zero()), whole_plane(-n, 1e-3 * n)}, cube(4));
  CHECK(p.cells.size() == 3);
  check_partition(p);
}

TEST_CASE("a plane on a side of the box cuts nothing and lends the side its name") {
  const Partition p = partition_space(
      {whole_plane({1, 0, 0}, {4, 0, 0}, 5), whole_plane({0, 1, 0}, {0, -4, 0}, 6)}, cube(4));
  CHECK(p.cells.size() == 1);
  CHECK(p.planes[1].source_plane == 5);
  CHECK(p.planes[2].source_plane == -1);  // looks into the box
  CHECK(p.cuts[0].plane == 1);
  CHECK((p.cuts[1].plane == 2 && p.cuts[1].is_reversed));
}

TEST_CASE("a plane through a corner and along an edge of the box cuts nothing") {
  const Partition p = partition_space(
      {whole_plane({1, 1, 1}, {4, 4, 4}), whole_plane({1, 1, 0}, {-4, -4, 0})}, cube(4));
  CHECK(p.cells.size() == 1);
  CHECK(p.cuts[0].plane == -1);
  CHECK(p.warnings.size() == 1);
}

TEST_CASE("a plane exactly through vertices and edges of cells") {
  std::vector<CutPlane> planes = lattice(1);
  planes.push_back(whole_plane({1, 1, 1}, Vec3::Zero()));
  planes.push_back(whole_plane({1, 1, 0}, Vec3::Zero()));
  const Partition p = partition_space(planes, cube(2));
  // Of the 64 unit cubes the first plane halves the 24 whose corners sum to −1 or −2, the other the
  // 16 with x + y = −1; both meet only on faces, and all vertices stay on the lattice.
  CHECK(p.cells.size() == 64 + 24 + 16);
  CHECK(p.vertices.size() == 5 * 5 * 5);
  check_partition(p);
}

TEST_CASE("a plane cuts only the cells that its hull reaches, and those completely") {
  const std::vector<Vec3> small{{-1, -1, 0}, {-3, -1, 0}, {-3, -3, 0}, {-1, -3, 0}};
  const Partition p =
      partition_space({whole_plane({1, 0, 0}, {0, 0, 0}), {Vec3(0, 0, 1), 0, small, 1}}, cube(4));
  CHECK(p.cells.size() == 3);
  CHECK(used_by(p, 7) == 1);
  const std::vector<Vec3> touching{{0.005, -1, 1}, {-3, -1, 1}, {-3, -3, 1}};
  const Partition q = partition_space(
      {whole_plane({1, 0, 0}, {0, 0, 0}), {Vec3(0, 0, 1), 1, touching, 1}}, cube(40));
  CHECK(q.cells.size() == 3);  // five millimetres beyond the first plane do not count
}

TEST_CASE("coarse planes first: finer planes only refine the cells") {
  std::vector<CutPlane> planes = building_like(60, 5);
  const Partition fine = partition_space(planes, building_box());
  planes.resize(20);
  const Partition coarse = partition_space(planes, building_box());
  for (const Partition::Piece& piece : coarse.pieces) {
    if (piece.plane < 6) continue;
    CHECK(used_by(fine, piece.plane) >= used_by(coarse, piece.plane));
  }
}

TEST_CASE("a cell says which one it was split from") {
  std::vector<CutPlane> planes = {{Vec3::UnitX(), 1, {}, -1}, {Vec3::UnitY(), 1, {}, -1}};
  Box box;
  box.extend(Vec3(0, 0, 0)), box.extend(Vec3(2, 2, 2));
  const Partition before = partition_space(planes, box);
  planes.push_back({Vec3(1, 2, 3).normalized(), 3, {}, -1});
  const Partition after = partition_space(planes, box);
  REQUIRE(after.cells.size() > before.cells.size());
  CHECK(after.cells[0].split_from == -1);
  std::vector<double> volume(before.cells.size(), 0);
  for (std::size_t c = 0; c < after.cells.size(); ++c) {
    CHECK(after.cells[c].split_from < static_cast<int>(c));
    int from = static_cast<int>(c);
    while (from >= static_cast<int>(volume.size())) from = after.cells[from].split_from;
    volume[from] += after.cells[c].volume;
  }
  for (std::size_t c = 0; c < volume.size(); ++c)
    CHECK(volume[c] == Approx(before.cells[c].volume));
}

TEST_CASE("building-like planes make closed convex cells") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Partition p = partition_space(building_like(200, seed), building_box());
    CHECK(p.cells.size() > 500);
    check_partition(p);
  }
}

TEST_CASE("the checks see a missing, a moved and a turned piece") {
  const Partition whole = partition_space(building_like(30, 1), building_box());
  const auto is_seen = [&](auto&& damage) {
    Partition p = whole;
    damage(p);
    return wrong_cells(p) != wrong_cells(whole);
  };
  CHECK(is_seen([](Partition& p) { p.pieces.erase(p.pieces.begin() + 50); }));
  CHECK(is_seen([](Partition& p) { p.pieces[50].cells[0] = (p.pieces[50].cells[0] + 1) % 9; }));
  CHECK(
      is_seen([](Partition& p) { std::swap(p.pieces.back().cells[0], p.pieces.back().cells[1]); }));
}

TEST_CASE("the sides of a piece's cells are those of its plane") {
  const Partition p = partition_space(building_like(200, 4), building_box());
  for (const Partition::Piece& piece : p.pieces) {
    const Partition::IntPlane& plane = p.planes[piece.plane];
    const Vec3 n(plane.normal[0], plane.normal[1], plane.normal[2]);
    for (int s = 0; s < 2; ++s) {
      if (piece.cells[s] < 0) continue;
      const Vec3 x = (p.cells[piece.cells[s]].centroid - p.origin) / p.grid;
      const double height = (n.dot(x) + static_cast<double>(plane.d)) / n.norm() * p.grid;
      CHECK((s == 0 ? height < 1e-9 : height > -1e-9));
    }
  }
}

TEST_CASE("rounded planes stay near the real ones over their hulls") {
  const auto planes = building_like(500, 6);
  const Partition p = partition_space(planes, building_box());
  double most = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (p.cuts[i].plane < 0) continue;  // outside the box
    const Partition::IntPlane& plane = p.planes[p.cuts[i].plane];
    const Vec3 n(plane.normal[0], plane.normal[1], plane.normal[2]);
    CHECK(n.normalized().dot(planes[i].normal) * (p.cuts[i].is_reversed ? -1 : 1) > 1 - 1e-12);
    for (const Vec3& x : planes[i].hull)
      most = std::max(most, std::abs(n.dot((x - p.origin) / p.grid) + plane.d) / n.norm() * p.grid);
  }
  CHECK(most < 12 * p.grid);
}

TEST_CASE("sides and orientations agree with unbounded integers") {
  std::vector<CutPlane> planes = rotated(lattice(1));
  for (const CutPlane& plane : building_like(60, 7)) planes.push_back(plane);
  const Partition p = partition_space(planes, building_box());
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const int plane = static_cast<int>(random() % p.planes.size());
    const int v = static_cast<int>(random() % p.vertices.size());
    if (side(p, plane, v) != oracle_side(p.planes[plane], p.vertices[v])) FAIL("side");
  }
  std::vector<std::vector<int>> on_plane(p.planes.size());
  for (std::size_t f = 0; f < p.planes.size(); ++f)
    for (std::size_t v = 0; v < p.vertices.size(); ++v)
      if (side(p, f, v) == 0) on_plane[f].push_back(static_cast<int>(v));
  int collinear = 0;
  for (int i = 0; i < 20000; ++i) {
    const int plane = static_cast<int>(random() % p.planes.size());
    const std::vector<int>& on = on_plane[plane];
    const auto pick = [&] { return on[random() % on.size()]; };
    if (on.empty()) continue;
    const int a = pick(), b = pick(), c = pick();
    const int expected = oracle_orientation(p, plane, a, b, c);
    collinear += expected == 0;
    if (orientation(p, plane, a, b, c) != expected) FAIL("orientation");
  }
  CHECK(collinear > 100);
}

TEST_CASE("the order along a line is that of exact coordinates, and turns with its planes") {
  const Partition p = partition_space(rotated(lattice(2)), cube(4));
  for (const Partition::Piece& piece : p.pieces) {
    const int f = piece.plane, g = piece.line_planes[0];
    const int a = piece.polygon[0], b = piece.polygon[1];
    const auto &na = p.planes[f].normal, &nb = p.planes[g].normal;
    const Vec3 direction = Vec3(na[0], na[1], na[2]).cross(Vec3(nb[0], nb[1], nb[2]));
    const auto &ha = p.vertices[a].h, &hb = p.vertices[b].h;
    int k = 0;
    direction.cwiseAbs().maxCoeff(&k);
    const cpp_int d = cpp_int(hb[k]) * cpp_int(ha[3]) - cpp_int(ha[k]) * cpp_int(hb[3]);
    const bool is_less = (d.sign() > 0) == (direction[k] > 0);
    if (along_line_less(p, f, g, a, b) != is_less || along_line_less(p, f, g, b, a) == is_less)
      FAIL("order");
    if (along_line_less(p, g, f, a, b) == is_less) FAIL("reversed");
    if (line_id(p, f, g) != line_id(p, g, f)) FAIL("line");
  }
}

TEST_CASE("planes of a pencil share one line, others do not") {
  const Partition p = partition_space(pencil(10), cube(4));
  std::set<LineId> lines;
  for (int a = 6; a < 16; ++a)
    for (int b = 6; b < a; ++b) lines.insert(line_id(p, a, b));
  CHECK(lines.size() == 1);
  CHECK(line_id(p, 7, 0) != line_id(p, 6, 7));  // 6 and 0 are parallel
  CHECK(LineIdHash()(line_id(p, 6, 7)) == LineIdHash()(line_id(p, 9, 8)));
}

TEST_CASE("the cap on cells leaves the rest out, says so, and the result is whole") {
  const Partition p = partition_space(building_like(200, 1), building_box(), {.max_cells = 100});
  CHECK(p.cells.size() == 100);
  REQUIRE(!p.warnings.empty());
  CHECK(p.warnings.back().find("cap of 100 cells") != std::string::npos);
  check_partition(p);
}

TEST_CASE("the same input gives the same partition") {
  CHECK(is_equal(partition_space(building_like(100, 8), building_box()),
                 partition_space(building_like(100, 8), building_box())));
}

TEST_CASE("a building far from the origin is cut as well as one near it") {
  const Vec3 far(3000, -2000, 150);
  auto planes = building_like(100, 9);
  const Partition near = partition_space(planes, building_box());
  for (CutPlane& plane : planes) {
    for (Vec3& p : plane.hull) p += far;
    plane.offset += plane.normal.dot(far);
  }
  const Box box = building_box();
  const Partition p = partition_space(planes, {box.min + far, box.max + far});
  CHECK(p.cells.size() == near.cells.size());
  check_partition(p);
}

TEST_CASE("a flat box is grown, an empty one is refused") {
  const Partition p =
      partition_space({whole_plane({1, 0, 0}, {1, 0, 0})}, {Vec3(0, 0, 5), Vec3(2, 3, 5)});
  CHECK(p.cells.size() == 2);
  CHECK(p.box.size().z() > 0);
  check_partition(p);
  CHECK_THROWS_AS(partition_space({}, Box()), Error);
  CHECK_THROWS_AS(partition_space({}, {Vec3(0, 0, 0), Vec3(1, NAN, 1)}), Error);
}

TEST_CASE("planes that are not finite, far away or reach nothing are left out") {
  const std::vector<Vec3> outside{{9, 9, 0}, {10, 9, 0}, {10, 10, 0}};
  const Partition p = partition_space({{Vec3(NAN, 0, 1), 0, {}, 0},
                                       {Vec3::Zero(), 0, {}, 1},
                                       {Vec3(0, 0, 1), 1e30, {}, 2},
                                       {Vec3(0, 0, 1), 0, {Vec3(0, 0, INFINITY)}, 3},
                                       {Vec3(0, 0, 1), 0, outside, 4}},
                                      cube(4));
  CHECK(p.cells.size() == 1);
  CHECK(p.cuts[4].plane == 6);
  CHECK(p.warnings.size() == 1);
}
