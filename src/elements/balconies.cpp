// Based on: elements.cpp.
// Differs: a balcony is told by its floor and the walls around it. From the street a scan may show
// no
//   floor, but the underside and the same walls; these tell it, too, where they close all sides
//   that the house does not, and nothing lies or stands on them. The floor is then a slab's
//   thickness above the underside.
// Notation: U floor of a balcony, W its walls, d one of four horizontal directions.
#include "balconies.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "parameters.h"

namespace colod::elements {
namespace {

using namespace parameters::elements::balconies;

/// A level plane near that height over at least half of the rectangle.
bool has_level(const std::vector<Panel>& panels, bool is_ceiling, const Range& z, const Vec3& a,
               const Range& ra, const Vec3& b, const Range& rb) {
  for (const Panel& p : panels) {
    if (!(is_ceiling ? p.is_ceiling : p.is_floor)) continue;
    const double height = p.plane->centroid.z();
    if (height < z.low || height > z.high) continue;
    if (overlap(p.along(a), ra) > 0.5 * ra.length() && overlap(p.along(b), rb) > 0.5 * rb.length())
      return true;
  }
  return false;
}

/// A wall that stands around a floor, looking away from it.
struct BalconyWall {
  Vec3 normal;    ///< of its outer side
  double offset;  ///< of its outer side
  double thickness;
  Range across, height;  ///< across: along beside(direction of the horizontal normal)
  Vec3 out;
  int plane;                     ///< whose outline it has
  const Panel* inner = nullptr;  ///< the plane of its inner side, where there is one
  double area;
};

/// A floor with what its walls say of its extent: of many only a part is seen, of some only the
/// underside.
struct Ground {
  const Panel* panel;
  double z;                     ///< of the floor
  std::vector<Vec3> ends = {};  ///< of its walls

  bool is_underside() const { return panel->is_ceiling; }

