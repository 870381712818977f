// *Based on:* Euler operators (Mäntylä, "An Introduction to Solid Modeling", 1988), of which only
// gluing a prism to a face is needed; constrained Delaunay triangulation of facets (CGAL).
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include "solid.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <set>

namespace colod::synth {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<int, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

constexpr double kWeld = 1e-6;  // m, corners nearer than this are one; parts are centimetres apart
constexpr double kCell = 1e-3;

/// Welds points as they come; the first of a group stays.
class Welder {
 public:
  int index(const Vec3& p) {
    std::array<std::int64_t, 3> low, high;
    for (int k = 0; k < 3; ++k) {
      low[k] = std::llround(std::floor((p[k] - kWeld) / kCell));
      high[k] = std::llround(std::floor((p[k] + kWeld) / kCell));
    }
    for (auto x = low[0]; x <= high[0]; ++x)
      for (auto y = low[1]; y <= high[1]; ++y)
        for (auto z = low[2]; z <= high[2]; ++z)
          if (const auto cell = cells_.find({x, y, z}); cell != cells_.end())
            for (int i : cell->second)
              if ((points[i] - p).norm() < kWeld) return i;
    const int i = static_cast<int>(points.size());
    points.push_back(p);
    cells_[{std::llround(std::floor(p.x() / kCell)), std::llround(std::floor(p.y() / kCell)),
            std::llround(std::floor(p.z() / kCell))}]
        .push_back(i);
    return i;
  }
  std::vector<Vec3> points;

 private:
  std::map<std::array<std::int64_t, 3>, std::vector<int>> cells_;
};

/// A facet's rings over welded vertices, holes reversed.
using Rings = std::vector<std::vector<int>>;

using DirectedEdges = std::set<std::pair<int, int>>;

DirectedEdges directed_edges(const std::vector<Rings>& facets) {
  DirectedEdges edges;
  for (const Rings& rings : facets)
    for (const auto& ring : rings)
      for (std::size_t i = 0; i < ring.size(); ++i)
        edges.insert({ring[i], ring[(i + 1) % ring.size()]});
  return edges;
}

/// Corners of `candidates` strictly inside the edge, in its order.
std::vector<int> corners_on(const std::vector<Vec3>& points, const std::set<int>& candidates, int a,
                            int b) {
  const Vec3 direction = (points[b] - points[a]).normalized();
  const double length = (points[b] - points[a]).norm();
  std::vector<std::pair<double, int>> on;
  for (int c : candidates) {
    const Vec3 to = points[c] - points[a];
    const double t = to.dot(direction);
    if (t > kWeld && t < length - kWeld && (to - t * direction).norm() < kWeld)
      on.push_back({t, c});
  }
  std::sort(on.begin(), on.end());
  std::vector<int> corners;
  for (const auto& [t, c] : on) corners.push_back(c);
  return corners;
}

/// Edges without a partner are split at the corners that lie on them.
void split_at_corners(const std::vector<Vec3>& points, std::vector<Rings>& facets) {
  const DirectedEdges edges = directed_edges(facets);
  std::set<int> candidates;
  const auto is_open = [&](int a, int b) { return !edges.count({b, a}); };
  for (const auto& [a, b] : edges)
    if (is_open(a, b)) candidates.insert({a, b});
  for (Rings& rings : facets)
    for (auto& ring : rings) {
      std::vector<int> full;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const int a = ring[i], b = ring[(i + 1) % ring.size()];
        full.push_back(a);
        if (!is_open(a, b)) continue;
        for (int c : corners_on(points, candidates, a, b)) full.push_back(c);
      }
      ring = full;
    }
}

/// Marks faces by how many rings must be crossed to reach them from outside.
void mark_depths(Triangulation& triangulation) {
  for (auto f : triangulation.all_face_handles()) f->info() = -1;
  std::vector<Triangulation::Face_handle> layer = {triangulation.infinite_face()};
  for (int depth = 0; !layer.empty(); ++depth) {
    std::vector<Triangulation::Face_handle> next, stack = layer;
    while (!stack.empty()) {
      const auto f = stack.back();
      stack.pop_back();
      if (f->info() >= 0) continue;
      f->info() = depth;
      for (int k = 0; k < 3; ++k) {
        const auto g = f->neighbor(k);
        if (g->info() < 0) (f->is_constrained(k) ? next : stack).push_back(g);
      }
    }
    layer = next;
  }
}

std::vector<Face> triangulate_rings(const std::vector<Vec3>& points, const Facet& facet,
                                    const Rings& rings) {
  Triangulation triangulation;
  std::map<int, Triangulation::Vertex_handle> handles;
  for (const auto& ring : rings)
    for (int i : ring)
      if (!handles.count(i)) {
        const Vec2 p = facet.project(points[i]);
        handles[i] = triangulation.insert({p.x(), p.y()});
        handles[i]->info() = i;
      }
  for (const auto& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i)
      triangulation.insert_constraint(handles[ring[i]], handles[ring[(i + 1) % ring.size()]]);
  mark_depths(triangulation);
  std::vector<Face> faces;
  for (auto f : triangulation.finite_face_handles())
    if (f->info() % 2 == 1)
      faces.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  for (Face& f : faces) std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  std::sort(faces.begin(), faces.end());
  return faces;
}

bool contains(const Ring& ring, const Vec2& p) {
  bool is_inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      is_inside = !is_inside;
  }
  return is_inside;
}

