// *Based on:* houses, halls and offices as they stand in European streets. Every number is drawn
// from a wide range; makes come from the street's pool.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include "variety.h"

#include <algorithm>
#include <cmath>

#include "fittings.h"
#include "plans.h"

namespace colod::synth {
namespace {

constexpr double kGroundFloor = 0.3;  // m above the highest ground
constexpr double kMostRise = 9;       // m of a roof over its eaves
constexpr double kMostGround = 0.22;  // rise over run
constexpr double kMostDrop = 3.5;     // m of ground along a house

/// Highest at the house's highest corner, where it is level with the floor of an ordinary house.
void lay_ground(House& house, bool has_sloping_ground) {
  if (!has_sloping_ground || house.random.chance(0.2)) return;
  constexpr double kApart = 6;  // m that blocks reach beyond the plan
  const double length = house.width + house.depth + 4 * kApart;
  const double steep = std::min(house.random.uniform(0.02, kMostGround), kMostDrop / length);
  const double angle = house.random.uniform(0, 2 * M_PI);
  house.ground.slope = steep * Vec2(std::cos(angle), std::sin(angle));
  double highest = 0;
  for (double x : {-kApart, house.width + kApart})
    for (double y : {-kApart, house.depth + kApart})
      highest = std::max(highest, house.ground.at({x, y}));
  house.ground.height = -highest;
}

/// Steep roofs over wide wings are no higher than roofs are.
double draw_slope(Random& r, double span) {
  return std::min(r.uniform(0.3, 1.7), 2 * kMostRise / span);
}

}  // namespace

Fitting draw_fitting(Random& r, const Pool& pool, int floors, double floor_height) {
  Fitting f;
  f.makes = pool.draw(r);
  f.floor_height = floor_height;
  for (int i = 0; i < floors; ++i) f.floors.push_back(kGroundFloor + i * floor_height);
  f.spacing = r.uniform(1.8, 4.2);
  f.side_share = r.uniform(0, 1);
  f.sill = r.uniform(0.35, 1.0);
  f.has_arcade = r.chance(0.15);
  f.has_shop = !f.has_arcade && floors > 1 && r.chance(0.25);
  f.has_bay = r.chance(0.25);
  f.has_loggias = r.chance(0.3);
  f.is_arched = r.chance(0.08);
  f.balcony_share = r.chance(0.6) ? r.uniform(0.2, 1) : 0;
  f.cornice_share = r.chance(0.4) ? r.uniform(0.3, 1) : 0;
  return f;
}

ShapedRoof draw_roof(Random& r, const DrawnPlan& drawn) {
  ShapedRoof roof;
  const double kind = r.uniform(0, 1);
  roof.kind = kind < 0.6 ? RoofKind::kHipped : kind < 0.82 ? RoofKind::kFlat : RoofKind::kMansard;
  roof.overhang = r.chance(0.7) ? r.size(0.1, 0.9) : 0;
  roof.thickness = r.size(0.1, 0.35);
  roof.hips.slope = draw_slope(r, drawn.plan.has_court() ? 8 : std::max(drawn.wing, 6.0) + 4);
  roof.hips.gable_share = r.chance(0.5) ? r.uniform(0.3, 1) : 0;
  roof.hips.steep_share = r.chance(0.3) ? 0.7 : 0;
  roof.hips.gable_object = roof.overhang > 0 ? kRoof : kBody;
  if (roof.overhang == 0 && roof.kind == RoofKind::kHipped && r.chance(0.5)) {
    roof.hips.step_thickness = r.size(0.25, 0.5);
    roof.hips.steps = 2 + r.pick(5);
    roof.hips.gable_share = std::max(0.7, roof.hips.gable_share);
  }
  if (roof.kind == RoofKind::kFlat) {
    roof.parapet = r.chance(0.8) ? r.size(0.25, 1.2) : 0;
    roof.parapet_width = r.size(0.15, 0.45);
  }
  if (roof.kind == RoofKind::kMansard) {
    roof.hips.slope = r.uniform(1.3, 3.2);
    roof.run = r.size(0.9, std::min(1.8, 0.3 * drawn.wing));
    roof.upper_slope = r.chance(0.5) ? r.uniform(0.15, 0.45) : 0;
  }
  return roof;
}

std::vector<Vec2> draw_profile(Random& r, double depth, double eaves) {
  const int kind = r.pick(4);
  std::vector<Vec2> profile = {{0, eaves}};
  if (kind == 0) {  // one pitch to the back
    profile.emplace_back(depth, eaves + depth * r.uniform(0.02, 0.15));
  } else if (kind == 1) {
    const int teeth = std::max(2, static_cast<int>(depth / r.uniform(4.5, 9)));
    const double rise = r.uniform(1, 2.6), run = r.uniform(0.25, 0.9);
    for (int i = 0; i < teeth; ++i) {
      profile.emplace_back(i * depth / teeth + run, eaves + rise);
      profile.emplace_back((i + 1) * depth / teeth, eaves);
    }
  } else if (kind == 2) {
    const double rise = depth * r.uniform(0.12, 0.4);
    constexpr int kSteps = 12;
    for (int i = 1; i < kSteps; ++i)
      profile.emplace_back(depth * (1 - std::cos(M_PI * i / kSteps)) / 2,
                           eaves + rise * std::sin(M_PI * i / kSteps));
    profile.emplace_back(depth, eaves);
  } else {
    const double ridge = depth * (r.chance(0.7) ? 0.5 : r.uniform(0.3, 0.7));
    profile.emplace_back(ridge, eaves + 0.5 * depth * r.uniform(0.06, 0.7));
    profile.emplace_back(depth, eaves);
  }
  return profile;
}

namespace {

/// A tower or an annex before some edges between two corners that stand out.
std::vector<Block> draw_blocks(Random& r, const std::vector<Vec2>& ring, double eaves,
                               const ShapedRoof& roof, double tower_share) {
  std::vector<Block> blocks;
  const std::size_t n = ring.size();
  const auto turns_left = [&](std::size_t i) {
    const Vec2 u = ring[i] - ring[(i + n - 1) % n], v = ring[(i + 1) % n] - ring[i];
    return u.x() * v.y() - u.y() * v.x() > 0;
  };
  for (std::size_t i = 0; i < n && blocks.size() < 2; ++i) {
    const double length = (ring[(i + 1) % n] - ring[i]).norm();
    if (!turns_left(i) || !turns_left((i + 1) % n) || length < 6.5 || !r.chance(0.2 + tower_share))
      continue;
    Block b;
    b.edge = static_cast<int>(i);
    b.width = r.size(2.6, std::min(7.0, length - 3.2));
    b.start = r.size(1.5, length - 1.6 - b.width);
    b.depth = r.size(1.5, 5);
    const bool is_tower = roof.overhang == 0 && r.chance(0.3 + tower_share);
    if (is_tower) {
      b.height = eaves + r.size(2, 5 + 20 * tower_share);
      b.spire = r.chance(0.6) ? b.width * r.uniform(0.4, 2.5) : 0;
      b.sides = r.chance(0.4) ? 5 + r.pick(4) : 4;
    } else {
      b.height = std::min(r.size(2.4, 4.2), eaves - 0.4);
      b.slope = r.chance(0.5) ? r.uniform(0.05, std::min(0.3, 0.5 / b.depth)) : 0;
    }
    blocks.push_back(b);
  }
  return blocks;
}

/// What stands before the plan, behind and beside it, with balconies.
void keep_room(House& house, const Plan& plan) {
  constexpr double kBalcony = 2.2;
  house.before = kBalcony, house.beside = 1;
  for (int f = 0; f < house.solid.facet_count(); ++f) {
    const Facet& facet = house.solid.facet(f);
    for (const Vec2& p : facet.outer) {
      const Vec3 at = facet.at(p.x(), p.y());
      house.before = std::max({house.before, -at.y(), at.y() - bounds(plan.outer).v1});
      house.beside = std::max({house.beside, -at.x(), at.x() - bounds(plan.outer).u1});
    }
  }
}

/// Through the front wing, from the street into the court or to the back.
void fit_passage(House& house, const ShapedBody& body, const Fitting& fitting) {
  for (const Wall& front : body.walls)
    for (const Wall& back : body.walls) {
      const Facet &f = house.solid.facet(front.facet), &b = house.solid.facet(back.facet);
      if (!front.is_street || b.normal.y() < 0.9 || !front.is_whole || !back.is_whole) continue;
      const double depth = b.origin.y() - f.origin.y(), width = house.random.uniform(2.2, 3.6);
      if (depth < 3 || depth > 14 || f.width() < width + 6) continue;
      const double v = kGroundFloor - f.origin.z() - 0.15;
      const double height = fitting.floor_height - 0.3;
      if (add_passage(house, front.facet, back.facet, house.random.uniform(0.3, 0.7) * f.width(), v,
                      width, height))
        return;
    }
}

struct Kind {
  std::string style;
  int floors;
  double floor_height, tower_share;
};

House finish_house(House house, const DrawnPlan& drawn, const Kind& kind, ShapedRoof roof,
                   Fitting fitting, bool has_sloping_ground) {
  Random& r = house.random;
  house.width = drawn.width, house.depth = drawn.depth;
  lay_ground(house, has_sloping_ground);
  const double eaves = kGroundFloor + kind.floors * kind.floor_height + r.uniform(0.1, 0.7) +
                       (roof.kind == RoofKind::kFlat && roof.overhang == 0 ? roof.parapet : 0);
  const auto blocks = kind.style == "row_house"
                          ? std::vector<Block>()
                          : draw_blocks(r, drawn.plan.outer, eaves, roof, kind.tower_share);
  if (std::any_of(blocks.begin(), blocks.end(), [&](const Block& b) { return b.height > eaves; }))
    roof.hips.gable_share = 0;  // a tower stands where the gable would
  const ShapedBody body = add_shaped_body(house, drawn.plan, eaves, roof, blocks);
  fitting.recess_depth = 0.28 * drawn.wing;
  if (r.chance(drawn.plan.has_court() ? 0.9 : 0.12)) fit_passage(house, body, fitting);
  fit_walls(house, body, fitting);
  fit_roofs(house, body, fitting);
  if (kind.style != "row_house") keep_room(house, drawn.plan);
  return house;
}

House make_plan_house(const Pool& pool, std::uint64_t seed, bool has_sloping_ground) {
  Random r(seed ^ 0x51ed270bull);
  const DrawnPlan drawn = draw_plan(r, r.uniform(0.2, 1.4));
  const int most = drawn.width * drawn.depth < 90 ? 3 : 7;
  const Kind kind = {"varied_" + drawn.name, 1 + std::min(r.pick(most), r.pick(most)),
                     r.size(2.5, 3.6), r.chance(0.2) ? 0.4 : 0.0};
  const ShapedRoof roof = draw_roof(r, drawn);
  return finish_house(House(kind.style, seed), drawn, kind, roof,
                      draw_fitting(r, pool, kind.floors, kind.floor_height), has_sloping_ground);
}

/// Walls towards the neighbours are gables without windows.
House make_row_house(const Pool& pool, std::uint64_t street, std::uint64_t seed,
                     bool has_sloping_ground) {
  Random r(seed ^ 0x2545f491ull), alike(street * 48271 + 7);
  const DrawnPlan drawn = draw_rectangle(r, 4.8, 9, 7.5, 12.5);
  const Kind kind = {"row_house", 2 + r.pick(3), alike.size(2.5, 3.3), 0};
  ShapedRoof roof;
  roof.hips = {.slope = draw_slope(alike, drawn.depth),
               .gable_share = drawn.width > drawn.depth ? 1.0 : 0.0};
  if (drawn.width <= drawn.depth || r.chance(0.3))
    roof.kind = RoofKind::kFlat, roof.parapet = r.size(0.3, 0.9);
  if (r.chance(0.3)) roof.hips.step_thickness = 0.3;
  roof.hips.gable_object = kBody;
  Fitting fitting = draw_fitting(r, pool, kind.floors, kind.floor_height);
  fitting.side_share = 0;
  return finish_house(House(kind.style, seed), drawn, kind, roof, fitting, has_sloping_ground);
}

House make_office(const Pool& pool, std::uint64_t seed, bool has_sloping_ground) {
  Random r(seed ^ 0x7f4a7c15ull);
  const DrawnPlan drawn =
      r.chance(0.6) ? draw_rectangle(r, 16, 34, 11, 24) : draw_plan(r, r.uniform(1, 1.4));
  const Kind kind = {"office", 2 + r.pick(8), r.size(3, 4.2), r.chance(0.3) ? 0.3 : 0.0};
  ShapedRoof roof;
  roof.kind = RoofKind::kFlat;
  roof.parapet = r.size(0.3, 1.4), roof.parapet_width = r.size(0.2, 0.5);
  Fitting fitting = draw_fitting(r, pool, kind.floors, kind.floor_height);
  fitting.is_ribbon = r.chance(0.75), fitting.is_arched = false, fitting.balcony_share = 0;
  fitting.spacing = r.uniform(2, 4.5), fitting.side_share = 1;
  return finish_house(House(kind.style, seed), drawn, kind, roof, fitting, has_sloping_ground);
}

House make_hall(const Pool& pool, std::uint64_t seed, bool has_sloping_ground) {
  House house("hall", seed);
  Random& r = house.random;
  house.width = r.size(16, 55), house.depth = r.size(10, 25);
  lay_ground(house, has_sloping_ground);
  const double eaves = r.size(4, 12);
  ProfileRoof roof = {.profile = draw_profile(r, house.depth, eaves)};
  if (r.chance(0.5))
    roof.wave_length = r.uniform(0.3, 1.2), roof.wave_height = r.uniform(0.04, 0.15);
  const ProfileBody body = add_profile_body(house, roof);
  Fitting fitting = draw_fitting(r, pool, 1, eaves);
  fitting.is_ribbon = r.chance(0.7), fitting.is_arched = false;
  fitting.sill = r.uniform(0.8, std::max(0.9, eaves - 3)), fitting.spacing = r.uniform(3, 8);
  DoorModel gate = fitting.makes.gate;
  gate.height = std::min(gate.height, eaves - 0.8);
  for (int wall : {body.front, r.chance(0.5) ? body.left : body.right}) {
    fit_door(house, wall, r.uniform(0.2, 0.8), gate);
    fit_door(house, wall, r.uniform(0.1, 0.9), fitting.makes.door);
  }
  for (int wall : {body.front, body.right, body.back, body.left})
    if (r.chance(0.75)) fit_wall_windows(house, wall, eaves, fitting);
  for (int facet : body.roofs) {
    if (house.solid.facet(facet).normal.z() < 0.6) continue;
    for (int i = r.pick(3); i > 0; --i)
      add_chimney(house, facet, r.uniform(0, house.width),
                  r.uniform(0, house.solid.facet(facet).height()), fitting.makes.chimney);
    if (r.chance(0.3)) add_roof_window(house, facet, r.uniform(0, house.width), 1);
  }
  return house;
}

}  // namespace

House make_varied_house(int index, std::uint64_t seed, const SynthOptions& options) {
  const Pool pool(options.seed);
  Random r(seed ^ 0x1b873593ull);
  const double kind = r.uniform(0, 1);
  const bool slopes = options.has_slopes;
  if (options.plans == SynthPlans::kHalls) return make_hall(pool, seed, slopes);
  if (options.plans == SynthPlans::kOffices) return make_office(pool, seed, slopes);
  if (index % 11 < 3) return make_row_house(pool, options.seed, seed, slopes);
  if (kind < 0.13) return make_hall(pool, seed, slopes);
  if (kind < 0.26) return make_office(pool, seed, slopes);
  return make_plan_house(pool, seed, slopes);
}

}  // namespace colod::synth
