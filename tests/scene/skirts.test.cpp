// Where buildings were cut out of a scene: what is left, and the ground that closes it, without a
// gap between them.
#include "scene/skirts.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "core/rays.h"
#include "meshes.h"
#include "scene/lighter.h"
#include "scene/tiles.h"
#include "scenes.h"

using namespace colod;
using namespace colod::test;

namespace {

constexpr double kSide = 40, kStep = 0.5;

/// A bumpy slope with a house that has a tree on either side of where it is cut.
class Place {
 public:
  Place() {
    source_.mesh = terrain_with_boxes(kSide, kStep, {house_, tree_});
    for (Vec3& p : source_.mesh.vertices) p.z() += slope(p.x(), p.y());
    source_.mesh = joined({source_}).mesh;
    map_.cell = 0.4;
    map_.width = map_.height = static_cast<int>(kSide / map_.cell);
    map_.top.assign(static_cast<std::size_t>(map_.width) * map_.height, NAN);
    map_.color.assign(map_.size(), Rgb{});
    draw_from_above(source_, ImageCache(1 << 20), map_);
    classes_.building.assign(map_.size(), -1);
    for (int y = 0; y < map_.height; ++y)
      for (int x = 0; x < map_.width; ++x) {
        const Vec2 p = map_.middle(x, y);
        classes_.ground.push_back(static_cast<float>(slope(p.x(), p.y())));
        const bool is_low = map_.top[map_.at(x, y)] - classes_.ground.back() < 1;
        classes_.of_cell.push_back(is_low ? SceneClass::kGround : SceneClass::kRest);
      }
  }

  /// All of it but the house; `has_skirts`: closed where it was cut; as light as `error` allows.
  Mesh without_house(bool has_skirts, double error = 0) const {
    const Territories territories({{"a", {{{{12, 14}, {24, 14}, {24, 24}, {12, 24}}}}, {}}});
    const ClosingGround ground(map_, classes_);
    Source left = territories.cut_out(source_, -1), below = ground.below(territories.pieces());
    for (Source* part : {&left, &below}) {
      if (!has_skirts) continue;
      const std::vector<char> is_joint = add_skirts(territories, ground, *part, 2 * error);
      if (error > 0) *part = lighter(*part, is_joint, error);
    }
    return joined({left, below}).mesh;
  }

  const HeightMap& map() const { return map_; }
  const SceneClasses& classes() const { return classes_; }

 private:
  static double slope(double x, double y) {
    return 0.3 * x + 0.25 * std::sin(x * 1.3) + 0.25 * std::cos(y * 1.7);
  }
  Box house_{{12, 14, 0}, {24, 24, 6}}, tree_{{24, 17, 0}, {30, 22, 4}};
  Source source_;
  HeightMap map_;
  SceneClasses classes_;
};

/// Of rays `step` metres apart that look down obliquely at the cut from all sides, those that meet
/// nothing.
int count_seen_through(const Mesh& mesh, double step = 0.1) {
  const RayScene rays(mesh);
  int count = 0;
  for (int turn = 0; turn < 12; ++turn)
    for (double u = 8; u < 28; u += step)
      for (double v = 10; v < 28; v += step) {
        const double a = turn * M_PI / 6;
        const Vec3 down = Vec3(std::cos(a), std::sin(a), -0.7).normalized();
        const Vec3 at(u, v, 0.3 * u);
        // The place ends where its border is: a ray is looked at for a few metres about the ground.
        count += !rays.first_hit(at - 12 * down, down, 0, 15);
      }
  return count;
}

}  // namespace

TEST_CASE("what was cut along a building is closed from all sides") {
  const Place place;
  CHECK(count_seen_through(place.without_house(false)) > 100);
  // A hole of 0.1 m is met by rays that lie 0.1 m apart from several sides; one slips through a
  // seam.
  CHECK(count_seen_through(place.without_house(true)) < 3);
}

TEST_CASE("it is closed to a pixel when it becomes lighter, too, and its own rim stays") {
  const double error = GENERATE(0.1, 0.3, 0.6);
  const Place place;
  const Mesh whole = place.without_house(true), light = place.without_house(true, error);
  CAPTURE(error, whole.faces.size(), light.faces.size());
  CHECK(light.faces.size() < (error < 0.2 ? 0.6 : 0.35) * whole.faces.size());
  CHECK(count_seen_through(light, error) < 6);  // of 50,000 and fewer
  const auto on_rim = [](const Mesh& mesh) {
    int count = 0;
    for (const Vec3& p : mesh.vertices)
      count += p.x() == 0 || p.y() == 0 || p.x() == kSide || p.y() == kSide;
    return count;
  };
  CHECK(on_rim(light) == on_rim(whole));
}

TEST_CASE("the ground below a building has few faces, and no edge inside that one alone has") {
  const Place place;
  const Territories hall({{"a", {{{{4, 4}, {36, 4}, {36, 36}, {4, 36}}}}, {}}});
  const Source ground = ClosingGround(place.map(), place.classes()).below(hall.pieces());
  CHECK(surface_area(ground.mesh) > 35 * 35);
  CHECK(ground.mesh.faces.size() < 1500);
  double rim = 0;
  std::map<std::array<int, 2>, int> uses;
  for (const Face& f : ground.mesh.faces)
    for (std::size_t k = 0; k < 3; ++k)
      ++uses[{std::min(f[k], f[(k + 1) % 3]), std::max(f[k], f[(k + 1) % 3])}];
  for (const auto& [edge, count] : uses)
    if (count == 1)
      rim += (ground.mesh.vertices[static_cast<std::size_t>(edge[0])] -
              ground.mesh.vertices[static_cast<std::size_t>(edge[1])])
                 .head<2>()
                 .norm();
  CHECK(rim == Approx(4 * 32 + 2 * M_PI * 1.5).epsilon(0.04));
}
