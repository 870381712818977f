// *Based on:* usual shapes in European streets.
//
// *Differs:* no --rules here.
//
// *Notation:* u, v: a facet's coordinates, right and up.
#include "makes.h"

#include <algorithm>
#include <cmath>

namespace colod::synth {
namespace {

/// A dormer's front over the roof's line: (from the middle to the right, up), right to left.
std::vector<Vec2> front_profile(const ShapedDormer& m) {
  const double half = m.width / 2;
  switch (m.shape) {
    case DormerShape::kGabled:
      return {{half, m.height}, {0, m.height + m.rise}, {-half, m.height}};
    case DormerShape::kMansard:
      return {{half, m.height},
              {0.7 * half, m.height + 0.75 * m.rise},
              {0, m.height + m.rise},
              {-0.7 * half, m.height + 0.75 * m.rise},
              {-half, m.height}};
    default:
      return {{half, m.height}, {-half, m.height}};
  }
}

/// Adds a dormer's facets where they stand on the roof.
struct DormerDrawing {
  House& house;
  int part;
  Vec3 foot_left, foot_right;
  Vec3 right, inward;  ///< unit, level
  double slope;        ///< of the roof
  std::vector<Vec2> profile;

  Vec3 middle() const { return (foot_left + foot_right) / 2; }
  Vec3 front(const Vec2& p) const { return middle() + p.x() * right + p.y() * Vec3::UnitZ(); }
  /// Straight behind, where it meets the roof.
  Vec3 behind(const Vec2& p) const { return front(p) + p.y() / slope * inward; }

