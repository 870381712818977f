#include "extraction/extraction.h"

#include <array>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "core/error.h"
#include "core/parallel.h"
#include "elements/elements_helpers.h"
#include "extraction_helpers.h"
#include "meshes.h"
#include "shared_data.h"

using namespace colod;
using namespace colod::test;

namespace {

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

/// A hall of 20 × 12 × 6 with a stair house on its roof to z = 8.5 and parapets of which nobody saw
/// the outside and the top for `gap` metres on either side of each corner; tops are 2 cm apart.
Mesh hall_with_parapets(double thickness, double gap) {
  Mesh m = join(box_mesh({0, 0, 0}, {20, 12, 6}), box_mesh({8, 5, 6}, {12, 8, 8.5}));
  const std::array<Vec3, 4> corners = {Vec3(0, 0, 0), Vec3(20, 0, 0), Vec3(20, 12, 0),
                                       Vec3(0, 12, 0)};
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 side = corners[(k + 1) % 4] - corners[k], along = side.normalized();
    const Vec3 inward = thickness * Vec3(-along.y(), along.x(), 0);
    const Vec3 low(0, 0, 6), high(0, 0, 6.4 + 0.02 * static_cast<double>(k));
    const Vec3 a = corners[k] + gap * along, b = corners[k] + side - gap * along;
    add_quad(m, a + low, b + low, b + high, a + high);
    const Vec3 c = corners[k] + inward, d = corners[k] + side + inward;  // seen into the corner
    add_quad(m, d + low, c + low, c + high, d + high);
    add_quad(m, a + high, b + high, b + inward + high, a + inward + high);
  }
  return m;
}

}  // namespace

TEST_CASE("parapets meet in their corners, also where those were not seen, without a post") {
  const double thickness = GENERATE(0.2, 0.25, 0.4), gap = GENERATE(0.0, 0.6, 1.0);
  const Extraction e = extract(hall_with_parapets(thickness, gap));
  const Check c = check(e.mesh);
  CAPTURE(thickness, gap);
  CHECK(c.is_closed);
  CHECK(c.is_fan);
  int corners = 0;
  for (const Vec3& p : e.mesh.vertices) {
    const bool is_on_stairs = p.x() > 7.9 && p.x() < 12.1 && p.y() > 4.9 && p.y() < 8.1;
    if (!is_on_stairs) CHECK(p.z() < 6.5);
    corners += p.z() > 6.3 && (p.x() < 0.01 || p.x() > 19.99) && (p.y() < 0.01 || p.y() > 11.99);
  }
  CHECK(corners >= 4);
  const double parapets = thickness * (64 - 4 * thickness) * 0.43;
  CHECK(signed_volume(e.mesh.mesh()) == Approx(20 * 12 * 6 + 4 * 3 * 2.5 + parapets).margin(0.5));
}

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
  const Extraction e = extract(gable_house(10, 6, 4, 3), {.rules = RuleSet::none()});
  expect_solid(e.mesh, 330);
  CHECK(e.mesh.vertices.size() == 10);
}

TEST_CASE("whole planes make more cells and the same house") {
  const Mesh house = join(l_shape(), box_mesh({1, 1, 4}, {3, 3, 6}));
  const RuleSet paper = RuleSet::none();
  const Extraction whole = extract(house, {.rules = paper});
  const Extraction reached = extract(house, {.rules = paper.with(Rule::kReach)});
  CHECK(whole.cells > reached.cells);
  CHECK(signed_volume(whole.mesh.mesh()) == Approx(signed_volume(reached.mesh.mesh())));
  CHECK(whole.warnings.empty());
  const int most = static_cast<int>(whole.cells) - 1;
  const Extraction capped = extract(house, {.rules = paper, .max_cells = most});
  CHECK(capped.cells == reached.cells);
  CHECK(joined(capped.warnings).find("outline reaches") != std::string::npos);
}

TEST_CASE("paper rules need no floor") {
  const Mesh open = without_faces(gable_house(10, 6, 4, 3), {0, 0, -1});
  expect_solid(extract(open, {.rules = RuleSet::none()}).mesh, 330);
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
