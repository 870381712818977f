// Ground, buildings and plants told apart on made-up height maps.
#include "scene/classes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace colod;

namespace {

/// A place of `side` metres: ground, then what stands on it.
class Place {
 public:
  template <typename Ground>
  Place(double side, Ground ground) {
    map_.cell = 0.4;
    map_.origin = {100, 200};
    map_.width = map_.height = static_cast<int>(side / map_.cell);
    for (int y = 0; y < map_.height; ++y)
      for (int x = 0; x < map_.width; ++x) {
        const Vec2 p = map_.middle(x, y) - map_.origin;
        map_.top.push_back(static_cast<float>(ground(p.x(), p.y())));
        map_.color.push_back({140, 130, 120});
      }
    ground_ = map_.top;
    inside_.assign(map_.size(), 0);
  }

  /// Level, at this height over the ground at its corner.
  Place& house(double x, double y, double w, double h, double height,
               const Rgb& color = {170, 90, 80}) {
    const float z = at(x, y) + static_cast<float>(height);
    cover(x, y, w, h, [&](std::size_t i, double, double) {
      map_.top[i] = z, inside_[i] = 1, map_.color[i] = color;
    });
    return *this;
  }

  /// Under a gable along x of so many metres a metre, measured to a few centimetres.
  Place& gable(double x, double y, double w, double h, double eaves, double slope) {
    std::mt19937 random(5);
    cover(x, y, w, h, [&](std::size_t i, double, double v) {
      const double up = slope * std::min(v - y, y + h - v);
      const double noise = 0.06 * (static_cast<double>(random() % 1000) / 1000 - 0.5);
      map_.top[i] = ground_[i] + static_cast<float>(eaves + up + noise);
      inside_[i] = 1, map_.color[i] = {170, 90, 80};
    });
    return *this;
  }

  /// A green, rough dome.
  Place& tree(double x, double y, double radius, double height) {
    std::mt19937 random(7);
    cover(x - radius, y - radius, 2 * radius, 2 * radius, [&](std::size_t i, double u, double v) {
      const double far = std::hypot(u - x, v - y) / radius;
      if (far > 1) return;
      const double bump = 0.8 * (static_cast<double>(random() % 1000) / 1000 - 0.5);
      map_.top[i] = ground_[i] + static_cast<float>(height * std::sqrt(1 - far * far) + bump + 1);
      map_.color[i] = {70, 120, 50};
    });
    return *this;
  }

  /// Green and rough, at this height.
  Place& wood(double x, double y, double w, double h, double height) {
    std::mt19937 random(9);
    cover(x, y, w, h, [&](std::size_t i, double, double) {
      const double bump = 2 * (static_cast<double>(random() % 1000) / 1000 - 0.5);
      map_.top[i] = ground_[i] + static_cast<float>(height + bump);
      map_.color[i] = {70, 120, 50};
    });
    return *this;
  }

  /// Grey boxes less than a metre high, one a square: what stands about on a flat roof.
  Place& clutter(double x, double y, double w, double h) {
    cover(x, y, w, h, [&](std::size_t i, double u, double v) {
      const int box = static_cast<int>(u / 0.8) + 7 * static_cast<int>(v / 0.8);
      map_.top[i] += static_cast<float>(0.3 * (box % 4));
      map_.color[i] = {120, 118, 115};
    });
    return *this;
  }

  const HeightMap& map() const { return map_; }

  /// Of the cells of houses and of those found, what both have.
  double overlap(const SceneClasses& found) const {
    double both = 0, any = 0;
    for (std::size_t i = 0; i < map_.size(); ++i) {
      const bool is_found = found.of_cell[i] == SceneClass::kBuilding;
      both += is_found && inside_[i], any += is_found || inside_[i];
    }
    return both / any;
  }

  /// Metres that the ground which was found is off on all cells but a thirtieth, beside steps.
  double ground_error(const SceneClasses& found) const {
    std::vector<double> off;
    for (std::size_t i = 0; i < map_.size(); ++i)
      off.push_back(std::abs(found.ground[i] - ground_[i]));
    std::sort(off.begin(), off.end());
    return off[off.size() * 97 / 100];
  }

 private:
  float at(double x, double y) const {
    return ground_[map_.at(static_cast<int>(x / map_.cell), static_cast<int>(y / map_.cell))];
  }
  template <typename Body>
  void cover(double x, double y, double w, double h, Body body) {
    for (int v = 0; v < map_.height; ++v)
      for (int u = 0; u < map_.width; ++u) {
        const Vec2 p = map_.middle(u, v) - map_.origin;
        if (p.x() > x && p.x() < x + w && p.y() > y && p.y() < y + h)
          body(map_.at(u, v), p.x(), p.y());
      }
  }

  HeightMap map_;
  std::vector<float> ground_;
  std::vector<char> inside_;
};

const auto kLevel = [](double, double) { return 5.0; };

}  // namespace

