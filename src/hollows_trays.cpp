// Based on: hollows.cpp.
// Differs: –
// Notation: U floor of a tray, W its walls, d one of four horizontal directions.
#include <algorithm>
#include <cmath>

#include "hollows_parts.h"

namespace colod::hollows {
namespace {

constexpr double kThickness = 0.12;  // metres of a wall whose other side is not seen
constexpr double kThickest = 0.35;   // metres between both sides of a thin wall
constexpr double kSlab = 0.18;       // metres of a floor whose underside is not seen
constexpr double kMostBeyond = 1.5;  // metres of a tray beyond the part of its floor that is seen
constexpr double kBelow = 1.0;       // metres below a floor: where nothing or a room is
constexpr double kLeastRail = 0.4, kMostRail = 1.6;  // metres of a tray's wall above its floor

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
struct TrayWall {
  Vec3 normal;    ///< of its outer side
  double offset;  ///< of its outer side
  double thickness;
  Range across, height;  ///< across: along beside(direction of the horizontal normal)
  Vec3 out;
  int plane;                     ///< whose outline it has
  const Panel* inner = nullptr;  ///< the plane of its inner side, where there is one
  double area;
};

/// A floor with what its walls say of its extent: of many only a part is seen.
struct Ground {
  const Panel* panel;
  std::vector<Vec3> ends;  ///< of its walls

