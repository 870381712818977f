#include "extraction/extraction.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "core/error.h"
#include "core/parallel.h"
#include "extraction/candidates.h"
#include "extraction/labels.h"
#include "extraction_helpers.h"
#include "measure/metrics.h"
#include "meshes.h"
#include "shared_data.h"

using namespace colod;
using namespace colod::test;

namespace {

void expect_solid(const PolygonMesh& mesh, double volume, double tolerance = 1e-3) {
  const Check c = check(mesh);
  CHECK(c.is_closed);
  CHECK(c.is_fan);
  CHECK_FALSE(c.is_degenerate);
  CHECK(c.rings_match);
  CHECK(c.components == 1);
  CHECK(signed_volume(mesh.mesh()) == Approx(volume).margin(tolerance));
}

void expect_counts(const PolygonMesh& mesh, std::size_t vertices, std::size_t facets,
                   std::size_t triangles) {
  CHECK(mesh.vertices.size() == vertices);
  CHECK(mesh.facets.size() == facets);
  CHECK(mesh.triangles.size() == triangles);
}

/// Triangles with corners anywhere on a grid of that many metres.
Mesh soup(int triangles, double grid) {
  Mesh mesh;
  std::mt19937 random(3);
  for (int i = 0; i < 3 * triangles; ++i) {
    Vec3 p;
    for (double& x : p) x = std::floor(grid * static_cast<double>(random()) * 0x1p-32);
    mesh.vertices.push_back(p);
    if (i % 3 == 2) mesh.faces.push_back({i - 2, i - 1, i});
  }
  std::erase_if(mesh.faces, [&](const Face& f) { return face_area(mesh, f) == 0; });
  return mesh;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& l : lines) all += l + "\n";
  return all;
}

Mesh without_faces(Mesh mesh, const Vec3& normal) {
  std::erase_if(mesh.faces, [&](const Face& f) {
    return face_cross(mesh, f).normalized().dot(normal) > 0.999;
  });
  return mesh;
}

Mesh without_walls(Mesh mesh) {
  std::erase_if(mesh.faces, [&](const Face& f) {
    return std::abs(face_cross(mesh, f).normalized().z()) < 0.01;
  });
  return mesh;
}

/// The border of an outline's triangles as one ring, corners of different triangles welded.
std::vector<int> ring_of(const Outline& outline) {
  const auto weld = [&](int v) {
    int first = 0;
    while (outline.vertices[first] != outline.vertices[v]) ++first;
    return first;
  };
  std::map<int, int> next;
  std::set<std::pair<int, int>> edges;
  for (const Face& f : outline.triangles)
    for (int i = 0; i < 3; ++i) edges.insert({weld(f[i]), weld(f[(i + 1) % 3])});
  for (const auto& [a, b] : edges)
    if (!edges.count({b, a})) next[a] = b;
  std::vector<int> ring = {next.begin()->first};
  while (next[ring.back()] != ring.front()) ring.push_back(next[ring.back()]);
  return ring;
}

/// Vertices and polygons of an OBJ file, about its first vertex.
Mesh read_plain_obj(const std::filesystem::path& path) {
  Mesh mesh;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      Vec3 p;
      words >> p.x() >> p.y() >> p.z();
      mesh.vertices.push_back(mesh.vertices.empty() ? p : Vec3(p - mesh.vertices[0]));
    } else if (word == "f") {
      std::vector<int> polygon;
      while (words >> word) polygon.push_back(std::stoi(word) - 1);
      for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        mesh.faces.push_back({polygon[0], polygon[i], polygon[i + 1]});
    }
  }
  if (!mesh.vertices.empty()) mesh.vertices[0].setZero();
  std::erase_if(mesh.faces, [&](const Face& f) { return face_area(mesh, f) < 1e-6; });
  return mesh;
}

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

