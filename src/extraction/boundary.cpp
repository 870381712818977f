// Based on: the boundary of a union of convex cells; half-edges as in Mäntylä, "An Introduction to
// Solid Modeling", 1988.
// Differs: the paper does not say how neighbouring faces are made to share their edges. Here every
// edge is split at all vertices of the boundary that lie on its line, found and ordered by integer
// predicates, so that no T-junction is left and no coordinate is ever compared.
// Notation: a corner is one position of one polygon's loop; the half-edge of a corner runs from it
// to the next corner of the loop.
#include "boundary.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <tuple>

#include "core/union_find.h"

namespace colod {
namespace {

struct HalfEdge {
  int low, high;  ///< the two vertices, rising
  bool is_forward;
  int corner;  ///< global number of the corner it starts at
  int next;    ///< global number of the corner it ends at
};

std::vector<HalfEdge> sorted_half_edges(const std::vector<std::vector<int>>& loops) {
  std::vector<HalfEdge> edges;
  int first = 0;
  for (const std::vector<int>& loop : loops) {
    const int n = static_cast<int>(loop.size());
    for (int i = 0; i < n; ++i) {
      const int a = loop[i], b = loop[(i + 1) % n];
      edges.push_back({std::min(a, b), std::max(a, b), a < b, first + i, first + (i + 1) % n});
    }
    first += n;
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& x, const HalfEdge& y) {
    return std::tie(x.low, x.high, x.corner) < std::tie(y.low, y.high, y.corner);
  });
  return edges;
}

/// Groups of loops that meet at an edge with other than one use in each direction, or at a vertex
/// with more than one fan.
std::vector<std::vector<int>> pinched_loops(const std::vector<std::vector<int>>& loops) {
  std::vector<int> loop_of_corner, vertex_of_corner;
  for (std::size_t l = 0; l < loops.size(); ++l)
    for (const int v : loops[l]) {
      loop_of_corner.push_back(static_cast<int>(l));
      vertex_of_corner.push_back(v);
    }
  std::vector<std::vector<int>> pinches;
  std::vector<int> vertices_done;
  UnionFind fans(loop_of_corner.size());
  const std::vector<HalfEdge> edges = sorted_half_edges(loops);
  for (std::size_t i = 0, j; i < edges.size(); i = j) {
    for (j = i; j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high;)
      ++j;
    if (j - i == 2 && edges[i].is_forward != edges[i + 1].is_forward) {
      fans.unite(edges[i].corner, edges[i + 1].next);
      fans.unite(edges[i].next, edges[i + 1].corner);
      continue;
    }
    pinches.emplace_back();
    for (std::size_t k = i; k < j; ++k) pinches.back().push_back(loop_of_corner[edges[k].corner]);
    vertices_done.insert(vertices_done.end(), {edges[i].low, edges[i].high});
  }
  std::sort(vertices_done.begin(), vertices_done.end());

  std::vector<int> corners(loop_of_corner.size());
  std::iota(corners.begin(), corners.end(), 0);
  std::stable_sort(corners.begin(), corners.end(),
                   [&](int a, int b) { return vertex_of_corner[a] < vertex_of_corner[b]; });
  for (std::size_t i = 0, j; i < corners.size(); i = j) {
    const int vertex = vertex_of_corner[corners[i]];
    bool is_pinched = false;
    for (j = i; j < corners.size() && vertex_of_corner[corners[j]] == vertex; ++j)
      is_pinched |= fans.find(corners[j]) != fans.find(corners[i]);
    if (!is_pinched || std::binary_search(vertices_done.begin(), vertices_done.end(), vertex))
      continue;
    pinches.emplace_back();
    for (std::size_t k = i; k < j; ++k) pinches.back().push_back(loop_of_corner[corners[k]]);
  }
  return pinches;
}

}  // namespace

