// *Based on:* facades with a ground floor, equal floors above and parts in columns.
//
// *Differs:* no --rules here.
//
// *Notation:* u, v: a facet's coordinates, right and up.
#include "fittings.h"

#include <algorithm>
#include <cmath>

namespace colod::synth {
namespace {

constexpr double kOverGround = 0.12;  // m of doors' foot
constexpr double kFromCorner = 0.7;   // m of recesses from a corner, more than windows are deep
constexpr double kFromWall = 2.6;     // m of what sticks out from a wall that stands before

/// The foot of a wall that stands on sloping ground, at its highest between two places.
double foot_between(const House& house, int facet, double u0, double u1) {
  const Facet& f = house.solid.facet(facet);
  double highest = 0;
  for (double u : {u0, u1}) {
    const Vec3 p = f.at(u, 0);
    highest = std::max(highest, house.ground.at(p.head<2>()) - f.origin.z());
  }
  return highest;
}

/// The facet's v at a height.
double level_on(const House& house, int facet, double z) {
  return z - house.solid.facet(facet).origin.z();
}

/// Along a wall, without the ends where other walls stand before it.
Vec2 free_range(const House& house, const Wall& wall, double from_corner) {
  const double width = house.solid.facet(wall.facet).width();
  return {wall.is_corner_start ? from_corner : kFromWall,
          width - (wall.is_corner_end ? from_corner : kFromWall)};
}

/// One wall after the other.
class WallFitter {
 public:
  WallFitter(House& house, const Fitting& fitting) : house_(house), f_(fitting) {}

  void fit_street(const Wall& wall) {
    const Vec2 range = free_range(house_, wall, kFromCorner);
    // The ground may rise towards a recess's back.
    const double rise = f_.recess_depth * house_.ground.slope.norm();
    const double foot = foot_between(house_, wall.facet, range.x(), range.y()) + rise + kOverGround;
    const double room = level_on(house_, wall.facet, f_.floors[0] + f_.floor_height) - 0.3 - foot;
    if (f_.has_arcade && wall.is_whole) fit_arcade(wall, range, foot, room);
    if (f_.has_shop && wall.is_whole) {
      ShopFront shop = f_.makes.shop;
      shop.height = std::min(shop.height, room);
      shop.depth = std::min(shop.depth, f_.recess_depth);
      if (shop.height > 2.2) add_shop_front(house_, wall.facet, range, foot, shop, f_.makes.door);
    }
    fit_columns(wall);
  }

  /// Balconies, loggias or a bay in columns over the floors.
  void fit_columns(const Wall& wall) {
    const Vec2 range = free_range(house_, wall, 0.3);
    const double length = range.y() - range.x();
    if (length < 3) return;
    const int columns = std::max(1, static_cast<int>(length / house_.random.uniform(5, 11)));
    const bool has_bay = f_.has_bay && wall.is_whole;
    for (int c = 0; c < columns; ++c) {
      const double u = range.x() + length * (c + 0.5) / columns;
      if (has_bay && c % 2 == 0 && fit_bay(wall, u)) continue;
      if (house_.random.chance(f_.balcony_share)) fit_balconies(wall, u);
    }
  }

  void fit_cornices(const Wall& wall) {
    const CorniceModel& cornice = f_.makes.cornice;
    Vec2 range = free_range(house_, wall, 0.08);
    const double top = level_on(house_, wall.facet, wall.top);
    if (f_.cornice_share > 0)
      add_cornice(house_, wall.facet, range.x(), range.y(), top - cornice.height - 0.04, cornice);
    CorniceModel course = cornice;
    course.name += "_course", course.height = 0.12;
    for (std::size_t i = 1; i < f_.floors.size(); ++i)
      if (house_.random.chance(f_.cornice_share))
        add_cornice(house_, wall.facet, range.x(), range.y(),
                    level_on(house_, wall.facet, f_.floors[i]) - 0.1, course);
  }

