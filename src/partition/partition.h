// Planes of a layer → convex cells, exact (paper section 3.3, Binary Space Partition).
//
// Everything combinatorial is decided by integer predicates, nothing by an epsilon (partition.cpp).
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry.h"

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
  double clip_tolerance = 0.01;  ///< metres that a hull must reach into a cell to cut it; at most a
                                 ///< thousandth of the box's diagonal is used
};

/// The cells of the box and the pieces of plane between them.
struct Partition {
  /// Integer planes: normal·x + d = 0 in grid units, |normal| ≈ 2^23; plane ids index this. The
  /// first six are the box (−x, +x, −y, +y, −z, +z; normals point out of it, source_plane −1 unless
  /// an input plane lies on that side and looks the same way). The normal looks where that of the
  /// first input plane that rounds to it looks; later ones (also reversed) only name it in `cuts`.
  struct IntPlane {
    std::array<std::int32_t, 3> normal;
    std::int64_t d;
    int source_plane;
  };
  std::vector<IntPlane> planes;

  /// What became of an input plane.
  struct Cut {
    int plane = -1;            ///< id in `planes`; −1: not finite, or outside the box
    bool is_reversed = false;  ///< planes[plane].normal looks against the input's normal
  };
  std::vector<Cut> cuts;  ///< as long as the input

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
    int split_from = -1;  ///< the cell of a lower index that it was a part of until a plane parted
                          ///< them; −1: none, the first cell
  };
  std::vector<Cell> cells;

  /// A convex polygon on `plane`; `cells` = {on the plane's negative side, on its positive side};
  /// −1: outside the box. `polygon` is counter-clockwise about the plane's normal, without
  /// collinear vertices. `line_planes[i]` is a plane that meets this one along edge i → i + 1. Two
  /// pieces of one plane do not overlap, but vertices of one may lie inside edges of the other.
  struct Piece {
    int plane;
    std::array<int, 2> cells;
    std::vector<int> polygon;
    std::vector<int> line_planes;
  };
  std::vector<Piece> pieces;

  double grid = 0;  ///< metres per grid unit, a power of two
  Vec3 origin;      ///< of the grid: points = origin + grid · (X, Y, Z) / W
  Box box;          ///< the input box grown to the next grid units
  std::vector<std::string> warnings;
};

/// Cuts `box` by the planes in the order given (largest first is best; coarse layers first makes
/// layers nest). A plane splits only the cells that its hull reaches, but each of those completely.
/// Never empty: without planes the box is the one cell. The integer planes stay within a dozen grid
/// units (50 µm for a box of 100 m) of the input over its hull. Deterministic, single-threaded;
/// about 20 µs and 1.5 kB per cell. Throws Error{kProcess} for a box that is empty or not finite.
Partition partition_space(const std::vector<CutPlane>& planes, const Box& box,
                          const PartitionOptions& options = {});

/// Exact predicates for what is built on a partition; ids index `planes` and `vertices`.

/// The side of `plane` on which `vertex` lies: −1 (behind), 0 (on it), 1 (where the normal looks).
int side(const Partition& partition, int plane, int vertex);

/// 1 where a, b, c turn counter-clockwise about the normal of `plane`, −1 clockwise, 0 collinear.
/// \pre all three lie on `plane`.
int orientation(const Partition& partition, int plane, int a, int b, int c);

/// True where v comes before w along the line of both planes, directed by
/// normal(plane_a) × normal(plane_b). A strict weak order; equal ids are never less.
/// \pre both vertices lie on both planes, which are not parallel.
bool along_line_less(const Partition& partition, int plane_a, int plane_b, int v, int w);

/// A line in space, equal for every pair of planes that meets in it: Plücker coordinates
/// (direction, moment) divided by their gcd, first non-zero one positive.
struct LineId {
  std::array<__int128, 6> h{};
  auto operator<=>(const LineId&) const = default;
};
struct LineIdHash {
  std::size_t operator()(const LineId& line) const;
};

/// \pre the planes are not parallel.
LineId line_id(const Partition& partition, int plane_a, int plane_b);

}  // namespace colod