/// Extruded L: 10 × 10 without its upper right 6 × 6, 4 high.
Mesh l_shape() {
  Mesh m;
  const std::vector<Vec2> ring = {{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}};
  for (const double z : {0.0, 4.0})
    for (const Vec2& p : ring) m.vertices.emplace_back(p.x(), p.y(), z);
  for (int i = 0; i < 6; ++i) {
    const int j = (i + 1) % 6;
    m.faces.push_back({i, j, j + 6});
    m.faces.push_back({i, j + 6, i + 6});
  }
  for (const Face& f : {Face{0, 1, 2}, Face{0, 2, 3}, Face{0, 3, 4}, Face{0, 4, 5}}) {
    m.faces.push_back({f[2], f[1], f[0]});
    m.faces.push_back({f[0] + 6, f[1] + 6, f[2] + 6});
  }
  return m;
}

/// Two triangles without thickness.
Mesh sheet_mesh(const Vec3& corner, const Vec3& u, const Vec3& v) {
  Mesh m;
  m.vertices = {corner, corner + u, corner + u + v, corner + v};
  m.faces = {{0, 1, 2}, {0, 2, 3}};
  return m;
}

}  // namespace

TEST_CASE("a box is a box") {
  const Extraction e = extract(box_mesh({0, 0, 0}, {8, 6, 5}));
  expect_solid(e.mesh, 240);
  expect_counts(e.mesh, 8, 6, 12);
  CHECK(e.is_manifold);
  for (const auto& facet : e.mesh.facets) CHECK(facet.plane >= 0);
}

TEST_CASE("a gable house keeps its ridge") {
  const Extraction e = extract(gable_house(10, 6, 4, 3));
  expect_solid(e.mesh, 10 * 6 * 4 + 10 * 6 * 3 / 2.0);
  expect_counts(e.mesh, 10, 7, 16);
}

TEST_CASE("a concave body keeps its inner corner") {
  const Extraction e = extract(l_shape());
  expect_solid(e.mesh, 4 * (40 + 24));
  expect_counts(e.mesh, 12, 8, 20);
}

TEST_CASE("a house without a floor is closed at its foot") {
  const Extraction e = extract(without_faces(gable_house(10, 6, 4, 3), {0, 0, -1}));
  expect_solid(e.mesh, 330);
  expect_counts(e.mesh, 10, 7, 16);
}

TEST_CASE("a house without floor and party wall is closed at its rectangle") {
  const Mesh open = without_faces(without_faces(gable_house(10, 6, 4, 3), {0, 0, -1}), {1, 0, 0});
  const Extraction e = extract(open);
  expect_solid(e.mesh, 330);
  expect_counts(e.mesh, 10, 7, 16);
}

TEST_CASE("a roof alone stands on walls down to the foot") {
  const Mesh roof = without_walls(gable_house(10, 6, 4, 3));
  const Extraction e = extract(roof);
  expect_solid(e.mesh, 330);
  expect_counts(e.mesh, 10, 7, 16);
}

TEST_CASE("a concave flat roof alone gets walls under all its borders") {
  Planes planes = planes_of_mesh(without_walls(l_shape()));
  std::erase_if(planes.planes, [](const Plane& p) { return p.normal.z() < 0; });
  planes.planes.front().outline.rings = {ring_of(planes.planes.front().outline)};
  Sight sight(planes);
  const Extraction e = extract_layer(planes, all_planes(planes), sight);
  expect_solid(e.mesh, 4 * 64);
  expect_counts(e.mesh, 12, 8, 20);
}

TEST_CASE("a dormer and an annex stay on their house") {
  Mesh house = join(gable_house(10, 6, 4, 3), box_mesh({10, 1, 0}, {13, 4, 3}));
  house = join(house, box_mesh({4, 0.5, 4.2}, {6, 2.5, 6}));
  const Extraction e = extract(house);
  const Check c = check(e.mesh);
  CHECK(c.is_closed);
  CHECK(c.is_fan);
  CHECK(c.components == 1);
  // The dormer stands above the roof's slope z = 4 + y from y = 0.5 to 2 (its top at 6).
  CHECK(signed_volume(e.mesh.mesh()) == Approx(330 + 27 + 2 * 1.5 * 1.5 / 2).margin(0.05));
}

TEST_CASE("a layer of few planes still gives a body") {
  const Planes planes = planes_of_mesh(gable_house(10, 6, 4, 3));
  Sight sight(planes);
  for (std::size_t n = 1; n <= planes.planes.size(); ++n) {
    std::vector<int> layer = all_planes(planes);
    layer.resize(n);
    const PolygonMesh mesh = extract_layer(planes, layer, sight).mesh;
    CHECK(check(mesh).is_closed);
    CHECK(check(mesh).is_fan);
    CHECK(signed_volume(mesh.mesh()) > 1);
  }
}