int BoundaryFinder::line_of(int plane_a, int plane_b) {
  const auto [a, b] = std::minmax(plane_a, plane_b);
  const std::uint64_t pair = static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
  const auto found = line_of_pair_.find(pair);
  if (found != line_of_pair_.end()) return found->second;
  const int fresh = static_cast<int>(planes_of_line_.size());
  const int line = line_of_id_.try_emplace(line_id(partition_, a, b), fresh).first->second;
  if (line == fresh) planes_of_line_.push_back({a, b});
  line_of_pair_[pair] = line;
  return line;
}

std::function<bool(int, int)> BoundaryFinder::less_on(int line) const {
  return [this, planes = planes_of_line_[line]](int v, int w) {
    return along_line_less(partition_, planes[0], planes[1], v, w);
  };
}

void BoundaryFinder::add_touching(const Boundary& boundary,
                                  std::vector<std::pair<int, int>>& vertices_of_line) {
  std::vector<char> is_on_boundary(partition_.vertices.size(), 0),
      is_used(partition_.pieces.size());
  for (const Boundary::Polygon& polygon : boundary.polygons) {
    is_used[polygon.piece] = 1;
    for (const int v : partition_.pieces[polygon.piece].polygon) is_on_boundary[v] = 1;
  }
  for (std::size_t p = 0; p < partition_.pieces.size(); ++p) {
    const Partition::Piece& piece = partition_.pieces[p];
    const std::size_t n = piece.polygon.size();
    for (std::size_t i = 0; i < n && !is_used[p]; ++i) {
      if (!is_on_boundary[piece.polygon[i]]) continue;
      for (const std::size_t edge : {i, (i + n - 1) % n})
        vertices_of_line.emplace_back(line_of(piece.plane, piece.line_planes[edge]),
                                      piece.polygon[i]);
    }
  }
}

std::vector<std::vector<int>> BoundaryFinder::sort_lines(
    std::vector<std::pair<int, int>> vertices_of_line) const {
  std::sort(vertices_of_line.begin(), vertices_of_line.end());
  vertices_of_line.erase(std::unique(vertices_of_line.begin(), vertices_of_line.end()),
                         vertices_of_line.end());
  std::vector<std::vector<int>> along(planes_of_line_.size());
  for (const auto& [line, vertex] : vertices_of_line) along[line].push_back(vertex);
  for (std::size_t line = 0; line < along.size(); ++line)
    if (along[line].size() > 2)
      std::sort(along[line].begin(), along[line].end(), less_on(static_cast<int>(line)));
  return along;
}

std::vector<int> BoundaryFinder::split_edge(int a, int b, int line,
                                            const std::vector<int>& order) const {
  std::vector<int> chain = {a};
  if (order.size() == 2) return chain;
  const auto less = less_on(line);
  const auto at = [&](int v) {
    return std::lower_bound(order.begin(), order.end(), v, less) - order.begin();
  };
  const auto from = at(a), to = at(b), step = from < to ? std::ptrdiff_t{1} : -1;
  for (auto j = from + step; j != to; j += step) chain.push_back(order[j]);
  return chain;
}

std::vector<std::vector<int>> BoundaryFinder::lines_of(
    const std::vector<int>& pieces, std::vector<std::pair<int, int>>& vertices_of_line) {
  std::vector<std::vector<int>> lines;
  for (const int p : pieces) {
    const Partition::Piece& piece = partition_.pieces[p];
    lines.emplace_back();
    const std::size_t n = piece.polygon.size();
    for (std::size_t i = 0; i < n; ++i) {
      lines.back().push_back(line_of(piece.plane, piece.line_planes[i]));
      vertices_of_line.emplace_back(lines.back()[i], piece.polygon[i]);
      vertices_of_line.emplace_back(lines.back()[i], piece.polygon[(i + 1) % n]);
    }
  }
  return lines;
}

