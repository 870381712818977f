// When layers switch: what a viewer sees of a change, and how all buildings agree.
#include "measure/switching.h"

#include <catch2/catch.hpp>

#include "core/rays.h"
#include "measure/switching_views.h"
#include "meshes.h"

using namespace colod;
using namespace colod::test;

namespace {

constexpr float kSky = 0.9f, kWall = 0.4f;

GreyPicture sky(int width, int height) {
  const std::size_t n = static_cast<std::size_t>(width) * height;
  return {width, height, std::vector<float>(n, kSky), std::vector<float>(n, 0)};
}

/// Pixels x0 ≤ x < x1, y0 ≤ y < y1 become surface of this luminance.
GreyPicture with_rectangle(GreyPicture p, int x0, int y0, int x1, int y1, float luminance = kWall) {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      p.luminance[y * p.width + x] = luminance, p.coverage[y * p.width + x] = 1;
  return p;
}

Mesh house_with_chimney(double side, double height) {
  const Mesh house = gable_house(12, 8, 6, 3);
  if (side == 0) return house;
  return join(house, box_mesh({3, 2, 7}, {3 + side, 2 + side, 8 + height}));
}

/// Layer 0 without the chimney, layer 1 with it.
LayerSight chimney_sight(double side, double height) {
  return measure_sights({house_with_chimney(0, 0), house_with_chimney(side, height)})[0];
}

const SwitchOptions kEight{.visual_error = 8};

/// Differs by 8 pixels at g, in inverse proportion elsewhere.
LayerSight sight_of(double g) {
  return {false, 4 * g, {{g / 4, 32}, {g / 2, 16}, {g, 8}, {2 * g, 4}}};
}

BuildingSights building_of(double g0, double g1) {
  return {{0, 1, 2}, {sight_of(g0), sight_of(g1), {}}};
}

}  // namespace

TEST_CASE("equal pictures do not differ, nor do lines that move by a pixel") {
  const GreyPicture house = with_rectangle(sky(60, 40), 10, 10, 50, 40);
  CHECK(compare_pictures(house, house).pixels() == 0);
  const GreyPicture moved = with_rectangle(sky(60, 40), 11, 10, 51, 40);
  CHECK(compare_pictures(house, moved).piece == 0);
  CHECK(compare_pictures(house, moved).outline <= 1);
}

TEST_CASE("a piece counts by its pixels and its contrast") {
  const GreyPicture wall = with_rectangle(sky(60, 40), 0, 0, 60, 40);
  for (const int side : {3, 6, 12})
    for (const float contrast : {0.1f, 0.25f, 0.4f}) {
      const GreyPicture window =
          with_rectangle(wall, 20, 15, 20 + side, 15 + side, kWall - contrast);
      const PictureDifference d = compare_pictures(wall, window);
      CHECK(d.piece == Approx(side * std::sqrt(contrast / kReferenceContrast)).epsilon(1e-4));
      CHECK(d.outline == 0);
      CHECK(compare_pictures(window, wall).piece == d.piece);
    }
  const GreyPicture faint = with_rectangle(wall, 20, 15, 40, 35, kWall - 0.04f);
  CHECK(compare_pictures(wall, faint).piece == 0);
}

TEST_CASE("of many pieces the largest counts, not their sum") {
  const GreyPicture wall = with_rectangle(sky(80, 40), 0, 0, 80, 40);
  GreyPicture windows = wall;
  for (int x = 5; x < 75; x += 10) windows = with_rectangle(windows, x, 10, x + 4, 14, 0.15f);
  CHECK(compare_pictures(wall, windows).piece == Approx(4).epsilon(1e-4));
}

TEST_CASE("an outline moves by what stands out of it or is missing from it") {
  const GreyPicture house = with_rectangle(sky(80, 60), 10, 30, 70, 60);
  for (const int height : {3, 8, 15}) {
    const GreyPicture chimney = with_rectangle(house, 30, 30 - height, 33, 30);
    CHECK(compare_pictures(house, chimney).outline == Approx(height).margin(0.2 * height));
    CHECK(compare_pictures(chimney, house).outline == compare_pictures(house, chimney).outline);
  }
}

TEST_CASE("pictures from far away are what rays see, averaged") {
  const Mesh mesh = house_with_chimney(1, 2);
  const RayScene scene(mesh);
  for (const Vec3& direction : {Vec3(0.6, -0.7, 0.4), Vec3(-0.2, 0.9, 0.1)}) {
    const FarView view = far_view(bounding_box(mesh.vertices), direction.normalized(), 0.15);
    const GreyPicture drawn = FarPicture(mesh, view).at(1);
    REQUIRE(drawn.width == view.width);
    int differing = 0;
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        const Vec3 eye =
            view.corner + view.sample * (x * view.right - y * view.up) - 100 * view.forward;
        differing += (drawn.coverage[y * view.width + x] > 0.5f) !=
                     static_cast<bool>(scene.first_hit(eye, view.forward));
      }
    CHECK(differing <= view.width * view.height / 1000);
    const GreyPicture averaged = FarPicture(mesh, view).at(4);
    double fine = 0, coarse = 0;
    for (const float c : drawn.coverage) fine += c;
    for (const float c : averaged.coverage) coarse += 16 * c;
    CHECK(coarse == Approx(fine));
  }
}

