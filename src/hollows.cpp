// Based on: nothing published; the planes of a balcony, a loggia and a chimney as scans show them.
// Differs: the paper knows closed segments and alcoves that rays see. Seen from the street a scan
//   has a balcony's outer faces and often its floor, not the inner faces of its parapet, rarely its
//   underside; a loggia's ceiling, cheeks and back, not its floor; a chimney without its top. Rays
//   then escape, or meet a thin wall from its back, and the part is closed over or cut away. Here
//   such parts are told by how their planes stand to each other, and what is missing is added.
// Notation: U floor of a tray, W its walls, d one of four horizontal directions.
#include "hollows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace colod {
namespace {

constexpr double kUpright = 0.35;    // |cosine| to the vertical of a wall's normal
constexpr double kLevel = 0.95;      // of a floor's or a ceiling's
constexpr double kAlike = 0.9;       // cosine of directions that count as the same
constexpr double kMostArea = 25;     // m² of a plane of such a part
constexpr double kThickness = 0.12;  // metres of a wall whose other side is not seen
constexpr double kThickest = 0.35;   // metres between both sides of a thin wall
constexpr double kSlab = 0.18;       // metres of a floor whose underside is not seen
constexpr double kReach = 0.35;      // metres between planes that meet
constexpr double kMostBeyond = 1.5;  // metres of a tray beyond the part of its floor that is seen
constexpr double kLeastRail = 0.4, kMostRail = 1.6;     // metres of a tray's wall above its floor
constexpr double kLeastDepth = 0.5, kMostDepth = 4;     // metres of a niche
constexpr double kLeastWidth = 0.8, kMostWidth = 15;    // metres of a niche
constexpr double kLeastShaft = 0.25, kMostShaft = 2.5;  // metres between a shaft's walls
constexpr double kMostCorner = 1.3;  // metres of a shaft of which only a corner is seen
constexpr double kTouch = 0.2;       // metres between walls that share an edge
constexpr double kGrowth = 0.1;      // metres that a rim reaches beyond its part

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  double length() const { return std::max(0.0, high - low); }
  double middle() const { return 0.5 * (low + high); }
  void extend(const Range& r) { low = std::min(low, r.low), high = std::max(high, r.high); }
};

double overlap(const Range& a, const Range& b) {
  return std::min(a.high, b.high) - std::max(a.low, b.low);
}

/// A plane with what is asked of it again and again.
struct Panel {
  int id;
  const Plane* plane;
  Box box;
  bool is_wall, is_floor, is_ceiling;
  Vec3 out;                  ///< of a wall: horizontal unit normal
  std::vector<Vec3> points;  ///< of its outline

  Range along(const Vec3& direction) const {
    Range r;
    for (const Vec3& v : points) {
      const double t = direction.dot(v);
      r.low = std::min(r.low, t), r.high = std::max(r.high, t);
    }
    return r;
  }
  double at(const Vec3& direction) const { return direction.dot(plane->centroid); }
  Range height() const { return {box.min.z(), box.max.z()}; }
};

Vec3 beside(const Vec3& out) { return Vec3::UnitZ().cross(out); }

bool is_near(const Box& a, const Box& b, double reach) {
  return (a.min.array() - reach <= b.max.array()).all() &&
         (b.min.array() - reach <= a.max.array()).all();
}

std::vector<Panel> panels_of(const Planes& planes, const std::vector<int>& among) {
  std::vector<Panel> panels;
  for (const int p : among) {
    const Plane& plane = planes.planes[p];
    if (plane.outline.vertices.empty() || !(plane.area > 0)) continue;
    Panel panel{p,
                &plane,
                bounding_box(plane.outline.vertices),
                false,
                false,
                false,
                {},
                plane.outline.vertices};
    panel.is_wall = std::abs(plane.normal.z()) < kUpright;
    panel.is_floor = plane.normal.z() > kLevel;
    panel.is_ceiling = plane.normal.z() < -kLevel;
    panel.out = Vec3(plane.normal.x(), plane.normal.y(), 0);
    if (panel.is_wall) panel.out.normalize();
    panels.push_back(panel);
  }
  return panels;
}