TEST_CASE("houses are found, trees are plants") {
  Place place(80, kLevel);
  place.house(10, 10, 12, 9, 6).house(40, 12, 10, 10, 3.2).tree(20, 50, 4, 6).tree(60, 55, 6, 9);
  const SceneClasses found = classify(place.map());
  CHECK(found.buildings == 2);
  CHECK(place.overlap(found) > 0.9);
  CHECK(place.ground_error(found) < 0.1);
  double plants = 0;
  for (const SceneClass c : found.of_cell) plants += c == SceneClass::kPlant;
  CHECK(plants * 0.16 > 0.7 * M_PI * (16 + 36));
}

TEST_CASE("a hall larger than the widest block is no terrace, and a terrace is no hall") {
  Place hall(300, kLevel);
  hall.house(60, 60, 180, 120, 12);
  const SceneClasses found = classify(hall.map());
  CHECK(found.buildings == 1);
  CHECK(hall.overlap(found) > 0.97);
  const Place terraces(150, [](double x, double) { return 3 * std::floor(x / 50); });
  CHECK(classify(terraces.map()).buildings == 0);
  CHECK(terraces.ground_error(classify(terraces.map())) < 1);
}

TEST_CASE("steep roofs are roofs, however narrow") {
  for (const double degrees : {45, 55, 62}) {
    CAPTURE(degrees);
    const double slope = std::tan(degrees * M_PI / 180);
    Place place(80, kLevel);
    place.gable(10, 10, 14, 5, 4, slope)
        .gable(40, 20, 12, 9, 4, slope)
        .gable(20, 50, 18, 12, 3, slope);
    const SceneClasses found = classify(place.map());
    CHECK(found.buildings == 3);
    CHECK(place.overlap(found) > 0.95);
  }
}

TEST_CASE("sheds are buildings, boxes as low as cars and long banks are none") {
  Place place(80, kLevel);
  place.house(10, 10, 4, 3, 2.4).house(30, 12, 3.4, 3.4, 2.6).gable(50, 30, 4, 3.2, 2.2, 0.5);
  CHECK(classify(place.map()).buildings == 3);
  place.house(10, 40, 4.4, 1.8, 1.4).house(20, 60, 40, 1.8, 2.5);
  CHECK(classify(place.map()).buildings == 3);
}

TEST_CASE("on slopes and hills ground stays ground and houses are found") {
  for (const double slope : {0.15, 0.35}) {
    Place place(120, [&](double x, double) { return slope * x; });
    place.house(30, 30, 12, 10, 7).house(70, 60, 10, 12, 8);
    const SceneClasses found = classify(place.map());
    INFO(slope);
    CHECK(found.buildings == 2);
    CHECK(place.overlap(found) > 0.85);
  }
  Place hill(160, [](double x, double y) {
    return 25 * std::exp(-(std::pow(x - 80, 2) + std::pow(y - 80, 2)) / 1800);
  });
  const SceneClasses found = classify(hill.map());
  CHECK(found.buildings == 0);
  CHECK(hill.ground_error(found) < 0.3);
}

TEST_CASE("a hill in a corner that houses and trees stand on is ground") {
  for (const double height : {9.0, 14.0}) {
    Place place(160, [&](double x, double y) {
      const double far = std::hypot(160 - x, y) / 90;
      return 5 + (far < 1 ? height * (1 + std::cos(M_PI * far)) / 2 : 0);
    });
    place.house(20, 100, 12, 9, 6).house(60, 20, 12, 10, 6).house(118, 12, 12, 9, 6);
    place.house(136, 34, 10, 10, 5).tree(120, 40, 4, 7).tree(144, 14, 4, 7);
    CAPTURE(height);
    CHECK(place.ground_error(classify(place.map())) < 1);
  }
}

TEST_CASE("in a dense quarter ground is found in streets and yards, on slopes, too") {
  struct Quarter {
    double east, north;     // slopes
    double overlap, error;  // steep ground meets the uphill eaves of houses of 3 m
  };
  const Quarter q =
      GENERATE(Quarter{0, 0, 0.9, 0.6}, Quarter{0.1, 0, 0.9, 0.6}, Quarter{0.2, 0, 0.84, 0.9},
               Quarter{0.12, 0.09, 0.79, 1.25}, Quarter{0.2, 0.15, 0.68, 1.05});
  Place place(260,
              [&](double x, double y) { return q.east * x + q.north * y + 2 * std::sin(y / 40); });
  int n = 0;
  for (int row = 0; row < 4;
       ++row)  // blocks of 70 by 50 m: houses along two streets, yards between
    for (int column = 0; column < 3; ++column)
      for (int house = 0; house < 7; ++house)
        for (const int side : {0, 1}) {
          const double depth = 14 + n % 4, y = 8 + 58 * row + (side ? 50 - depth : 0);
          place.house(8 + 78 * column + 10 * house, y, 10, depth, 3 * (1 + (5 * n / 3) % 3) + 0.1);
          ++n;
        }
  const SceneClasses found = classify(place.map());
  INFO(q.east << " " << q.north);
  CHECK(place.overlap(found) > q.overlap);
  CHECK(place.ground_error(found) < q.error);
}

