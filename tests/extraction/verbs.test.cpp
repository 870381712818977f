// One verb of room `extraction` each: plan, simplify, thicken, and spares.
#include <catch2/catch.hpp>

#include "extraction/coverage.h"
#include "extraction/evidence.h"
#include "extraction/leaders.h"
#include "extraction/min_cut.h"
#include "extraction/plan.h"
#include "extraction/simplify.h"
#include "extraction_helpers.h"
#include "meshes.h"

using namespace colod;
using namespace colod::test;

namespace {

/// Two triangles without thickness.
Mesh sheet_mesh(const Vec3& corner, const Vec3& u, const Vec3& v) {
  Mesh m;
  m.vertices = {corner, corner + u, corner + u + v, corner + v};
  m.faces = {{0, 1, 2}, {0, 2, 3}};
  return m;
}

/// A block of 10 × 12 × 14 m with a passage of 3 × 4 m along y, behind a wall 0.4 m thick.
Mesh block_with_passage() {
  Mesh m;
  const std::vector<Vec2> ring = {{0, 0},   {0.4, 0}, {0.4, 4}, {3.4, 4},
                                  {3.4, 0}, {10, 0},  {10, 14}, {0, 14}};
  for (const double y : {0.0, 12.0})
    for (const Vec2& p : ring) m.vertices.emplace_back(p.x(), y, p.y());
  for (int i = 0; i < 8; ++i) {
    const int j = (i + 1) % 8;
    m.faces.push_back({i, j + 8, j});
    m.faces.push_back({i, i + 8, j + 8});
  }
  for (const Face& f :
       {Face{7, 0, 1}, Face{7, 1, 2}, Face{7, 2, 3}, Face{7, 3, 6}, Face{6, 3, 5}, Face{3, 4, 5}}) {
    m.faces.push_back(f);
    m.faces.push_back({f[2] + 8, f[1] + 8, f[0] + 8});
  }
  return m;
}

int find_plane(const Planes& planes, const Vec3& normal, double offset) {
  for (std::size_t p = 0; p < planes.planes.size(); ++p)
    if (planes.planes[p].normal.dot(normal) > 0.999 &&
        std::abs(planes.planes[p].offset - offset) < 1e-6)
      return static_cast<int>(p);
  return -1;
}

}  // namespace

TEST_CASE("planes that look elsewhere are no leaders, nor are those farther than the tolerance") {
  const Planes planes = planes_of_mesh(gable_house(8, 6, 5, 0.4));
  const std::vector<int> all = all_planes(planes);
  CHECK(find_leaders(planes, all, 0) == all);
  CHECK(find_leaders(planes, all, 0.3) == all);
  const std::vector<int> merged = find_leaders(planes, all, 1);  // 15 degrees between the roofs
  CHECK(std::set<int>(merged.begin(), merged.end()).size() == 6);
}

TEST_CASE("a chip goes, a chimney stays") {
  const Mesh house = gable_house(8, 6, 5, 3);
  const Mesh chip = box_mesh({3, -0.1, 1}, {3.4, 1, 1.4});
  const Mesh chimney = box_mesh({2, 1, 5}, {2.6, 1.6, 8.5});
  const PolygonMesh both = extract(join(join(house, chip), chimney)).mesh;
  CHECK(both.facets.size() == 17);
  const PolygonMesh one = extract(join(join(house, chip), chimney), {.tolerance = 0.1}).mesh;
  CHECK(one.facets.size() == 12);
  CHECK(check(one).is_closed);
}

TEST_CASE("turning cells saves facets within its limits and never turns forced cells") {
  // A box of 4 with a step of 0.2 in one corner: 9 facets, 6 without the step.
  const Planes planes =
      planes_of_mesh(join(box_mesh({0, 0, 0}, {4, 4, 4}), box_mesh({4, 0, 0}, {4.2, 1, 1})));
  const std::vector<int> all = all_planes(planes);
  Sight sight(planes);
  const CuttingPlan plan = plan_cuts(planes, all, sight.rays, {});
  const Partition partition = partition_space(plan.planes, plan.box);
  Evidence evidence = gather_evidence(partition, sight, {});
  measure_coverage(partition, planes, plan.input, evidence);
  const std::vector<char> nothing(partition.cells.size(), 0), all_cells(partition.cells.size(), 1);
  const std::vector<char> before = cut_cells(partition, evidence, nothing);
  const auto saved = [&](const SimplifyOptions& options, const std::vector<char>& forced) {
    std::vector<char> is_inside = before;
    return simplify_cells(partition, evidence, forced, options, is_inside);
  };
  CHECK(saved({.facet_volume = 1, .depth = 0.3}, nothing) == 3);
  CHECK(saved({.facet_volume = 1, .depth = 0.3}, all_cells) == 3);  // the step is taken away
  CHECK(saved({.facet_volume = 1, .depth = 0.1}, nothing) == 0);
  CHECK(saved({.facet_volume = 0.01, .depth = 0.3}, nothing) == 0);
}

