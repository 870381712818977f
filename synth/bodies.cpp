// *Based on:* roofs of equal slope over rectangles, written down as polygons.
//
// *Differs:* no --rules here.
//
// *Notation:* L, D: a footprint's length along x and its depth along y; ze: height of the eaves
// where the walls end; zs, zb: bottom and top of the roof's edge board; zr: ridge.
#include "bodies.h"

#include <algorithm>

#include "outlines.h"

namespace colod::synth {
namespace {

/// Upright quadrangles over a polygon's edges; returns one facet per edge.
std::vector<int> add_walls(Solid& solid, const std::vector<Vec2>& polygon, double z0, double z1,
                           int object) {
  std::vector<int> walls;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    walls.push_back(solid.add(
        {{a.x(), a.y(), z0}, {b.x(), b.y(), z0}, {b.x(), b.y(), z1}, {a.x(), a.y(), z1}}, object));
  }
  return walls;
}

/// Roof planes over an axis-parallel rectangle, hipped on the short sides. Front, right, back,
/// left.
std::vector<int> add_hips(Solid& solid, double x0, double y0, double x1, double y1, double z,
                          double slope, int object) {
  const double half = std::min(x1 - x0, y1 - y0) / 2, zr = z + slope * half;
  const Vec3 a(x0, y0, z), b(x1, y0, z), c(x1, y1, z), d(x0, y1, z);
  const Vec3 p(x0 + half, y0 + half, zr), q(x1 - half, y1 - half, zr);
  if ((p - q).norm() < 1e-3)
    return {solid.add({a, b, p}, object), solid.add({b, c, p}, object),
            solid.add({c, d, p}, object), solid.add({d, a, p}, object)};
  if (x1 - x0 > y1 - y0)
    return {solid.add({a, b, q, p}, object), solid.add({b, c, q}, object),
            solid.add({c, d, p, q}, object), solid.add({d, a, p}, object)};
  return {solid.add({a, b, p}, object), solid.add({b, c, q, p}, object),
          solid.add({c, d, q}, object), solid.add({d, a, p, q}, object)};
}

/// The closed cross-section of a gabled house with its roof's thickness, from the foot in front.
struct Profile {
  double depth, ze, zs, zr, overhang, thickness;

  Profile(const RoofShape& s, double d)
      : depth(d),
        ze(s.eaves),
        zs(s.eaves - s.overhang * s.slope),
        zr(s.eaves + s.slope * d / 2),
        overhang(s.overhang),
        thickness(s.thickness) {}
  Vec3 wall(double x, bool is_back) const { return {x, is_back ? depth : 0, ze}; }
  Vec3 edge(double x, bool is_back, bool is_top) const {
    return {x, is_back ? depth + overhang : -overhang, zs + (is_top ? thickness : 0)};
  }
  Vec3 ridge(double x, bool is_top) const { return {x, depth / 2, zr + (is_top ? thickness : 0)}; }
};

/// Upper sides, edge boards and undersides of a gabled roof between x0 − verge and x1 + verge.
std::vector<int> add_gable_roof(Solid& solid, const Profile& p, double x0, double x1,
                                double verge) {
  const double a = x0 - verge, b = x1 + verge;
  const std::vector<int> roofs = {
      solid.add(
          {p.edge(a, false, true), p.edge(b, false, true), p.ridge(b, true), p.ridge(a, true)},
          kRoof),
      solid.add({p.edge(b, true, true), p.edge(a, true, true), p.ridge(a, true), p.ridge(b, true)},
                kRoof)};
  solid.add({p.edge(a, false, false), p.edge(b, false, false), p.edge(b, false, true),
             p.edge(a, false, true)},
            kRoof);
  solid.add({p.edge(b, true, false), p.edge(a, true, false), p.edge(a, true, true),
             p.edge(b, true, true)},
            kRoof);
  for (bool is_back : {false, true}) {
    std::vector<Vec3> under = {p.edge(a, is_back, false), p.edge(b, is_back, false)};
    if (verge > 0) under.insert(under.end(), {p.ridge(b, false), p.ridge(x1, false)});
    under.insert(under.end(), {p.wall(x1, is_back), p.wall(x0, is_back)});
    if (verge > 0) under.insert(under.end(), {p.ridge(x0, false), p.ridge(a, false)});
    solid.add(is_back ? under : reversed(under), kRoof);
  }
  return roofs;
}

std::vector<Vec3> chevron(const Profile& p, double x) {
  return {p.edge(x, false, false), p.ridge(x, false), p.edge(x, true, false),
          p.edge(x, true, true),   p.ridge(x, true),  p.edge(x, false, true)};
}

/// A house up to its eaves: floor, walls, soffit and the edge board all around.
struct WallsToEaves {
  Body body;  ///< without roofs
  std::vector<Vec2> eaves;
  double foot;  ///< of the roof [m]
};

WallsToEaves add_walls_to_eaves(House& house, const RoofShape& shape) {
  Solid& solid = house.solid;
  const auto footprint = rectangle(0, 0, house.width, house.depth);
  const auto eaves = offset(footprint, shape.overhang);
  solid.add(reversed(lifted(footprint, 0)), kBody);
  const auto walls = add_walls(solid, footprint, 0, shape.eaves, kBody);
  add_rim(solid, {eaves, {}}, {footprint, {}}, shape.eaves, false, kRoof);
  const double foot = shape.eaves + shape.thickness;
  add_walls(solid, eaves, shape.eaves, foot, kRoof);
  return {{walls[0], walls[1], walls[2], walls[3], {}}, eaves, foot};
}

}  // namespace