TEST_CASE("a larger part is seen from farther away, and a looser bound from nearer") {
  double before = 0;
  for (const double side : {0.5, 1.0, 2.0}) {
    const LayerSight sight = chimney_sight(side, 2 * side);
    CHECK(sight.deviation > side);
    const double g = visible_gsd(sight.profile, 8);
    CHECK(g > 1.4 * before);
    CHECK(visible_gsd(sight.profile, 16) < g);
    CHECK(visible_gsd(sight.profile, 4) > g);
    before = g;
  }
}

TEST_CASE("at the switch a chimney is about as large as the bound says") {
  for (const double side : {0.6, 1.2}) {  // 8 pixels a side at a quarter of the contrast
    const double g = visible_gsd(chimney_sight(side, 3).profile, 8);
    CHECK(3 / g > 2);  // its height in pixels
    CHECK(3 / g < 12);
  }
}

TEST_CASE("place does not matter, and the same meshes give the same figures") {
  const std::vector<Mesh> layers = {house_with_chimney(0, 0), house_with_chimney(1, 2)};
  std::vector<Mesh> moved = layers;
  for (Mesh& mesh : moved)
    for (Vec3& p : mesh.vertices) p += Vec3(1024, -512, 64);
  const auto a = measure_sights(layers), b = measure_sights(layers), c = measure_sights(moved);
  REQUIRE(a[0].profile.size() == b[0].profile.size());
  for (std::size_t i = 0; i < a[0].profile.size(); ++i)
    CHECK(a[0].profile[i].pixels == b[0].profile[i].pixels);
  CHECK(visible_gsd(c[0].profile, 8) == Approx(visible_gsd(a[0].profile, 8)).epsilon(0.05));
}

TEST_CASE("layers that are alike have nothing to switch") {
  const Mesh plain = house_with_chimney(0, 0), rich = house_with_chimney(1, 2);
  const auto sights = measure_sights({plain, plain, rich, rich});
  CHECK(sights[0].is_like_finer);
  CHECK(!sights[1].is_like_finer);
  CHECK(sights[2].is_like_finer);
  CHECK(sights[0].deviation == sights[1].deviation);
  CHECK(sights[2].deviation == 0);
  const std::vector<double> g = own_gsds({{0, 1, 2, 3}, sights}, {});
  CHECK(g[0] == g[1]);
  CHECK(g[1] > 0);
  CHECK(g[2] == 0);
  CHECK(g[3] == 0);
}

TEST_CASE("own gsds fall by a factor worth a level, whatever was measured") {
  const std::vector<double> g = own_gsds(building_of(0.5, 0.45), kEight);
  CHECK(g[1] == Approx(0.45));
  CHECK(g[0] == Approx(1.501 * 0.45));
  const std::vector<double> other = own_gsds(building_of(0.9, 0.3), {.visual_error = 4});
  CHECK(other[1] == Approx(0.6));
  CHECK(other[0] == Approx(1.8));
  const std::vector<double> strict =
      own_gsds(building_of(0.5, 0.3), {.measure = SwitchMeasure::kDeviation, .pixel_error = 4});
  CHECK(strict[1] == Approx(0.3));
  CHECK(strict[0] == Approx(0.5));
}

TEST_CASE("no gsd is below the rounding's share") {
  CHECK(own_gsds(building_of(0.5, 0.01), {.pixel_error = 2, .rounding = 0.2})[1] == Approx(0.1));
}

TEST_CASE("the scene's gsd keeps the bound of nine buildings in ten") {
  std::vector<BuildingSights> buildings;
  for (int i = 1; i <= 20; ++i) buildings.push_back(building_of(0.1 * i, 0.02 * i));
  const auto plan = plan_scene_switches(buildings, 3, kEight);
  REQUIRE(plan.size() == 3);
  CHECK(plan[2].gsd == 0);
  CHECK(plan[1].gsd == Approx(0.36));
  CHECK(plan[0].gsd == Approx(1.8));
  CHECK(plan[0].buildings == 20);
  CHECK(plan[0].too_coarse == Approx(0.1));
  CHECK(plan[0].coarse_factor == Approx(2 / 1.8));
  CHECK(plan[0].too_fine == Approx(0.85));
  CHECK(plan[0].fine_factor == Approx(18));
  const auto low = plan_scene_switches(buildings, 3, {.visual_error = 8, .share = 0.1});
  CHECK(low[0].gsd == Approx(0.2));
  CHECK(low[0].too_coarse == Approx(0.9));
}

TEST_CASE("buildings with nothing to switch do not count, and failed layers are left out") {
  BuildingSights block{{0, 1, 2}, {{true, 0, {}}, {true, 0, {}}, {}}};
  BuildingSights without_finest{{0, 1}, {sight_of(5), {}}};
  const auto plan = plan_scene_switches({building_of(0.8, 0.2), block, without_finest}, 3, kEight);
  CHECK(plan[0].buildings == 2);
  CHECK(plan[1].buildings == 1);
  CHECK(plan[1].gsd == Approx(0.2));
  const auto none = plan_scene_switches({block}, 3, {});
  CHECK(none[0].gsd == 0);
  CHECK(none[0].buildings == 0);
}
