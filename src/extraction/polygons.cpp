// Based on: "a vertex stays where at least three output planes meet" and constrained Delaunay
// triangles for facets with holes, as in Sulzer & Lafarge, "Concise plane arrangements for
// low-poly surface and volume modelling", ECCV 2024.
// Differs: the paper says nothing about how the surface between cells becomes polygons. Both rules
// make it in the same way: whether a vertex stays is decided once for all facets, and the
// triangulation is exact, on rational coordinates; doubles come at the very end.
// Notation: as in boundary.cpp; the twin of a half-edge is the one that runs back.
#include "polygons.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace colod {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_tag>;
using Directed = std::pair<int, int>;

/// A merged facet, vertices as ids of the partition.
struct MergedFacet {
  int plane;
  bool is_reversed;
  int first_polygon;
  std::vector<std::vector<int>> rings;
  std::vector<Face> triangles;
};

/// The boundary as half-edges.
struct HalfEdges {
  std::vector<int> vertex, next, twin, polygon;  ///< per half-edge
};

HalfEdges make_half_edges(const Boundary& boundary) {
  HalfEdges h;
  for (std::size_t p = 0; p < boundary.polygons.size(); ++p) {
    const std::vector<int>& loop = boundary.polygons[p].loop;
    const int first = static_cast<int>(h.vertex.size()), n = static_cast<int>(loop.size());
    for (int i = 0; i < n; ++i) {
      h.vertex.push_back(loop[i]);
      h.next.push_back(first + (i + 1) % n);
      h.polygon.push_back(static_cast<int>(p));
    }
  }
  std::vector<std::tuple<int, int, int>> edges;
  for (std::size_t e = 0; e < h.vertex.size(); ++e) {
    const auto [low, high] = std::minmax(h.vertex[e], h.vertex[h.next[e]]);
    edges.emplace_back(low, high, static_cast<int>(e));
  }
  std::sort(edges.begin(), edges.end());
  h.twin.assign(h.vertex.size(), -1);
  assert(edges.size() % 2 == 0);
  for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {
    const int a = std::get<2>(edges[i]), b = std::get<2>(edges[i + 1]);
    assert(h.vertex[a] == h.vertex[h.next[b]] && h.vertex[b] == h.vertex[h.next[a]]);
    h.twin[a] = b, h.twin[b] = a;
  }
  return h;
}

/// Facet number per polygon: connected across edges, one plane, one side.
std::vector<int> merge_polygons(const Boundary& boundary, const HalfEdges& h) {
  std::vector<std::vector<int>> edges_of_polygon(boundary.polygons.size());
  for (std::size_t e = 0; e < h.vertex.size(); ++e)
    edges_of_polygon[h.polygon[e]].push_back(static_cast<int>(e));
  std::vector<int> facet(boundary.polygons.size(), -1);
  int count = 0;
  for (std::size_t seed = 0; seed < facet.size(); ++seed) {
    if (facet[seed] >= 0) continue;
    std::vector<int> stack = {static_cast<int>(seed)};
    facet[seed] = count;
    while (!stack.empty()) {
      const int p = stack.back();
      stack.pop_back();
      for (const int e : edges_of_polygon[p]) {
        const int q = h.polygon[h.twin[e]];
        if (facet[q] >= 0 || boundary.polygons[q].plane != boundary.polygons[p].plane ||
            boundary.polygons[q].is_reversed != boundary.polygons[p].is_reversed)
          continue;
        facet[q] = count;
        stack.push_back(q);
      }
    }
    ++count;
  }
  return facet;
}

/// Signed area of a ring about `normal`, m².
double ring_area(const std::vector<Vec3>& points, const std::vector<int>& ring,
                 const Vec3& normal) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    sum += (points[ring[i]] - points[ring[0]]).cross(points[ring[i + 1]] - points[ring[0]]);
  return 0.5 * sum.dot(normal);
}

Vec3 outward_normal(const Partition& partition, int plane, bool is_reversed) {
  const auto& n = partition.planes[plane].normal;
  const Vec3 normal = Vec3(n[0], n[1], n[2]).normalized();
  return is_reversed ? Vec3(-normal) : normal;
}