TEST_CASE("what stands about on a roof is the roof's, a tree beside it is not") {
  Place place(60, kLevel);
  place.house(10, 10, 24, 20, 6).clutter(14, 14, 14, 12).tree(45, 20, 5, 6);
  const SceneClasses found = classify(place.map());
  CHECK(found.buildings == 1);
  CHECK(place.overlap(found) > 0.95);
}

TEST_CASE("a smooth crown or copse amid leaves is a plant, houses beside and amid trees are none") {
  const double size = GENERATE(6.0, 7.5, 9.0);
  CAPTURE(size);
  constexpr Rgb kDull = {118, 120, 116}, kTiles = {170, 90, 80}, kShade = {80, 88, 80};
  const auto found = [](double side, const Rgb& color, bool is_wood) {
    Place place(80, kLevel);
    if (is_wood)
      place.wood(40 - side, 40 - side, 2 * side, 2 * side, 5);
    else
      place.wood(40 - 2 * side, 40 - side, 1.5 * side, 2 * side, 5);
    place.house(40 - side / 2, 40 - side / 2, side, side, 6, color);
    return classify(place.map()).buildings;
  };
  CHECK(found(size, kDull, true) == 0);
  CHECK(found(size, kTiles, true) == 1);
  CHECK(found(size, kDull, false) == 1);
  CHECK(found(2 * size, kDull, true) == 1);
  CHECK(found(2 * size, kShade, true) == 0);
  CHECK(found(2 * size, kShade, false) == 1);
}

TEST_CASE("two houses of one height that touch at a corner are two") {
  for (const double size : {8.0, 20.0, 40.0}) {
    Place place(2 * size + 40, kLevel);
    place.house(10, 10, size, size, 6).house(10 + size, 10 + size - 1.6, size, size, 6);
    CHECK(classify(place.map()).buildings == 2);
  }
}

TEST_CASE("a block is parted where its roofs lie at different heights") {
  Place place(80, kLevel);
  place.house(10, 10, 10, 12, 6).house(20, 10, 10, 12, 8.5).house(30, 10, 10, 12, 5);
  CHECK(classify(place.map()).buildings == 3);
  Place stairs(80, kLevel);  // a level on a roof is no building of its own
  stairs.house(10, 10, 30, 20, 6).house(20, 16, 6, 6, 8.5);
  CHECK(classify(stairs.map()).buildings == 1);
}

TEST_CASE("outlines are straight and square, with courtyards, and have areas") {
  Place place(80, kLevel);
  place.house(10, 10, 40, 12, 6).house(10, 22, 12, 20, 6).house(38, 22, 12, 20, 6);
  place.house(10, 42, 40, 10, 6);
  const SceneClasses found = classify(place.map());
  const std::vector<Footprint> plans = outline_buildings(place.map(), found);
  REQUIRE(plans.size() == 1);
  REQUIRE(plans[0].parts.size() == 1);
  REQUIRE(plans[0].parts[0].size() == 2);
  CHECK(plans[0].parts[0][0].size() == 4);
  CHECK(plans[0].parts[0][1].size() == 4);
  for (const Vec2& p : plans[0].parts[0][0]) {
    const Vec2 q = p - place.map().origin;
    CHECK(std::min(std::abs(q.x() - 10), std::abs(q.x() - 50)) < 0.7);
    CHECK(std::min(std::abs(q.y() - 10), std::abs(q.y() - 52)) < 0.7);
  }
}

TEST_CASE("gaps in a map are nothing, and an empty place has no building") {
  Place place(60, kLevel);
  place.house(20, 20, 12, 12, 6);
  HeightMap map = place.map();
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 30; ++x) map.top[map.at(x, y)] = NAN;
  const SceneClasses found = classify(map);
  CHECK(found.buildings == 1);
  CHECK(found.of_cell[map.at(5, 5)] == SceneClass::kNothing);
  for (float& z : map.top) z = NAN;
  CHECK(classify(map).buildings == 0);
}

TEST_CASE("the least building has a plan, too, however its corners are cut") {
  for (const double radius : {1.7, 2.1, 4.0}) {
    HeightMap map;
    map.cell = 0.4, map.width = map.height = 40;
    SceneClasses classes;
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) {
        const Vec2 p = map.middle(x, y) - Vec2(8, 8);
        const bool is_in = std::abs(p.x()) + std::abs(p.y()) < radius;
        classes.building.push_back(is_in ? 0 : -1);
        map.top.push_back(is_in ? 3 : 0);
      }
    classes.buildings = 1;
    classes.ground.assign(map.size(), 0);
    CAPTURE(radius);
    const std::vector<Footprint> plans = outline_buildings(map, classes);
    REQUIRE(plans.size() == 1);
    CHECK(std::stod(plans[0].attributes.at(2).second) > radius * radius);
  }
}