 private:
  void fit_arcade(const Wall& wall, const Vec2& range, double foot, double room) {
    ArcadeModel arcade = f_.makes.arcade;
    arcade.height = std::min(arcade.height, room);
    arcade.depth = std::min(arcade.depth, f_.recess_depth);
    if (arcade.height < 2.2 || arcade.depth < 1.2) return;
    const int back = add_arcade(house_, wall.facet, range, foot, arcade);
    if (back < 0) return;
    fit_door(house_, back, house_.random.uniform(0.2, 0.8), f_.makes.door);
    WindowModel window = f_.makes.ground_window;
    window.height = std::min(window.height, arcade.height - 1.1);
    for (double u : facade_columns(house_, back, f_.spacing))
      add_window(house_, back, u, 0.8, window);
  }

  bool fit_bay(const Wall& wall, double u) {
    const BayModel& bay = f_.makes.bay;
    const double foot = foot_between(house_, wall.facet, u - bay.width / 2, u + bay.width / 2);
    const bool from_ground = house_.random.chance(0.5);
    const double v = from_ground
                         ? foot + 0.2
                         : level_on(house_, wall.facet,
                                    f_.floors[std::min<std::size_t>(1, f_.floors.size() - 1)]);
    const double height = level_on(house_, wall.facet, wall.top) - 0.5 - v;
    if (height < 2.2) return false;
    WindowModel window = f_.makes.window;
    window.width = std::min(window.width, bay.width - 2 * bay.splay - 0.5);
    window.name += "_bay";
    window.panes = std::min(window.panes, 1), window.rows = 1, window.surround = 0;
    window.has_sill = false;
    return add_bay(house_, wall.facet, u, v, height, f_.floor_height, bay, window);
  }

  void fit_balconies(const Wall& wall, double u) {
    BalconyModel balcony = f_.makes.balcony;
    LoggiaModel loggia = f_.makes.loggia;
    loggia.depth = std::min(loggia.depth, f_.recess_depth);
    loggia.height = std::min(loggia.height, f_.floor_height - 0.4);
    for (std::size_t i = 1; i < f_.floors.size(); ++i) {
      const double v = level_on(house_, wall.facet, f_.floors[i]);
      const Vec2 range = free_range(house_, wall, 0.25);
      if (u - balcony.width / 2 < range.x() || u + balcony.width / 2 > range.y()) return;
      BalconyModel here = balcony;
      if (i > 1 || f_.has_arcade || f_.has_bay || !wall.is_whole) here.pillars = 0;
      if (f_.has_loggias)
        add_loggia(house_, wall.facet, u, v, loggia, f_.makes.french);
      else
        add_balcony(house_, wall.facet, u, v, here, f_.makes.french);
    }
  }