/// Facets with rings, without vertices where only two facets meet: there both facets' edges lie on
/// the line of their two planes.
std::vector<MergedFacet> trace_facets(const Partition& partition, const Boundary& boundary) {
  const HalfEdges h = make_half_edges(boundary);
  const std::vector<int> facet = merge_polygons(boundary, h);
  std::vector<MergedFacet> facets;
  for (std::size_t p = 0; p < facet.size(); ++p)
    if (facet[p] == static_cast<int>(facets.size()))
      facets.push_back({boundary.polygons[p].plane,
                        boundary.polygons[p].is_reversed,
                        static_cast<int>(p),
                        {},
                        {}});
  const auto is_border = [&](int e) { return facet[h.polygon[e]] != facet[h.polygon[h.twin[e]]]; };
  std::vector<int> degree(partition.vertices.size(), 0);
  for (std::size_t e = 0; e < h.vertex.size(); ++e)
    if (is_border(static_cast<int>(e))) ++degree[h.vertex[e]];
  std::vector<char> is_done(h.vertex.size(), 0);
  for (std::size_t seed = 0; seed < h.vertex.size(); ++seed) {
    if (is_done[seed] || !is_border(static_cast<int>(seed))) continue;
    std::vector<int> ring;
    int e = static_cast<int>(seed);
    do {
      is_done[e] = 1;
      if (degree[h.vertex[e]] >= 3) ring.push_back(h.vertex[e]);
      e = h.next[e];
      while (!is_border(e)) e = h.next[h.twin[e]];
    } while (e != static_cast<int>(seed));
    facets[facet[h.polygon[seed]]].rings.push_back(std::move(ring));
  }
  for (MergedFacet& f : facets) {
    const Vec3 normal = outward_normal(partition, f.plane, f.is_reversed);
    const auto outer = std::max_element(f.rings.begin(), f.rings.end(), [&](auto& a, auto& b) {
      return ring_area(partition.points, a, normal) < ring_area(partition.points, b, normal);
    });
    std::iter_swap(f.rings.begin(), outer);
  }
  std::stable_sort(facets.begin(), facets.end(), [](const MergedFacet& a, const MergedFacet& b) {
    return std::tie(a.plane, a.is_reversed) < std::tie(b.plane, b.is_reversed);
  });
  return facets;
}

/// An integer of up to 127 bits as an exact number, from pieces that doubles hold.
Kernel::FT exact(__int128 value) {
  const bool is_negative = value < 0;
  auto rest = static_cast<unsigned __int128>(is_negative ? -value : value);
  Kernel::FT sum = 0;
  double scale = 1;
  for (; rest != 0; rest >>= 48, scale *= 281474976710656.0)
    sum += Kernel::FT(static_cast<double>(static_cast<std::uint64_t>(rest & 0xFFFFFFFFFFFFull))) *
           Kernel::FT(scale);
  if (is_negative) sum = -sum;
  return sum;
}

/// Faces of the triangulation inside an odd number of rings.
std::map<Triangulation::Face_handle, bool> mark_inside(const Triangulation& t) {
  std::map<Triangulation::Face_handle, bool> is_inside;
  std::vector<Triangulation::Face_handle> stack = {t.infinite_face()};
  is_inside[t.infinite_face()] = false;
  while (!stack.empty()) {
    const Triangulation::Face_handle f = stack.back();
    stack.pop_back();
    for (int i = 0; i < 3; ++i) {
      const Triangulation::Face_handle g = f->neighbor(i);
      if (is_inside.try_emplace(g, is_inside[f] != f->is_constrained(i)).second) stack.push_back(g);
    }
  }
  return is_inside;
}