  Range along(const Vec3& direction) const {
    Range r = panel->along(direction);
    for (const Vec3& x : ends) r.extend({direction.dot(x), direction.dot(x)});
    return r;
  }
};

bool is_rail(const Panel& floor, const Panel& wall) {
  const double z = floor.plane->centroid.z();
  return wall.height().high >= z + kLeastRail && wall.height().high <= z + kMostRail &&
         wall.height().low <= z + kReach;
}

bool stands_beside(const Ground& floor, const Panel& wall, const Vec3& out, double at) {
  const double edge = floor.along(out).high;
  if (edge < at - 0.4 || edge > at + 0.2 || floor.panel->at(out) > at - 0.15) return false;
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

std::vector<TrayWall> walls_of_tray(const std::vector<Panel>& panels, const Ground& floor) {
  std::vector<TrayWall> walls;
  const double reach = floor.ends.empty() ? 0.4 : kMostBeyond;
  for (const Panel& whole : panels) {
    if (!whole.is_wall || whole.plane->area > kMostArea || whole.plane->area < 0.15) continue;
    if (!is_near(whole.box, floor.panel->box, reach)) continue;
    const Panel p = part_near(whole, floor.panel->box, kMostBeyond);
    if (p.points.size() < 3 || !is_rail(*floor.panel, p)) continue;
    if (!stands_beside(floor, p, p.out, p.at(p.out))) continue;
    TrayWall w{p.plane->normal, p.plane->offset, kThickness, p.along(beside(p.out)),
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

/// The house, or another wall, that closes a side of a tray which has none of its own.
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
    if (p.is_wall && p.out.dot(d) < -kAlike && p.plane->area < kMostArea &&
        is_rail(*floor.panel, p) && std::abs(p.at(d) - floor.along(d).high) < kReach &&
        is_near(p.box, floor.panel->box, kMostBeyond))
      return &p;
  return nullptr;
}

/// Where the walls end, for those that do not reach far beyond the floor.
std::vector<Vec3> ends_of(const std::vector<TrayWall>& walls, const Panel& floor) {
  std::vector<Vec3> ends;
  for (const TrayWall& w : walls) {
    const Vec3 side = beside(w.out);
    const Range own = floor.along(side);
    for (const double t : {w.across.low, w.across.high})
      if (t > own.low - kMostBeyond && t < own.high + kMostBeyond)
        ends.push_back(t * side + (w.out.dot(floor.plane->centroid)) * w.out);
  }
  return ends;
}

}  // namespace

std::optional<Hollow> tray_on(const std::vector<Panel>& panels, const Panel& panel) {
  Ground floor{&panel, {}};
  std::vector<TrayWall> walls = walls_of_tray(panels, floor);
  if (walls.empty()) return std::nullopt;
  floor.ends = ends_of(walls, panel);
  walls = walls_of_tray(panels, floor);
  floor.ends = ends_of(walls, panel);
  const auto crossing = [&](const TrayWall& a, const TrayWall& b) {
    return std::abs(a.out.dot(b.out)) < 0.8;
  };
  bool has_corner = false;
  for (const TrayWall& a : walls)
    for (const TrayWall& b : walls) has_corner |= crossing(a, b);
  if (!has_corner) return std::nullopt;
  const TrayWall main =
      *std::max_element(walls.begin(), walls.end(),
                        [](const TrayWall& a, const TrayWall& b) { return a.area < b.area; });

  // Above rooms a floor is a roof, and what stands around it parapets and walls.
  if (is_room(panels, panel.plane->centroid - kBelow * Vec3::UnitZ())) return std::nullopt;

  const double z = panel.plane->centroid.z();
  double top = 0, weight = 0, bottom = z;
  for (const TrayWall& w : walls) {
    if (w.area < 0.3 * main.area) continue;
    top += w.area * w.height.high, weight += w.area;
    if (w.height.low > z - 0.6) bottom = std::min(bottom, w.height.low);
  }
  top /= weight;
  if (bottom > z - 0.06) bottom = z - kSlab;

  Hollow tray{.kind = Hollow::Kind::kTray, .planes = {panel.id}};
  tray.air = {{-Vec3::UnitZ(), -z - 0.01}, {Vec3::UnitZ(), top}};
  for (const Vec3& d : {main.out, beside(main.out), Vec3(-main.out), Vec3(-beside(main.out))}) {
    if (std::any_of(walls.begin(), walls.end(),
                    [&](const TrayWall& w) { return w.out.dot(d) > 0.8; }))
      continue;
    const double edge = floor.along(d).high;
    tray.air.push_back({d, edge + 0.1});
    const bool is_at_house = is_closed_by_house(panels, floor, d, top);
    tray.solid.push_back({d, edge + (is_at_house ? kReach : 0.01)});
    if (is_at_house) continue;
    if (const Panel* inner = lone_inner_side(panels, floor, d)) {
      walls.push_back({-inner->plane->normal, -inner->plane->offset + kThickness, kThickness,
                       inner->along(beside(d)), inner->height(), d, inner->id, inner,
                       inner->plane->area});
      continue;
    }
    tray.rims.push_back(upright_rim(d, edge, floor.along(beside(d)), {bottom, z}));
  }

  for (const TrayWall& w : walls) {
    tray.planes.push_back(w.plane);
    if (w.inner) tray.planes.push_back(w.inner->id);
    tray.air.push_back({w.normal, w.offset - w.thickness});
    const Range across = floor.along(beside(w.out));
    tray.sheets.push_back({{w.normal, w.offset + 0.005},
                           {-w.normal, -(w.offset - w.thickness - 0.005)},
                           {beside(w.out), across.high + 0.01},
                           {-beside(w.out), -(across.low - 0.01)},
                           {Vec3::UnitZ(), top + 0.02},
                           {-Vec3::UnitZ(), -(z - 0.01)}});
    const bool is_lone = w.inner && w.inner->id == w.plane;
    tray.rims.push_back(
        {w.normal, w.offset,
         rectangle(w.normal, w.offset, beside(w.out), across, Vec3::UnitZ(), {bottom, top}),
         is_lone ? w.plane : -1});
    if (!is_lone) {
      const Vec3 normal = w.inner ? w.inner->plane->normal : Vec3(-w.normal);
      const double offset = w.inner ? w.inner->plane->offset : -(w.offset - w.thickness);
      tray.rims.push_back(
          {normal, offset,
           rectangle(normal, offset, beside(w.out), across, Vec3::UnitZ(), {z, top}), w.plane});
    }
    tray.solid.push_back({w.normal, w.offset + 0.005});
  }
  tray.solid.push_back({Vec3::UnitZ(), z + 0.005});
  tray.solid.push_back({-Vec3::UnitZ(), -bottom + 0.005});
  const Range a = floor.along(main.out), b = floor.along(beside(main.out));
  if (!has_level(panels, false, {top - 0.1, top + 0.1}, main.out, a, beside(main.out), b))
    tray.rims.push_back(level_rim(1, top, main.out, a, beside(main.out), b));
  if (!has_level(panels, true, {z - 0.7, z - 0.04}, main.out, a, beside(main.out), b))
    tray.rims.push_back(level_rim(-1, bottom, main.out, a, beside(main.out), b, panel.id));
  return tray;
}
}  // namespace colod::hollows
