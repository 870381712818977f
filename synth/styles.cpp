// *Based on:* kinds of houses common in central European streets.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "bodies.h"

namespace colod::synth {
namespace {

constexpr double kGround = 0.3;      // ground floor above the street
constexpr double kThreshold = 0.12;  // doors' foot

Facade make_facade(Random& random, int floors, double floor_height) {
  Facade facade;
  facade.spacing = random.uniform(2.3, 3.0);
  for (int i = 0; i < floors; ++i) facade.floors.push_back(kGround + i * floor_height);
  return facade;
}

/// The columns of `facet` nearest to a share of its width.
double column_at(const House& house, int facet, const Facade& facade, double share) {
  const auto columns = facade_columns(house, facet, facade.spacing);
  return columns[std::min(columns.size() - 1, static_cast<std::size_t>(share * columns.size()))];
}

/// Evenly over the middle `spread` of the roof's width.
void add_dormers(House& house, int roof, int count, const DormerModel& model, double spread = 1) {
  const double width = house.solid.facet(roof).width();
  const double v = 0.14 * house.solid.facet(roof).height() + 0.25;
  for (int i = 0; i < count; ++i)
    add_dormer(house, roof, width * (0.5 + spread * ((i + 0.5) / count - 0.5)), v, model);
}

/// Near the ridge, where there is room.
void add_chimney_on(House& house, int roof, double share, const ChimneyModel& model) {
  const Facet& f = house.solid.facet(roof);
  const double width = f.width(), height = f.height();
  for (double v : {0.78, 0.68, 0.58, 0.45, 0.3})
    for (double du : {0.0, -0.12, 0.12, 0.25, -0.25})
      if (add_chimney(house, roof, (share + du) * width, v * height, model)) return;
}

House make_row_house(std::uint64_t seed, const Catalogue& catalogue) {
  House house("row_house", seed);
  Random& r = house.random;
  const int floors = r.chance(0.3) ? 3 : 2;
  const double floor_height = r.size(2.7, 2.9);
  house.width = r.size(6.2, 7.6), house.depth = r.size(9, 10.5);
  const RoofShape shape = {.eaves = kGround + floors * floor_height + 0.2,
                           .slope = r.uniform(0.8, 1.05),
                           .overhang = 0.35,
                           .thickness = 0.18};
  const Body body = add_gable_body(house, shape);
  const WindowModel& window = house.choose(catalogue.windows);
  const Facade facade = make_facade(r, floors, floor_height);
  add_door(house, body.front, column_at(house, body.front, facade, r.chance(0.5) ? 0 : 0.9),
           kThreshold, catalogue.doors[0]);
  add_windows(house, body.front, facade, window);
  if (r.chance(0.5))
    add_balcony(house, body.back, house.width / 2, facade.floors[1], catalogue.balconies[0],
                house.choose(catalogue.french_doors));
  add_windows(house, body.back, facade, window);
  if (r.chance(0.7))
    add_dormers(house, body.roofs[0], 1 + r.pick(2), house.choose(catalogue.dormers));
  add_chimney_on(house, body.roofs[r.pick(2)], r.uniform(0.15, 0.3),
                 house.choose(catalogue.chimneys));
  if (r.chance(0.6)) add_roof_window(house, body.roofs[1], house.width * 0.7, 2.2);
  return house;
}

House make_villa(std::uint64_t seed, const Catalogue& catalogue) {
  House house("hip_villa", seed);
  Random& r = house.random;
  const double floor_height = r.size(2.8, 3.1);
  house.width = r.size(11.5, 14), house.depth = r.size(9, 10.5);
  const Body body = add_hip_body(house, {.eaves = kGround + 2 * floor_height + 0.2,
                                         .slope = r.uniform(0.7, 0.95),
                                         .overhang = 0.45,
                                         .thickness = 0.22});
  const WindowModel& window =
      house.choose(r.chance(0.5) ? catalogue.tall_windows : catalogue.windows);
  const Facade facade = make_facade(r, 2, floor_height);
  const double side = r.chance(0.5) ? 0.24 : 0.76;
  add_bay(house, body.front, side * house.width, 0.25, 2 * floor_height - 0.35, floor_height,
          house.choose(catalogue.bays), window);
  add_door(house, body.front, column_at(house, body.front, facade, 0.5), kThreshold,
           catalogue.doors[1]);
  add_balcony(house, r.chance(0.5) ? body.back : body.front, house.width * (1 - side),
              facade.floors[1], house.choose(catalogue.balconies), catalogue.french_doors[0]);
  for (int wall : {body.front, body.right, body.back, body.left})
    add_windows(house, wall, facade, window);
  const DormerModel& dormer = house.choose(catalogue.dormers);
  add_dormers(house, body.roofs[0], 1 + r.pick(2), dormer, 0.5);
  if (r.chance(0.5)) add_dormers(house, body.roofs[2], 1, dormer);
  add_chimney_on(house, body.roofs[2], r.uniform(0.35, 0.65), house.choose(catalogue.chimneys));
  return house;
}

House make_apartments(std::uint64_t seed, const Catalogue& catalogue) {
  House house("apartment_block", seed);
  Random& r = house.random;
  const int floors = 3 + r.pick(3);
  const double floor_height = r.size(2.8, 2.95);
  house.width = r.size(17, 23), house.depth = r.size(10, 12);
  const Body body = add_flat_body(house, kGround + floors * floor_height + 0.7);
  const WindowModel& window = house.choose(catalogue.windows);
  const BalconyModel& balcony = house.choose(catalogue.balconies);
  const LoggiaModel& loggia = catalogue.loggias[0];
  const DoorModel& french = house.choose(catalogue.french_doors);
  Facade facade = make_facade(r, floors, floor_height);
  facade.spacing = r.uniform(2.8, 3.3);
  add_door(house, body.front, house.width / 2, kThreshold, catalogue.doors[1]);
  const bool has_loggias = r.chance(0.5);
  for (int i = 1; i < floors; ++i) {
    for (double share : {0.18, 0.82}) {
      const double u = share * house.width, v = facade.floors[i];
      if (has_loggias)
        add_loggia(house, body.front, u, v, loggia, french);
      else
        add_balcony(house, body.front, u, v, balcony, french);
    }
    add_balcony(house, body.back, house.width / 2, facade.floors[i], balcony, french);
  }
  for (int wall : {body.front, body.back}) add_windows(house, wall, facade, window);
  facade.spacing = 4.5;
  for (int wall : {body.right, body.left}) add_windows(house, wall, facade, window);
  add_stairhead(house, body.roofs[0], house.width / 2, house.depth / 2);
  for (double share : {0.2, 0.8})
    add_chimney(house, body.roofs[0], share * house.width, house.depth * 0.55,
                catalogue.chimneys[1]);
  return house;
}

House make_winged_house(std::uint64_t seed, const Catalogue& catalogue) {
  House house("winged_house", seed);
  Random& r = house.random;
  const int floors = 1 + r.pick(2);
  const double floor_height = r.size(2.7, 2.95);
  house.width = r.size(12.5, 15.5), house.depth = r.size(8.5, 10);
  const double wing_width = r.size(5, 6.2), wing_depth = r.size(3, 5.5);
  const double wing_x = r.chance(0.5) ? 0.7 : house.width - 0.7 - wing_width;
  const WingedBody body = add_winged_body(house,
                                          {.eaves = kGround + floors * floor_height + 0.2,
                                           .slope = r.uniform(0.85, 1.1),
                                           .overhang = 0.4,
                                           .thickness = 0.2},
                                          wing_x, wing_width, wing_depth);
  const WindowModel& window = house.choose(catalogue.windows);
  Facade facade = make_facade(r, floors, floor_height);
  const int long_front = wing_x > house.width / 2 ? body.main.front : body.front_right;
  add_door(house, long_front, house.solid.facet(long_front).width() / 2, kThreshold,
           catalogue.doors[0]);
  if (floors > 1)
    add_balcony(house, body.wing_front, wing_width / 2, facade.floors[1], catalogue.balconies[0],
                house.choose(catalogue.french_doors));
  for (int wall : {body.main.front, body.front_right, body.wing_front, body.wing_left,
                   body.wing_right, body.main.right, body.main.back, body.main.left})
    add_windows(house, wall, facade, window);
  const Facet& gable = house.solid.facet(body.wing_gable);
  add_window(house, body.wing_gable, gable.width() / 2, 0.5, catalogue.windows[1]);
  if (r.chance(0.7))
    add_dormers(house, body.main.roofs[1], 1 + r.pick(3), house.choose(catalogue.dormers));
  add_chimney_on(house, body.main.roofs[r.pick(2)], wing_x > house.width / 2 ? 0.2 : 0.8,
                 house.choose(catalogue.chimneys));
  return house;
}

House make_shop(std::uint64_t seed, const Catalogue& catalogue) {
  constexpr double kPier = 0.65, kShopHeight = 2.9, kRecess = 1.4;
  House house("mansard_shop", seed);
  Random& r = house.random;
  const int floors = 3 + r.pick(2);
  const double floor_height = r.size(2.9, 3.1);
  house.width = r.size(9.5, 12.5), house.depth = r.size(9.5, 11);
  const Body body = add_mansard_body(house,
                                     {.eaves = kGround + floors * floor_height + 0.3,
                                      .slope = r.uniform(2.2, 2.6),
                                      .overhang = 0.35,
                                      .thickness = 0.25},
                                     r.size(1.15, 1.3));
  Facade facade = make_facade(r, floors, floor_height);
  const int part = house.new_part(ElementKind::kLoggia, "shopfront", kRecess);
  const Rect front = {kPier, kThreshold, house.width - kPier, kShopHeight};
  const int shop = house.solid.extrude(body.front, front.ring(), -kRecess, part).cap;
  const double width = house.solid.facet(shop).width();
  add_door(house, shop, width / 2, kThreshold, catalogue.doors[1]);
  for (double share : {0.2, 0.8})
    add_window(house, shop, share * width, 0.5, catalogue.tall_windows[1]);
  const WindowModel& window = house.choose(catalogue.tall_windows);
  if (r.chance(0.6))
    add_bay(house, body.front, house.width / 2, facade.floors[1] + 0.15,
            (floors - 1) * floor_height - 0.5, floor_height, house.choose(catalogue.bays),
            catalogue.windows[0]);
  for (int wall : {body.front, body.right, body.back, body.left})
    add_windows(house, wall, facade, window);
  for (int roof : {0, 2}) {
    const double length = house.solid.facet(body.roofs[roof]).width();
    for (double share : {0.22, 0.5, 0.78})
      add_dormer(house, body.roofs[roof], share * length, 0.5, catalogue.dormers[1]);
  }
  const Facet& top = house.solid.facet(body.roofs[4]);
  add_chimney(house, body.roofs[4], 0.2 * top.width(), 0.4 * top.height(),
              house.choose(catalogue.chimneys));
  return house;
}

House make_detached(std::uint64_t seed, const Catalogue& catalogue) {
  House house("gable_house", seed);
  Random& r = house.random;
  const int floors = 1 + r.pick(2);
  const double floor_height = r.size(2.7, 2.9);
  house.width = r.size(9.5, 12.5), house.depth = r.size(8, 9.5);
  const Body body = add_gable_body(house, {.eaves = kGround + floors * floor_height + 0.3,
                                           .slope = r.uniform(0.8, 1.1),
                                           .overhang = 0.5,
                                           .verge = 0.35,
                                           .thickness = 0.2});
  const WindowModel& window = house.choose(catalogue.windows);
  const Facade facade = make_facade(r, floors, floor_height);
  add_door(house, body.front, column_at(house, body.front, facade, r.uniform(0.2, 0.8)), kThreshold,
           catalogue.doors[0]);
  const double attic = kGround + floors * floor_height;
  add_balcony(house, body.right, house.depth / 2, attic, catalogue.balconies[0],
              catalogue.french_doors[0]);
  for (int wall : {body.front, body.right, body.back, body.left})
    add_windows(house, wall, facade, window);
  add_window(house, body.left, house.depth / 2, attic + 0.9, catalogue.windows[1]);
  add_dormers(house, body.roofs[0], 1 + r.pick(3), house.choose(catalogue.dormers));
  add_chimney_on(house, body.roofs[r.pick(2)], r.uniform(0.3, 0.7),
                 house.choose(catalogue.chimneys));
  for (double share : {0.25, 0.75})
    if (r.chance(0.6)) add_roof_window(house, body.roofs[1], share * house.width, 2.0);
  return house;
}

House make_church(std::uint64_t seed, const Catalogue& catalogue) {
  House house("church", seed);
  Random& r = house.random;
  house.width = r.size(10, 12), house.depth = r.size(18, 22);
  const RoofShape shape = {
      .eaves = r.size(7, 8), .slope = r.uniform(1.0, 1.2), .overhang = 0.3, .thickness = 0.2};
  const double ridge = shape.eaves + shape.slope * house.width / 2;
  const double tower = r.size(5, 5.8), height = ridge + r.size(5, 7);
  const ChurchBody body = add_church_body(house, shape, tower, height);
  const WindowModel &nave = catalogue.arched_windows[0], &belfry = catalogue.arched_windows[1];
  add_door(house, body.tower.front, tower / 2, kThreshold, catalogue.doors[1]);
  for (int wall : {body.tower.front, body.tower.left, body.tower.right})
    for (double share : {0.3, 0.7}) add_window(house, wall, share * tower, height - 3, belfry);
  add_window(house, body.tower.front, tower / 2, 5.5, nave);
  add_window(house, body.tower.back, tower / 2, house.solid.facet(body.tower.back).height() - 2.8,
             belfry);
  for (int wall : {body.main.left, body.main.right}) {
    Facade facade = make_facade(r, 1, 3);
    facade.spacing = 3.6, facade.sill = 1.9;
    add_windows(house, wall, facade, nave);
  }
  add_door(house, body.main.back, house.width / 2, kThreshold, catalogue.doors[0]);
  for (double share : {0.3, 0.7})
    for (int roof : body.main.roofs)
      add_dormer(house, roof, share * house.depth, 1.5, catalogue.dormers[0]);
  return house;
}

using Maker = House (*)(std::uint64_t, const Catalogue&);
constexpr Maker kMakers[] = {make_row_house, make_villa,    make_apartments, make_winged_house,
                             make_shop,      make_detached, make_church};

}  // namespace

int style_count() { return static_cast<int>(std::size(kMakers)); }

House make_house(int style, std::uint64_t seed, const Catalogue& catalogue) {
  return kMakers[style](seed, catalogue);
}

}  // namespace colod::synth
