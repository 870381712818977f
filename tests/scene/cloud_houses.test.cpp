// Houses that an airborne cloud shows: straight, upright walls whichever way they stand to the
// cells of the surface.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <functional>
#include <random>

#include "las_files.h"
#include "pipeline/pipeline.h"
#include "relief/relief.h"
#include "scene/cloud_surface.h"
#include "scene/territory.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;

namespace {

constexpr double kSide = 50;  // metres of the square that the cloud covers
const Vec2 kMiddle(kSide / 2, kSide / 2);

/// Heights over the ground in a house's own metres; 0 beside it.
using Heights = std::function<double(double x, double y)>;

Vec2 turned(const Vec2& p, double angle_deg) {
  const double a = angle_deg * M_PI / 180;
  return {std::cos(a) * p.x() - std::sin(a) * p.y(), std::sin(a) * p.x() + std::cos(a) * p.y()};
}

/// 10 points a m², and as many on the walls of a box of so many metres, if any.
CloudSurface surface_over(const Heights& house, double angle_deg, double walls = 0) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0, kSide), share(0, 1), half(-walls / 2, walls / 2);
  std::normal_distribution<double> noise(0, 0.02);
  std::vector<LasPoint> points;
  for (int i = 0; i < 10 * kSide * kSide; ++i) {
    const Vec2 at(place(random), place(random));
    const Vec2 own = turned(at - kMiddle, -angle_deg);
    points.push_back({{at.x(), at.y(), house(own.x(), own.y()) + noise(random)}, 1});
  }
  for (int i = 0; walls > 0 && i < 4 * walls * 10; ++i) {
    const double along = half(random), rise = share(random), edge = walls / 2;
    const std::array<Vec2, 4> sides = {Vec2(along, edge), Vec2(along, -edge), Vec2(edge, along),
                                       Vec2(-edge, along)};
    const Vec2 at = kMiddle + turned(sides[static_cast<std::size_t>(i) % 4], angle_deg);
    points.push_back({{at.x(), at.y(), rise * house(0, 0)}, 1});
  }
  const TemporaryFolder folder;
  const std::string path = (folder / "a.las").string();
  std::ofstream(path, std::ios::binary) << las(points, 2, 0);
  return surface_of({path}, {});
}

/// The piece of the surface over a square plan of 2 · `half` metres, with what is within its eaves.
Source house_on(const CloudSurface& surface, double half, double angle_deg) {
  std::vector<Vec2> ring;
  for (const Vec2& corner :
       {Vec2(-half, -half), Vec2(half, -half), Vec2(half, half), Vec2(-half, half)})
    ring.push_back(kLasOffset.head<2>() + kMiddle + turned(corner, angle_deg));
  const Territories plan({{"house", {{ring}}, {}}});
  std::vector<Source> parts;
  for (int tile = 0; tile < tile_count(surface.map); ++tile)
    parts.push_back(plan.cut_out(surface_tile(surface.map, tile), 0));
  Source house = joined(parts);
  house.name = house.given_name = "house";
  return house;
}

Layer finest_of(const Source& house) {
  Options options;
  options.ns = 30;
  const Scene scene = build_scene({{house}, {}}, options);
  REQUIRE(scene.buildings.size() == 1);
  REQUIRE(scene.buildings[0].failure.empty());
  return scene.buildings[0].layers.back();
}

/// Walls, of all that is neither level nor a roof.
bool has_straight_walls(const PolygonMesh& mesh) {
  for (const PolygonMesh::Facet& f : mesh.facets)
    if (std::abs(f.normal.z()) > 1e-6 && std::abs(f.normal.z()) < 0.2) return false;
  return true;
}

bool is_in(double x, double y, double half_x, double half_y) {
  return std::abs(x) < half_x && std::abs(y) < half_y;
}

struct House {
  const char* name;
  double half;  ///< metres: of the square around it
  std::size_t facets;
  double volume;  ///< m³
  Heights heights;
};

