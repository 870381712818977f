// What a partition must always satisfy, and the arrangements that are known to be hard.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "partition/partition.h"

namespace colod::test {

inline CutPlane whole_plane(const Vec3& normal, const Vec3& through, int source = -1) {
  const Vec3 n = normal.normalized();
  return {n, n.dot(through), {}, source};
}

inline Box cube(double half) { return {Vec3::Constant(-half), Vec3::Constant(half)}; }

inline Eigen::Matrix3d some_rotation() {
  return Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
}

inline std::vector<CutPlane> rotated(std::vector<CutPlane> planes) {
  for (CutPlane& plane : planes) {
    plane.normal = some_rotation() * plane.normal;
    for (Vec3& p : plane.hull) p = some_rotation() * p;
  }
  return planes;
}

/// The mirror planes of the cube through one point: nine planes, 48 chambers. With copies, each
/// direction comes three times, the second time reversed.
inline std::vector<CutPlane> star(bool has_copies) {
  std::vector<CutPlane> planes;
  for (const double sign : has_copies ? std::vector{1.0, -1.0, 1.0} : std::vector{1.0})
    for (const Vec3& n :
         {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 0), Vec3(1, -1, 0), Vec3(0, 1, 1),
          Vec3(0, 1, -1), Vec3(1, 0, 1), Vec3(1, 0, -1)})
      planes.push_back(whole_plane(sign * n, Vec3::Zero()));
  return planes;
}

/// Different planes through the z axis, with normals (a, b) and (−b, a) of small whole numbers.
inline std::vector<CutPlane> pencil(std::size_t count) {
  std::vector<CutPlane> planes;
  for (int a = 1; planes.size() < count; ++a)
    for (int b = 1 - a; b <= a; ++b)
      if (std::gcd(a, b) == 1)
        for (const Vec3& n : {Vec3(a, b, 0), Vec3(-b, a, 0)})
          planes.push_back(whole_plane(n, Vec3::Zero()));
  planes.resize(count);
  return planes;
}

/// x, y, z = −n … n.
inline std::vector<CutPlane> lattice(int n) {
  std::vector<CutPlane> planes;
  for (int i = -n; i <= n; ++i)
    for (int k = 0; k < 3; ++k) planes.push_back(whole_plane(Vec3::Unit(k), Vec3::Constant(i)));
  return planes;
}

