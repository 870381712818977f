// Inside room `partition`: convex cells with exact vertices, and how a plane splits them.
#pragma once

#include <utility>
#include <vector>

#include "predicates.h"

namespace colod {

/// A corner of a polygon, and a plane that meets the polygon's plane along the edge to the next
/// one.
struct Corner {
  int vertex;
  int line_plane;
};
using Ring = std::vector<Corner>;

/// A convex polyhedron; faces counter-clockwise seen from outside, one a plane, each edge in
/// exactly two faces with the same end points.
struct ConvexCell {
  struct Face {
    int plane;
    int begin;  ///< of its corners
    int end;
  };
  std::vector<Face> faces;
  std::vector<Corner> corners;

  void add_face(int plane, const Ring& ring);
};

/// What splitting needs of a partition under construction.
class Splitter {
 public:
  explicit Splitter(Partition& partition) : partition_(partition), table_(partition.vertices) {}

  ConvexCell box_cell();

  /// The side of the vertex; remembered until another plane is asked for.
  int sign(int plane, int vertex);

  /// Cuts `cell` by a plane: `cell` keeps the negative part, `positive` gets the other, `cut` the
  /// polygon between them, counter-clockwise about the plane's normal. False, and nothing changed,
  /// where the cell does not lie strictly on both sides.
  bool split(ConvexCell& cell, int plane, ConvexCell& positive, Ring& cut);

  /// Cuts a convex polygon on `ring_plane` by another plane; a part may be empty. An edge on the
  /// plane goes with the part that it bounds.
  void split(const Ring& ring, int ring_plane, int plane, Ring& negative, Ring& positive);

 private:
  struct Crossing {
    int a, b;  ///< ends of the edge, a < b
    int vertex;
  };
  void split_ring(const Ring& ring, int ring_plane, int plane, Ring& negative, Ring& positive);
  int crossing(int a, int b, int ring_plane, int line_plane, int plane);
  bool is_crossed(const ConvexCell& cell, int plane);

  Partition& partition_;
  VertexTable table_;
  std::vector<Crossing> crossings_;  ///< of the cell being split
  std::vector<int> signed_for_;      ///< per vertex: the plane that signs_ is about
  std::vector<signed char> signs_;
};

/// Volume, centroid and box, in metres; the partition's `points` are set.
Partition::Cell measure(const ConvexCell& cell, const std::vector<Vec3>& points);

}  // namespace colod
