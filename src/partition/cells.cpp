// Based on: binary space partitions (Fuchs, Kedem and Naylor 1980) with plane-based polyhedra.
// Differs: the sign of a vertex is computed once a plane and shared by all faces and cells, so that
//   they cannot disagree; vertices on the plane go to both parts, and a face that only touches the
//   plane with an edge keeps that edge, relabelled, and lends it to the cut.
// Notation: negative/positive the parts behind and before the plane; a ring is a polygon with
// labels.
#include "cells.h"

#include <algorithm>
#include <cassert>

namespace colod {
namespace {

/// Edges that one part has on the cutting plane, turned round and chained to the face that closes
/// it.
Ring closing_face(const ConvexCell& part, int plane) {
  struct Edge {
    int from, to, face_plane;
  };
  std::vector<Edge> edges;
  for (const ConvexCell::Face& face : part.faces) {
    for (int i = face.begin; i < face.end; ++i) {
      if (part.corners[i].line_plane != plane) continue;
      const int next = i + 1 < face.end ? i + 1 : face.begin;
      edges.push_back({part.corners[next].vertex, part.corners[i].vertex, face.plane});
    }
  }
  Ring ring;
  for (std::size_t at = 0, count = 0; count < edges.size(); ++count) {
    ring.push_back({edges[at].from, edges[at].face_plane});
    const auto next = std::find_if(edges.begin(), edges.end(),
                                   [&](const Edge& e) { return e.from == edges[at].to; });
    assert(next != edges.end());
    at = next - edges.begin();
    assert((at == 0) == (count + 1 == edges.size()));  // one ring, and it uses every edge
  }
  return ring;
}

}  // namespace

void ConvexCell::add_face(int plane, const Ring& ring) {
  const int begin = static_cast<int>(corners.size());
  corners.insert(corners.end(), ring.begin(), ring.end());
  faces.push_back({plane, begin, static_cast<int>(corners.size())});
}

ConvexCell Splitter::box_cell() {
  const auto corner = [&](int x, int y, int z) {
    const auto& planes = partition_.planes;
    return table_.id(meet(planes[x], planes[2 + y], planes[4 + z]));
  };
  ConvexCell cell;
  for (int axis = 0; axis < 3; ++axis) {
    for (int end = 0; end < 2; ++end) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      // about +axis: (−u,−v) → (+u,−v) → (+u,+v) → (−u,+v), and the other way round on the low side
      const int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      const int along[4] = {2 * v, 2 * u + 1, 2 * v + 1, 2 * u};
      Ring ring;
      for (int i = 0; i < 4; ++i) {
        const int at = end == 1 ? i : (4 - i) % 4;
        int place[3];
        place[axis] = end, place[u] = around[at][0], place[v] = around[at][1];
        ring.push_back({corner(place[0], place[1], place[2]), along[end == 1 ? at : (at + 3) % 4]});
      }
      cell.add_face(2 * axis + end, ring);
    }
  }
  return cell;
}

int Splitter::sign(int plane, int vertex) {
  if (static_cast<std::size_t>(vertex) >= signed_for_.size()) {
    signed_for_.resize(partition_.vertices.size(), -1);
    signs_.resize(partition_.vertices.size());
  }
  if (signed_for_[vertex] != plane) {
    signed_for_[vertex] = plane;
    signs_[vertex] =
        static_cast<signed char>(side_of(partition_.planes[plane], partition_.vertices[vertex].h));
  }
  return signs_[vertex];
}

bool Splitter::is_crossed(const ConvexCell& cell, int plane) {
  bool has_negative = false, has_positive = false;
  for (const Corner& corner : cell.corners) {
    const int s = sign(plane, corner.vertex);
    has_negative |= s<0, has_positive |= s> 0;
    if (has_negative && has_positive) return true;
  }
  return false;
}

int Splitter::crossing(int a, int b, int ring_plane, int line_plane, int plane) {
  if (a > b) std::swap(a, b);
  for (const Crossing& c : crossings_)
    if (c.a == a && c.b == b) return c.vertex;
  const auto& planes = partition_.planes;
  const int vertex = table_.id(meet(planes[ring_plane], planes[line_plane], planes[plane]));
  crossings_.push_back({a, b, vertex});
  return vertex;
}