/// What of a panel lies near a box: walls of different parts are one plane where they are flush.
Panel part_near(Panel panel, const Box& around, double reach) {
  std::erase_if(panel.points, [&](const Vec3& x) {
    Box box;
    box.extend(x);
    return !is_near(box, around, reach);
  });
  panel.box = bounding_box(panel.points);
  return panel;
}

/// The rectangle on a plane that covers ranges along two directions.
std::vector<Vec3> rectangle(const Vec3& normal, double offset, const Vec3& a, const Range& ra,
                            const Vec3& b, const Range& rb) {
  std::vector<Vec3> hull;
  for (const auto& [u, v] : {std::pair{ra.low - kGrowth, rb.low - kGrowth},
                             {ra.high + kGrowth, rb.low - kGrowth},
                             {ra.high + kGrowth, rb.high + kGrowth},
                             {ra.low - kGrowth, rb.high + kGrowth}}) {
    const Vec3 x = u * a + v * b;
    hull.push_back(x + (offset - normal.dot(x)) * normal);
  }
  return hull;
}

Hollow::Rim level_rim(double sign, double z, const Vec3& a, const Range& ra, const Vec3& b,
                      const Range& rb, int like = -1) {
  const Vec3 normal = sign * Vec3::UnitZ();
  return {normal, sign * z, rectangle(normal, sign * z, a, ra, b, rb), like};
}

Hollow::Rim upright_rim(const Vec3& out, double offset, const Range& across, const Range& height,
                        int like = -1) {
  return {out, offset, rectangle(out, offset, beside(out), across, Vec3::UnitZ(), height), like};
}

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

