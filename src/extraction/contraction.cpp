// Based on: edge contraction under the link condition of Dey et al., "Topology preserving edge
// contraction", 1999.
// Differs: the paper says nothing of what four planes leave that nearly meet in a point: edges of
// fractions of a millimetre, and facets as narrow. Both rules contract them, while the surface
// stays closed, keeps its directions and cuts itself nowhere.
// Notation: an edge is (length, vertex, vertex), the vertices rising.
#include "contraction.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "core/intersections.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::extraction::contraction;

using Edge = std::tuple<double, int, int>;

constexpr int kPasses = 5;  // what one contraction forbids another may allow

/// No triangle may turn by more than 60 degrees from its facet; `cross`: product of its sides.
bool keeps_direction(const Vec3& normal, const Vec3& cross) {
  return cross.norm() > 0 && normal.dot(cross) > 0.5 * cross.norm();
}

Vec3 cross_of(const PolygonMesh& mesh, const Face& f) {
  const Vec3& a = mesh.vertices[f[0]];
  return (mesh.vertices[f[1]] - a).cross(mesh.vertices[f[2]] - a);
}

/// Contracts edges one at a time; knows which triangles use a vertex.
class Contraction {
 public:
  explicit Contraction(PolygonMesh& mesh) : mesh_(mesh), triangles_of_(mesh.vertices.size()) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const int v : mesh.triangles[t]) triangles_of_[v].push_back(static_cast<int>(t));
    for (const Face& f : mesh.triangles) boxes_.push_back(box_of(f));
    is_gone_.assign(mesh.triangles.size(), 0);
    target_.resize(mesh.vertices.size());
    for (std::size_t v = 0; v < target_.size(); ++v) target_[v] = static_cast<int>(v);
  }

  /// Moves `from` onto `to` if that is allowed; `to` must lie within `depth` metres of the planes
  /// of all triangles that move.
  bool contract(int from, int to, double depth) {
    std::vector<int> shared, moved;
    for (const int t : triangles_of_[from]) (has(t, to) ? shared : moved).push_back(t);
    if (shared.size() != 2 || link(from, to).size() != 2 || is_too_small(shared, from, to))
      return false;
    for (const int t : moved) {
      const Face& f = mesh_.triangles[t];
      Face g = f;
      std::replace(g.begin(), g.end(), from, to);
      const Vec3& normal = mesh_.facets[mesh_.facet_of_triangle[t]].normal;
      if (!keeps_direction(normal, cross_of(mesh_, g)) || distance_from(f, to) > depth ||
          meets_another(g, shared, moved))
        return false;
    }
    for (const int t : shared) {
      is_gone_[t] = 1;
      for (const int v : mesh_.triangles[t]) std::erase(triangles_of_[v], t);
    }
    for (const int t : moved) {
      std::replace(mesh_.triangles[t].begin(), mesh_.triangles[t].end(), from, to);
      boxes_[t] = box_of(mesh_.triangles[t]);
      triangles_of_[to].push_back(t);
    }
    triangles_of_[from].clear();
    target_[from] = to;
    return true;
  }

  /// Removes what was contracted from triangles, rings, facets and vertices.
  void finish();

  int facets_at(int v) const {
    std::set<int> facets;
    for (const int t : triangles_of_[v]) facets.insert(mesh_.facet_of_triangle[t]);
    return static_cast<int>(facets.size());
  }

 private:
  double distance_from(const Face& f, int v) const {
    const Vec3 cross = cross_of(mesh_, f);
    const double length = cross.norm();
    return length > 0 ? std::abs(cross.dot(mesh_.vertices[v] - mesh_.vertices[f[0]])) / length : 0;
  }
  /// A triangle that moves would cut one that stays.
  bool meets_another(const Face& f, const std::vector<int>& shared,
                     const std::vector<int>& moved) const {
    const Box box = box_of(f);
    for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
      const auto is_t = [t](int i) { return i == t; };
      const Box& other = boxes_[t];
      const bool is_near = !is_gone_[t] && (box.min.array() <= other.max.array()).all() &&
                           (other.min.array() <= box.max.array()).all();
      if (!is_near || std::any_of(shared.begin(), shared.end(), is_t) ||
          std::any_of(moved.begin(), moved.end(), is_t) ||
          is_degenerate(mesh_.vertices, mesh_.triangles[t]))
        continue;
      if (do_intersect(mesh_.vertices, f, mesh_.triangles[t])) return true;
    }
    return false;
  }
  Box box_of(const Face& f) const {
    Box box;
    for (const int v : f) box.extend(mesh_.vertices[v]);
    return box;
  }
  bool has(int t, int v) const {
    const Face& f = mesh_.triangles[t];
    return std::find(f.begin(), f.end(), v) != f.end();
  }
  std::set<int> neighbours(int v) const {
    std::set<int> around;
    for (const int t : triangles_of_[v])
      around.insert(mesh_.triangles[t].begin(), mesh_.triangles[t].end());
    around.erase(v);
    return around;
  }
  std::vector<int> link(int a, int b) const {
    const std::set<int> at_a = neighbours(a), at_b = neighbours(b);
    std::vector<int> both;
    std::set_intersection(at_a.begin(), at_a.end(), at_b.begin(), at_b.end(),
                          std::back_inserter(both));
    return both;
  }
  /// A vertex would be left with two triangles, back to back.
  bool is_too_small(const std::vector<int>& shared, int a, int b) const {
    if (triangles_of_[a].size() + triangles_of_[b].size() < 7) return true;
    for (const int t : shared)
      for (const int v : mesh_.triangles[t])
        if (v != a && v != b && triangles_of_[v].size() <= 3) return true;
    return false;
  }

  PolygonMesh& mesh_;
  std::vector<std::vector<int>> triangles_of_;
  std::vector<Box> boxes_;  ///< of the triangles
  std::vector<char> is_gone_;
  std::vector<int> target_;
};

