// *Based on:* the usual definition of a 2-manifold by fans of faces around vertices; self
// intersections as in CGAL's Polygon Mesh Processing (boxes, then exact predicates by the number of
// shared vertices), on a soup instead of a half-edge mesh so that non-manifold input is accepted;
// inside is where the winding number is not 0.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include <CGAL/Bbox_3.h>
#include <CGAL/Box_intersection_d/Box_with_handle_d.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/intersections.h"
#include "core/parallel.h"
#include "core/union_find.h"
#include "metrics.h"
#include "welded.h"

namespace colod {
namespace {

using FaceBox = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const Face*>;

constexpr std::size_t kPairsAtOnce = 1 << 20;  // bounds the memory of the candidate pairs

CGAL::Bbox_3 to_cgal(const Box& box) {
  return {box.min.x(), box.min.y(), box.min.z(), box.max.x(), box.max.y(), box.max.z()};
}

void count_edges(const std::vector<EdgeUse>& uses, Validity& v) {
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    const std::size_t n = last - first;
    v.boundary_edges += n == 1;
    v.nonmanifold_edges += n > 2;
    v.misoriented_edges += n == 2 && uses[first].is_forward == uses[first + 1].is_forward;
  });
}

/// Corners (a face at one of its vertices) are joined over edges with two faces; a vertex with more
/// than one set of corners is where surfaces merely touch.
std::int64_t count_nonmanifold_vertices(const Welded& m, const std::vector<EdgeUse>& uses) {
  UnionFind fans(3 * m.faces.size());
  const auto corner = [&](const EdgeUse& use, int vertex) {
    const int k = m.faces[use.face][use.side] == vertex ? use.side : (use.side + 1) % 3;
    return 3 * use.face + k;
  };
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    if (last - first != 2) return;
    for (int vertex : {uses[first].low, uses[first].high})
      fans.unite(corner(uses[first], vertex), corner(uses[first + 1], vertex));
  });
  std::vector<int> fans_of(m.points.size(), 0);
  for (int c = 0; c < static_cast<int>(3 * m.faces.size()); ++c)
    fans_of[m.faces[c / 3][c % 3]] += fans.find(c) == c;
  return std::count_if(fans_of.begin(), fans_of.end(), [](int n) { return n > 1; });
}

/// Per face the number of its component, counted from 0.
std::vector<int> find_components(const Welded& m, const std::vector<EdgeUse>& uses) {
  UnionFind sets(m.faces.size());
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first + 1; i < last; ++i) sets.unite(uses[first].face, uses[i].face);
  });
  std::vector<int> component(m.faces.size());
  int count = 0;
  for (int f = 0; f < static_cast<int>(m.faces.size()); ++f) {
    const int root = sets.find(f);  // the set's lowest face: it has its number by now
    component[f] = root == f ? count++ : component[root];
  }
  return component;
}

/// How often a closed surface winds around a point that is not on it: 0 outside (solid angles: van
/// Oosterom & Strackee, "The solid angle of a plane triangle", 1983).
double winding_number(const Welded& m, const std::vector<int>& faces, const Vec3& x) {
  double sum = 0;
  for (const int f : faces) {
    const Vec3 a = m.points[m.faces[f][0]] - x, b = m.points[m.faces[f][1]] - x,
               c = m.points[m.faces[f][2]] - x;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * M_PI);
}

/// Components that lie inside another one. \pre `m` is watertight.
int count_enclosed(const Welded& m, const std::vector<int>& component, int components) {
  std::vector<std::vector<int>> faces(components);
  for (std::size_t f = 0; f < component.size(); ++f)
    faces[component[f]].push_back(static_cast<int>(f));
  using ComponentBox =
      CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const std::vector<int>*>;
  std::vector<ComponentBox> boxes;
  for (const std::vector<int>& own : faces) {
    Box box;
    for (const int f : own)
      for (const int v : m.faces[f]) box.extend(m.points[v]);
    boxes.emplace_back(to_cgal(box), &own);
  }
  std::vector<char> is_enclosed(components, 0);
  const auto look = [&](const ComponentBox& inner, const ComponentBox& outer) {
    const std::size_t id = inner.handle() - faces.data();
    for (int i = 0; i < 3; ++i)
      if (inner.min_coord(i) < outer.min_coord(i) || inner.max_coord(i) > outer.max_coord(i))
        return;
    if (is_enclosed[id]) return;
    // The middle of a face: corners may touch the outer surface.
    const Face& f = m.faces[inner.handle()->front()];
    const Vec3 x = (m.points[f[0]] + m.points[f[1]] + m.points[f[2]]) / 3;
    is_enclosed[id] = std::abs(winding_number(m, *outer.handle(), x)) > 0.5;
  };
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(),
                                [&](const ComponentBox& a, const ComponentBox& b) {
                                  look(a, b);
                                  look(b, a);
                                });
  return static_cast<int>(std::count(is_enclosed.begin(), is_enclosed.end(), 1));
}

