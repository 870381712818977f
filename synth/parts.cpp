// *Based on:* usual dimensions of dwellings in central Europe.
//
// *Differs:* no --rules here.
//
// *Notation:* u, v: a facet's coordinates, right and up.
#include "parts.h"

#include <algorithm>
#include <cmath>

namespace colod::synth {
namespace {

constexpr double kGap = 0.03;     // m between parts that would touch otherwise
constexpr double kMargin = 0.14;  // m of wall around a part

Ring counter_clockwise(Ring ring) {
  if (signed_area(ring) < 0) std::reverse(ring.begin(), ring.end());
  return ring;
}

/// Points (u, height) before facet `wall`, at its v, seen in the coordinates of facet `floor`.
Ring on_floor(const Solid& solid, int wall, double v, const std::vector<Vec2>& points, int floor) {
  Ring ring;
  for (const Vec2& p : points)
    ring.push_back(solid.facet(floor).project(solid.facet(wall).at(p.x(), v, p.y())));
  return counter_clockwise(ring);
}

Ring arch(const Rect& r) {
  constexpr int kSteps = 6;
  const double radius = (r.u1 - r.u0) / 2, spring = r.v1 - radius, middle = (r.u0 + r.u1) / 2;
  Ring ring = {{r.u0, r.v0}, {r.u1, r.v0}};
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = M_PI * i / kSteps;
    ring.emplace_back(middle + radius * std::cos(angle), spring + radius * std::sin(angle));
  }
  return ring;
}

/// Side by side in a frame; each a little deeper than it.
void add_panes(Solid& solid, int frame, int panes, int object, int rows = 1) {
  constexpr double kFrame = 0.07, kPaneDepth = 0.03;
  const double width = solid.facet(frame).width(), height = solid.facet(frame).height();
  const double pane = (width - (panes + 1) * kFrame) / panes;
  const double tall = (height - (rows + 1) * kFrame) / rows;
  for (int i = 0; i < panes; ++i)
    for (int k = 0; k < rows; ++k) {
      const double u = kFrame + i * (pane + kFrame), v = kFrame + k * (tall + kFrame);
      const double top = k + 1 == rows ? height - kFrame : v + tall;
      solid.extrude(frame, Rect{u, v, u + pane, top}.ring(), -kPaneDepth, object);
    }
}

/// A leaf with two panels.
void add_opening(House& house, int facet, const Rect& rect, const DoorModel& model,
                 ElementKind kind) {
  const int part = house.new_part(kind, model.name, model.reveal);
  const int leaf = house.solid.extrude(facet, rect.ring(), -model.reveal, part).cap;
  add_panes(house.solid, leaf, model.width > 1.4 ? 2 : 1, part);
}

}  // namespace

Catalogue::Catalogue(std::uint64_t seed) {
  Random r(seed * 7919 + 17);
  const auto window = [&](const std::string& name, double width, double height, int panes,
                          bool has_sill) {
    return WindowModel{name,
                       width + r.size(-0.1, 0.1),
                       height + r.size(-0.1, 0.1),
                       r.size(0.08, 0.25),
                       panes,
                       has_sill,
                       false};
  };
  windows = {window("window_square", 1.2, 1.3, 2, true),
             window("window_single", 0.9, 1.35, 1, true),
             window("window_plain", 1.1, 1.4, 0, false)};
  tall_windows = {window("window_tall", 1.0, 1.8, 1, true),
                  window("window_wide", 1.9, 1.4, 2, true)};
  arched_windows = {{"window_arched", r.size(1.1, 1.4), r.size(3.0, 3.6), 0.25, 0, false, true},
                    {"window_belfry", r.size(0.9, 1.1), r.size(1.9, 2.2), 0.22, 0, false, true}};
  doors = {{"door_plain", r.size(1.0, 1.1), r.size(2.1, 2.2), r.size(0.12, 0.2)},
           {"door_double", r.size(1.6, 1.8), r.size(2.3, 2.5), r.size(0.15, 0.25)}};
  french_doors = {{"door_french", r.size(0.95, 1.1), r.size(2.1, 2.15), r.size(0.1, 0.18)},
                  {"door_french_double", r.size(1.6, 1.8), r.size(2.1, 2.15), r.size(0.1, 0.18)}};
  balconies = {{"balcony_small", r.size(2.3, 2.6), r.size(1.1, 1.3), r.size(0.95, 1.05)},
               {"balcony_wide", r.size(3.4, 3.9), r.size(1.4, 1.7), r.size(0.95, 1.05)}};
  dormers = {{"dormer_gabled", false, r.size(1.6, 1.9), r.size(1.35, 1.5)},
             {"dormer_shed", true, r.size(2.1, 2.7), r.size(1.35, 1.5)}};
  chimneys = {{"chimney_slim", r.size(0.5, 0.6), r.size(0.5, 0.6), r.size(1.0, 1.3)},
              {"chimney_long", r.size(0.95, 1.1), r.size(0.55, 0.65), r.size(1.1, 1.5)}};
  bays = {{"bay_square", r.size(2.3, 2.7), r.size(0.8, 1.0), 0},
          {"bay_splayed", r.size(2.8, 3.2), r.size(0.8, 0.95), r.size(0.4, 0.55)}};
  loggias = {{"loggia", r.size(2.9, 3.4), r.size(2.3, 2.4), r.size(1.2, 1.5)}};
}