Boundary BoundaryFinder::find(const std::vector<char>& is_inside) {
  const auto inside = [&](int cell) { return cell >= 0 && is_inside[cell]; };
  Boundary boundary;
  std::vector<int> pieces;
  for (std::size_t p = 0; p < partition_.pieces.size(); ++p) {
    const Partition::Piece& piece = partition_.pieces[p];
    if (inside(piece.cells[0]) == inside(piece.cells[1])) continue;
    const bool is_reversed = inside(piece.cells[1]);
    pieces.push_back(static_cast<int>(p));
    boundary.polygons.push_back({static_cast<int>(p),
                                 piece.plane,
                                 is_reversed,
                                 piece.cells[is_reversed],
                                 piece.cells[!is_reversed],
                                 {}});
  }
  std::vector<std::pair<int, int>> vertices_of_line;  // (line, vertex)
  const std::vector<std::vector<int>> lines = lines_of(pieces, vertices_of_line);
  add_touching(boundary, vertices_of_line);
  const std::vector<std::vector<int>> along = sort_lines(std::move(vertices_of_line));
  for (std::size_t k = 0; k < boundary.polygons.size(); ++k) {
    Boundary::Polygon& polygon = boundary.polygons[k];
    const std::vector<int>& corners = partition_.pieces[polygon.piece].polygon;
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (const int v : split_edge(corners[i], corners[(i + 1) % corners.size()], lines[k][i],
                                    along[lines[k][i]]))
        polygon.loop.push_back(v);
    if (polygon.is_reversed) std::reverse(polygon.loop.begin(), polygon.loop.end());
  }
  return boundary;
}

std::vector<std::pair<int, int>> BoundaryFinder::find_neighbours() {
  std::vector<int> pieces(partition_.pieces.size());
  std::iota(pieces.begin(), pieces.end(), 0);
  std::vector<std::pair<int, int>> vertices_of_line;
  const std::vector<std::vector<int>> lines = lines_of(pieces, vertices_of_line);
  const std::vector<std::vector<int>> along = sort_lines(std::move(vertices_of_line));
  std::vector<std::array<int, 4>> stretches;  // plane, both ends, piece
  for (const int p : pieces) {
    const Partition::Piece& piece = partition_.pieces[p];
    const std::size_t n = piece.polygon.size();
    for (std::size_t i = 0; i < n; ++i) {
      const int end = piece.polygon[(i + 1) % n];
      std::vector<int> chain = split_edge(piece.polygon[i], end, lines[p][i], along[lines[p][i]]);
      chain.push_back(end);
      for (std::size_t j = 0; j + 1 < chain.size(); ++j)
        stretches.push_back(
            {piece.plane, std::min(chain[j], chain[j + 1]), std::max(chain[j], chain[j + 1]), p});
    }
  }
  std::sort(stretches.begin(), stretches.end());
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t i = 0; i + 1 < stretches.size(); ++i)
    if (std::equal(stretches[i].begin(), stretches[i].begin() + 3, stretches[i + 1].begin()))
      pairs.emplace_back(stretches[i][3], stretches[i + 1][3]);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

std::vector<std::vector<int>> find_pinches(const Boundary& boundary) {
  std::vector<std::vector<int>> loops;
  loops.reserve(boundary.polygons.size());
  for (const Boundary::Polygon& polygon : boundary.polygons) loops.push_back(polygon.loop);
  std::vector<std::vector<int>> pinches = pinched_loops(loops);
  for (std::vector<int>& pinch : pinches) {
    std::vector<int> cells;
    for (const int polygon : pinch) {
      cells.push_back(boundary.polygons[polygon].inside);
      cells.push_back(boundary.polygons[polygon].outside);
    }
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    pinch = std::move(cells);
  }
  return pinches;
}

bool is_closed_manifold(const std::vector<Face>& triangles) {
  std::vector<std::vector<int>> loops;
  loops.reserve(triangles.size());
  for (const Face& f : triangles) loops.emplace_back(f.begin(), f.end());
  return pinched_loops(loops).empty();
}

}  // namespace colod
