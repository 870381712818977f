// Based on: walls under roof borders of airborne clouds as in Huang et al., "City3D", Remote
// Sensing 2022; lines simplified after Douglas & Peucker, 1973.
// Differs: the paper takes facades for granted. Here (robust rules only) a long border of a roof
// with no roof beyond it and no wall of the layer under it becomes a vertical candidate plane,
// which the min-cut may use or leave.
// Notation: the outer side of a border is the side away from its roof.
#include "walls.h"

#include <algorithm>
#include <cmath>

#include "core/flat.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::extraction::walls;

constexpr std::size_t kMost = 60;

struct Border {
  Vec2 a, b;  ///< the roof lies to the left
  double z;   ///< metres: the higher end
  double length;
  Vec2 outward() const { return Vec2(b.y() - a.y(), a.x() - b.x()) / length; }
  Vec2 middle() const { return 0.5 * (a + b); }
};

void add_borders(const Plane& roof, std::vector<Border>& borders) {
  for (const std::vector<int>& ring : roof.outline.rings) {
    if (ring.size() < 3) continue;
    std::vector<Vec3> points;
    for (const int v : ring) points.push_back(roof.outline.vertices[v]);
    // Starts at the vertex farthest from the first, which is likely a corner.
    const auto far = std::max_element(points.begin(), points.end(), [&](auto& p, auto& q) {
      return (p - points[0]).squaredNorm() < (q - points[0]).squaredNorm();
    });
    std::rotate(points.begin(), far, points.end());
    points.push_back(points[0]);
    const auto distance = [&](int i, int from, int to) {
      const Vec2 d = (points[to] - points[from]).head<2>(),
                 e = (points[i] - points[from]).head<2>();
      const double length = d.norm();
      return length > 0 ? std::abs(cross(d, e)) / length : e.norm();
    };
    const int last = static_cast<int>(points.size()) - 1;
    std::vector<int> kept = corners_between(0, last, kSimplify, distance);
    kept.insert(kept.begin(), 0), kept.push_back(last);
    for (std::size_t i = 0; i + 1 < kept.size(); ++i) {
      const Vec3 &p = points[kept[i]], &q = points[kept[i + 1]];
      const double length = (q - p).head<2>().norm();
      if (length >= kLeastBorder)
        borders.push_back({p.head<2>(), q.head<2>(), std::max(p.z(), q.z()), length});
    }
  }
}

/// A roof goes on beyond the border, at about its height or higher.
bool has_roof_beyond(const RayScene& rays, const Border& border, const Plane& roof) {
  int hits = 0;
  for (const double t : {0.2, 0.5, 0.8}) {
    const Vec2 p = border.a + t * (border.b - border.a), q = p + kBeside * border.outward();
    const double z = std::abs(roof.normal.z()) > 1e-6
                         ? (roof.offset - roof.normal.head<2>().dot(p)) / roof.normal.z()
                         : border.z;
    if (rays.first_hit({q.x(), q.y(), z - kSameRoof - kBeside}, Vec3::UnitZ())) ++hits;
  }
  return hits >= 2;
}

/// A wall of the layer runs along the border, under it or a little off.
bool is_supported(const Planes& planes, const std::vector<int>& layer_planes,
                  const Border& border) {
  const Vec2 middle = border.middle(), outward = border.outward();
  const Vec2 along(-outward.y(), outward.x());
  for (const int p : layer_planes) {
    const Plane& wall = planes.planes[p];
    const double horizontal = wall.normal.head<2>().norm();
    if (horizontal < 0.97 || wall.normal.head<2>().dot(outward) < kParallel * horizontal) continue;
    const double from =
        (wall.offset - wall.normal.z() * wall.centroid.z() - wall.normal.head<2>().dot(middle)) /
        horizontal;
    if (std::abs(from) > kSupport) continue;
    double low = 1e300, high = -1e300, bottom = 1e300;
    for (const Vec3& v : wall.outline.vertices) {
      const double t = along.dot(v.head<2>() - middle);
      low = std::min(low, t), high = std::max(high, t), bottom = std::min(bottom, v.z());
    }
    if (low < 0.5 && high > -0.5 && bottom < border.z) return true;
  }
  return false;
}

/// Of roofs that end there with no wall of the layer under them; the longest first.
std::vector<Border> lone_borders(const Planes& planes, const std::vector<int>& layer_planes,
                                 const RayScene& rays) {
  std::vector<Border> borders;
  for (const int p : layer_planes) {
    const Plane& roof = planes.planes[p];
    if (roof.normal.z() < 0.3) continue;
    std::vector<Border> own;
    add_borders(roof, own);
    for (const Border& b : own)
      if (!has_roof_beyond(rays, b, roof) && !is_supported(planes, layer_planes, b))
        borders.push_back(b);
  }
  std::stable_sort(borders.begin(), borders.end(),
                   [](const Border& a, const Border& b) { return a.length > b.length; });
  return borders;
}

struct Wall {
  Vec2 normal;
  double offset;
};

/// Across the border; as a wall of the building, or square to it, where it is nearly so.
Vec2 aligned_normal(const std::vector<Wall>& walls, const Border& border) {
  const Vec2 outward = border.outward();
  Vec2 normal = outward;
  double closest = kParallel;
  for (const Wall& w : walls)
    for (const Vec2& like : {w.normal, Vec2(-w.normal.y(), w.normal.x())}) {
      const double cosine = like.dot(outward);
      if (std::abs(cosine) <= closest) continue;
      closest = std::abs(cosine);
      normal = cosine > 0 ? like : Vec2(-like);
    }
  return normal;
}

CutPlane cut_under(const Border& border, const Wall& wall, const Box& box) {
  const Vec2 along(-wall.normal.y(), wall.normal.x());
  const double reach = 0.5 * border.length + 1.0, foot = box.min.z(), top = box.max.z();
  CutPlane cut{Vec3(wall.normal.x(), wall.normal.y(), 0), wall.offset, {}, -1};
  for (const auto& [t, z] : {std::pair{-reach, foot}, {reach, foot}, {reach, top}, {-reach, top}}) {
    const Vec2 p = border.middle() + t * along;
    cut.hull.emplace_back(p.x(), p.y(), z);
  }
  return cut;
}

}  // namespace

std::vector<CutPlane> walls_under_borders(const Planes& planes,
                                          const std::vector<int>& layer_planes,
                                          const RayScene& rays, const Box& box,
                                          const std::vector<CuttingPlan::Limit>& limits) {
  std::vector<CutPlane> cuts;
  std::vector<Wall> walls;
  for (const CuttingPlan::Limit& side : limits)
    if (side.normal.head<2>().norm() > 0.99)
      walls.push_back({side.normal.head<2>().normalized(), side.offset});
  const std::size_t most = walls.size() + kMost;
  for (const Border& b : lone_borders(planes, layer_planes, rays)) {
    if (walls.size() >= most) break;
    const bool is_known = std::any_of(walls.begin(), walls.end(), [&](const Wall& w) {
      return std::abs(w.normal.dot(b.outward())) > kParallel &&
             std::abs(w.normal.dot(b.middle()) - w.offset) < kTogether;
    });
    if (is_known) continue;
    const Vec2 normal = aligned_normal(walls, b);
    walls.push_back({normal, normal.dot(b.middle())});
    cuts.push_back(cut_under(b, walls.back(), box));
  }
  return cuts;
}

}  // namespace colod