/// With the facets that they have, and the volume.
std::vector<House> houses() {
  return {
      {"shed", 2, 6, 4 * 4 * 3.0, [](double x, double y) { return is_in(x, y, 2, 2) ? 3 : 0; }},
      {"hall", 11, 6, 22 * 14 * 8.0, [](double x, double y) { return is_in(x, y, 11, 7) ? 8 : 0; }},
      {"ell", 8, 8, 7 * (256 - 64.0),
       [](double x, double y) { return is_in(x, y, 8, 8) && !(x > 0 && y > 0) ? 7 : 0; }},
      {"court", 10, 10, 9 * (400 - 81.0),
       [](double x, double y) { return is_in(x, y, 10, 10) && !is_in(x, y, 4.5, 4.5) ? 9 : 0; }},
      {"gable", 7, 7, 14 * 9 * (5 + 0.8 * 4.5 / 2),
       [](double x, double y) { return is_in(x, y, 7, 4.5) ? 5 + 0.8 * (4.5 - std::abs(y)) : 0; }},
      {"two heights", 9, 10, 9 * 10 * (4 + 9.0),
       [](double x, double y) { return is_in(x, y, 9, 5) ? (x < 0 ? 4 : 9) : 0; }},
  };
}

}  // namespace

TEST_CASE("walls of a cloud's house are straight and few whichever way it stands") {
  const double angle = GENERATE(0, 15, 30, 45);
  for (const House& house : houses()) {
    CAPTURE(angle, house.name);
    const Source source = house_on(surface_over(house.heights, angle), house.half, angle);
    CHECK(raster_cell(source.mesh) > 0);
    const Layer layer = finest_of(source);
    CHECK(layer.validity.is_watertight);
    CHECK(layer.mesh.facets.size() <= house.facets + 2);
    CHECK(has_straight_walls(layer.mesh));
    // A cell at the rim shows the roof if one of its two points lies on it: 0.1 m too wide.
    CHECK(signed_volume(layer.mesh.mesh()) == Approx(house.volume).epsilon(0.6 / house.half));
  }
}

TEST_CASE("a tower that a cloud shows is upright, and a steep roof is no wall") {
  const double angle = GENERATE(0, 20, 45);
  CAPTURE(angle);
  const auto tower = [](double x, double y) { return std::hypot(x, y) < 5 ? 12 : 0; };
  const Layer round = finest_of(house_on(surface_over(tower, angle), 5, angle));
  CHECK(round.validity.is_watertight);
  CHECK(round.mesh.facets.size() <= 20);
  CHECK(has_straight_walls(round.mesh));
  CHECK(signed_volume(round.mesh.mesh()) == Approx(12 * M_PI * 25).epsilon(0.12));
  // 68 degrees over two metres, level above.
  const auto mansard = [](double x, double y) {
    const double in = 8 - std::max(std::abs(x), std::abs(y));
    return in < 0 ? 0 : 5 + 2.5 * std::min(in, 2.0);
  };
  const Layer steep = finest_of(house_on(surface_over(mansard, angle), 8, angle));
  CHECK(steep.validity.is_watertight);
  CHECK(steep.mesh.facets.size() <= 40);  // 14, and what noise makes of steep cells
  const double volume = 256 * 5 + 5 * (256 + 144 + 192) / 3.0;
  CHECK(signed_volume(steep.mesh.mesh()) == Approx(volume).epsilon(0.06));
}

TEST_CASE("points on walls change no wall") {
  const double angle = GENERATE(0, 30);
  CAPTURE(angle);
  const auto box = [](double x, double y) { return is_in(x, y, 6, 6) ? 7 : 0; };
  const Layer layer = finest_of(house_on(surface_over(box, angle, 12), 6, angle));
  CHECK(layer.validity.is_watertight);
  CHECK(layer.mesh.facets.size() <= 8);
  CHECK(has_straight_walls(layer.mesh));
  CHECK(signed_volume(layer.mesh.mesh()) == Approx(7 * 144).epsilon(0.1));
}

TEST_CASE("a house without the rule says that its walls are stepped") {
  const auto box = [](double x, double y) { return is_in(x, y, 6, 6) ? 7 : 0; };
  const Source source = house_on(surface_over(box, 20), 6, 20);
  Options options;
  options.ns = 30;
  const auto tells = [&] {
    const Scene scene = build_scene({{source}, {}}, options);
    const std::vector<std::string>& said = scene.buildings.at(0).warnings;
    return std::any_of(said.begin(), said.end(),
                       [](const std::string& w) { return w.find("stepped") != std::string::npos; });
  };
  CHECK_FALSE(tells());
  options.rules = options.rules.without(Rule::kRelief);
  CHECK(tells());
}
