// Based on: elements.cpp.
// Differs: –
// Notation: –
#include "panels.h"

#include <cmath>
#include <numbers>

#include "core/flat.h"

namespace colod::elements {
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

double largest_area(const std::vector<Panel>& panels) {
  double most = 0;
  for (const Panel& p : panels) most = std::max(most, p.plane->area);
  return most;
}

std::vector<const Panel*> walls_up_to(const std::vector<Panel>& panels, double most_area) {
  std::vector<const Panel*> walls;
  for (const Panel& p : panels)
    if (p.is_wall && p.plane->area >= 0.3 && p.plane->area <= most_area) walls.push_back(&p);
  return walls;
}

std::vector<const Panel*> small_walls(const std::vector<Panel>& panels) {
  return walls_up_to(panels, std::min(kMostCheek, 0.1 * largest_area(panels)));
}

std::vector<std::pair<const Panel*, const Panel*>> near_pairs(
    const std::vector<const Panel*>& walls, double reach) {
  std::vector<std::pair<const Panel*, const Panel*>> pairs;
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (std::size_t j = i + 1; j < walls.size(); ++j)
      if (is_near(walls[i]->box, walls[j]->box, reach)) pairs.emplace_back(walls[i], walls[j]);
  return pairs;
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

Element::Rim level_rim(double sign, double z, const Vec3& a, const Range& ra, const Vec3& b,
                       const Range& rb, int like) {
  const Vec3 normal = sign * Vec3::UnitZ();
  return {normal, sign * z, rectangle(normal, sign * z, a, ra, b, rb), like};
}

Element::Rim upright_rim(const Vec3& out, double offset, const Range& across, const Range& height,
                         int like) {
  return {out, offset, rectangle(out, offset, beside(out), across, Vec3::UnitZ(), height), like};
}

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

}  // namespace colod::elements