inline double unit(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

/// Rectangles as buildings have them, in a box of 44 × 34 × 22 m: upright in two directions (with
/// half a degree of noise), level and sloped ones; sizes from 15 m down to 0.5 m, largest first,
/// the small ones near the large ones; hulls grown by 0.1 m.
inline std::vector<CutPlane> building_like(int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<CutPlane> planes;
  for (int i = 0; i < count; ++i) {
    const double kind = unit(random);
    const double turn = (random() % 2 ? 0.3 : 1.8708) + 0.01 * (unit(random) - 0.5);
    Vec3 n(std::cos(turn), std::sin(turn), 0);
    if (kind > 0.7) n = Vec3::UnitZ();
    if (kind > 0.85) n = Vec3(n.x(), n.y(), 0.5 + unit(random)).normalized();
    if (random() % 2) n = -n;
    const auto [u, v] = plane_basis(n);
    const double size = std::max(1.0, 30 / std::sqrt(1 + 0.2 * i));
    const double a = size * (0.3 + 0.7 * unit(random)) / 2 + 0.1;
    const double b = size * (0.3 + 0.7 * unit(random)) / 2 + 0.1;
    Vec3 c(40 * unit(random) - 20, 30 * unit(random) - 15, 20 * unit(random) - 10);
    if (i > 20) {
      const std::vector<Vec3>& host = planes[random() % 20].hull;
      const double s = unit(random), t = unit(random);
      c = host[0] + s * (host[1] - host[0]) + t * (host[3] - host[0]) + (unit(random) - 0.5) * n;
    }
    planes.push_back({n,
                      n.dot(c),
                      {c - a * u - b * v, c + a * u - b * v, c + a * u + b * v, c - a * u + b * v},
                      i});
  }
  return planes;
}

inline Box building_box() { return {Vec3(-22, -17, -11), Vec3(22, 17, 11)}; }

/// Every edge of every piece, split at all vertices of its line: per piece the closed vertex list.
inline std::vector<std::vector<int>> conforming(const Partition& p) {
  struct Line {
    int a, b;
    std::set<int> members;
    std::vector<int> order;
    std::unordered_map<int, int> rank;
  };
  std::map<LineId, Line> lines;
  const auto line_of = [&](const Partition::Piece& piece, std::size_t i) -> Line& {
    return lines
        .try_emplace(line_id(p, piece.plane, piece.line_planes[i]),
                     Line{piece.plane, piece.line_planes[i], {}, {}, {}})
        .first->second;
  };
  for (const Partition::Piece& piece : p.pieces)
    for (std::size_t i = 0; i < piece.polygon.size(); ++i) {
      Line& line = line_of(piece, i);
      line.members.insert(piece.polygon[i]);
      line.members.insert(piece.polygon[(i + 1) % piece.polygon.size()]);
    }
  for (auto& [id, line] : lines) {
    line.order.assign(line.members.begin(), line.members.end());
    std::sort(line.order.begin(), line.order.end(),
              [&, a = line.a, b = line.b](int v, int w) { return along_line_less(p, a, b, v, w); });
    for (std::size_t i = 0; i < line.order.size(); ++i)
      line.rank[line.order[i]] = static_cast<int>(i);
  }
  std::vector<std::vector<int>> rings;
  for (const Partition::Piece& piece : p.pieces) {
    std::vector<int> ring;
    for (std::size_t i = 0; i < piece.polygon.size(); ++i) {
      const Line& line = line_of(piece, i);
      const int from = line.rank.at(piece.polygon[i]);
      const int to = line.rank.at(piece.polygon[(i + 1) % piece.polygon.size()]);
      for (int r = from; r != to; r += to > from ? 1 : -1) ring.push_back(line.order[r]);
    }
    rings.push_back(ring);
  }
  return rings;
}

/// "" or what is wrong with the pieces as polygons: exactly on their planes, strictly convex,
/// counter-clockwise.
inline std::string wrong_pieces(const Partition& p) {
  for (const Partition::Piece& piece : p.pieces) {
    const std::size_t n = piece.polygon.size();
    if (n < 3 || piece.line_planes.size() != n) return "corners";
    if (piece.cells[0] < 0 || (piece.cells[1] < 0) != (piece.plane < 6)) return "cells";
    for (std::size_t i = 0; i < n; ++i) {
      const int a = piece.polygon[i], b = piece.polygon[(i + 1) % n],
                c = piece.polygon[(i + 2) % n];
      if (side(p, piece.plane, a) != 0) return "corner beside the plane";
      if (side(p, piece.line_planes[i], a) != 0 || side(p, piece.line_planes[i], b) != 0)
        return "edge beside its line";
      if (orientation(p, piece.plane, a, b, c) != 1) return "not convex";
    }
  }
  return "";
}

/// "" or what is wrong with one cell, given its pieces: each elementary edge once each way, all
/// corners on the right side of all planes, and Euler's formula for the merged polyhedron.
inline std::string wrong_cell(const Partition& p, const std::vector<std::vector<int>>& rings,
                              const std::vector<int>& pieces, int cell) {
  std::map<std::pair<int, int>, int> plane_of_edge;
  std::map<int, std::set<int>> planes_of_vertex;
  std::set<int> planes;
  for (const int id : pieces) {
    const Partition::Piece& piece = p.pieces[id];
    const bool is_behind = piece.cells[0] == cell;
    planes.insert(piece.plane);
    for (std::size_t i = 0; i < rings[id].size(); ++i) {
      int a = rings[id][i], b = rings[id][(i + 1) % rings[id].size()];
      if (!is_behind) std::swap(a, b);
      if (!plane_of_edge.try_emplace({a, b}, piece.plane).second) return "edge used twice one way";
      planes_of_vertex[a].insert(piece.plane);
    }
  }
  std::set<std::pair<int, int>> edges;
  for (const auto& [edge, plane] : plane_of_edge) {
    const auto back = plane_of_edge.find({edge.second, edge.first});
    if (back == plane_of_edge.end()) return "open edge";
    if (plane != back->second) edges.insert(std::minmax(plane, back->second));
  }
  int corners = 0;
  for (const auto& [v, around] : planes_of_vertex) corners += around.size() >= 3;
  for (const int id : pieces)
    for (const auto& [v, around] : planes_of_vertex)
      if (side(p, p.pieces[id].plane, v) * (p.pieces[id].cells[0] == cell ? 1 : -1) > 0)
        return "corner on the wrong side";
  const int euler = corners - static_cast<int>(edges.size()) + static_cast<int>(planes.size());
  return euler == 2 ? "" : "Euler's number is " + std::to_string(euler);
}

/// How many cells have which fault.
inline std::map<std::string, int> wrong_cells(const Partition& p) {
  std::vector<std::vector<int>> pieces_of(p.cells.size());
  for (std::size_t i = 0; i < p.pieces.size(); ++i)
    for (const int cell : p.pieces[i].cells)
      if (cell >= 0) pieces_of[cell].push_back(static_cast<int>(i));
  const auto rings = conforming(p);
  std::map<std::string, int> wrong;
  for (std::size_t c = 0; c < p.cells.size(); ++c)
    ++wrong[wrong_cell(p, rings, pieces_of[c], static_cast<int>(c))];
  return wrong;
}

inline double total_volume(const Partition& p) {
  double volume = 0;
  for (const Partition::Cell& cell : p.cells) volume += cell.volume;
  return volume;
}

/// All that must hold for every partition.
inline void check_partition(const Partition& p) {
  CHECK(wrong_pieces(p) == "");
  CHECK(total_volume(p) == Approx(p.box.size().prod()).epsilon(1e-9));
  CHECK(p.points.size() == p.vertices.size());
  std::set<std::array<__int128, 4>> points;
  for (const Partition::Vertex& v : p.vertices) points.insert(v.h);
  CHECK(points.size() == p.vertices.size());
  for (const auto& [what, count] : wrong_cells(p)) {
    INFO(what << " in " << count << " cells");
    CHECK(what == "");
  }
}

}  // namespace colod::test