void measure_polygons(const Welded& m, const std::vector<EdgeUse>& uses,
                      const std::vector<FaceShape>& shapes, Validity& v) {
  const auto neighbours = face_neighbours(m, uses);
  const std::vector<int> polygon = find_polygons(m, neighbours, shapes);
  v.polygons = polygon.empty() ? 0 : *std::max_element(polygon.begin(), polygon.end()) + 1;
  std::vector<double> area(v.polygons, 0), perimeter(v.polygons, 0);
  for (std::size_t f = 0; f < polygon.size(); ++f) {
    if (polygon[f] < 0) continue;
    area[polygon[f]] += shapes[f].area;
    for (int side = 0; side < 3; ++side) {
      const int next = neighbours[f][side];
      if (next < 0 || polygon[next] != polygon[f])
        perimeter[polygon[f]] +=
            (m.points[m.faces[f][side]] - m.points[m.faces[f][(side + 1) % 3]]).norm();
    }
  }
  for (int p = 0; p < v.polygons; ++p) {
    const double width = 2 * area[p] / perimeter[p];
    if (p == 0 || width < v.least_width) v.least_width = width;
  }
}

/// The faces that lie on three points, once, and how many do: all of them meet one another, and
/// whatever one meets the others meet.
struct Stacks {
  std::vector<Face> faces;
  std::vector<std::int64_t> sizes;
};

Stacks stack_faces(const Welded& m) {
  const auto corners = [](Face f) {
    std::sort(f.begin(), f.end());
    return f;
  };
  std::vector<std::pair<Face, int>> sorted;
  for (int f = 0; f < static_cast<int>(m.faces.size()); ++f)
    if (!is_degenerate(m.points, m.faces[f])) sorted.emplace_back(corners(m.faces[f]), f);
  std::sort(sorted.begin(), sorted.end());
  Stacks stacks;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (i == 0 || sorted[i].first != sorted[i - 1].first) {
      stacks.faces.push_back(m.faces[sorted[i].second]);
      stacks.sizes.push_back(0);
    }
    ++stacks.sizes.back();
  }
  return stacks;
}

std::int64_t count_intersecting(const Welded& m, const Stacks& stacks,
                                const std::vector<std::pair<int, int>>& pairs) {
  constexpr std::size_t kGrain = 256;
  const std::size_t blocks = (pairs.size() + kGrain - 1) / kGrain;
  std::vector<std::int64_t> found(blocks, 0);
  parallel_for(blocks, [&](std::size_t b) {
    for (std::size_t i = b * kGrain; i < std::min(pairs.size(), (b + 1) * kGrain); ++i) {
      const auto [f, g] = pairs[i];
      if (do_intersect(m.points, stacks.faces[f], stacks.faces[g]))
        found[b] += stacks.sizes[f] * stacks.sizes[g];
    }
  });
  return std::accumulate(found.begin(), found.end(), std::int64_t{0});
}

std::int64_t count_self_intersections(const Welded& m) {
  const Stacks stacks = stack_faces(m);
  std::vector<FaceBox> boxes;
  std::int64_t found = 0;
  for (std::size_t s = 0; s < stacks.faces.size(); ++s) {
    Box box;
    for (int v : stacks.faces[s]) box.extend(m.points[v]);
    boxes.emplace_back(to_cgal(box), &stacks.faces[s]);
    found += stacks.sizes[s] * (stacks.sizes[s] - 1) / 2;
  }
  std::vector<std::pair<int, int>> pairs;
  const auto collect = [&](const FaceBox& a, const FaceBox& b) {
    pairs.emplace_back(a.handle() - stacks.faces.data(), b.handle() - stacks.faces.data());
    if (pairs.size() < kPairsAtOnce) return;
    found += count_intersecting(m, stacks, pairs);
    pairs.clear();
  };
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), collect);
  return found + count_intersecting(m, stacks, pairs);
}

}  // namespace

Validity check_validity(const Mesh& mesh, bool check_self_intersections) {
  Validity v;
  v.vertices = static_cast<int>(mesh.vertices.size());
  v.faces = static_cast<int>(mesh.faces.size());
  const Welded welded = weld(mesh);
  const std::vector<EdgeUse> uses = sorted_edge_uses(welded.faces);
  std::vector<FaceShape> shapes;
  for (const Face& f : welded.faces) shapes.push_back(face_shape(welded, f));

  v.degenerate_faces = welded.collapsed;
  for (const FaceShape& s : shapes) {
    v.degenerate_faces += s.area == 0;
    v.area += s.area;
  }
  count_edges(uses, v);
  v.nonmanifold_vertices = count_nonmanifold_vertices(welded, uses);
  const std::vector<int> component = find_components(welded, uses);
  for (const int c : component) v.components = std::max(v.components, c + 1);
  measure_polygons(welded, uses, shapes, v);
  v.volume = signed_volume({welded.points, welded.faces});
  const bool has_faces = !welded.faces.empty();
  v.is_manifold = has_faces && v.nonmanifold_edges == 0 && v.nonmanifold_vertices == 0;
  v.is_watertight = has_faces && v.boundary_edges == 0 && v.nonmanifold_edges == 0 &&
                    v.misoriented_edges == 0 && welded.collapsed == 0;
  if (v.is_watertight && v.components > 1)
    v.enclosed_components = count_enclosed(welded, component, v.components);
  if (check_self_intersections) v.self_intersections = count_self_intersections(welded);
  return v;
}

}  // namespace colod
