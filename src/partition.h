// Room 8: planes of a layer → convex cells, exact (paper section 3.3, Binary Space Partition).
//
// Everything combinatorial is decided by integer predicates, nothing by an epsilon (partition.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry.h"

namespace colod {

/// A plane that cuts, with the part of space that it reaches.
struct CutPlane {
  Vec3 normal;  ///< unit
  double offset = 0;
  std::vector<Vec3> hull;  ///< convex hull of its outline, grown; empty: the plane cuts everything
  int source_plane = -1;   ///< index kept through to PolygonMesh::Facet::plane
};

struct PartitionOptions {
  int max_cells = 200000;  ///< a count, not seconds; when it is hit the remaining planes are left
                           ///< out, and `warnings` says so
};

/// The cells of the box and the pieces of plane between them.
struct Partition {
  /// Integer planes: normal·x + d = 0 in grid units; plane ids index this. The first six are the
  /// box.
  struct IntPlane {
    std::array<std::int32_t, 3> normal;
    std::int64_t d;
    int source_plane;
  };
  std::vector<IntPlane> planes;

  /// Homogeneous canonical points (X, Y, Z, W)/gcd, W > 0: equal points have equal ids.
  struct Vertex {
    std::array<__int128, 4> h;
  };
  std::vector<Vertex> vertices;
  std::vector<Vec3> points;  ///< the vertices as doubles, metres, local frame

  struct Cell {
    Vec3 centroid;
    double volume = 0;  ///< m³; the volumes of all cells sum to the box's
    Box box;
  };
  std::vector<Cell> cells;

  /// A convex polygon on `plane`; `cells` = {on the plane's negative side, on its positive side};
  /// −1: outside the box. `polygon` is counter-clockwise about the plane's normal. `line_planes[i]`
  /// is the plane that meets this one along edge i.
  struct Piece {
    int plane;
    std::array<int, 2> cells;
    std::vector<int> polygon;
    std::vector<int> line_planes;
  };
  std::vector<Piece> pieces;

  double grid = 0;  ///< metres per grid unit
  Vec3 origin;      ///< of the grid
  std::vector<std::string> warnings;
};

/// Cuts `box` by the planes in the order given (largest first is best; coarse layers first makes
/// layers nest).
Partition partition_space(const std::vector<CutPlane>& planes, const Box& box,
                          const PartitionOptions& options = {});

}  // namespace colod
