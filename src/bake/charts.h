// Inside room `bake` only: facets as rectangles, and rectangles in an atlas.
#pragma once

#include <algorithm>
#include <vector>

#include "core/geometry.h"
#include "image/packing.h"

namespace colod::bake {

/// A facet, or several in one plane that share edges, turned so that its rectangle is the smallest.
struct Chart {
  std::vector<int> triangles;
  Vec3 origin = Vec3::Zero();  ///< of the rectangle's upper left corner, seen from outside
  Vec3 right = Vec3::UnitX(), down = Vec3::UnitY();  ///< unit, in the plane
  Vec3 normal = Vec3::UnitZ();                       ///< unit, outward
  double width = 0, height = 0;                      ///< metres along right and down; width no less
  double area = 0;                                   ///< m², of its triangles
  bool is_blank = false;  ///< nobody saw it: it has one colour, and a single block of the atlas

  Vec2 flat(const Vec3& p) const { return {(p - origin).dot(right), (p - origin).dot(down)}; }
  /// How a normal stands on it: x right, y up, z outward; what turns away from it, as on a reveal,
  /// lies in its plane. Unit.
  Vec3 turned(const Vec3& n) const {
    const Vec3 own(n.dot(right), -n.dot(down), std::max(0.0, n.dot(normal)));
    return own.norm() > 0 ? own.normalized() : Vec3(Vec3::UnitZ());
  }
  Vec3 lift(const Vec2& q) const { return origin + q.x() * right + q.y() * down; }
};

/// By their first triangles.
std::vector<Chart> find_charts(const PolygonMesh& mesh);

/// Where charts lie; sides are multiples of 4.
struct Atlas {
  int width = 0, height = 0;
  double texel = 0;               ///< metres: as asked, or larger where the atlas would not fit
  std::vector<PackedRect> rects;  ///< per chart, with its gutters

  /// In texels; of a blank chart all lies within its block.
  Vec2 place(const Chart& chart, std::size_t index, const Vec2& q) const;
};

/// The smallest atlas found whose sides are at most `largest`.
Atlas pack_charts(const std::vector<Chart>& charts, double texel, int largest);

}  // namespace colod::bake
