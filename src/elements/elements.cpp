// Based on: nothing published; the planes of a balcony, a loggia and a chimney as scans show them.
// Differs: the paper knows closed segments and alcoves that rays see. Seen from the street a scan
//   has a balcony's outer faces and often its floor, not the inner faces of its parapet, rarely its
//   underside; a loggia's ceiling, cheeks and back, not its floor; a chimney without its top. Rays
//   then escape, or meet a thin wall from its back, and the part is closed over or cut away. Here
//   such parts are told by how their planes stand to each other, and what is missing is added.
// Notation: U floor of a tray, W its walls, d one of four horizontal directions.
#include "elements.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/flat.h"
#include "parts.h"

namespace colod {
namespace hollows {
namespace {

constexpr double kGrowth = 0.1;  // metres that a rim reaches beyond its part
constexpr int kRays = 16;        // that tell a room

/// 1: a ray first meets the front of a plane, −1: the back, 0: none.
int first_side(const std::vector<Panel>& panels, const Vec3& from, const Vec3& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  int side = 0;
  for (const Panel& p : panels) {
    const double slope = p.plane->normal.dot(direction);
    const double t = std::abs(slope) > 1e-6 ? -p.plane->signed_distance(from) / slope : -1;
    if (t <= 0 || t >= nearest || !covers(p.plane->outline, p.plane->normal, from + t * direction))
      continue;
    nearest = t, side = slope < 0 ? 1 : -1;
  }
  return side;
}

}  // namespace

double overlap(const Range& a, const Range& b) {
  return std::min(a.high, b.high) - std::max(a.low, b.low);
}

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

Panel part_near(Panel panel, const Box& around, double reach) {
  std::erase_if(panel.points, [&](const Vec3& x) {
    Box box;
    box.extend(x);
    return !is_near(box, around, reach);
  });
  panel.box = bounding_box(panel.points);
  return panel;
}

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
                      const Range& rb, int like) {
  const Vec3 normal = sign * Vec3::UnitZ();
  return {normal, sign * z, rectangle(normal, sign * z, a, ra, b, rb), like};
}

Hollow::Rim upright_rim(const Vec3& out, double offset, const Range& across, const Range& height,
                        int like) {
  return {out, offset, rectangle(out, offset, beside(out), across, Vec3::UnitZ(), height), like};
}

/// A triangle of its outline has its middle there.
bool reaches_into(const Panel& panel, const Region& region) {
  const Outline& outline = panel.plane->outline;
  return std::any_of(outline.triangles.begin(), outline.triangles.end(), [&](const Face& f) {
    return contains(region,
                    (outline.vertices[f[0]] + outline.vertices[f[1]] + outline.vertices[f[2]]) / 3);
  });
}

bool is_room(const std::vector<Panel>& panels, const Vec3& x) {
  int balance = 0;
  for (int k = 0; k < kRays; ++k) {
    const double angle = 2 * std::numbers::pi * (k + 0.5) / kRays;
    balance += first_side(panels, x, Vec3(std::cos(angle), std::sin(angle), 0));
  }
  return balance <= -kRays / 2;
}

bool meets_back(const std::vector<Panel>& panels, const Vec3& from, const Vec3& direction) {
  return first_side(panels, from, direction) < 0;
}

}  // namespace hollows

using namespace hollows;

namespace {

constexpr double kMostCheek = 12;      // m² of a wall beside a niche, a shaft or a bay
constexpr double kLeastUnderside = 1;  // m² of a tray whose floor is not seen

std::vector<const Panel*> walls_up_to(const std::vector<Panel>& panels, double most_area) {
  std::vector<const Panel*> walls;
  for (const Panel& p : panels)
    if (p.is_wall && p.plane->area >= 0.3 && p.plane->area <= most_area) walls.push_back(&p);
  return walls;
}

double largest_area(const std::vector<Panel>& panels) {
  double most = 0;
  for (const Panel& p : panels) most = std::max(most, p.plane->area);
  return most;
}

/// Of a tray, or other walls of a shaft or a bay that is known.
bool is_known(const Planes& planes, const std::vector<Hollow>& hollows, const Hollow& part) {
  for (const Hollow& h : hollows) {
    Region grown = h.solid;
    for (HalfSpace& side : grown) side.offset += kReach;
    for (const int p : part.planes) {
      if (std::find(h.planes.begin(), h.planes.end(), p) != h.planes.end()) return true;
      if (h.kind == part.kind && contains(grown, planes.planes[p].centroid)) return true;
    }
  }
  return false;
}

void put_in_order(Hollow& hollow) {
  if (hollow.bounds.empty() && !hollow.is_whole) hollow.bounds = hollow.planes;
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
  for (const Panel& p : panels)
    if (p.is_ceiling && p.plane->area >= kLeastUnderside && p.plane->area <= kMostArea)
      if (auto tray = tray_on(panels, p); tray && !is_known(planes, hollows, *tray))
        hollows.push_back(std::move(*tray));
  const double largest = largest_area(panels);
  const std::vector<const Panel*> sides = walls_up_to(panels, kMostCheek),
                                  walls = walls_up_to(panels, std::min(kMostCheek, 0.1 * largest));
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (std::size_t j = i + 1; j < walls.size(); ++j)
      if (is_near(walls[i]->box, walls[j]->box, kMostWidth))
        if (auto niche = niche_between(panels, *walls[i], *walls[j], largest))
          hollows.push_back(std::move(*niche));
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
  for (std::size_t i = 0; i < sides.size(); ++i)  // a small house's may be large beside its walls
    for (std::size_t j = i + 1; j < sides.size(); ++j)
      if (is_near(sides[i]->box, sides[j]->box, kMostWidth))
        if (auto bay = bay_between(panels, *sides[i], *sides[j]))
          if (!is_known(planes, hollows, *bay)) hollows.push_back(std::move(*bay));
  for (Hollow& h : dormers_on(panels)) hollows.push_back(std::move(h));
  for (const Panel& p : panels)
    if (auto recess = recess_before(panels, p)) hollows.push_back(std::move(*recess));
  for (Hollow& h : hollows) put_in_order(h);
  return hollows;
}

}  // namespace colod
