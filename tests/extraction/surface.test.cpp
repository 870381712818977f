#include "extraction/surface.h"

#include <catch2/catch.hpp>

#include "extraction/boundary.h"
#include "extraction/components.h"
#include "extraction/contraction.h"
#include "extraction_helpers.h"
#include "measure/metrics.h"
#include "meshes.h"

using namespace colod;
using namespace colod::test;

namespace {

/// A facet a ring; rings are convex, without holes.
PolygonMesh polygon_mesh(std::vector<Vec3> vertices, const std::vector<std::vector<int>>& rings) {
  PolygonMesh m;
  m.vertices = std::move(vertices);
  for (const std::vector<int>& ring : rings) {
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      m.triangles.push_back({ring[0], ring[i], ring[i + 1]});
      m.facet_of_triangle.push_back(static_cast<int>(m.facets.size()));
    }
    const Vec3 normal = face_cross(m.mesh(), m.triangles.back()).normalized();
    m.facets.push_back({normal, -1, {ring}});
  }
  return m;
}

/// A box whose corner at (4, 4, 4) is cut off, `size` metres along each edge.
PolygonMesh chipped_box(double size) {
  std::vector<Vec3> vertices = box_mesh({0, 0, 0}, {4, 4, 4}).vertices;
  vertices[7].x() -= size;
  vertices.insert(vertices.end(), {{4, 4 - size, 4}, {4, 4, 4 - size}});
  return polygon_mesh(std::move(vertices), {{0, 2, 3, 1},
                                            {4, 5, 8, 7, 6},
                                            {0, 1, 5, 4},
                                            {2, 6, 7, 9, 3},
                                            {0, 4, 6, 2},
                                            {1, 3, 9, 8, 5},
                                            {7, 8, 9}});
}

/// A box of 4 m whose top has a ledge along its front, a triangle `depth` metres deep; behind it
/// the top rises to `height` at the middle of the back.
PolygonMesh box_with_ledge(double depth, double height) {
  std::vector<Vec3> vertices = box_mesh({0, 0, 0}, {4, 4, 4}).vertices;
  vertices.insert(vertices.end(), {{2, depth, 4}, {2, 4, height}});
  return polygon_mesh(std::move(vertices), {{0, 2, 3, 1},
                                            {0, 1, 5, 4},
                                            {0, 4, 6, 2},
                                            {1, 3, 7, 5},
                                            {2, 6, 9, 7, 3},
                                            {4, 5, 8},
                                            {4, 8, 9},
                                            {4, 9, 6},
                                            {5, 9, 8},
                                            {5, 7, 9}});
}

}  // namespace

TEST_CASE("cubes that touch along an edge or at a vertex become one manifold") {
  using Cubes = std::set<std::array<int, 3>>;
  const std::vector<std::pair<std::array<int, 3>, Cubes>> cases = {
      {{3, 2, 1}, {{0, 0, 0}, {1, 1, 0}, {2, 1, 0}, {2, 0, 0}, {0, 1, 0}}},
      {{2, 2, 1}, {{0, 0, 0}, {1, 1, 0}}},
      {{2, 2, 2}, {{0, 0, 0}, {1, 1, 1}}},
      {{2, 2, 2}, {{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}}},
      {{2, 2, 3},
       {{0, 0, 0},
        {1, 0, 0},
        {0, 1, 0},
        {1, 1, 0},
        {0, 0, 1},
        {1, 1, 1},
        {0, 0, 2},
        {1, 0, 2},
        {0, 1, 2},
        {1, 1, 2}}},
      {{3, 3, 3}, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 1, 1}, {1, 1, 1}}},
  };
  for (const auto& [size, chosen] : cases) {
    const Partition grid = cubes(size[0], size[1], size[2]);
    const PolygonMesh mesh = make_surface(grid, choose_cubes(grid, chosen)).mesh;
    const double volume = signed_volume(mesh.mesh());
    expect_solid(mesh, std::round(volume), 1e-9);
    CHECK(volume > 0.5);
  }
}

TEST_CASE("any choice of cubes gives a closed 2-manifold with the volume of its cells") {
  const Partition grid = cubes(4, 4, 4);
  std::uint64_t state = 1;
  for (int run = 0; run < 60; ++run) {
    std::vector<char> is_inside(grid.cells.size());
    for (char& c : is_inside) {
      state = state * 6364136223846793005ull + 1442695040888963407ull;
      c = (state >> 33) % 100 < 30 + static_cast<unsigned>(run) % 50;
    }
    std::vector<char> mended = is_inside;
    fill_cavities(grid, mended);
    mend_pinches(grid, mended);
    REQUIRE(keep_largest_components(grid, mended, 0.05));
    fill_cavities(grid, mended);
    const double volume = static_cast<double>(std::count(mended.begin(), mended.end(), 1));
    const PolygonMesh mesh = make_surface(grid, is_inside).mesh;
    const Check c = check(mesh);
    CHECK((c.is_closed && c.is_fan && !c.is_degenerate && c.rings_match));
    CHECK(signed_volume(mesh.mesh()) == Approx(volume).margin(1e-9));
    CHECK(is_closed_manifold(mesh.triangles));
  }
}