void Contraction::finish() {
  const auto resolve = [&](int v) {
    while (target_[v] != v) v = target_[v];
    return v;
  };
  PolygonMesh out;
  std::vector<int> new_vertex(mesh_.vertices.size(), -1), new_facet(mesh_.facets.size(), -1);
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v)
    if (target_[v] == static_cast<int>(v) && !triangles_of_[v].empty()) {
      new_vertex[v] = static_cast<int>(out.vertices.size());
      out.vertices.push_back(mesh_.vertices[v]);
    }
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    if (!is_gone_[t]) new_facet[mesh_.facet_of_triangle[t]] = 0;
  for (std::size_t f = 0; f < mesh_.facets.size(); ++f) {
    if (new_facet[f] < 0) continue;
    PolygonMesh::Facet facet = mesh_.facets[f];
    for (std::vector<int>& ring : facet.rings) {
      for (int& v : ring) v = new_vertex[resolve(v)];
      ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
      while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
    }
    std::erase_if(facet.rings, [](const std::vector<int>& ring) { return ring.size() < 3; });
    new_facet[f] = static_cast<int>(out.facets.size());
    out.facets.push_back(std::move(facet));
  }
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (is_gone_[t]) continue;
    Face f = mesh_.triangles[t];
    for (int& v : f) v = new_vertex[v];
    out.triangles.push_back(f);
    out.facet_of_triangle.push_back(new_facet[mesh_.facet_of_triangle[t]]);
  }
  mesh_ = std::move(out);
}

/// Contracts what `find` names, shortest first, and asks again; returns how many edges went.
template <class Find>
int contract(PolygonMesh& mesh, double depth, const Find& find) {
  int total = 0;
  for (int pass = 0, count = 1; pass < kPasses && count > 0; ++pass, total += count) {
    std::vector<Edge> edges = find(mesh);
    count = 0;
    if (edges.empty()) break;
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    Contraction contraction(mesh);
    for (const auto& [d, a, b] : edges) {
      // The vertex with fewer planes moves, so that as few facets as possible bend.
      const bool a_moves = contraction.facets_at(a) <= contraction.facets_at(b);
      const int from = a_moves ? a : b, to = a_moves ? b : a;
      count += contraction.contract(from, to, depth) || contraction.contract(to, from, depth);
    }
    contraction.finish();
  }
  return total;
}

/// Edges of a triangle that are shorter than `length`.
void add_short_edges(const PolygonMesh& mesh, const Face& f, double length,
                     std::vector<Edge>& edges) {
  for (int i = 0; i < 3; ++i) {
    const auto [a, b] = std::minmax(f[i], f[(i + 1) % 3]);
    const double d = (mesh.vertices[a] - mesh.vertices[b]).norm();
    if (d < length) edges.emplace_back(d, a, b);
  }
}

/// Contracting has turned the triangle away from its facet: it is a facet of its own by now.
bool is_bent(const PolygonMesh& mesh, std::size_t t) {
  const Vec3 cross = cross_of(mesh, mesh.triangles[t]);
  return mesh.facets[mesh.facet_of_triangle[t]].normal.dot(cross) < kPlanar * cross.norm();
}

bool is_narrow(const PolygonMesh& mesh, std::size_t t, double width) {
  const PolygonMesh::Facet& facet = mesh.facets[mesh.facet_of_triangle[t]];
  return is_bent(mesh, t) || measure_facet(mesh, facet).width() < width;
}

}  // namespace

FacetSize measure_facet(const PolygonMesh& mesh, const PolygonMesh::Facet& facet) {
  FacetSize size;
  const Vec3& o = mesh.vertices[facet.rings[0][0]];
  for (const std::vector<int>& ring : facet.rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec3 &a = mesh.vertices[ring[i]], &b = mesh.vertices[ring[(i + 1) % ring.size()]];
      size.perimeter += (b - a).norm();
      size.area += 0.5 * facet.normal.dot((a - o).cross(b - o));
    }
  return size;
}

int contract_short_edges(PolygonMesh& mesh, double length) {
  return contract(mesh, kInfinity, [length](const PolygonMesh& m) {
    std::vector<Edge> edges;
    for (const Face& f : m.triangles) add_short_edges(m, f, length, edges);
    return edges;
  });
}

int contract_narrow_facets(PolygonMesh& mesh, double width) {
  const auto contract_up_to = [&](double length, double depth) {
    return contract(mesh, depth, [&](const PolygonMesh& m) {
      std::vector<Edge> edges;
      for (std::size_t t = 0; t < m.triangles.size(); ++t)
        if (is_narrow(m, t, width)) add_short_edges(m, m.triangles[t], length, edges);
      return edges;
    });
  };
  int total = 0;
  for (double length = 2 * width; length <= kLongest * width; length *= 2)
    total += contract_up_to(length, kInfinity);
  return total + contract_up_to(kInfinity, width);
}

}  // namespace colod
