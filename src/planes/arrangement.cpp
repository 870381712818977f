// Based on: alpha shapes (Edelsbrunner, Kirkpatrick, Seidel 1983) as a filter of the Delaunay
// triangulation; Douglas and Peucker 1973; constrained Delaunay triangulation by CGAL.
// Differs: nothing between --rules paper and robust.
// Notation: winding = how often the edges go round a place, counter-clockwise.
#include "arrangement.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/flat.h"

namespace colod::regions {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
struct FaceInfo {
  int component = -1;
  bool is_inside = false;
  std::array<bool, 3> is_walked{};
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel>;
using ConstrainedBase = CGAL::Constrained_triangulation_face_base_2<Kernel, FaceBase>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, ConstrainedBase>,
    CGAL::Exact_predicates_tag>;
using Delaunay =
    CGAL::Delaunay_triangulation_2<Kernel,
                                   CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>>;

bool less(const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); }

/// The edges without those that run both ways and without points.
std::vector<Edge2> cancel(const std::vector<Edge2>& edges) {
  struct Half {
    Vec2 low, high;
    int way;
  };
  std::vector<Half> halves;
  for (const Edge2& e : edges) {
    if (less(e.a, e.b)) halves.push_back({e.a, e.b, 1});
    if (less(e.b, e.a)) halves.push_back({e.b, e.a, -1});
  }
  std::stable_sort(halves.begin(), halves.end(), [](const Half& a, const Half& b) {
    return less(a.low, b.low) || (a.low == b.low && less(a.high, b.high));
  });
  std::vector<Edge2> left;
  for (std::size_t i = 0, end; i < halves.size(); i = end) {
    int sum = 0;
    for (end = i; end < halves.size() && halves[end].low == halves[i].low &&
                  halves[end].high == halves[i].high;)
      sum += halves[end++].way;
    for (int k = 0; k < std::abs(sum); ++k)
      left.push_back(sum > 0 ? Edge2{halves[i].low, halves[i].high}
                             : Edge2{halves[i].high, halves[i].low});
  }
  return left;
}

Cdt triangulate(const std::vector<Edge2>& edges) {
  std::map<std::pair<double, double>, std::size_t> index;
  std::vector<Point> points;
  const auto id = [&](const Vec2& p) {
    const auto [it, is_new] = index.try_emplace({p.x(), p.y()}, points.size());
    if (is_new) points.emplace_back(p.x(), p.y());
    return it->second;
  };
  std::vector<std::pair<std::size_t, std::size_t>> constraints;
  for (const Edge2& e : edges) {
    const std::size_t a = id(e.a), b = id(e.b);
    constraints.emplace_back(a, b);
  }
  Cdt cdt;
  cdt.insert_constraints(points.begin(), points.end(), constraints.begin(), constraints.end());
  return cdt;
}

int winding(const std::vector<Edge2>& edges, const Vec2& p) {
  int count = 0;
  for (const Edge2& e : edges) {
    if ((e.a.y() <= p.y()) == (e.b.y() <= p.y())) continue;
    const Vec2 along = e.b - e.a, to = p - e.a;
    const double side = along.x() * to.y() - along.y() * to.x();
    if (e.b.y() > e.a.y() && side > 0) ++count;
    if (e.b.y() < e.a.y() && side < 0) --count;
  }
  return count;
}

/// Parts of the plane between the constrained edges; each is inside or outside as a whole.
void label(Cdt& cdt, const std::vector<Edge2>& edges) {
  for (auto f = cdt.all_faces_begin(); f != cdt.all_faces_end(); ++f) f->info() = {};
  std::vector<Cdt::Face_handle> stack, part;
  int components = 0;
  const auto spread = [&](Cdt::Face_handle start) {
    part.clear();
    stack.push_back(start);
    start->info().component = components;
    while (!stack.empty()) {
      const Cdt::Face_handle f = stack.back();
      stack.pop_back();
      part.push_back(f);
      for (int k = 0; k < 3; ++k) {
        const Cdt::Face_handle g = f->neighbor(k);
        if (g->info().component >= 0 || f->is_constrained(k)) continue;
        g->info().component = components;
        stack.push_back(g);
      }
    }
    ++components;
  };
  spread(cdt.infinite_face());
  for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f) {
    if (f->info().component >= 0) continue;
    spread(f);
    const auto largest = std::max_element(part.begin(), part.end(), [&](auto a, auto b) {
      return std::abs(cdt.triangle(a).area()) < std::abs(cdt.triangle(b).area());
    });
    const Point c = CGAL::centroid(cdt.triangle(*largest));
    const bool is_inside = winding(edges, {c.x(), c.y()}) > 0;
    for (const Cdt::Face_handle g : part) g->info().is_inside = is_inside;
  }
}