Body add_gable_body(House& house, const RoofShape& shape) {
  Solid& solid = house.solid;
  const double L = house.width, D = house.depth;
  const Profile p(shape, D);
  Body body;
  const auto footprint = rectangle(0, 0, L, D);
  solid.add(reversed(lifted(footprint, 0)), kBody);
  body.front = solid.add({{0, 0, 0}, {L, 0, 0}, p.wall(L, false), p.wall(0, false)}, kBody);
  body.back = solid.add({{L, D, 0}, {0, D, 0}, p.wall(0, true), p.wall(L, true)}, kBody);
  const auto gable = [&](double x) {
    std::vector<Vec3> corners = {{x, 0, 0}, {x, D, 0}, p.wall(x, true)};
    if (shape.verge > 0)
      corners.push_back(p.ridge(x, false));
    else
      corners.insert(corners.end(),
                     {p.edge(x, true, false), p.edge(x, true, true), p.ridge(x, true),
                      p.edge(x, false, true), p.edge(x, false, false)});
    corners.push_back(p.wall(x, false));
    return corners;
  };
  body.right = solid.add(gable(L), kBody);
  body.left = solid.add(reversed(gable(0)), kBody);
  if (shape.verge > 0) {
    solid.add(chevron(p, L + shape.verge), kRoof);
    solid.add(reversed(chevron(p, -shape.verge)), kRoof);
  }
  body.roofs = add_gable_roof(solid, p, 0, L, shape.verge);
  return body;
}

Body add_hip_body(House& house, const RoofShape& shape) {
  auto [body, eaves, foot] = add_walls_to_eaves(house, shape);
  body.roofs = add_hips(house.solid, eaves[0].x(), eaves[0].y(), eaves[2].x(), eaves[2].y(), foot,
                        shape.slope, kRoof);
  return body;
}

Body add_flat_body(House& house, double height) {
  constexpr double kParapetWidth = 0.25, kParapet = 0.4;
  Solid& solid = house.solid;
  const auto footprint = rectangle(0, 0, house.width, house.depth);
  solid.add(reversed(lifted(footprint, 0)), kBody);
  const auto walls = add_walls(solid, footprint, 0, height, kBody);
  const int top = solid.add(lifted(footprint, height), kRoof);
  const Rect inner = Rect{0, 0, house.width, house.depth}.grown(-kParapetWidth);
  return {walls[0],
          walls[1],
          walls[2],
          walls[3],
          {solid.extrude(top, inner.ring(), -kParapet, kRoof).cap}};
}

Body add_mansard_body(House& house, const RoofShape& shape, double run) {
  Solid& solid = house.solid;
  auto [body, eaves, foot] = add_walls_to_eaves(house, shape);
  const auto low = lifted(eaves, foot),
             high = lifted(offset(eaves, -run), foot + shape.slope * run);
  for (int i = 0; i < 4; ++i)
    body.roofs.push_back(solid.add({low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]}, kRoof));
  body.roofs.push_back(solid.add(high, kRoof));
  return body;
}