  Range along(const Vec3& direction) const {
    Range r = panel->along(direction);
    for (const Vec3& x : ends) r.extend({direction.dot(x), direction.dot(x)});
    return r;
  }
};

bool is_rail(const Ground& floor, const Panel& wall) {
  const double least = floor.is_underside() ? kLeastRailAlone : kLeastRail;
  const auto [low, high] = wall.height();
  return high >= floor.z + least && high <= floor.z + kMostRail && low <= floor.z + kReach;
}

bool stands_beside(const Ground& floor, const Panel& wall, const Vec3& out, double at) {
  const double edge = floor.along(out).high;
  const double beyond = floor.is_underside() ? kReach : 0.2;  // a slab may be larger than its floor
  if (edge < at - 0.4 || edge > at + beyond || floor.panel->at(out) > at - 0.15) return false;
  const Range across = wall.along(beside(out)), floor_across = floor.along(beside(out));
  return overlap(across, floor_across) >= 0.5 * std::min(across.length(), floor_across.length());
}

const Panel* inner_side(const std::vector<Panel>& panels, const Panel& wall) {
  const Panel* best = nullptr;
  for (const Panel& p : panels) {
    if (!p.is_wall || p.plane->area > kMostArea || p.out.dot(wall.out) > -kLevel) continue;
    const double behind = wall.at(wall.out) - p.at(wall.out);
    if (behind < 0.03 || behind > kThickest || !is_near(p.box, wall.box, kReach)) continue;
    if (overlap(p.height(), wall.height()) < 0.3) continue;
    const Vec3 side = beside(wall.out);
    if (overlap(p.along(side), wall.along(side)) < 0.3) continue;
    if (!best || p.plane->area > best->plane->area) best = &p;
  }
  return best;
}

std::vector<BalconyWall> walls_of_balcony(const std::vector<Panel>& panels, const Ground& floor) {
  std::vector<BalconyWall> walls;
  const double reach = floor.ends.empty() ? 0.4 : kMostBeyond;
  for (const Panel& whole : panels) {
    if (!whole.is_wall || whole.plane->area > kMostArea || whole.plane->area < 0.15) continue;
    if (!is_near(whole.box, floor.panel->box, reach)) continue;
    const Panel p = part_near(whole, floor.panel->box, kMostBeyond);
    if (p.points.size() < 3 || !is_rail(floor, p)) continue;
    if (!stands_beside(floor, p, p.out, p.at(p.out))) continue;
    BalconyWall w{p.plane->normal, p.plane->offset, kThickness, p.along(beside(p.out)),
                  p.height(),      p.out,           p.id,       nullptr,
                  p.plane->area};
    if (const Panel* inner = inner_side(panels, p)) {
      w.inner = inner;
      w.thickness = p.at(p.out) - inner->at(p.out);
    }
    walls.push_back(w);
  }
  return walls;
}

/// The house, or another wall, that closes a side of a balcony which has none of its own.
bool is_closed_by_house(const std::vector<Panel>& panels, const Ground& floor, const Vec3& d,
                        double top) {
  const double edge = floor.along(d).high;
  const Range across = floor.along(beside(d));
  for (const Panel& p : panels)
    if (p.is_wall && p.out.dot(d) < -0.8 && p.at(d) > edge - kReach && p.at(d) < edge + 0.6 &&
        p.height().high > top + 0.3 && p.height().low < top &&
        overlap(p.along(beside(d)), across) > 0.5 * across.length())
      return true;
  return false;
}

/// The inner side of a wall whose outer side is not seen.
const Panel* lone_inner_side(const std::vector<Panel>& panels, const Ground& floor, const Vec3& d) {
  for (const Panel& p : panels)
    if (p.is_wall && p.out.dot(d) < -kAlike && p.plane->area < kMostArea && is_rail(floor, p) &&
        std::abs(p.at(d) - floor.along(d).high) < kReach &&
        is_near(p.box, floor.panel->box, kMostBeyond))
      return &p;
  return nullptr;
}

/// Where the walls end, for those that do not reach far beyond the floor.
std::vector<Vec3> ends_of(const std::vector<BalconyWall>& walls, const Panel& floor) {
  std::vector<Vec3> ends;
  for (const BalconyWall& w : walls) {
    const Vec3 side = beside(w.out);
    const Range own = floor.along(side);
    for (const double t : {w.across.low, w.across.high})
      if (t > own.low - kMostBeyond && t < own.high + kMostBeyond)
        ends.push_back(t * side + (w.out.dot(floor.plane->centroid)) * w.out);
  }
  return ends;
}

/// A side of a balcony with no wall whose outer side is seen.
struct OpenSide {
  Vec3 out;
  double edge;  ///< of the floor, along out
  enum class Closed { kByHouse, kByInnerSide, kByNothing } closed;
};

/// What planes form a balcony.
struct Balcony {
  Ground floor;
  std::vector<BalconyWall> walls = {};
  std::vector<OpenSide> open_sides = {};
  Vec3 out = {};      ///< of its largest wall
  Range height = {};  ///< from the floor's underside to the top of the walls
};

bool has_corner(const std::vector<BalconyWall>& walls) {
  for (const BalconyWall& a : walls)
    for (const BalconyWall& b : walls)
      if (std::abs(a.out.dot(b.out)) < 0.8) return true;
  return false;
}

Range height_of(const std::vector<BalconyWall>& walls, double largest_area, double z) {
  double top = 0, weight = 0, bottom = z;
  for (const BalconyWall& w : walls) {
    if (w.area < 0.3 * largest_area) continue;
    top += w.area * w.height.high, weight += w.area;
    if (w.height.low > z - 0.6) bottom = std::min(bottom, w.height.low);
  }
  return {bottom > z - 0.06 ? z - kSlab : bottom, top / weight};
}

/// Adds the sides that no wall closes, and the walls of which only the inner side is seen.
void close_sides(const std::vector<Panel>& panels, Balcony& balcony) {
  const Vec3 side = beside(balcony.out);
  std::vector<BalconyWall> added;
  for (const Vec3& d : {balcony.out, side, Vec3(-balcony.out), Vec3(-side)}) {
    if (std::any_of(balcony.walls.begin(), balcony.walls.end(),
                    [&](const BalconyWall& w) { return w.out.dot(d) > 0.8; }))
      continue;
    OpenSide open{d, balcony.floor.along(d).high, OpenSide::Closed::kByNothing};
    if (is_closed_by_house(panels, balcony.floor, d, balcony.height.high)) {
      open.closed = OpenSide::Closed::kByHouse;
    } else if (const Panel* inner = lone_inner_side(panels, balcony.floor, d)) {
      open.closed = OpenSide::Closed::kByInnerSide;
      added.push_back({-inner->plane->normal, -inner->plane->offset + kThickness, kThickness,
                       inner->along(beside(d)), inner->height(), d, inner->id, inner,
                       inner->plane->area});
    }
    balcony.open_sides.push_back(open);
  }
  balcony.walls.insert(balcony.walls.end(), added.begin(), added.end());
}

/// Something lies on the walls: they are the sides of a closed box.
bool has_lid(const std::vector<Panel>& panels, const Balcony& balcony) {
  const Vec3 side = beside(balcony.out);
  const Range a = balcony.floor.along(balcony.out), b = balcony.floor.along(side);
  return std::any_of(panels.begin(), panels.end(), [&](const Panel& p) {
    return p.plane->normal.z() > kUpright && p.height().high > balcony.floor.z + kLeastRail &&
           p.height().low < balcony.height.high + kAboveBalcony &&
           overlap(p.along(balcony.out), a) > 0.3 * a.length() &&
           overlap(p.along(side), b) > 0.3 * b.length();
  });
}

/// Walls go on above a balcony's own, or panes stand there: what is within is a room.
bool is_closed_above(const std::vector<Panel>& panels, const Balcony& balcony) {
  for (const double above : {0.25, 0.9}) {
    Vec3 x = balcony.floor.panel->plane->centroid;
    x.z() = balcony.height.high + above;
    if (std::all_of(balcony.walls.begin(), balcony.walls.end(),
                    [&](const BalconyWall& w) { return meets_back(panels, x, w.out); }))
      return true;
  }
  return false;
}

/// Of a balcony whose floor is not seen: walls or the house on all sides, nothing above them.
bool is_open_box(const std::vector<Panel>& panels, const Balcony& balcony) {
  return std::none_of(balcony.open_sides.begin(), balcony.open_sides.end(),
                      [](auto& s) { return s.closed == OpenSide::Closed::kByNothing; }) &&
         !has_lid(panels, balcony) && !is_closed_above(panels, balcony);
}

std::optional<Balcony> find_balcony(const std::vector<Panel>& panels, const Panel& panel) {
  const double z = panel.plane->centroid.z();
  Balcony balcony{{&panel, panel.is_ceiling ? z + kSlab : z}};
  // The walls beside what is seen of the floor say how far it goes, and that which others do.
  for (int round = 0; round < 2; ++round) {
    balcony.walls = walls_of_balcony(panels, balcony.floor);
    balcony.floor.ends = ends_of(balcony.walls, panel);
  }
  if (!has_corner(balcony.walls)) return std::nullopt;
  // Above rooms a floor is a roof, and what stands around it parapets and walls.
  if (is_room(panels, panel.plane->centroid - kBelow * Vec3::UnitZ())) return std::nullopt;
  const BalconyWall& largest =
      *std::max_element(balcony.walls.begin(), balcony.walls.end(),
                        [](const BalconyWall& a, const BalconyWall& b) { return a.area < b.area; });
  balcony.out = largest.out;
  balcony.height = height_of(balcony.walls, largest.area, balcony.floor.z);
  if (balcony.floor.is_underside()) balcony.height.low = z;
  close_sides(panels, balcony);
  if (balcony.floor.is_underside() && !is_open_box(panels, balcony)) return std::nullopt;
  return balcony;
}

void describe_side(const Balcony& balcony, const OpenSide& side, Element& element) {
  const bool is_at_house = side.closed == OpenSide::Closed::kByHouse;
  element.air.push_back({side.out, side.edge + 0.1});
  element.solid.push_back({side.out, side.edge + (is_at_house ? kReach : 0.01)});
  if (side.closed == OpenSide::Closed::kByNothing)
    element.rims.push_back(upright_rim(side.out, side.edge, balcony.floor.along(beside(side.out)),
                                       {balcony.height.low, balcony.floor.z}));
}

void describe_wall(const Balcony& balcony, const BalconyWall& w, Element& element) {
  const Vec3 side = beside(w.out);
  const Range across = balcony.floor.along(side);
  const auto [bottom, top] = balcony.height;
  element.planes.push_back(w.plane);
  if (w.inner) element.planes.push_back(w.inner->id);
  element.air.push_back({w.normal, w.offset - w.thickness});
  element.solid.push_back({w.normal, w.offset + 0.005});
  element.sheets.push_back({{w.normal, w.offset + 0.005},
                            {-w.normal, -(w.offset - w.thickness - 0.005)},
                            {side, across.high + 0.01},
                            {-side, -(across.low - 0.01)},
                            {Vec3::UnitZ(), top + 0.02},
                            {-Vec3::UnitZ(), -(balcony.floor.z - 0.01)}});
  const auto add_rim = [&](const Vec3& normal, double offset, const Range& height, int like) {
    element.rims.push_back(
        {normal, offset, rectangle(normal, offset, side, across, Vec3::UnitZ(), height), like});
  };
  const bool is_lone = w.inner && w.inner->id == w.plane;
  add_rim(w.normal, w.offset, {bottom, top}, is_lone ? w.plane : -1);
  if (is_lone) return;
  const Range above_floor = {balcony.floor.z, top};
  if (w.inner)
    add_rim(w.inner->plane->normal, w.inner->plane->offset, above_floor, w.plane);
  else
    add_rim(-w.normal, -(w.offset - w.thickness), above_floor, w.plane);
}

/// The floor's slab, and the levels that no plane shows: on top of the walls and under the slab.
void describe_levels(const std::vector<Panel>& panels, const Balcony& balcony, Element& element) {
  const Vec3 out = balcony.out, side = beside(out);
  const Range a = balcony.floor.along(out), b = balcony.floor.along(side);
  const auto [bottom, top] = balcony.height;
  element.solid.push_back({Vec3::UnitZ(), balcony.floor.z + 0.005});
  element.solid.push_back({-Vec3::UnitZ(), -bottom + 0.005});
  if (!has_level(panels, false, {top - 0.1, top + 0.1}, out, a, side, b))
    element.rims.push_back(level_rim(1, top, out, a, side, b));
  if (balcony.floor.is_underside())
    element.rims.push_back(level_rim(1, balcony.floor.z, out, a, side, b, balcony.floor.panel->id));
  else if (!has_level(panels, true, {balcony.floor.z - 0.7, balcony.floor.z - 0.04}, out, a, side,
                      b))
    element.rims.push_back(level_rim(-1, bottom, out, a, side, b, balcony.floor.panel->id));
}

std::optional<Element> balcony_on(const std::vector<Panel>& panels, const Panel& floor) {
  const std::optional<Balcony> balcony = find_balcony(panels, floor);
  if (!balcony) return std::nullopt;
  Element element{.kind = ElementKind::kBalcony, .planes = {floor.id}};
  element.air = {{-Vec3::UnitZ(), -balcony->floor.z - 0.01}, {Vec3::UnitZ(), balcony->height.high}};
  for (const OpenSide& side : balcony->open_sides) describe_side(*balcony, side, element);
  for (const BalconyWall& wall : balcony->walls) describe_wall(*balcony, wall, element);
  describe_levels(panels, *balcony, element);
  return element;
}

/// Over each floor or underside.
std::vector<Element> balconies_on(const std::vector<Panel>& panels, bool Panel::*is_level,
                                  double least_area) {
  std::vector<Element> found;
  for (const Panel& p : panels)
    if (p.*is_level && p.plane->area >= least_area && p.plane->area <= kMostArea)
      if (auto balcony = balcony_on(panels, p)) found.push_back(std::move(*balcony));
  return found;
}

}  // namespace

std::vector<Element> find_balconies(const std::vector<Panel>& panels) {
  return balconies_on(panels, &Panel::is_floor, kLeastFloor);
}

std::vector<Element> find_balconies_from_below(const std::vector<Panel>& panels) {
  return balconies_on(panels, &Panel::is_ceiling, kLeastUnderside);
}

}  // namespace colod::elements
