// Planar polygons with holes from loose directed edges: the step that all outlines share. Not for
// other rooms.
#pragma once

#include <vector>

#include "core/geometry.h"

namespace colod::regions {

/// A directed edge with the covered side on its left.
struct Edge2 {
  Vec2 a, b;
};

/// A covered part of the plane.
struct Arrangement {
  std::vector<Vec2> vertices;
  std::vector<std::vector<int>> rings;  ///< outer counter-clockwise, holes clockwise; no ring
                                        ///< crosses or touches itself along an edge
  std::vector<Face> triangles;          ///< counter-clockwise, constrained Delaunay
  double area() const;
};

/// What the edges wind around at least once. Edges may cross, overlap and repeat, but together they
/// must be closed.
Arrangement arrange(const std::vector<Edge2>& edges);

/// The edges of the alpha shape (Delaunay triangles whose circumradius is at most `radius`).
std::vector<Edge2> alpha_shape(const std::vector<Vec2>& points, double radius);

double signed_area(const std::vector<Vec2>& ring);

/// Douglas–Peucker on a closed ring; fewer than three vertices left: empty.
std::vector<Vec2> simplify_ring(const std::vector<Vec2>& ring, double tolerance);

}  // namespace colod::regions