  int add_front() {
    std::vector<Vec3> corners = {foot_left, foot_right};
    for (const Vec2& p : profile) corners.push_back(front(p));
    return house.solid.add(corners, part);
  }
  void add_cheeks() {
    house.solid.add({foot_right, behind(profile.front()), front(profile.front())}, part);
    house.solid.add({foot_left, front(profile.back()), behind(profile.back())}, part);
  }
  void add_tops() {
    for (std::size_t k = 0; k + 1 < profile.size(); ++k)
      house.solid.add(
          {front(profile[k]), behind(profile[k]), behind(profile[k + 1]), front(profile[k + 1])},
          part);
  }
  /// Instead of the tops: a ridge that begins behind the front.
  Vec3 add_hips(double rise) {
    const Vec2 &r = profile.front(), &l = profile.back();
    const Vec2 ridge(0, r.y() + rise);
    const Vec3 end = behind(ridge);
    const double set_back = std::min(r.x(), 0.5 * ridge.y() / slope);
    const Vec3 peak = front(ridge) + set_back * inward;
    house.solid.add({front(r), peak, front(l)}, part);
    house.solid.add({front(r), behind(r), end, peak}, part);
    house.solid.add({front(l), peak, end, behind(l)}, part);
    return end;
  }
};

}  // namespace

bool add_shaped_dormer(House& house, int facet, double u, double v, const ShapedDormer& model) {
  if (model.shape == DormerShape::kShed)
    return add_dormer(house, facet, u, v, {model.name, true, model.width, model.height});
  const Facet roof = house.solid.facet(facet);
  const double horizontal = std::hypot(roof.v.x(), roof.v.y()), slope = roof.v.z() / horizontal;
  if (!(slope > 0.15)) return false;
  const double u0 = u - model.width / 2, u1 = u + model.width / 2;
  const double reach = (model.height + model.rise) / slope / horizontal;
  if (!house.solid.fits(facet, {u0, v, u1, v + reach}, 0.25)) return false;
  const int part = house.new_part(ElementKind::kDormer, model.name, model.height / slope);
  DormerDrawing drawing = {house,          part,
                           roof.at(u0, v), roof.at(u1, v),
                           roof.u,         Vec3(roof.v.x(), roof.v.y(), 0) / horizontal,
                           slope,          front_profile(model)};
  Ring base = {roof.project(drawing.foot_left), roof.project(drawing.foot_right)};
  for (const Vec2& p : drawing.profile) base.push_back(roof.project(drawing.behind(p)));
  const int front = drawing.add_front();
  drawing.add_cheeks();
  if (model.shape == DormerShape::kHipped)
    base.insert(base.end() - 1, roof.project(drawing.add_hips(model.rise)));
  else
    drawing.add_tops();
  house.solid.cut(facet, base);
  WindowModel window = model.window;
  window.width = std::min(window.width, model.width - 0.5);
  window.height = std::min(window.height, model.height - 0.45);
  add_window(house, front, model.width / 2, 0.22, window);
  return true;
}

bool add_shop_front(House& house, int facet, const Vec2& u, double v, const ShopFront& model,
                    const DoorModel& door) {
  const Rect rect = {u.x(), v, u.y(), v + model.height};
  if (u.y() - u.x() < 2.5 || !house.solid.fits(facet, rect, 0.05)) return false;
  const int part = house.new_part(ElementKind::kLoggia, model.name, model.depth);
  const int shop = house.solid.extrude(facet, rect.ring(), -model.depth, part).cap;
  const double width = house.solid.facet(shop).width();
  const double door_at = house.random.uniform(0.2, 0.8) * width;
  add_door(house, shop, door_at, 0.1, door);
  const double pitch = width / model.windows;
  const WindowModel pane = {model.name + "_window",
                            std::max(0.5, pitch - 0.5),
                            model.height - 0.9,
                            0.08,
                            model.windows > 2 ? 1 : 2,
                            false,
                            false};
  for (int i = 0; i < model.windows; ++i) add_window(house, shop, (i + 0.5) * pitch, 0.5, pane);
  return true;
}

int add_arcade(House& house, int facet, const Vec2& u, double v, const ArcadeModel& model) {
  constexpr double kBehindFront = 0.03;
  Solid& solid = house.solid;
  const Rect rect = {u.x(), v, u.y(), v + model.height};
  if (u.y() - u.x() < 2 * model.spacing || !solid.fits(facet, rect, 0.05)) return -1;
  const int part = house.new_part(ElementKind::kArcade, model.name, model.depth);
  const Attached walk = solid.extrude(facet, rect.ring(), -model.depth, part);
  const int pillars =
      std::max(1, static_cast<int>(std::lround((u.y() - u.x()) / model.spacing)) - 1);
  const int floor = walk.sides[0], ceiling = walk.sides[2];
  for (int i = 0; i < pillars; ++i) {
    const double middle = u.x() + (u.y() - u.x()) * (i + 1) / (pillars + 1);
    Ring base;
    for (const Vec2& p : Rect{middle - model.pillar / 2, -kBehindFront - model.pillar,
                              middle + model.pillar / 2, -kBehindFront}
                             .ring())
      base.push_back(solid.facet(floor).project(solid.facet(facet).at(p.x(), v, p.y())));
    if (signed_area(base) < 0) std::reverse(base.begin(), base.end());
    solid.connect(floor, base, ceiling, part);
  }
  return walk.cap;
}

bool add_passage(House& house, int facet, int behind, double u, double v, double width,
                 double height) {
  Solid& solid = house.solid;
  const Rect rect = {u - width / 2, v, u + width / 2, v + height};
  const Facet &front = solid.facet(facet), &back = solid.facet(behind);
  Ring far;
  const double depth = (front.origin - back.origin).dot(front.normal);
  for (const Vec2& p : rect.ring()) far.push_back(back.project(front.at(p.x(), p.y(), -depth)));
  if (!solid.fits(facet, rect, 0.1) || !solid.fits(behind, bounds(far), 0.1)) return false;
  const int part = house.new_part(ElementKind::kPassage, "passage", depth);
  solid.connect(facet, rect.ring(), behind, part);
  return true;
}

bool add_cornice(House& house, int facet, double from, double to, double v,
                 const CorniceModel& model) {
  const Rect strip = {from, v, to, v + model.height};
  if (to - from < 1 || !house.solid.fits(facet, strip, 0.02)) return false;
  const int part = house.new_part(ElementKind::kCornice, model.name, model.depth);
  house.solid.extrude(facet, strip.ring(), model.depth, part);
  return true;
}

bool add_penthouse(House& house, int facet, const Rect& rect, double height,
                   const WindowModel& window) {
  if (!house.solid.fits(facet, rect, 0.5)) return false;
  const int part = house.new_part(ElementKind::kStairhead, "penthouse", height);
  const Attached room = house.solid.extrude(facet, rect.ring(), height, part);
  for (int side : room.sides) {
    const double width = house.solid.facet(side).width();
    const int n = static_cast<int>(width / (window.width + 1.2));
    for (int i = 0; i < n; ++i) add_window(house, side, width * (i + 0.5) / n, 0.8, window);
  }
  return true;
}

}  // namespace colod::synth