House::House(std::string style_name, std::uint64_t seed)
    : style(std::move(style_name)), random(seed) {
  new_part(ElementKind::kPlain, "", 0);
  new_part(ElementKind::kRoof, "", 0);
}

int House::new_part(ElementKind kind, const std::string& model, double relief) {
  SynthPart part;
  part.kind = kind;
  part.model = model;
  part.instance = static_cast<int>(parts.size());
  part.depth = relief;
  parts.push_back(part);
  return part.instance;
}

namespace {

/// A frame of stone before the wall. Returns its front, and where the window lies on it.
std::pair<int, Rect> add_surround(Solid& solid, int facet, const Rect& window, double relief,
                                  int part) {
  constexpr double kWidth = 0.12;
  const int front = solid.extrude(facet, window.grown(kWidth).ring(), relief, part).cap;
  const Rect all = bounds(solid.facet(front).outer);
  return {front, all.grown(-kWidth)};
}

}  // namespace

bool add_window(House& house, int facet, double u, double v, const WindowModel& model) {
  constexpr double kSillOverhang = 0.06, kSillHeight = 0.05, kSillDepth = 0.06;
  Solid& solid = house.solid;
  const Rect rect = {u - model.width / 2, v, u + model.width / 2, v + model.height};
  Rect all = rect;
  const Rect sill = {rect.u0 - kSillOverhang, v - kGap - kSillHeight, rect.u1 + kSillOverhang,
                     v - kGap};
  if (model.has_sill) all = {sill.u0, sill.v0, sill.u1, rect.v1};
  if (!solid.fits(facet, all, kMargin)) return false;
  const int part = house.new_part(ElementKind::kWindow, model.name, model.reveal);
  if (model.surround > 0) {
    const auto [front, inner] = add_surround(solid, facet, rect, model.surround, part);
    const int frame = solid.extrude(front, inner.ring(), -model.reveal - model.surround, part).cap;
    if (model.panes > 0) add_panes(solid, frame, model.panes, part, model.rows);
    return true;
  }
  const Ring ring = model.is_arched ? arch(rect) : rect.ring();
  const int frame = solid.extrude(facet, ring, -model.reveal, part).cap;
  if (model.panes > 0 && !model.is_arched) add_panes(solid, frame, model.panes, part, model.rows);
  if (model.has_sill) solid.extrude(facet, sill.ring(), kSillDepth, part);
  return true;
}

bool add_door(House& house, int facet, double u, double v, const DoorModel& model) {
  const Rect rect = {u - model.width / 2, v, u + model.width / 2, v + model.height};
  if (!house.solid.fits(facet, {rect.u0, rect.v0 + kMargin - 0.05, rect.u1, rect.v1}, kMargin))
    return false;
  add_opening(house, facet, rect, model, ElementKind::kDoor);
  return true;
}

namespace {

/// From a slab's underside down to the ground, along its front.
void add_pillars(House& house, int facet, int underside, const Rect& slab,
                 const BalconyModel& model, int part) {
  constexpr double kFromEdge = 0.08;
  Solid& solid = house.solid;
  for (int i = 0; i < model.pillars; ++i) {
    const double share = model.pillars == 1 ? 0.5 : i / (model.pillars - 1.0);
    const double span = model.width - 2 * kFromEdge - model.pillar;
    const double u = slab.u0 + kFromEdge + share * span, front = model.depth - kFromEdge;
    const Ring base = on_floor(solid, facet, slab.v0,
                               {{u, front - model.pillar},
                                {u + model.pillar, front - model.pillar},
                                {u + model.pillar, front},
                                {u, front}},
                               underside);
    std::vector<Vec3> feet;
    for (const Vec2& p : base)
      feet.push_back(house.ground.on(solid.facet(underside).at(p.x(), p.y()).head<2>()));
    solid.attach(underside, base, feet, part);
  }
}

}  // namespace