TEST_CASE("simple block models are closed with their own volume") {
  const std::filesystem::path folder = test::shared_data() / "delft";
  COLOD_SKIP_WITHOUT(folder);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".obj") continue;
    ++files;
    INFO(entry.path().filename().string());
    const Extraction e = extract(read_plain_obj(entry.path()));
    const Check c = check(e.mesh);
    CHECK(c.is_closed);
    CHECK(c.is_fan);
    CHECK(c.components == 1);
    CHECK(signed_volume(e.mesh.mesh()) > 1);
  }
  CHECK(files > 0);
}

TEST_CASE("a chimney leaves a hole in the roof's facet") {
  Mesh house = join(box_mesh({0, 0, 0}, {10, 8, 5}), box_mesh({4, 3, 5}, {5, 4, 7}));
  std::erase_if(house.faces, [&](const Face& f) {
    return f[0] >= 8 && face_cross(house, f).normalized().z() < -0.9;
  });
  const Extraction e = extract(house);
  expect_solid(e.mesh, 402);
  CHECK(e.mesh.facets.size() == 11);
  CHECK(std::count_if(e.mesh.facets.begin(), e.mesh.facets.end(),
                      [](const auto& f) { return f.rings.size() == 2; }) == 1);
}

TEST_CASE("paper rules close what is closed") {
  const Extraction e = extract(gable_house(10, 6, 4, 3), {.is_paper = true});
  expect_solid(e.mesh, 330);
  CHECK(e.mesh.vertices.size() == 10);
}

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
    const PolygonMesh mesh = extract_surface(grid, choose_cubes(grid, chosen));
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
    const PolygonMesh mesh = extract_surface(grid, is_inside);
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

TEST_CASE("a layer is the same whatever was looked at before") {
  const Planes planes = planes_of_mesh(join(l_shape(), box_mesh({1, 1, 4}, {3, 3, 6})));
  const std::vector<int> all = all_planes(planes), few(all.begin(), all.begin() + 6);
  Sight fresh(planes), used(planes);
  extract_layer(planes, few, used);
  const std::size_t known = used.votes.size();
  CHECK(known > 0);
  const PolygonMesh once = extract_layer(planes, all, fresh).mesh;
  const PolygonMesh after = extract_layer(planes, all, used).mesh;
  CHECK(once.vertices == after.vertices);
  CHECK(once.triangles == after.triangles);
  CHECK(used.votes.size() < known + fresh.votes.size());  // some points were asked in both
}

TEST_CASE("one and two threads give the same mesh") {
  const auto run = [](int threads) {
    limit_threads(threads);
    const PolygonMesh mesh = extract(join(l_shape(), box_mesh({1, 1, 4}, {3, 3, 6}))).mesh;
    limit_threads(0);
    return mesh;
  };
  const PolygonMesh one = run(1), two = run(2);
  CHECK(one.vertices == two.vertices);
  CHECK(one.triangles == two.triangles);
  expect_solid(one, 4 * 64 + 8);
}

TEST_CASE("planes that make too many cells are bounded, which a warning says") {
  for (const double grid : {8.0, 64.0}) {
    const Planes planes = planes_of_mesh(soup(40, grid));
    for (const int most : {50, 400}) {
      Sight sight(planes);
      const Extraction few =
          extract_layer(planes, all_planes(planes), sight, {.nr = 10, .max_cells = most});
      INFO(grid << " " << most);
      CHECK(few.cells <= most);
      CHECK(check(few.mesh).is_closed);
      CHECK(joined(few.warnings).find("cap of " + std::to_string(most) + " cells") !=
            std::string::npos);
      CHECK(joined(few.warnings).find("--min-points") != std::string::npos);
    }
  }
  const Planes house = planes_of_mesh(gable_house(12, 8, 6, 3));
  Sight fresh(house), spent(house);
  spent.cells = std::int64_t{1} << 40;
  CHECK(extract_layer(house, all_planes(house), fresh).warnings.empty());
  CHECK(fresh.cells > 0);
  const Extraction last = extract_layer(house, all_planes(house), spent);
  expect_solid(last.mesh, 720);
  CHECK(joined(last.warnings).find("too many cells") != std::string::npos);
}