void Splitter::split(const Ring& ring, int ring_plane, int plane, Ring& negative, Ring& positive) {
  crossings_.clear();
  split_ring(ring, ring_plane, plane, negative, positive);
}

void Splitter::split_ring(const Ring& ring, int ring_plane, int plane, Ring& negative,
                          Ring& positive) {
  negative.clear(), positive.clear();
  bool has_negative = false, has_positive = false;
  for (const Corner& corner : ring) {
    const int s = sign(plane, corner.vertex);
    has_negative |= s<0, has_positive |= s> 0;
  }
  assert(has_negative || has_positive);  // a polygon never lies on a plane that cuts beside it
  if (!has_positive || !has_negative) {
    (has_positive ? positive : negative) = ring;
    return;
  }
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto [a, line] = ring[i];
    const int b = ring[i + 1 < ring.size() ? i + 1 : 0].vertex;
    const int sa = sign(plane, a), sb = sign(plane, b);
    // where an edge leaves a part, the cut follows in it
    if (sa <= 0) negative.push_back({a, sa == 0 && sb > 0 ? plane : line});
    if (sa >= 0) positive.push_back({a, sa == 0 && sb < 0 ? plane : line});
    if (sa * sb >= 0) continue;
    const int m = crossing(a, b, ring_plane, line, plane);
    negative.push_back({m, sa < 0 ? plane : line});
    positive.push_back({m, sa > 0 ? plane : line});
  }
}

bool Splitter::split(ConvexCell& cell, int plane, ConvexCell& positive, Ring& cut) {
  if (!is_crossed(cell, plane)) return false;
  crossings_.clear();
  ConvexCell negative;
  positive = {};
  Ring ring, behind, before;
  for (const ConvexCell::Face& face : cell.faces) {
    ring.assign(cell.corners.begin() + face.begin, cell.corners.begin() + face.end);
    split_ring(ring, face.plane, plane, behind, before);
    if (behind.empty() || before.empty()) {
      Ring& whole = behind.empty() ? before : behind;
      for (std::size_t i = 0; i < whole.size(); ++i) {
        const int next = whole[i + 1 < whole.size() ? i + 1 : 0].vertex;
        if (sign(plane, whole[i].vertex) == 0 && sign(plane, next) == 0)
          whole[i].line_plane = plane;
      }
    }
    if (!behind.empty()) negative.add_face(face.plane, behind);
    if (!before.empty()) positive.add_face(face.plane, before);
  }
  cut = closing_face(negative, plane);
  negative.add_face(plane, cut);
  positive.add_face(plane, closing_face(positive, plane));
  cell = std::move(negative);
  return true;
}

Partition::Cell measure(const ConvexCell& cell, const std::vector<Vec3>& points) {
  Partition::Cell result;
  const Vec3 apex = points[cell.corners.front().vertex];
  Vec3 moment = Vec3::Zero(), mean = Vec3::Zero();
  double volume = 0;
  for (const ConvexCell::Face& face : cell.faces) {
    const Vec3 a = points[cell.corners[face.begin].vertex] - apex;
    for (int i = face.begin; i < face.end; ++i) {
      const Vec3& point = points[cell.corners[i].vertex];
      result.box.extend(point);
      mean += (point - apex) / static_cast<double>(cell.corners.size());
      if (i == face.begin || i + 1 == face.end) continue;
      const Vec3 b = point - apex, c = points[cell.corners[i + 1].vertex] - apex;
      const double part = a.dot(b.cross(c)) / 6;
      volume += part;
      moment += part / 4 * (a + b + c);
    }
  }
  result.volume = std::max(volume, 0.0);
  // a sliver's volume has no digits left to divide by, but the mean of its corners is inside it
  const double extent = result.box.diagonal();
  const bool is_sliver = !(volume > 1e-12 * extent * extent * extent);
  result.centroid = apex + (is_sliver ? mean : Vec3(moment / volume));
  return result;
}

}  // namespace colod