void triangulate(const Partition& partition, MergedFacet& facet) {
  const Vec3 normal = outward_normal(partition, facet.plane, facet.is_reversed);
  int drop;
  normal.cwiseAbs().maxCoeff(&drop);
  int u = (drop + 1) % 3, v = (drop + 2) % 3;
  if (normal[drop] < 0) std::swap(u, v);
  Triangulation t;
  std::map<int, Triangulation::Vertex_handle> handles;
  for (const std::vector<int>& ring : facet.rings)
    for (const int vertex : ring) {
      if (handles.count(vertex)) continue;
      const auto& p = partition.vertices[vertex].h;
      const Kernel::FT w = exact(p[3]);
      const auto handle = t.insert(Kernel::Point_2(exact(p[u]) / w, exact(p[v]) / w));
      handle->info() = vertex;
      handles[vertex] = handle;
    }
  for (const std::vector<int>& ring : facet.rings)
    for (std::size_t i = 0; i < ring.size(); ++i)
      t.insert_constraint(handles[ring[i]], handles[ring[(i + 1) % ring.size()]]);
  const auto is_inside = mark_inside(t);
  for (auto f = t.finite_faces_begin(); f != t.finite_faces_end(); ++f)
    if (is_inside.at(f))
      facet.triangles.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  for (Face& f : facet.triangles)
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  std::sort(facet.triangles.begin(), facet.triangles.end());
}

/// The third corner of the triangle with the directed edge (a, b), and that triangle's position.
std::pair<int, std::size_t> find_triangle(const std::vector<Face>& triangles, int a, int b) {
  for (std::size_t k = 0; k < triangles.size(); ++k)
    for (int i = 0; i < 3; ++i)
      if (triangles[k][i] == a && triangles[k][(i + 1) % 3] == b)
        return {triangles[k][(i + 2) % 3], k};
  assert(false && "a diagonal has a triangle on each side");
  return {-1, 0};
}

/// Two facets whose planes share a line may both want the same diagonal on it: the later one breaks
/// its diagonal at a point of its own.
void settle_diagonals(std::vector<MergedFacet>& facets, std::vector<Vec3>& points) {
  std::set<Directed> used;
  for (const MergedFacet& f : facets)
    for (const std::vector<int>& ring : f.rings)
      for (std::size_t i = 0; i < ring.size(); ++i)
        used.insert(std::minmax(ring[i], ring[(i + 1) % ring.size()]));
  for (MergedFacet& f : facets) {
    std::set<Directed> border;
    for (const std::vector<int>& ring : f.rings)
      for (std::size_t i = 0; i < ring.size(); ++i)
        border.insert(std::minmax(ring[i], ring[(i + 1) % ring.size()]));
    std::vector<Directed> taken;
    for (const Face& t : f.triangles)
      for (int i = 0; i < 3; ++i) {
        const Directed edge = {t[i], t[(i + 1) % 3]};
        if (edge.first < edge.second && !border.count(edge) && !used.insert(edge).second)
          taken.push_back(edge);
      }
    for (const auto& [a, b] : taken) {
      const auto [c, left] = find_triangle(f.triangles, a, b);
      const auto [d, right] = find_triangle(f.triangles, b, a);
      const int m = static_cast<int>(points.size());
      points.push_back(0.5 * (points[a] + points[b]));
      f.triangles[left] = {a, m, c};
      f.triangles[right] = {b, m, d};
      f.triangles.insert(f.triangles.end(), {{m, b, c}, {m, a, d}});
    }
  }
}

}  // namespace

PolygonMesh build_polygons(const Partition& partition, const Boundary& boundary) {
  std::vector<MergedFacet> facets = trace_facets(partition, boundary);
  for (MergedFacet& f : facets) triangulate(partition, f);
  std::vector<Vec3> points = partition.points;
  settle_diagonals(facets, points);

  PolygonMesh mesh;
  std::vector<int> number(points.size(), -1);
  const auto vertex = [&](int v) {
    if (number[v] < 0) {
      number[v] = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back(points[v]);
    }
    return number[v];
  };
  for (const MergedFacet& f : facets) {
    PolygonMesh::Facet facet;
    facet.normal = outward_normal(partition, f.plane, f.is_reversed);
    facet.plane = partition.planes[f.plane].source_plane;
    for (const std::vector<int>& ring : f.rings) {
      facet.rings.emplace_back();
      for (const int v : ring) facet.rings.back().push_back(vertex(v));
    }
    for (const Face& t : f.triangles) {
      mesh.triangles.push_back({vertex(t[0]), vertex(t[1]), vertex(t[2])});
      mesh.facet_of_triangle.push_back(static_cast<int>(mesh.facets.size()));
    }
    mesh.facets.push_back(std::move(facet));
  }
  return mesh;
}

}  // namespace colod
