// Inside room `extraction`: the faces between inside and outside cells.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/geometry.h"
#include "partition/partition.h"

namespace colod {

/// The pieces between an inside and an outside cell, split at every vertex on their lines, so that
/// an edge of one is an edge of its neighbours.
struct Boundary {
  struct Polygon {
    int piece;
    int plane;
    bool is_reversed;       ///< the outward normal looks against the plane's
    int inside, outside;    ///< cells; outside −1: beyond the box
    std::vector<int> loop;  ///< vertex ids, counter-clockwise seen from outside
  };
  std::vector<Polygon> polygons;
};

/// Finds boundaries of one partition; remembers which pairs of planes meet in the same line.
class BoundaryFinder {
 public:
  explicit BoundaryFinder(const Partition& partition) : partition_(partition) {}
  Boundary find(const std::vector<char>& is_inside);
  /// Pairs of pieces (a < b, rising) of one plane that have a stretch of an edge in common.
  std::vector<std::pair<int, int>> find_neighbours();

 private:
  int line_of(int plane_a, int plane_b);
  /// Orders vertices of the line.
  std::function<bool(int, int)> less_on(int line) const;
  /// Per piece the line of each edge; appends the ends to `vertices_of_line`.
  std::vector<std::vector<int>> lines_of(const std::vector<int>& pieces,
                                         std::vector<std::pair<int, int>>& vertices_of_line);
  /// Per line its vertices in order.
  std::vector<std::vector<int>> sort_lines(std::vector<std::pair<int, int>> vertices_of_line) const;
  /// The vertices from a to b, without b, of a line's.
  std::vector<int> split_edge(int a, int b, int line, const std::vector<int>& order) const;
  /// Vertices of the boundary that only touch a line of it, as corners of pieces between equal
  /// cells.
  void add_touching(const Boundary& boundary, std::vector<std::pair<int, int>>& vertices_of_line);

  const Partition& partition_;
  std::unordered_map<std::uint64_t, int> line_of_pair_;
  std::unordered_map<LineId, int, LineIdHash> line_of_id_;
  std::vector<std::array<int, 2>> planes_of_line_;
};

/// The cells around each edge with more than two faces and each vertex with more than one fan of
/// faces; −1 stands for the space beyond the box. Empty: the boundary is a closed 2-manifold.
std::vector<std::vector<int>> find_pinches(const Boundary& boundary);

/// The same for triangles: every edge once in each direction, every vertex one fan.
bool is_closed_manifold(const std::vector<Face>& triangles);

}  // namespace colod
