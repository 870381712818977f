// Inside room `elements`: the planes as detectors see them, and what all of these ask of them.
#pragma once

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "elements.h"
#include "parameters.h"

namespace colod::elements {

using namespace parameters::elements::panels;

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  double length() const { return std::max(0.0, high - low); }
  void extend(const Range& r) { low = std::min(low, r.low), high = std::max(high, r.high); }
};
/// Negative: how far apart.
double overlap(const Range& a, const Range& b);

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

/// In the order of `among`, without those that have no outline.
std::vector<Panel> panels_of(const Planes& planes, const std::vector<int>& among);
double largest_area(const std::vector<Panel>& panels);
/// Walls of at least 0.3 m², in order.
std::vector<const Panel*> walls_up_to(const std::vector<Panel>& panels, double most_area);
/// Walls that are small beside the building's largest plane, in order.
std::vector<const Panel*> small_walls(const std::vector<Panel>& panels);
/// Each pair whose boxes are within `reach` metres of each other, in order.
std::vector<std::pair<const Panel*, const Panel*>> near_pairs(
    const std::vector<const Panel*>& walls, double reach);
/// What of a panel lies near a box: walls of different parts are one plane where they are flush.
Panel part_near(Panel panel, const Box& around, double reach);

Vec3 beside(const Vec3& out);
bool is_near(const Box& a, const Box& b, double reach);
/// A triangle of its outline has its middle there.
bool reaches_into(const Panel& panel, const Region& region);

/// Inside the building, as most level rays from there see it: they meet planes from their back.
bool is_room(const std::vector<Panel>& panels, const Vec3& x);
/// The first plane that a ray meets shows it its back.
bool meets_back(const std::vector<Panel>& panels, const Vec3& from, const Vec3& direction);

/// The rectangle on a plane that covers ranges along two directions, a little grown.
std::vector<Vec3> rectangle(const Vec3& normal, double offset, const Vec3& a, const Range& ra,
                            const Vec3& b, const Range& rb);
/// `sign` 1: looks up, −1: down.
Element::Rim level_rim(double sign, double z, const Vec3& a, const Range& ra, const Vec3& b,
                       const Range& rb, int like = -1);
/// `across` is along beside(out).
Element::Rim upright_rim(const Vec3& out, double offset, const Range& across, const Range& height,
                         int like = -1);

}  // namespace colod::elements