TEST_CASE("a plane that a layer cannot do without joins it") {
  const Planes planes = planes_of_mesh(block_with_passage());
  const int inner = find_plane(planes, {1, 0, 0}, 0.4);
  REQUIRE(inner >= 0);
  std::vector<int> layer = all_planes(planes);
  std::erase(layer, inner);
  Sight sight(planes);
  const ExtractionOptions options{.tolerance = 0.2};
  const double volume = 12 * (140 - 12);
  const Extraction without = extract_layer(planes, layer, sight, options);
  CHECK(std::abs(signed_volume(without.mesh.mesh()) - volume) > 12);
  const Extraction with = extract_layer(planes, layer, {{inner}}, sight, options);
  expect_solid(with.mesh, volume);
  CHECK(with.joined == std::vector<int>{inner});
}

TEST_CASE("a box on a roof does not join a coarse layer") {
  const Planes planes =
      planes_of_mesh(join(box_mesh({0, 0, 0}, {12, 10, 9}), box_mesh({5, 4, 9}, {7, 6, 11})));
  std::vector<int> layer, box;
  for (const int p : all_planes(planes)) (planes.planes[p].area < 5 ? box : layer).push_back(p);
  Sight sight(planes);
  const Extraction e = extract_layer(planes, layer, {box}, sight, {.tolerance = 0.2});
  expect_solid(e.mesh, 12 * 10 * 9);
  CHECK(e.joined.empty());
}

TEST_CASE("a wing joins, however many facets it adds") {
  const Planes planes =
      planes_of_mesh(join(box_mesh({0, 0, 0}, {12, 10, 9}), box_mesh({12, 1, 0}, {20, 9, 8})));
  std::vector<int> layer, wing;
  for (const int p : all_planes(planes)) (planes.planes[p].area < 65 ? wing : layer).push_back(p);
  Sight sight(planes);
  const Extraction e = extract_layer(planes, layer, {wing}, sight, {.tolerance = 0.2});
  CHECK(signed_volume(e.mesh.mesh()) == Approx(12 * 10 * 9 + 8 * 8 * 8));
  CHECK(e.joined == wing);
}

TEST_CASE("a sheet that stands out of the building becomes a thin body") {
  const Mesh house = box_mesh({0, 0, 0}, {8, 6, 5});
  const Mesh canopy = sheet_mesh({3, -1.5, 3}, {2, 0, 0}, {0, 1.5, 0});
  const Mesh fin = sheet_mesh({0, 0, 5}, {8, 0, 0}, {0, 0, 1});  // the front wall goes on
  expect_solid(extract(join(house, canopy)).mesh, 240);
  const PolygonMesh with = extract(join(house, canopy), {.is_finest = true}).mesh;
  expect_solid(with, 240 + 2 * 1.5 * 0.08);
  CHECK(with.facets.size() == 11);
  const PolygonMesh both = extract(join(join(house, canopy), fin), {.is_finest = true}).mesh;
  expect_solid(both, 240 + 2 * 1.5 * 0.08 + 8 * 1 * 0.08);
  CHECK(both.facets.size() == 13);
}

TEST_CASE("sheets that meet are joined at their corners") {
  const Mesh house = box_mesh({0, 0, 0}, {8, 6, 6});
  Mesh screen = sheet_mesh({2, -1.2, 2}, {3, 0, 0}, {0, 0, 2});  // front and both sides
  screen = join(screen, sheet_mesh({2, 0, 2}, {0, -1.2, 0}, {0, 0, 2}));
  screen = join(screen, sheet_mesh({5, -1.2, 2}, {0, 1.2, 0}, {0, 0, 2}));
  const PolygonMesh mesh = extract(join(house, screen), {.is_finest = true}).mesh;
  expect_solid(mesh, 288 + 2 * (3 * 1.2 - (3 - 0.16) * (1.2 - 0.08)));
  CHECK(mesh.facets.size() == 14);  // three outer, three inner, top and bottom
}

TEST_CASE("steps, sheets that touch nothing and noise are no thin bodies") {
  const Mesh house = box_mesh({0, 0, 0}, {8, 6, 5});
  const Mesh step = join(house, sheet_mesh({3, -1.5, 0.3}, {2, 0, 0}, {0, 1.5, 0}));
  const double with_step = signed_volume(extract(step).mesh.mesh());
  const ExtractionOptions options{.is_finest = true};
  expect_solid(extract(step, options).mesh, with_step);
  expect_solid(extract(join(house, sheet_mesh({3, -2.5, 3}, {2, 0, 0}, {0, 1.5, 0})), options).mesh,
               240);
  Planes planes = planes_of_mesh(join(house, sheet_mesh({3, -1.5, 3}, {2, 0, 0}, {0, 1.5, 0})));
  planes.surface = Planes::Surface::kNoisy;
  Sight sight(planes);
  expect_solid(extract_layer(planes, all_planes(planes), sight, options).mesh, 240);
}
