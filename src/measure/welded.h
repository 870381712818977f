// A mesh over welded vertices: its edges, neighbours and polygons, for measures of its shape.
#pragma once

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

#include "core/geometry.h"

namespace colod {

/// The faces worth looking at, over welded vertices.
struct Welded {
  std::vector<Vec3> points;
  std::vector<Face> faces;     // three different vertices each, all finite
  std::int64_t collapsed = 0;  // faces that lost a vertex by welding, or are not finite
};

Welded weld(const Mesh& mesh);

/// One use of an edge by a face; sorted, the uses of one edge are neighbours.
struct EdgeUse {
  int low, high;   // vertices
  int face, side;  // side s of a face runs from its vertex s to its vertex s + 1
  bool is_forward;

  bool operator<(const EdgeUse& o) const {
    return std::tie(low, high, face, side) < std::tie(o.low, o.high, o.face, o.side);
  }
  bool is_same_edge(const EdgeUse& o) const { return low == o.low && high == o.high; }
};

std::vector<EdgeUse> sorted_edge_uses(const std::vector<Face>& faces);

/// Calls visit(first, last) for the uses of each edge.
template <typename Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, Visit visit) {
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    for (j = i + 1; j < uses.size() && uses[j].is_same_edge(uses[i]);) ++j;
    visit(i, j);
  }
}

/// Neighbours over edges with exactly two faces, −1: none.
std::vector<std::array<int, 3>> face_neighbours(const Welded& m, const std::vector<EdgeUse>& uses);

/// A face's unit normal (zero when degenerate), area and height over its longest side.
struct FaceShape {
  Vec3 normal = Vec3::Zero();
  double area = 0, height = 0;
};

FaceShape face_shape(const Welded& m, const Face& f);

/// Per face the number of its polygon, −1: degenerate. Grown from the largest face left, every face
/// judged against the seed's plane, so that a gently curved surface does not count as one polygon.
std::vector<int> find_polygons(const Welded& m, const std::vector<std::array<int, 3>>& neighbours,
                               const std::vector<FaceShape>& shapes);

}  // namespace colod