bool add_balcony(House& house, int facet, double u, double v, const BalconyModel& model,
                 const DoorModel& door) {
  Solid& solid = house.solid;
  const double half = model.width / 2, depth = model.depth, wall = model.wall;
  const Rect slab = {u - half, v - model.slab, u + half, v};
  const Rect opening = {u - door.width / 2, v + kGap, u + door.width / 2, v + kGap + door.height};
  const Rect all = {slab.u0, slab.v0, slab.u1, opening.v1};
  if (!solid.fits(facet, all, kMargin)) return false;
  const int part = house.new_part(ElementKind::kBalcony, model.name, depth);
  const Attached plate = solid.extrude(facet, slab.ring(), depth, part);
  const int top = plate.sides[2];
  const double a = slab.u0 + kGap, b = slab.u1 - kGap, front = depth - kGap;
  const Ring parapet = on_floor(solid, facet, v,
                                {{a, kGap},
                                 {a, front},
                                 {b, front},
                                 {b, kGap},
                                 {b - wall, kGap},
                                 {b - wall, front - wall},
                                 {a + wall, front - wall},
                                 {a + wall, kGap}},
                                top);
  solid.extrude(top, parapet, model.parapet, part);
  add_pillars(house, facet, plate.sides[0], slab, model, part);
  add_opening(house, facet, opening, door, ElementKind::kDoor);
  solid.facet(facet).reserved.push_back(all);
  return true;
}

bool add_loggia(House& house, int facet, double u, double v, const LoggiaModel& model,
                const DoorModel& door) {
  constexpr double kFromCorner = 0.6, kParapet = 0.95, kThickness = 0.12;
  Solid& solid = house.solid;
  const Rect rect = {u - model.width / 2, v, u + model.width / 2, v + model.height};
  if (!solid.fits(facet, {rect.u0 - kFromCorner, rect.v0, rect.u1 + kFromCorner, rect.v1}, kMargin))
    return false;
  const int part = house.new_part(ElementKind::kLoggia, model.name, model.depth);
  const Attached recess = solid.extrude(facet, rect.ring(), -model.depth, part);
  const double a = rect.u0 + kGap, b = rect.u1 - kGap;
  const Ring strip = on_floor(
      solid, facet, v, {{a, -kGap}, {a, -kGap - kThickness}, {b, -kGap - kThickness}, {b, -kGap}},
      recess.sides[0]);
  solid.extrude(recess.sides[0], strip, kParapet, part);
  add_opening(house, recess.cap,
              {model.width / 2 - door.width / 2, kGap, model.width / 2 + door.width / 2,
               kGap + door.height},
              door, ElementKind::kDoor);
  return true;
}

bool add_bay(House& house, int facet, double u, double v, double height, double floor_height,
             const BayModel& model, const WindowModel& window) {
  Solid& solid = house.solid;
  const Rect rect = {u - model.width / 2, v, u + model.width / 2, v + height};
  if (!solid.fits(facet, rect, 0.2)) return false;
  const int part = house.new_part(ElementKind::kBay, model.name, model.depth);
  const Rect front = {rect.u0 + model.splay, rect.v0, rect.u1 - model.splay, rect.v1};
  const int cap = solid.extrude(facet, rect.ring(), model.depth, part, front.ring()).cap;
  const double middle = solid.facet(cap).width() / 2;
  for (double z = 0; z + window.height + 0.6 < height; z += floor_height)
    add_window(house, cap, middle, z + 0.6, window);
  return true;
}

bool add_dormer(House& house, int facet, double u, double v, const DormerModel& model) {
  constexpr double kShedSlope = 0.18;
  Solid& solid = house.solid;
  const Facet roof = solid.facet(facet);
  const double horizontal = std::hypot(roof.v.x(), roof.v.y());
  const double slope = roof.v.z() / horizontal;
  const Vec3 inward = Vec3(roof.v.x(), roof.v.y(), 0) / horizontal;
  const double rise = model.is_shed ? 0 : 0.45 * model.width;
  // How far behind the front the eaves, and the ridge, meet the roof.
  const double eaves = model.height / (model.is_shed ? slope - kShedSlope : slope);
  const double ridge = (model.height + rise) / slope;
  const double reach = std::max(eaves, model.is_shed ? 0 : ridge) / horizontal;
  const double u0 = u - model.width / 2, u1 = u + model.width / 2;
  if (!(eaves > 0) || !solid.fits(facet, {u0, v, u1, v + reach}, 0.25)) return false;

  const int part = house.new_part(ElementKind::kDormer, model.name, eaves);
  const Vec3 f0 = roof.at(u0, v), f1 = roof.at(u1, v), up = Vec3::UnitZ();
  const Vec3 e0 = f0 + model.height * up, e1 = f1 + model.height * up;
  const Vec3 back = eaves * (inward + slope * up), b0 = f0 + back, b1 = f1 + back;
  const Vec3 middle = (f0 + f1) / 2, peak = middle + (model.height + rise) * up;
  const Vec3 end = middle + ridge * (inward + slope * up);
  Ring base = {roof.project(f0), roof.project(f1), roof.project(b1)};
  if (!model.is_shed) base.push_back(roof.project(end));
  base.push_back(roof.project(b0));
  solid.cut(facet, base);
  const int front =
      model.is_shed ? solid.add({f0, f1, e1, e0}, part) : solid.add({f0, f1, e1, peak, e0}, part);
  solid.add({f1, b1, e1}, part);
  solid.add({f0, e0, b0}, part);
  if (model.is_shed) {
    solid.add({e1, b1, b0, e0}, part);
  } else {
    solid.add({e1, b1, end, peak}, part);
    solid.add({e0, peak, end, b0}, part);
  }
  const WindowModel small = {model.name + "_window",
                             std::min(1.5, model.width - 0.6),
                             model.height - 0.5,
                             0.1,
                             model.is_shed ? 2 : 1,
                             false,
                             false};
  add_window(house, front, model.width / 2, 0.2, small);
  return true;
}