  House& house_;
  const Fitting& f_;
};

/// In a row along the roof, as many as it has room for or fewer.
void fit_dormers(House& house, int roof, const ShapedDormer& dormer) {
  const Facet& f = house.solid.facet(roof);
  const double width = f.width(), height = f.height();
  const int most = static_cast<int>(width / (dormer.width + 1.2));
  if (most < 1) return;
  const int count = 1 + house.random.pick(std::min(most, 6));
  const double v = house.random.uniform(0.06, 0.25) * height + 0.2;
  for (int i = 0; i < count; ++i)
    add_shaped_dormer(house, roof, width * (i + 0.5) / count, v, dormer);
}

void fit_chimneys(House& house, int roof, const ChimneyModel& model) {
  const double width = house.solid.facet(roof).width(), height = house.solid.facet(roof).height();
  for (int attempt = 0; attempt < 4; ++attempt)
    if (add_chimney(house, roof, house.random.uniform(0.1, 0.9) * width,
                    house.random.uniform(0.4, 0.85) * height, model))
      return;
}

void fit_deck(House& house, int deck, const Fitting& fitting) {
  Random& r = house.random;
  const double width = house.solid.facet(deck).width(), height = house.solid.facet(deck).height();
  const double w = r.uniform(2.2, std::max(2.3, 0.5 * width)),
               d = r.uniform(2.2, std::max(2.3, 0.4 * height));
  const double u = r.uniform(0, width - w), v = r.uniform(0, height - d);
  if (r.chance(0.7))
    add_penthouse(house, deck, {u, v, u + w, v + d}, r.size(2.2, 3.4), fitting.makes.window);
  const int vents = r.pick(6);
  for (int i = 0; i < vents; ++i)
    add_chimney(house, deck, r.uniform(0, width), r.uniform(0, height), fitting.makes.chimney);
}

}  // namespace

bool fit_door(House& house, int facet, double share, const DoorModel& door) {
  const double width = house.solid.facet(facet).width();
  const double u = std::clamp(share * width, door.width / 2 + 0.3,
                              std::max(door.width / 2 + 0.3, width - door.width / 2 - 0.3));
  for (double shift : {0.0, 1.2, -1.2, 2.6, -2.6, 4.4, -4.4}) {
    const double at = u + shift;
    const double foot = foot_between(house, facet, at - door.width / 2, at + door.width / 2);
    if (add_door(house, facet, at, foot + kOverGround, door)) return true;
  }
  return false;
}

void fit_wall_windows(House& house, int facet, double top, const Fitting& fitting) {
  for (std::size_t i = 0; i < fitting.floors.size(); ++i) {
    const Makes& m = fitting.makes;
    WindowModel window = fitting.is_ribbon   ? m.ribbon
                         : fitting.is_arched ? m.arched
                         : i == 0            ? m.ground_window
                                             : m.window;
    const double most = fitting.floor_height - fitting.sill - 0.35;
    window.height = std::min(window.height, most);
    if (window.is_arched && window.height < window.width / 2 + 0.2) continue;
    const double v = level_on(house, facet, fitting.floors[i] + fitting.sill);
    if (fitting.floors[i] + fitting.sill + window.height > top) continue;
    const double spacing = std::max(fitting.spacing, window.width + 0.55);
    for (double u : facade_columns(house, facet, spacing)) add_window(house, facet, u, v, window);
  }
}

void fit_walls(House& house, const ShapedBody& body, const Fitting& fitting) {
  WallFitter fitter(house, fitting);
  bool has_door = false;
  for (const Wall& wall : body.walls) {
    if (wall.is_street) {
      fitter.fit_street(wall);
      if (!has_door || house.random.chance(0.2))
        has_door =
            fit_door(house, wall.facet, house.random.uniform(0.1, 0.9), fitting.makes.door) ||
            has_door;
    } else if (std::abs(house.solid.facet(wall.facet).normal.y()) > 0.9 && !fitting.has_arcade) {
      fitter.fit_columns(wall);
    }
  }
  if (!has_door && !body.walls.empty())
    fit_door(house, body.walls[0].facet, 0.5, fitting.makes.door);
  for (const Wall& wall : body.walls) {
    const bool is_side = std::abs(house.solid.facet(wall.facet).normal.x()) > 0.9;
    if (is_side && fitting.side_share == 0) continue;  // a neighbour's wall stands before it
    fitter.fit_cornices(wall);
    if (!is_side || house.random.chance(fitting.side_share))
      fit_wall_windows(house, wall.facet, wall.top, fitting);
  }
  for (const Wall& wall : body.block_walls) fit_wall_windows(house, wall.facet, wall.top, fitting);
  for (int gable : body.roof.gables) {
    const Facet& f = house.solid.facet(gable);
    add_window(house, gable, f.width() / 2, 0.14 * f.height() + 0.3, fitting.makes.side_window);
  }
}

void fit_roofs(House& house, const ShapedBody& body, const Fitting& fitting) {
  Random& r = house.random;
  for (int roof : body.roof.slopes) {
    if (r.chance(0.5)) fit_dormers(house, roof, fitting.makes.dormer);
    if (r.chance(0.35)) fit_chimneys(house, roof, fitting.makes.chimney);
    for (int i = r.chance(0.4) ? 1 + r.pick(4) : 0; i > 0; --i)
      add_roof_window(house, roof, r.uniform(0, house.solid.facet(roof).width()),
                      r.uniform(0.1, 0.7) * house.solid.facet(roof).height());
  }
  for (int deck : body.decks) fit_deck(house, deck, fitting);
}

}  // namespace colod::synth
