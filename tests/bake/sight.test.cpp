// What a chart shows, drawn all at once, beside what two rays at each place say.
#include "bake/sight.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "bake/parameters.h"

using namespace colod;
using namespace colod::bake;

namespace {

/// A bumpy sheet about the plane y = 0 that looks to −y, `n` squares a side of `side` metres.
Mesh sheet(int n, double side, double bump, double y) {
  Mesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      mesh.vertices.push_back({side * i / n, y + bump * std::sin(3.0 * i + 5.0 * j), side * j / n});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.faces.push_back({a, b, d});
      mesh.faces.push_back({a, d, c});
    }
  return mesh;
}

void add(Mesh& mesh, const Mesh& other) {
  const int base = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Face& f : other.faces) mesh.faces.push_back({f[0] + base, f[1] + base, f[2] + base});
}

/// The plane y = 0 from −y: right is x, down is −z.
Chart chart(double side) {
  Chart c;
  c.origin = {0, 0, side};
  c.right = Vec3::UnitX(), c.down = -Vec3::UnitZ(), c.normal = -Vec3::UnitY();
  c.width = c.height = side;
  return c;
}

/// The share of places for which both say the same, of those where rays see something.
double agreement(const Mesh& mesh, const Probe& probe, double side, double reach,
                 const Probe::Holes& holes = {}) {
  const Chart own = chart(side);
  const SampleGrid grid{{0.003, 0.004}, side / 101, 100, 100};
  const std::vector<Sighting> seen = Sight(mesh, probe, own, reach).look(grid, holes);
  int all = 0, alike = 0;
  for (int y = 0; y < grid.rows; ++y)
    for (int x = 0; x < grid.columns; ++x) {
      const Vec3 place = own.lift(grid.begin + grid.step * Vec2(x, y));
      const Found found = probe.find(place, own.normal, reach, holes);
      const Sighting& s = seen[grid.index(x, y)];
      if (found.how != Finding::kSeen) {
        CHECK(s.face < 0);
        continue;
      }
      const Vec3 shown = place + s.offset * own.normal;
      ++all, alike += s.face >= 0 && (shown - found.point).norm() < 1e-4;
    }
  REQUIRE(all > 1000);
  return static_cast<double>(alike) / all;
}

}  // namespace

TEST_CASE("a chart shows what rays at each place see: the nearest that agrees, on both sides") {
  const int squares = GENERATE(1, 7, 40, 200);
  const double side = GENERATE(0.5, 4.0, 30.0);
  const double bump = squares > 1 ? 0.02 * side / squares : 0;
  CAPTURE(squares, side);
  Mesh mesh = sheet(squares, side, bump, 0.03);
  add(mesh, sheet(squares, 0.6 * side, bump, -0.1));  // before it, over a part
  Mesh away = sheet(squares, side, bump, -0.01);      // nearer, and looks the other way
  for (Face& f : away.faces) std::swap(f[0], f[1]);
  add(mesh, away);
  CHECK(agreement(mesh, Probe(mesh), side, 0.5) > 0.999);
  CHECK(agreement(mesh, Probe(mesh, Sides::kBoth), side, 0.5) > 0.999);
}

TEST_CASE("what lies beyond the reach is not shown, and a hole shows what lies behind it") {
  const double side = GENERATE(1.0, 9.0);
  CAPTURE(side);
  Mesh mesh = sheet(5, side, 0, 0.02);
  add(mesh, sheet(5, side, 0, 0.4));
  const Probe probe(mesh);
  const auto in_the_middle = [&](int face, const Vec3& p) {
    return face < 50 && std::abs(p.x() - side / 2) < side / 5 && p.z() > side / 3;
  };
  CHECK(agreement(mesh, probe, side, 0.5, in_the_middle) > 0.999);
  const Mesh far = sheet(5, side, 0, 0.4);
  const SampleGrid grid{{0, 0}, side / 10, 10, 10};
  const Chart own = chart(side);
  for (const Sighting& s : Sight(far, Probe(far), own, 0.3).look(grid, {})) CHECK(s.face < 0);
}

TEST_CASE("where nothing that agrees is near no nearest place is asked for, and none is missed") {
  const double side = GENERATE(1.0, 6.0);
  CAPTURE(side);
  const Mesh mesh = sheet(4, side / 3, 0, 0.1);  // at the lower left
  const Probe probe(mesh);
  const Chart own = chart(side);
  const Sight sight(mesh, probe, own, 0.5);
  bool is_ever_far = false;
  NearestInTurn last = probe.in_turn();
  for (double y = 0; y <= side; y += side / 50)
    for (double x = 0; x <= side; x += side / 50) {
      NearestInTurn fresh = probe.in_turn();
      const Found found = probe.beside(own.lift({x, y}), own.normal, 0.5, {}, fresh);
      const Found again = probe.beside(own.lift({x, y}), own.normal, 0.5, {}, last);
      CHECK(again.how == found.how);
      CHECK((again.point - found.point).norm() < 1e-6);
      if (found.how != Finding::kNone) CHECK(sight.may_be_near({x, y}));
      is_ever_far |= !sight.may_be_near({x, y});
    }
  CHECK(is_ever_far);
}