bool add_chimney(House& house, int facet, double u, double v, const ChimneyModel& model) {
  Solid& solid = house.solid;
  const Facet roof = solid.facet(facet);
  const double along = model.depth / std::max(0.2, std::hypot(roof.v.x(), roof.v.y()));
  const Rect rect = {u - model.width / 2, v, u + model.width / 2, v + along};
  if (!solid.fits(facet, rect, 0.2)) return false;
  const int part = house.new_part(ElementKind::kChimney, model.name, model.height);
  const double top = roof.at(rect.u0, rect.v1).z() + model.height;
  std::vector<Vec3> cap;
  for (const Vec2& p : rect.ring()) {
    const Vec3 foot = roof.at(p.x(), p.y());
    cap.emplace_back(foot.x(), foot.y(), top);
  }
  const int mouth = solid.attach(facet, rect.ring(), cap, part).cap;
  const Facet& crown = solid.facet(mouth);
  const Rect flue = Rect{0, 0, crown.width(), crown.height()}.grown(-0.12);
  solid.extrude(mouth, flue.ring(), -0.3, part);
  return true;
}

bool add_ornament(House& house, int facet, double u, double v, const OrnamentModel& model) {
  constexpr double kTaper = 0.2;  // of the width, on each side
  Solid& solid = house.solid;
  const Rect foot = {u - model.width / 2, v - model.height / 2, u + model.width / 2,
                     v + model.height / 2};
  if (!solid.fits(facet, foot, kMargin)) return false;
  const int part = house.new_part(ElementKind::kOrnament, model.name, model.depth);
  const double taper = kTaper * std::min(model.width, model.height);
  solid.extrude(facet, foot.ring(), model.depth, part, foot.grown(-taper).ring());
  return true;
}

bool add_roof_window(House& house, int facet, double u, double v) {
  constexpr double kWidth = 0.78, kHeight = 1.18, kRelief = 0.08;
  const Rect rect = {u - kWidth / 2, v, u + kWidth / 2, v + kHeight};
  if (!house.solid.fits(facet, rect, 0.2)) return false;
  const int part = house.new_part(ElementKind::kWindow, "roof_window", kRelief);
  const int frame = house.solid.extrude(facet, rect.ring(), kRelief, part).cap;
  add_panes(house.solid, frame, 1, part);
  return true;
}

bool add_stairhead(House& house, int facet, double u, double v) {
  constexpr double kWidth = 3.4, kDepth = 4.2, kHeight = 2.6;
  const Rect rect = {u - kWidth / 2, v - kDepth / 2, u + kWidth / 2, v + kDepth / 2};
  if (!house.solid.fits(facet, rect, 0.3)) return false;
  const int part = house.new_part(ElementKind::kStairhead, "stairhead", kHeight);
  house.solid.extrude(facet, rect.ring(), kHeight, part);
  return true;
}

std::vector<double> facade_columns(const House& house, int facet, double spacing) {
  const double width = house.solid.facet(facet).width();
  const int n = std::max(1, static_cast<int>(std::floor((width - 0.6) / spacing)));
  std::vector<double> columns;
  for (int i = 0; i < n; ++i) columns.push_back(width * (i + 0.5) / n);
  return columns;
}

void add_windows(House& house, int facet, const Facade& facade, const WindowModel& model) {
  for (double floor : facade.floors)
    for (double u : facade_columns(house, facet, facade.spacing))
      add_window(house, facet, u, floor + facade.sill, model);
}

}  // namespace colod::synth