WingedBody add_winged_body(House& house, const RoofShape& shape, double wing_x, double wing_width,
                           double wing_depth) {
  Solid& solid = house.solid;
  const double L = house.width, D = house.depth, ze = shape.eaves, zb = ze + shape.thickness;
  const std::vector<Vec2> plan = {{0, 0},
                                  {wing_x, 0},
                                  {wing_x, -wing_depth},
                                  {wing_x + wing_width, -wing_depth},
                                  {wing_x + wing_width, 0},
                                  {L, 0},
                                  {L, D},
                                  {0, D}};
  const auto eaves = offset(plan, shape.overhang);
  solid.add(reversed(lifted(plan, 0)), kBody);
  const auto walls = add_walls(solid, plan, 0, ze, kBody);
  add_rim(solid, {eaves, {}}, {plan, {}}, ze, false, kRoof);

  const double x0 = eaves[0].x(), x1 = eaves[5].x(), y0 = eaves[0].y(), y1 = eaves[6].y();
  const double a = eaves[1].x(), b = eaves[4].x(), yw = eaves[2].y();
  const double ym = (y0 + y1) / 2, zr = zb + shape.slope * (y1 - y0) / 2;
  const double m = (a + b) / 2, zw = zb + shape.slope * (b - a) / 2, yv = y0 + (b - a) / 2;
  for (int i : {0, 1, 3, 4, 6}) {  // edge boards; the other three sides are gables
    const Vec2 &p = eaves[i], &q = eaves[i + 1];
    solid.add({{p.x(), p.y(), ze}, {q.x(), q.y(), ze}, {q.x(), q.y(), zb}, {p.x(), p.y(), zb}},
              kRoof);
  }
  WingedBody body;
  solid.add({{x1, y0, ze}, {x1, y1, ze}, {x1, y1, zb}, {x1, ym, zr}, {x1, y0, zb}}, kRoof);
  solid.add({{x0, y1, ze}, {x0, y0, ze}, {x0, y0, zb}, {x0, ym, zr}, {x0, y1, zb}}, kRoof);
  body.wing_gable =
      solid.add({{a, yw, ze}, {b, yw, ze}, {b, yw, zb}, {m, yw, zw}, {a, yw, zb}}, kRoof);
  const int front = solid.add({{x0, y0, zb},
                               {a, y0, zb},
                               {m, yv, zw},
                               {b, y0, zb},
                               {x1, y0, zb},
                               {x1, ym, zr},
                               {x0, ym, zr}},
                              kRoof);
  const int back = solid.add({{x1, y1, zb}, {x0, y1, zb}, {x0, ym, zr}, {x1, ym, zr}}, kRoof);
  const int left = solid.add({{a, yw, zb}, {m, yw, zw}, {m, yv, zw}, {a, y0, zb}}, kRoof);
  const int right = solid.add({{m, yw, zw}, {b, yw, zb}, {b, y0, zb}, {m, yv, zw}}, kRoof);
  body.main = {walls[0], walls[5], walls[6], walls[7], {front, back, left, right}};
  body.front_right = walls[4];
  body.wing_left = walls[1], body.wing_front = walls[2], body.wing_right = walls[3];
  return body;
}

namespace {

/// Draws a church in the coordinates of its profile: the ridge along x, the tower before x = 0.
struct ChurchDrawing {
  Solid& solid;
  double length, across;  ///< metres: the nave's
  Profile profile;
  double y0, y1;  ///< where the tower begins and ends
  double top0;    ///< metres: the nave's roof there