TEST_CASE("short edges are contracted") {
  PolygonMesh mesh = extract(gable_house(10, 6, 4, 3)).mesh;
  CHECK(contract_short_edges(mesh, 1e-3) == 0);
  CHECK(contract_short_edges(mesh, 4.5) > 0);
  CHECK(check(mesh).is_closed);
}

TEST_CASE("no contraction makes the surface cut itself") {
  const auto add = [](PolygonMesh& mesh, const Mesh& part) {
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const Face& f : part.faces) {
      mesh.triangles.push_back({f[0] + first, f[1] + first, f[2] + first});
      mesh.facet_of_triangle.push_back(static_cast<int>(mesh.facets.size()));
    }
    mesh.facets.emplace_back();
  };
  const PolygonMesh house = extract(gable_house(10, 6, 4, 3)).mesh;
  PolygonMesh alone = house;
  const int freely = contract_short_edges(alone, 4.5);
  int tried = 0, refused = 0;
  for (double x = 0.3; x < 10; x += 1.3)
    for (double y = 0.3; y < 6; y += 1.3)
      for (double z = 0.3; z < 7; z += 1.3) {
        const Vec3 at(x, y, z);
        const Mesh bit = box_mesh(at - Vec3::Constant(0.01), at + Vec3::Constant(0.01));
        PolygonMesh mesh = house, only_bit;
        add(mesh, bit), add(only_bit, bit);
        if (check_validity(mesh.mesh()).self_intersections > 0) continue;
        ++tried;
        const int bits = contract_short_edges(only_bit, 4.5);
        refused += contract_short_edges(mesh, 4.5) < freely + bits;
        CHECK(check_validity(mesh.mesh()).self_intersections == 0);
      }
  CHECK(tried > 40);
  CHECK(refused > 0);
}

TEST_CASE("a pinched boundary is seen") {
  CHECK(is_closed_manifold(box_mesh({0, 0, 0}, {1, 1, 1}).faces));
  Mesh open = box_mesh({0, 0, 0}, {1, 1, 1});
  open.faces.pop_back();
  CHECK_FALSE(is_closed_manifold(open.faces));
  const Partition grid = cubes(2, 2, 2);
  BoundaryFinder finder(grid);
  CHECK(find_pinches(finder.find(choose_cubes(grid, {{0, 0, 0}, {1, 1, 0}}))).size() == 1);
  CHECK(find_pinches(finder.find(choose_cubes(grid, {{0, 0, 0}, {1, 1, 1}}))).size() == 1);
  CHECK(find_pinches(finder.find(choose_cubes(grid, {{0, 0, 0}, {1, 0, 0}}))).empty());
}

TEST_CASE("narrow facets are contracted where their short edges allow it") {
  PolygonMesh mesh = chipped_box(0.005);
  expect_solid(mesh, 64);
  REQUIRE(mesh.facets.size() == 7);
  CHECK(contract_narrow_facets(mesh, 0.001) == 0);
  CHECK(contract_narrow_facets(mesh, 0.003) == 2);
  CHECK(mesh.facets.size() == 6);
  CHECK(is_closed_manifold(mesh.triangles));
  for (const auto& facet : mesh.facets) CHECK(measure_facet(mesh, facet).width() > 1);
}

TEST_CASE("long edges of a narrow facet go where no plane moves by more than its width") {
  PolygonMesh level = box_with_ledge(0.004, 4.001);
  CHECK(contract_narrow_facets(level, 0.001) == 0);
  CHECK(contract_narrow_facets(level, 0.005) == 1);
  CHECK(level.vertices.size() == 9);
  CHECK(is_closed_manifold(level.triangles));
  for (const auto& facet : level.facets) CHECK(measure_facet(level, facet).width() > 0.5);

  PolygonMesh gabled = box_with_ledge(0.004, 40);  // so steep that a roof would move by 8 mm
  CHECK(contract_narrow_facets(gabled, 0.005) == 0);
  CHECK(gabled.vertices.size() == 10);
}

TEST_CASE("what contracting has bent away from its facet is contracted like a narrow one") {
  PolygonMesh mesh = chipped_box(0.005);
  const auto narrow = std::find_if(mesh.facets.begin(), mesh.facets.end(), [&](const auto& f) {
    return measure_facet(mesh, f).width() < 0.1;
  });
  REQUIRE(narrow != mesh.facets.end());
  const int chip = static_cast<int>(narrow - mesh.facets.begin());
  for (int& f : mesh.facet_of_triangle)
    if (f == chip) f = (chip + 1) % 7;
  CHECK(contract_narrow_facets(mesh, 0.003) == 2);
  CHECK(mesh.facets.size() == 6);
  CHECK(is_closed_manifold(mesh.triangles));
}