/// The ring that begins with edge k of face f, inside on its left.
std::vector<int> walk_ring(Cdt::Face_handle f, int k) {
  std::vector<int> ring;
  while (!f->info().is_walked[k]) {
    f->info().is_walked[k] = true;
    ring.push_back(f->vertex(Cdt::ccw(k))->info());
    const Cdt::Vertex_handle end = f->vertex(Cdt::cw(k));
    k = Cdt::ccw(k);  // the edge of f that leaves `end`
    while (f->neighbor(k)->info().is_inside) {
      f = f->neighbor(k);
      k = Cdt::cw(f->index(end));
    }
  }
  return ring;
}

}  // namespace

double Arrangement::area() const {
  double sum = 0;
  for (const Face& t : triangles) {
    const Vec2 a = vertices[t[1]] - vertices[t[0]], b = vertices[t[2]] - vertices[t[0]];
    sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return sum;
}

double signed_area(const std::vector<Vec2>& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
    sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return sum;
}

Arrangement arrange(const std::vector<Edge2>& all_edges) {
  Arrangement result;
  const std::vector<Edge2> edges = cancel(all_edges);
  if (edges.size() < 3) return result;
  Cdt cdt = triangulate(edges);
  if (cdt.dimension() < 2) return result;
  label(cdt, edges);
  for (auto v = cdt.all_vertices_begin(); v != cdt.all_vertices_end(); ++v) v->info() = -1;
  for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f) {
    if (!f->info().is_inside) continue;
    Face t;
    for (int k = 0; k < 3; ++k) {
      int& id = f->vertex(k)->info();
      if (id < 0) {
        id = static_cast<int>(result.vertices.size());
        result.vertices.emplace_back(f->vertex(k)->point().x(), f->vertex(k)->point().y());
      }
      t[k] = id;
    }
    result.triangles.push_back(t);
  }
  for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f)
    for (int k = 0; f->info().is_inside && k < 3; ++k)
      if (!f->neighbor(k)->info().is_inside && !f->info().is_walked[k])
        result.rings.push_back(walk_ring(f, k));
  return result;
}

std::vector<Edge2> alpha_shape(const std::vector<Vec2>& points, double radius) {
  Delaunay dt;
  std::vector<Point> list;
  for (const Vec2& p : points) list.emplace_back(p.x(), p.y());
  dt.insert(list.begin(), list.end());
  std::vector<Edge2> edges;
  if (dt.dimension() < 2) return edges;
  for (auto f = dt.finite_faces_begin(); f != dt.finite_faces_end(); ++f)
    f->info().is_inside = CGAL::squared_radius(f->vertex(0)->point(), f->vertex(1)->point(),
                                               f->vertex(2)->point()) <= radius * radius;
  const auto at = [](Delaunay::Vertex_handle v) { return Vec2(v->point().x(), v->point().y()); };
  for (auto f = dt.finite_faces_begin(); f != dt.finite_faces_end(); ++f)
    for (int k = 0; f->info().is_inside && k < 3; ++k)
      if (!f->neighbor(k)->info().is_inside)
        edges.push_back({at(f->vertex(Delaunay::ccw(k))), at(f->vertex(Delaunay::cw(k)))});
  return edges;
}

std::vector<Vec2> simplify_ring(const std::vector<Vec2>& ring, double tolerance) {
  const int n = static_cast<int>(ring.size());
  if (n < 3) return {};
  // Two vertices that surely stay: the least one and the one farthest from it.
  const int begin =
      static_cast<int>(std::min_element(ring.begin(), ring.end(), less) - ring.begin());
  int far = begin;
  for (int i = 0; i < n; ++i)
    if ((ring[i] - ring[begin]).norm() > (ring[far] - ring[begin]).norm()) far = i;
  const int opposite = (far - begin + n) % n;
  const auto at = [&](int k) -> const Vec2& { return ring[(begin + k) % n]; };
  const auto distance = [&](int i, int from, int to) {
    const Vec2 along = at(to) - at(from), off = at(i) - at(from);
    const double t = std::clamp(off.dot(along) / std::max(along.squaredNorm(), 1e-300), 0.0, 1.0);
    return (off - t * along).norm();
  };
  std::vector<Vec2> left = {at(0)};
  for (const int k : corners_between(0, opposite, tolerance, distance)) left.push_back(at(k));
  if (opposite > 0) left.push_back(at(opposite));
  for (const int k : corners_between(opposite, n, tolerance, distance)) left.push_back(at(k));
  return left.size() < 3 ? std::vector<Vec2>{} : left;
}

}  // namespace colod::regions