/// Liang and Barsky's clipping: does the segment pass through the rectangle?
bool crosses(const Vec2& a, const Vec2& b, const Rect& r) {
  double t0 = 0, t1 = 1;
  const Vec2 d = b - a;
  const double low[2] = {r.u0, r.v0}, high[2] = {r.u1, r.v1};
  for (int k = 0; k < 2; ++k) {
    if (d[k] == 0) {
      if (a[k] < low[k] || a[k] > high[k]) return false;
      continue;
    }
    const double s = (low[k] - a[k]) / d[k], t = (high[k] - a[k]) / d[k];
    t0 = std::max(t0, std::min(s, t));
    t1 = std::min(t1, std::max(s, t));
  }
  return t0 <= t1;
}

}  // namespace

Rect bounds(const Ring& ring) {
  Rect r = {ring[0].x(), ring[0].y(), ring[0].x(), ring[0].y()};
  for (const Vec2& p : ring) {
    r.u0 = std::min(r.u0, p.x()), r.u1 = std::max(r.u1, p.x());
    r.v0 = std::min(r.v0, p.y()), r.v1 = std::max(r.v1, p.y());
  }
  return r;
}

double signed_area(const Ring& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

int Solid::add(const std::vector<Vec3>& corners, int object) {
  Facet f;
  Vec3 normal = Vec3::Zero();  // Newell's
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += (corners[i] - corners[0]).cross(corners[(i + 1) % corners.size()] - corners[0]);
  f.normal = normal.normalized();
  const auto basis = plane_basis(f.normal);
  f.u = basis[0], f.v = basis[1];
  f.origin = corners[0];
  f.object = object;
  for (const Vec3& c : corners) f.outer.push_back(f.project(c));
  const Rect box = bounds(f.outer);
  f.origin = f.at(box.u0, box.v0);
  for (Vec2& p : f.outer) p -= Vec2(box.u0, box.v0);
  facets_.push_back(f);
  return static_cast<int>(facets_.size()) - 1;
}

Attached Solid::attach(int facet, const Ring& base, const std::vector<Vec3>& cap, int object) {
  assert(base.size() == cap.size() && signed_area(base) > 0);
  const std::size_t n = base.size();
  std::vector<Vec3> foot;
  for (const Vec2& p : base) foot.push_back(facets_[facet].at(p.x(), p.y()));
  facets_[facet].holes.push_back(base);
  Attached result;
  for (std::size_t i = 0; i < n; ++i)
    result.sides.push_back(add({foot[i], foot[(i + 1) % n], cap[(i + 1) % n], cap[i]}, object));
  result.cap = add(cap, object);
  return result;
}

Attached Solid::extrude(int facet, const Ring& base, double height, int object,
                        const Ring& cap_ring) {
  std::vector<Vec3> cap;
  for (const Vec2& p : cap_ring.empty() ? base : cap_ring)
    cap.push_back(facets_[facet].at(p.x(), p.y(), height));
  return attach(facet, base, cap, object);
}

std::vector<int> Solid::connect(int facet, const Ring& base, int other, int object) {
  const Facet from = facets_[facet], to = facets_[other];
  std::vector<Vec3> foot, end;
  Ring ring;
  for (const Vec2& p : base) {
    foot.push_back(from.at(p.x(), p.y()));
    const double t = (to.origin - foot.back()).dot(to.normal) / from.normal.dot(to.normal);
    end.push_back(foot.back() + t * from.normal);
    ring.push_back(to.project(end.back()));
  }
  if (signed_area(ring) < 0) std::reverse(ring.begin(), ring.end());
  facets_[facet].holes.push_back(base);
  facets_[other].holes.push_back(ring);
  std::vector<int> sides;
  const std::size_t n = base.size();
  for (std::size_t i = 0; i < n; ++i)
    sides.push_back(add({foot[i], foot[(i + 1) % n], end[(i + 1) % n], end[i]}, object));
  return sides;
}

void Solid::cut(int facet, const Ring& base) { facets_[facet].holes.push_back(base); }

bool Solid::fits(int facet, const Rect& rect, double margin) const {
  const Facet& f = facets_[facet];
  const Rect r = rect.grown(margin);
  if (!contains(f.outer, {(r.u0 + r.u1) / 2, (r.v0 + r.v1) / 2})) return false;
  for (std::size_t i = 0; i < f.outer.size(); ++i)
    if (crosses(f.outer[i], f.outer[(i + 1) % f.outer.size()], r)) return false;
  for (const Ring& hole : f.holes)
    if (r.overlaps(bounds(hole))) return false;
  return std::none_of(f.reserved.begin(), f.reserved.end(),
                      [&](const Rect& o) { return r.overlaps(o); });
}

Mesh Solid::triangulate(std::vector<int>& face_object) const {
  Welder welder;
  std::vector<Rings> facets;
  for (const Facet& f : facets_) {
    Rings rings(1 + f.holes.size());
    for (const Vec2& p : f.outer) rings[0].push_back(welder.index(f.at(p.x(), p.y())));
    for (std::size_t h = 0; h < f.holes.size(); ++h) {
      for (const Vec2& p : f.holes[h]) rings[h + 1].push_back(welder.index(f.at(p.x(), p.y())));
      std::reverse(rings[h + 1].begin(), rings[h + 1].end());
    }
    facets.push_back(rings);
  }
  split_at_corners(welder.points, facets);
  Mesh mesh;
  mesh.vertices = welder.points;
  face_object.clear();
  for (std::size_t i = 0; i < facets.size(); ++i)
    for (const Face& f : triangulate_rings(mesh.vertices, facets_[i], facets[i])) {
      mesh.faces.push_back(f);
      face_object.push_back(facets_[i].object);
    }
  return mesh;
}

}  // namespace colod::synth