// ---- trays

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

  const double z = panel.plane->centroid.z();
  double top = 0, weight = 0, bottom = z;
  for (const TrayWall& w : walls) {
    if (w.area < 0.3 * main.area) continue;
    top += w.area * w.height.high, weight += w.area;
    if (w.height.low > z - 0.6) bottom = std::min(bottom, w.height.low);
  }
  top /= weight;
  if (bottom > z - 0.06) bottom = z - kSlab;

  Hollow tray{Hollow::Kind::kTray, {panel.id}, {}, {}, {}, {}, {}};
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
      const double thickness = kThickness;
      walls.push_back({-inner->plane->normal, -inner->plane->offset + thickness, thickness,
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

// ---- niches

/// Between two walls that face each other.
struct Gap {
  const Panel *left, *right;
  Vec3 across, forward;  ///< from left to right; out of the niche
  Range width, depth, height;
};

double largest_area(const std::vector<Panel>& panels) {
  double most = 0;
  for (const Panel& p : panels) most = std::max(most, p.plane->area);
  return most;
}

std::optional<Gap> gap_between(const Panel& a, const Panel& b) {
  if (a.out.dot(b.out) > -kAlike) return std::nullopt;
  Gap gap{&a, &b, a.out, beside(a.out), {a.at(a.out), b.at(a.out)}, {}, {}};
  if (gap.width.high - gap.width.low < kLeastWidth || gap.width.length() > kMostWidth)
    return std::nullopt;
  const Range da = a.along(gap.forward), db = b.along(gap.forward);
  const double common = overlap(da, db);
  if (common < 0.6 * std::min(da.length(), db.length()) || common < kLeastDepth ||
      std::max(da.length(), db.length()) > kMostDepth)
    return std::nullopt;
  const double rise = overlap(a.height(), b.height());
  if (rise < 0.8 || rise < 0.5 * std::min(a.height().length(), b.height().length()))
    return std::nullopt;
  gap.depth = {0.5 * (da.low + db.low), 0.5 * (da.high + db.high)};
  gap.height = {0.5 * (a.height().low + b.height().low), 0.5 * (a.height().high + b.height().high)};
  return gap;
}

/// Share of the gap's width that walls at its back take, which look out of it.
double back_share(const std::vector<Panel>& panels, const Gap& gap, const Vec3& forward,
                  double back, double most_area, std::vector<const Panel*>& found) {
  double sum = 0;
  for (const Panel& p : panels) {
    if (!p.is_wall || p.out.dot(forward) < kAlike || p.plane->area > most_area) continue;
    if (std::abs(p.at(forward) - back) > kReach) continue;
    const double rise = overlap(p.height(), gap.height);
    if (rise < 0.4 * gap.height.length()) continue;
    const double share = overlap(p.along(gap.across), gap.width) / gap.width.length();
    if (share <= 0.05) continue;
    sum += share, found.push_back(&p);
  }
  return sum;
}

/// A wall larger than a niche's cheeks that looks the same way as the niche and lies in its mouth.
bool is_behind_facade(const std::vector<Panel>& panels, const Gap& gap, const Vec3& forward,
                      double mouth, double least_area) {
  for (const Panel& p : panels)
    if (p.is_wall && p.out.dot(forward) > kAlike && p.plane->area >= least_area &&
        std::abs(p.at(forward) - mouth) < kReach && overlap(p.along(gap.across), gap.width) > -1 &&
        overlap(p.height(), gap.height) > -1.5)
      return true;
  return false;
}

std::optional<Hollow> niche_in(const std::vector<Panel>& panels, const Gap& gap, double largest) {
  const double most_back = std::min(30.0, 0.3 * largest);
  for (const double sign : {1.0, -1.0}) {
    const Vec3 forward = sign * gap.forward;
    const double back = sign > 0 ? gap.depth.low : -gap.depth.high;
    const double mouth = sign > 0 ? gap.depth.high : -gap.depth.low;
    std::vector<const Panel*> backs;
    const double closed = back_share(panels, gap, forward, back, most_back, backs);
    const Panel* ceiling = nullptr;
    const Panel* floor = nullptr;
    for (const Panel& p : panels) {
      if (!p.is_ceiling && !p.is_floor) continue;
      if (p.plane->area > most_back) continue;
      if (overlap(p.along(gap.across), gap.width) < 0.6 * gap.width.length() ||
          p.along(gap.across).length() > 1.3 * gap.width.length())
        continue;
      if (overlap(p.along(gap.forward), gap.depth) < 0.5 * gap.depth.length()) continue;
      const double at = p.is_ceiling ? gap.height.high : gap.height.low;
      if (std::abs(p.plane->centroid.z() - at) > 0.5) continue;
      const Panel*& kept = p.is_ceiling ? ceiling : floor;
      if (!kept || p.plane->area > kept->plane->area) kept = &p;
    }
    if (closed < 0.5 && !ceiling) continue;
    const double cheeks = std::max(gap.left->plane->area, gap.right->plane->area);
    if (!is_behind_facade(panels, gap, forward, mouth, std::max(2 * cheeks, 10.0))) continue;

    Range height = gap.height;
    if (ceiling) height.high = ceiling->plane->centroid.z();
    if (floor) height.low = floor->plane->centroid.z();
    const auto largest_back = std::max_element(backs.begin(), backs.end(), [](auto* x, auto* y) {
      return x->plane->area < y->plane->area;
    });
    const Panel* closing = backs.empty() ? nullptr : *largest_back;
    const double behind = closing ? closing->at(forward) : back;
    Hollow niche{Hollow::Kind::kNiche, {gap.left->id, gap.right->id}, {}, {}, {}, {}, {}};
    niche.air = {{-gap.left->plane->normal, -gap.left->plane->offset},
                 {-gap.right->plane->normal, -gap.right->plane->offset},
                 {-forward, -behind + 0.02},
                 {forward, mouth + 0.15},
                 {Vec3::UnitZ(), height.high + 0.02},
                 {-Vec3::UnitZ(), -height.low + 0.02}};
    const Range depth = sign > 0 ? Range{behind, mouth} : Range{behind, mouth};
    if (!ceiling)
      niche.rims.push_back(level_rim(-1, height.high, gap.across, gap.width, forward, depth));
    if (!floor)
      niche.rims.push_back(level_rim(1, height.low, gap.across, gap.width, forward, depth));
    if (closed < 0.5) {
      const Range across =
          forward.dot(gap.forward) > 0 ? Range{-gap.width.high, -gap.width.low} : gap.width;
      niche.rims.push_back(upright_rim(forward, behind, across, height));
    }
    if (ceiling) niche.planes.push_back(ceiling->id);
    if (floor) niche.planes.push_back(floor->id);
    niche.bounds = niche.planes;
    if (closing) niche.bounds.push_back(closing->id);
    Region grown = niche.air;
    for (HalfSpace& h : grown) h.offset += 0.25;
    for (const Panel& p : panels) {
      if (p.plane->area > most_back) continue;
      std::size_t in = 0;
      for (const Vec3& v : p.plane->outline.vertices) in += contains(grown, v);
      if (contains(grown, p.plane->centroid) &&
          static_cast<double>(in) > 0.7 * static_cast<double>(p.plane->outline.vertices.size()))
        niche.planes.push_back(p.id);
    }
    return niche;
  }
  return std::nullopt;
}

// ---- shafts

/// A triangle of its outline has its middle there.
bool reaches_into(const Panel& panel, const Region& region) {
  const Outline& outline = panel.plane->outline;
  return std::any_of(outline.triangles.begin(), outline.triangles.end(), [&](const Face& f) {
    return contains(region,
                    (outline.vertices[f[0]] + outline.vertices[f[1]] + outline.vertices[f[2]]) / 3);
  });
}

std::optional<Hollow> shaft_between(const std::vector<Panel>& panels, const Panel& a,
                                    const Panel& b) {
  if (a.out.dot(b.out) > -kAlike) return std::nullopt;
  const double apart = a.at(a.out) - b.at(a.out);
  if (apart < kLeastShaft || apart > kMostShaft) return std::nullopt;
  const Vec3 side = beside(a.out);
  Range across = a.along(side);
  const Range other = b.along(side);
  if (overlap(across, other) < 0.6 * std::min(across.length(), other.length()) ||
      std::max(across.length(), other.length()) > kMostShaft)
    return std::nullopt;
  if (overlap(a.height(), b.height()) < 0.4) return std::nullopt;
  across.extend(other);
  Range height = a.height();
  height.extend(b.height());
  const Range thick = {b.at(a.out), a.at(a.out)};
  Hollow shaft{Hollow::Kind::kShaft, {a.id, b.id}, {}, {}, {}, {}, {}};
  shaft.solid = {{a.plane->normal, a.plane->offset},
                 {b.plane->normal, b.plane->offset},
                 {side, across.high},
                 {-side, -across.low},
                 {Vec3::UnitZ(), height.high},
                 {-Vec3::UnitZ(), -height.low}};
  Region grown = shaft.solid;
  for (HalfSpace& h : grown) h.offset += 0.2;
  bool has_top = false, has_side[2] = {false, false};
  for (const Panel& p : panels) {
    if (!reaches_into(p, grown)) continue;
    if (p.plane->normal.z() > 0.3 && p.box.max.z() > height.high - 0.5) has_top = true;
    if (!p.is_wall) continue;
    for (const int k : {0, 1})
      if (p.out.dot(k ? side : Vec3(-side)) > kAlike) has_side[k] = true;
  }
  if (has_top) return std::nullopt;
  shaft.rims.push_back(level_rim(1, height.high, a.out, thick, side, across));
  shaft.rims.push_back(level_rim(-1, height.low, a.out, thick, side, across));
  for (const int k : {0, 1}) {
    if (has_side[k]) continue;
    const Vec3 out = k ? side : Vec3(-side);
    const Range width = beside(out).dot(a.out) > 0 ? thick : Range{-thick.high, -thick.low};
    shaft.rims.push_back(upright_rim(out, k ? across.high : -across.low, width, height));
  }
  return shaft;
}

/// Two walls around a corner, where the scan shows no more of a shaft: each is as wide as the other
/// side is deep.
std::optional<Hollow> shaft_at_corner(const std::vector<Panel>& panels, const Panel& a,
                                      const Panel& b) {
  if (std::abs(a.out.dot(b.out)) > 0.3) return std::nullopt;
  const Range depth_a = b.along(a.out), depth_b = a.along(b.out);
  for (const Range& r : {depth_a, depth_b})
    if (r.length() < kLeastShaft || r.length() > kMostCorner) return std::nullopt;
  if (std::abs(depth_a.high - a.at(a.out)) > kTouch ||
      std::abs(depth_b.high - b.at(b.out)) > kTouch)
    return std::nullopt;
  const double common = overlap(a.height(), b.height());
  if (common < 0.5 || common < 0.6 * std::min(a.height().length(), b.height().length()))
    return std::nullopt;
  Range height = a.height();
  height.extend(b.height());
  Hollow shaft{Hollow::Kind::kShaft, {a.id, b.id}, {}, {}, {}, {}, {}};
  shaft.solid = {{a.plane->normal, a.plane->offset},
                 {b.plane->normal, b.plane->offset},
                 {-a.out, -depth_a.low},
                 {-b.out, -depth_b.low},
                 {Vec3::UnitZ(), height.high},
                 {-Vec3::UnitZ(), -height.low}};
  Region grown = shaft.solid;
  for (HalfSpace& h : grown) h.offset += 0.2;
  for (const Panel& p : panels)
    if (p.id != a.id && p.id != b.id && (p.is_wall || p.plane->normal.z() > 0.3) &&
        p.box.max.z() > height.high - 0.5 && reaches_into(p, grown))
      return std::nullopt;
  shaft.rims.push_back(level_rim(1, height.high, a.out, depth_a, b.out, depth_b));
  shaft.rims.push_back(level_rim(-1, height.low, a.out, depth_a, b.out, depth_b));
  for (const bool is_a : {true, false}) {
    const Vec3 out = is_a ? Vec3(-a.out) : Vec3(-b.out);
    const Range& own = is_a ? depth_a : depth_b;
    const Range& other = is_a ? depth_b : depth_a;
    const bool is_along = beside(out).dot(is_a ? b.out : a.out) > 0;
    shaft.rims.push_back(
        upright_rim(out, -own.low, is_along ? other : Range{-other.high, -other.low}, height));
  }
  return shaft;
}

/// Of a tray, or other walls of a shaft that is known.
bool is_known(const Planes& planes, const std::vector<Hollow>& hollows, const Hollow& shaft) {
  for (const Hollow& h : hollows) {
    Region grown = h.solid;
    for (HalfSpace& side : grown) side.offset += kReach;
    for (const int p : shaft.planes) {
      if (std::find(h.planes.begin(), h.planes.end(), p) != h.planes.end()) return true;
      if (h.kind == Hollow::Kind::kShaft && contains(grown, planes.planes[p].centroid)) return true;
    }
  }
  return false;
}

void put_in_order(Hollow& hollow) {
  if (hollow.bounds.empty()) hollow.bounds = hollow.planes;
  for (std::vector<int>* list : {&hollow.planes, &hollow.bounds}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
}

}  // namespace

bool contains(const Region& region, const Vec3& x) {
  return std::all_of(region.begin(), region.end(),
                     [&](const HalfSpace& h) { return h.normal.dot(x) <= h.offset; });
}

std::vector<Hollow> find_hollows(const Planes& planes, const std::vector<int>& among) {
  const std::vector<Panel> panels = panels_of(planes, among);
  std::vector<Hollow> hollows;
  for (const Panel& p : panels)
    if (p.is_floor && p.plane->area >= 0.5 && p.plane->area <= kMostArea)
      if (auto tray = tray_on(panels, p)) hollows.push_back(std::move(*tray));
  const double largest = largest_area(panels);
  const double most_cheek = std::min(12.0, 0.1 * largest);
  std::vector<const Panel*> walls;
  for (const Panel& p : panels)
    if (p.is_wall && p.plane->area >= 0.3 && p.plane->area <= most_cheek) walls.push_back(&p);
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (std::size_t j = i + 1; j < walls.size(); ++j)
      if (is_near(walls[i]->box, walls[j]->box, kMostWidth))
        if (const auto gap = gap_between(*walls[i], *walls[j]))
          if (auto niche = niche_in(panels, *gap, largest)) hollows.push_back(std::move(*niche));
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (std::size_t j = i + 1; j < walls.size(); ++j)
      if (is_near(walls[i]->box, walls[j]->box, kMostShaft))
        if (auto shaft = shaft_between(panels, *walls[i], *walls[j]))
          if (!is_known(planes, hollows, *shaft)) hollows.push_back(std::move(*shaft));
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (std::size_t j = i + 1; j < walls.size(); ++j)
      if (is_near(walls[i]->box, walls[j]->box, kTouch))
        if (auto shaft = shaft_at_corner(panels, *walls[i], *walls[j]))
          if (!is_known(planes, hollows, *shaft)) hollows.push_back(std::move(*shaft));
  for (Hollow& h : hollows) put_in_order(h);
  return hollows;
}

}  // namespace colod