  /// A quarter turn, which keeps orientation, brings the gable at x = 0 to the street.
  int add(std::vector<Vec3> corners, int object) {
    for (Vec3& c : corners) c = Vec3(across - c.y(), c.x(), c.z());
    return solid.add(corners, object);
  }
};

/// The far gable whole, the near one on both sides of the tower.
int add_church_gables(ChurchDrawing& church) {
  const auto& [solid, length, across, p, y0, y1, top0] = church;
  const int back = church.add({{length, 0, 0},
                               {length, across, 0},
                               p.wall(length, true),
                               p.edge(length, true, false),
                               p.edge(length, true, true),
                               p.ridge(length, true),
                               p.edge(length, false, true),
                               p.edge(length, false, false),
                               p.wall(length, false)},
                              kBody);
  church.add(reversed({{0, 0, 0},
                       {0, y0, 0},
                       {0, y0, top0},
                       p.edge(0, false, true),
                       p.edge(0, false, false),
                       p.wall(0, false)}),
             kBody);
  church.add(reversed({{0, y1, 0},
                       {0, across, 0},
                       p.wall(0, true),
                       p.edge(0, true, false),
                       p.edge(0, true, true),
                       {0, y1, top0}}),
             kBody);
  return back;
}

/// Both roofs, each with its edge board and the underside of its overhang.
std::vector<int> add_church_roofs(ChurchDrawing& church) {
  const Profile& p = church.profile;
  const double length = church.length;
  std::vector<int> roofs;
  for (bool is_back : {false, true}) {
    std::vector<Vec3> roof = {p.edge(0, is_back, true), p.edge(length, is_back, true),
                              p.ridge(length, true), p.ridge(0, true)};
    std::vector<Vec3> board = {p.edge(0, is_back, false), p.edge(length, is_back, false),
                               p.edge(length, is_back, true), p.edge(0, is_back, true)};
    std::vector<Vec3> under = {p.wall(0, is_back), p.wall(length, is_back),
                               p.edge(length, is_back, false), p.edge(0, is_back, false)};
    roofs.push_back(church.add(is_back ? reversed(roof) : roof, kRoof));
    church.add(is_back ? reversed(board) : board, kRoof);
    church.add(is_back ? reversed(under) : under, kRoof);
  }
  return roofs;
}

/// Three walls from the ground, the fourth from the nave's roof.
Body add_tower(ChurchDrawing& church, double w, double h, int tower) {
  const auto& [solid, length, across, p, y0, y1, top0] = church;
  Body body;
  body.front = church.add({{-w, y1, 0}, {-w, y0, 0}, {-w, y0, h}, {-w, y1, h}}, tower);
  body.right = church.add({{-w, y0, 0}, {0, y0, 0}, {0, y0, h}, {-w, y0, h}}, tower);
  body.left = church.add({{0, y1, 0}, {-w, y1, 0}, {-w, y1, h}, {0, y1, h}}, tower);
  body.back =
      church.add({{0, y0, top0}, p.ridge(0, true), {0, y1, top0}, {0, y1, h}, {0, y0, h}}, tower);
  const double x0 = across - y1, x1 = across - y0;  // after the turn
  const auto plan = rectangle(x0, -w, x1, 0);
  const auto eaves = offset(plan, 0.25);
  add_rim(solid, {eaves, {}}, {plan, {}}, h, false, kRoof);
  add_walls(solid, eaves, h, h + 0.25, kRoof);
  body.roofs =
      add_hips(solid, eaves[0].x(), eaves[0].y(), eaves[2].x(), eaves[2].y(), h + 0.25, 2.2, kRoof);
  return body;
}

}  // namespace

ChurchBody add_church_body(House& house, const RoofShape& shape, double tower_width,
                           double tower_height) {
  const double length = house.depth, across = house.width, w = tower_width;
  const double y0 = (across - w) / 2, y1 = y0 + w;
  const Profile p(shape, across);
  ChurchDrawing church{
      house.solid, length, across, p, y0, y1, p.zr + p.thickness - shape.slope * (across / 2 - y0)};
  const int tower = house.new_part(ElementKind::kSpire, "", tower_width);
  ChurchBody body;
  church.add(
      {{0, 0, 0}, {0, y0, 0}, {0, y1, 0}, {0, across, 0}, {length, across, 0}, {length, 0, 0}},
      kBody);
  church.add({{-w, y0, 0}, {-w, y1, 0}, {0, y1, 0}, {0, y0, 0}}, tower);
  body.main.right =
      church.add({{0, 0, 0}, {length, 0, 0}, p.wall(length, false), p.wall(0, false)}, kBody);
  body.main.left = church.add(
      {{length, across, 0}, {0, across, 0}, p.wall(0, true), p.wall(length, true)}, kBody);
  body.main.back = add_church_gables(church);
  body.main.roofs = add_church_roofs(church);
  body.tower = add_tower(church, w, tower_height, tower);
  return body;
}

}  // namespace colod::synth