TEST_CASE("one wall alone becomes a thin body, no plane is an error") {
  Mesh wall;
  wall.vertices = {{0, 0, 0}, {6, 0, 0}, {6, 0, 4}, {0, 0, 4}};
  wall.faces = {{0, 1, 2}, {0, 2, 3}};
  const Extraction e = extract(wall);
  expect_solid(e.mesh, 6 * 4 * 0.5);
  Sight nothing{Planes()};
  CHECK_THROWS_AS(extract_layer({}, {}, nothing), Error);
}

TEST_CASE("a detached annex is kept, a small shed is not") {
  const Mesh house = box_mesh({0, 0, 0}, {10, 10, 5});
  const Extraction annex = extract(join(house, box_mesh({20, 0, 0}, {26, 6, 4})));
  CHECK(check(annex.mesh).is_closed);
  CHECK(check(annex.mesh).components == 2);
  CHECK(signed_volume(annex.mesh.mesh()) == Approx(500 + 144));
  expect_solid(extract(join(house, box_mesh({20, 0, 0}, {22, 2, 2}))).mesh, 500);
}

TEST_CASE("what is within the tolerance of a larger plane is no detail of its own") {
  const Mesh step = join(box_mesh({0, 0, 0}, {8, 6, 5}), box_mesh({8, 0.2, 0}, {12, 6, 5}));
  expect_counts(extract(step).mesh, 12, 8, 20);
  const PolygonMesh mesh = extract(step, {.tolerance = 0.3}).mesh;
  expect_counts(mesh, 8, 6, 12);
  expect_solid(mesh, 360);
}

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

namespace {

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

TEST_CASE("a plane that a layer cannot do without joins it") {
  const Planes planes = planes_of_mesh(block_with_passage());
  const int inner = find_plane(planes, {1, 0, 0}, 0.4);
  REQUIRE(inner >= 0);
  std::vector<int> layer = all_planes(planes), joined;
  std::erase(layer, inner);
  Sight sight(planes);
  const ExtractionOptions options{.tolerance = 0.2};
  const double volume = 12 * (140 - 12);
  const Extraction without = extract_layer(planes, layer, sight, options);
  CHECK(std::abs(signed_volume(without.mesh.mesh()) - volume) > 12);
  const Extraction with = extract_layer(planes, layer, {{inner}}, sight, options, joined);
  expect_solid(with.mesh, volume);
  CHECK(joined == std::vector<int>{inner});
}

TEST_CASE("a box on a roof does not join a coarse layer") {
  const Planes planes =
      planes_of_mesh(join(box_mesh({0, 0, 0}, {12, 10, 9}), box_mesh({5, 4, 9}, {7, 6, 11})));
  std::vector<int> layer, box, joined = {1};
  for (const int p : all_planes(planes)) (planes.planes[p].area < 5 ? box : layer).push_back(p);
  Sight sight(planes);
  const Extraction e = extract_layer(planes, layer, {box}, sight, {.tolerance = 0.2}, joined);
  expect_solid(e.mesh, 12 * 10 * 9);
  CHECK(joined.empty());
}

TEST_CASE("a wing joins, however many facets it adds") {
  const Planes planes =
      planes_of_mesh(join(box_mesh({0, 0, 0}, {12, 10, 9}), box_mesh({12, 1, 0}, {20, 9, 8})));
  std::vector<int> layer, wing, joined;
  for (const int p : all_planes(planes)) (planes.planes[p].area < 65 ? wing : layer).push_back(p);
  Sight sight(planes);
  const Extraction e = extract_layer(planes, layer, {wing}, sight, {.tolerance = 0.2}, joined);
  CHECK(signed_volume(e.mesh.mesh()) == Approx(12 * 10 * 9 + 8 * 8 * 8));
  CHECK(joined == wing);
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
  planes.distance = 0.1;  // found in noise
  Sight sight(planes);
  expect_solid(extract_layer(planes, all_planes(planes), sight, options).mesh, 240);
}
