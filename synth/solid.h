// Inside the synth room: a closed solid as planar facets, grown by attaching prisms to facets.
//
// Nothing is intersected. A part is attached by cutting its base out of the facet that carries it
// and adding the part's sides and cap on the same vertices, so a closed solid stays closed. What
// must hold is that bases lie inside their facet and apart from each other (`fits`).
#pragma once

#include <vector>

#include "core/geometry.h"

namespace colod::synth {

using Ring = std::vector<Vec2>;

/// A rectangle in a facet's own coordinates.
struct Rect {
  double u0 = 0, v0 = 0, u1 = 0, v1 = 0;

  Rect grown(double by) const { return {u0 - by, v0 - by, u1 + by, v1 + by}; }
  bool overlaps(const Rect& o) const { return u0 < o.u1 && o.u0 < u1 && v0 < o.v1 && o.v0 < v1; }
  Ring ring() const { return {{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}}; }
};

Rect bounds(const Ring& ring);
/// Positive when counter-clockwise.
double signed_area(const Ring& ring);

/// A planar polygon with holes. u is horizontal (to the right, seen from outside), v upwards; the
/// outer ring's lowest u and v are zero.
struct Facet {
  Vec3 origin, u, v, normal;
  Ring outer;                  ///< counter-clockwise about the normal
  std::vector<Ring> holes;     ///< counter-clockwise too
  std::vector<Rect> reserved;  ///< taken by something that stands before the facet
  int object = 0;

  Vec3 at(double pu, double pv, double height = 0) const {
    return origin + pu * u + pv * v + height * normal;
  }
  Vec2 project(const Vec3& p) const { return {(p - origin).dot(u), (p - origin).dot(v)}; }
  double width() const { return bounds(outer).u1; }
  double height() const { return bounds(outer).v1; }
};

/// What attaching leaves: the cap's facet and one side per edge of the base, in its order.
struct Attached {
  int cap = -1;
  std::vector<int> sides;
};

class Solid {
 public:
  /// A facet from its corners, counter-clockwise seen from outside. Returns its index.
  int add(const std::vector<Vec3>& corners, int object);
  /// Cuts `base` (counter-clockwise) out of the facet, joins it to `cap` (as many corners) by
  /// quadrangles, which must be planar.
  Attached attach(int facet, const Ring& base, const std::vector<Vec3>& cap, int object);
  /// A prism on the facet, outwards, or into it when `height` is negative. `cap_ring`: another ring
  /// than the base, with parallel edges.
  Attached extrude(int facet, const Ring& base, double height, int object,
                   const Ring& cap_ring = {});
  /// Joins two facets that face each other, or away from each other, by what stands on `base`
  /// straight along the first one's normal: a pillar between them, or a passage through the solid.
  /// Returns the sides.
  std::vector<int> connect(int facet, const Ring& base, int other, int object);
  /// Cuts `base` out and leaves the rest to facets that the caller adds.
  void cut(int facet, const Ring& base);

  /// The rectangle, grown by `margin`, lies inside the facet and apart from all that is on it.
  bool fits(int facet, const Rect& rect, double margin) const;

  int facet_count() const { return static_cast<int>(facets_.size()); }
  Facet& facet(int i) { return facets_[i]; }
  const Facet& facet(int i) const { return facets_[i]; }

  /// Welded and triangulated; facets that meet along a part of an edge get each other's vertices.
  Mesh triangulate(std::vector<int>& face_object) const;

 private:
  std::vector<Facet> facets_;
};

}  // namespace colod::synth
