// *Based on:* houses, rows, courts, halls and sheds as the varied streets have them.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include "scene_house.h"

#include <algorithm>
#include <cmath>

namespace colod::synth {
namespace {

constexpr double kFirstFloor = 0.3;  // m above the ground

double eaves_of(int floors, double floor_height) { return kFirstFloor + floors * floor_height; }

House shaped(const Plot& plot, const Pool& pool, const std::string& style, int floors,
             double floor_height, ShapedRoof roof, SceneHouse& out) {
  House house(style, plot.seed);
  Random& r = house.random;
  house.width = plot.drawn.width, house.depth = plot.drawn.depth;
  Fitting fitting = draw_fitting(r, pool, floors, floor_height);
  fitting.recess_depth = 0.28 * plot.drawn.wing;
  const bool has_parapet = roof.kind == RoofKind::kFlat && roof.overhang == 0;
  const double eaves =
      eaves_of(floors, floor_height) + r.uniform(0.1, 0.6) + (has_parapet ? roof.parapet : 0);
  const ShapedBody body = add_shaped_body(house, plot.drawn.plan, eaves, roof, {});
  fit_walls(house, body, fitting);
  fit_roofs(house, body, fitting);
  out.footprint = roof.overhang > 0 ? plot.drawn.plan.grown(roof.overhang) : plot.drawn.plan;
  return house;
}

House make_detached(const Plot& plot, const Pool& pool, SceneHouse& out) {
  Random r(plot.seed ^ 0x51ed270bull);
  ShapedRoof roof = draw_roof(r, plot.drawn);
  const bool is_small = plot.drawn.width * plot.drawn.depth < 110;
  const int floors = 1 + r.pick(is_small ? 2 : 3);
  return shaped(plot, pool, "house", floors, r.size(2.5, 3.2), roof, out);
}

House make_court(const Plot& plot, const Pool& pool, SceneHouse& out) {
  Random r(plot.seed ^ 0x51ed270bull);
  ShapedRoof roof = draw_roof(r, plot.drawn);
  return shaped(plot, pool, "court", 2 + r.pick(3), r.size(2.8, 3.5), roof, out);
}

House make_office(const Plot& plot, const Pool& pool, SceneHouse& out) {
  Random r(plot.seed ^ 0x7f4a7c15ull);
  ShapedRoof roof;
  roof.kind = RoofKind::kFlat;
  roof.parapet = r.size(0.3, 1.2), roof.parapet_width = r.size(0.2, 0.5);
  return shaped(plot, pool, "office", 2 + r.pick(4), r.size(3, 3.8), roof, out);
}

/// A garden shed: one slope or a small gable, no windows.
House make_shed(const Plot& plot, SceneHouse& out) {
  House house("shed", plot.seed);
  Random& r = house.random;
  const double depth = house.depth = plot.drawn.depth;
  house.width = plot.drawn.width;
  const double eaves = r.size(2.1, 2.7);
  std::vector<Vec2> profile = {{0, eaves}};
  if (r.chance(0.5)) profile.emplace_back(depth / 2, eaves + depth * r.uniform(0.15, 0.35));
  profile.emplace_back(depth, profile.size() > 1 ? eaves : eaves + r.uniform(0.1, 0.5));
  add_profile_body(house, {.profile = profile});
  out.footprint = plot.drawn.plan;
  return house;
}

House make_hall(const Plot& plot, const Pool& pool, SceneHouse& out) {
  House house("hall", plot.seed);
  Random& r = house.random;
  house.width = plot.drawn.width, house.depth = plot.drawn.depth;
  const double eaves = r.size(4, 9);
  const ProfileBody body =
      add_profile_body(house, {.profile = draw_profile(r, house.depth, eaves)});
  Fitting fitting = draw_fitting(r, pool, 1, eaves);
  fitting.is_ribbon = r.chance(0.7), fitting.is_arched = false;
  fitting.sill = r.uniform(0.8, std::max(0.9, eaves - 3)), fitting.spacing = r.uniform(3, 8);
  DoorModel gate = fitting.makes.gate;
  gate.height = std::min(gate.height, eaves - 0.8);
  fit_door(house, body.front, r.uniform(0.2, 0.8), gate);
  for (const int wall : {body.front, body.right, body.back, body.left})
    if (r.chance(0.75)) fit_wall_windows(house, wall, eaves, fitting);
  out.footprint = plot.drawn.plan;
  return house;
}

/// Its ridge lies along the row; a third of them are as high as all of the row, others by floors.
House make_row_house(const Plot& plot, const Pool& pool, SceneHouse& out) {
  Random alike(plot.row * 48271 + 7), r(plot.seed ^ 0x2545f491ull);
  const double floor_height = alike.size(2.6, 3.2), slope = alike.uniform(0.45, 1.0);
  const bool is_pitched = !alike.chance(0.2);
  const int floors = 2 + alike.pick(3) + (r.chance(0.3) ? 1 : 0) - (r.chance(0.15) ? 1 : 0);
  House house("row_house", plot.seed);
  const double depth = house.depth = plot.drawn.depth;
  house.width = plot.drawn.width;
  const double eaves =
      eaves_of(floors, floor_height) + 0.3 + (r.chance(0.5) ? r.size(-0.3, 0.4) : 0);
  std::vector<Vec2> profile = {{0, eaves}, {depth, eaves}};
  if (is_pitched)
    profile.insert(profile.begin() + 1, Vec2(depth / 2, eaves + slope * depth / 2));
  else
    profile.back().y() += r.uniform(0.1, 0.4);
  const ProfileBody body = add_profile_body(house, {.profile = profile});
  Fitting fitting = draw_fitting(house.random, pool, floors, floor_height);
  fit_door(house, body.front, r.uniform(0.2, 0.8), fitting.makes.door);
  for (const int wall : {body.front, body.back}) fit_wall_windows(house, wall, eaves, fitting);
  for (const int facet : body.roofs) {
    const Facet& roof = house.solid.facet(facet);
    const double width = roof.width(), height = roof.height();
    if (is_pitched && slope > 0.6 && r.chance(0.4))
      add_shaped_dormer(house, facet, width / 2, 0.35 * height, fitting.makes.dormer);
    if (r.chance(0.5))
      add_chimney(house, facet, r.uniform(0.2, 0.8) * width, 0.7 * height, fitting.makes.chimney);
  }
  out.footprint = plot.drawn.plan;
  return house;
}

}  // namespace

SceneHouse make_scene_house(const Plot& plot, const Pool& pool) {
  SceneHouse out{House("", 0), {}};
  switch (plot.kind) {
    case PlotKind::kDetached:
      out.house = make_detached(plot, pool, out);
      break;
    case PlotKind::kRow:
      out.house = make_row_house(plot, pool, out);
      break;
    case PlotKind::kCourt:
      out.house = make_court(plot, pool, out);
      break;
    case PlotKind::kHall:
      out.house = make_hall(plot, pool, out);
      break;
    case PlotKind::kOffice:
      out.house = make_office(plot, pool, out);
      break;
    case PlotKind::kShed:
      out.house = make_shed(plot, out);
      break;
  }
  return out;
}

SynthBuilding place_scene_house(const SceneHouse& made, const Plot& plot, const std::string& name,
                                bool is_local) {
  SynthBuilding building;
  building.style = made.house.style;
  building.parts = made.house.parts;
  building.source.name = building.source.path = name;
  building.source.mesh = made.house.solid.triangulate(building.source.face_object);
  const Vec2 origin = is_local ? Vec2(Vec2::Zero()) : plot.origin;
  const double foot = is_local ? 0 : plot.foot;
  const Eigen::Rotation2Dd turn(plot.yaw);
  for (Vec3& v : building.source.mesh.vertices) {
    const Vec2 p = turn * Vec2(v.head<2>()) + origin;
    v = Vec3(p.x(), p.y(), v.z() + foot).unaryExpr([](double x) {
      return std::round(x * 1e6) / 1e6;
    });
  }
  return building;
}

}  // namespace colod::synth
