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

namespace colod {
namespace {

using FaceBox = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const Face*>;

constexpr double kCoplanarDistance = 1e-4;  // m
constexpr double kCoplanarAngleDeg = 0.1;
constexpr double kReliableHeight = 5e-3;       // m; a thinner face's normal says little
constexpr std::size_t kPairsAtOnce = 1 << 20;  // bounds the memory of the candidate pairs

CGAL::Bbox_3 to_cgal(const Box& box) {
  return {box.min.x(), box.min.y(), box.min.z(), box.max.x(), box.max.y(), box.max.z()};
}

/// The faces worth looking at, over welded vertices.
struct Welded {
  std::vector<Vec3> points;
  std::vector<Face> faces;     // three different vertices each, all finite
  std::int64_t collapsed = 0;  // faces that lost a vertex by welding, or are not finite
};

bool is_less(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

Welded weld(const Mesh& mesh) {
  std::vector<int> order;
  for (int i = 0; i < static_cast<int>(mesh.vertices.size()); ++i)
    if (mesh.vertices[i].allFinite()) order.push_back(i);
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return is_less(mesh.vertices[i], mesh.vertices[j]); });
  Welded welded;
  std::vector<int> point_of_vertex(mesh.vertices.size(), -1);
  for (int i : order) {
    if (welded.points.empty() || welded.points.back() != mesh.vertices[i])
      welded.points.push_back(mesh.vertices[i]);
    point_of_vertex[i] = static_cast<int>(welded.points.size()) - 1;
  }
  for (const Face& f : mesh.faces) {
    const Face g = {point_of_vertex[f[0]], point_of_vertex[f[1]], point_of_vertex[f[2]]};
    const bool is_face =
        std::min({g[0], g[1], g[2]}) >= 0 && g[0] != g[1] && g[1] != g[2] && g[2] != g[0];
    if (is_face) welded.faces.push_back(g);
    welded.collapsed += !is_face;
  }
  return welded;
}

/// One use of an edge by a face; sorted, the uses of one edge are neighbours.
struct EdgeUse {
  int low, high;   // vertices
  int face, side;  // side s of a face runs from its vertex s to its vertex s + 1
  bool is_forward;

  bool operator<(const EdgeUse& o) const {
    return std::tie(low, high, face, side) < std::tie(o.low, o.high, o.face, o.side);
  }
  bool is_same_edge(const EdgeUse& o) const { return low == o.low && high == o.high; }
};

std::vector<EdgeUse> sorted_edge_uses(const std::vector<Face>& faces) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * faces.size());
  for (int f = 0; f < static_cast<int>(faces.size()); ++f)
    for (int s = 0; s < 3; ++s) {
      const int a = faces[f][s], b = faces[f][(s + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), f, s, a < b});
    }
  std::sort(uses.begin(), uses.end());
  return uses;
}

/// Calls visit(first, last) for the uses of each edge.
template <typename Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, Visit visit) {
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    for (j = i + 1; j < uses.size() && uses[j].is_same_edge(uses[i]);) ++j;
    visit(i, j);
  }
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

/// Neighbours over edges with exactly two faces, −1: none.
std::vector<std::array<int, 3>> face_neighbours(const Welded& m, const std::vector<EdgeUse>& uses) {
  std::vector<std::array<int, 3>> neighbours(m.faces.size(), {-1, -1, -1});
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    if (last - first != 2) return;
    const EdgeUse &a = uses[first], &b = uses[first + 1];
    neighbours[a.face][a.side] = b.face;
    neighbours[b.face][b.side] = a.face;
  });
  return neighbours;
}

/// A face's unit normal (zero when degenerate), area and height over its longest side.
struct FaceShape {
  Vec3 normal = Vec3::Zero();
  double area = 0, height = 0;
};

FaceShape face_shape(const Welded& m, const Face& f) {
  const Vec3 a = m.points[f[0]], ab = m.points[f[1]] - a, ac = m.points[f[2]] - a;
  const Vec3 cross = ab.cross(ac);
  const double twice = cross.norm();
  FaceShape shape;
  if (!(twice > 0)) return shape;
  shape.normal = cross / twice;
  shape.area = 0.5 * twice;
  shape.height = twice / std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
  return shape;
}

/// Per face the number of its polygon, −1: degenerate. Grown from the largest face left, every face
/// judged against the seed's plane, so that a gently curved surface does not count as one polygon.
std::vector<int> find_polygons(const Welded& m, const std::vector<std::array<int, 3>>& neighbours,
                               const std::vector<FaceShape>& shapes) {
  const double min_cos = std::cos(kCoplanarAngleDeg * M_PI / 180);
  std::vector<int> order(m.faces.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int i, int j) { return shapes[i].area > shapes[j].area; });
  std::vector<int> polygon(m.faces.size(), -1);
  const auto is_coplanar = [&](int seed, int face) {
    const double cos = shapes[seed].normal.dot(shapes[face].normal);
    if (cos < (shapes[face].height < kReliableHeight ? 0.0 : min_cos)) return false;
    const Vec3 base = m.points[m.faces[seed][0]];
    for (int v : m.faces[face])
      if (!(std::abs(shapes[seed].normal.dot(m.points[v] - base)) <= kCoplanarDistance))
        return false;
    return true;
  };
  int polygons = 0;
  for (int seed : order) {
    if (polygon[seed] >= 0 || shapes[seed].area == 0) continue;  // a degenerate face is no polygon
    std::vector<int> stack = {seed};
    polygon[seed] = polygons;
    while (!stack.empty()) {
      const int face = stack.back();
      stack.pop_back();
      for (int next : neighbours[face])
        if (next >= 0 && polygon[next] < 0 && is_coplanar(seed, next)) {
          polygon[next] = polygons;
          stack.push_back(next);
        }
    }
    ++polygons;
  }
  return polygon;
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
