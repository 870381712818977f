// *Based on:* Cohen-Steiner, Da, "A greedy Delaunay-based surface reconstruction algorithm", 2004:
// triangles of the Delaunay tetrahedra, chosen greedily by the smallest empty sphere.
//
// *Differs:* grows everywhere at once and knows which side is outside, hence has no front (CGAL's
// breaks ties by memory address: not the same bytes twice). No --rules here.
//
// *Notation:* none.
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>

#include "core/union_find.h"
#include "internal.h"

namespace colod::synth {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Tetrahedra = CGAL::Delaunay_triangulation_3<
    Kernel,
    CGAL::Triangulation_data_structure_3<CGAL::Triangulation_vertex_base_with_info_3<int, Kernel>,
                                         CGAL::Delaunay_triangulation_cell_base_3<Kernel>>>;

constexpr std::size_t kMinComponent = 12;  // faces; smaller pieces are not kept

/// A triangle of the points' Delaunay tetrahedra, turned as the surface that its corners were taken
/// from.
struct Candidate {
  double radius;  ///< squared, of the smallest empty sphere through it
  Face face;
  Vec3 normal;    ///< unit
  double facing;  ///< cosine against the mean normal of its samples
};

/// The triangulation hands out facets from either side: corners are sorted, or rounding would tell.
double empty_radius(const std::vector<Sample>& samples, Face corners, std::array<int, 2> apexes) {
  const auto point = [&](int i) {
    const Vec3& p = samples[i].point;
    return Kernel::Point_3(p.x(), p.y(), p.z());
  };
  std::sort(corners.begin(), corners.end());
  const auto p = point(corners[0]), q = point(corners[1]), r = point(corners[2]);
  double radius = std::numeric_limits<double>::infinity();
  bool is_gabriel = true;
  for (int apex : apexes) {
    if (apex < 0) continue;
    is_gabriel =
        is_gabriel && CGAL::side_of_bounded_sphere(p, q, r, point(apex)) != CGAL::ON_BOUNDED_SIDE;
    radius = std::min(radius, CGAL::squared_radius(p, q, r, point(apex)));
  }
  return is_gabriel ? CGAL::squared_radius(p, q, r) : radius;
}

/// False where the triangle is too long, has no area or joins the two faces of a thin wall.
bool make_candidate(const std::vector<Sample>& samples, double longest_edge, Candidate& c) {
  constexpr double kMinAgreement = 1.2;  // length of the sum of three unit directions
  const Sample* s[3] = {&samples[c.face[0]], &samples[c.face[1]], &samples[c.face[2]]};
  for (int k = 0; k < 3; ++k)
    if ((s[k]->point - s[(k + 1) % 3]->point).norm() > longest_edge) return false;
  const Vec3 towards = s[0]->normal + s[1]->normal + s[2]->normal;
  const Vec3 cross = (s[1]->point - s[0]->point).cross(s[2]->point - s[0]->point);
  if (towards.norm() < kMinAgreement || !(cross.norm() > 1e-9)) return false;
  c.normal = cross.normalized();
  c.facing = c.normal.dot(towards.normalized());
  if (c.facing < 0) {
    std::swap(c.face[1], c.face[2]);
    c.normal = -c.normal, c.facing = -c.facing;
  }
  return true;
}

/// Ordered by radius, then by corners.
std::vector<Candidate> find_candidates(const std::vector<Sample>& samples, double longest_edge) {
  std::vector<std::pair<Kernel::Point_3, int>> points;
  for (int i = 0; i < static_cast<int>(samples.size()); ++i) {
    const Vec3& p = samples[i].point;
    points.push_back({{p.x(), p.y(), p.z()}, i});
  }
  const Tetrahedra triangulation(points.begin(), points.end());
  const auto apex = [&](const Tetrahedra::Facet& facet) {
    const auto vertex = facet.first->vertex(facet.second);
    return triangulation.is_infinite(vertex) ? -1 : vertex->info();
  };
  std::vector<Candidate> candidates;
  for (auto it = triangulation.finite_facets_begin(); it != triangulation.finite_facets_end();
       ++it) {
    Candidate c;
    for (int k = 0; k < 3; ++k) c.face[k] = it->first->vertex((it->second + k + 1) % 4)->info();
    std::sort(c.face.begin(), c.face.end());
    if (!make_candidate(samples, longest_edge, c)) continue;
    c.radius = empty_radius(samples, c.face, {apex(*it), apex(triangulation.mirror_facet(*it))});
    candidates.push_back(c);
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.radius, a.face) < std::tie(b.radius, b.face);
  });
  return candidates;
}

/// Triangles chosen one by one; every edge keeps at most two, in opposite directions, not folded.
class Surface {
 public:
  bool add(const Candidate& c, double min_fold_cosine) {
    for (int k = 0; k < 3; ++k) {
      const int a = c.face[k], b = c.face[(k + 1) % 3];
      if (normal_of_side_.count(key(a, b))) return false;
      const auto other = normal_of_side_.find(key(b, a));
      if (other != normal_of_side_.end() && other->second.dot(c.normal) < min_fold_cosine)
        return false;
    }
    for (int k = 0; k < 3; ++k)
      normal_of_side_.emplace(key(c.face[k], c.face[(k + 1) % 3]), c.normal);
    faces.push_back(c.face);
    return true;
  }
  std::vector<Face> faces;

 private:
  static std::uint64_t key(int a, int b) {
    return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
  }
  std::unordered_map<std::uint64_t, Vec3> normal_of_side_;  // by directed edge
};

/// The faces around a vertex, parted into fans connected over edges at it.
std::vector<std::vector<int>> fans_at(const std::vector<Face>& faces, std::vector<int> left) {
  const auto is_adjacent = [&](int f, int g) {
    int shared = 0;
    for (int v : faces[f]) shared += std::count(faces[g].begin(), faces[g].end(), v) > 0;
    return shared >= 2;
  };
  std::vector<std::vector<int>> fans;
  while (!left.empty()) {
    std::vector<int> fan = {left.back()};
    left.pop_back();
    for (std::size_t i = 0; i < fan.size(); ++i)
      for (std::size_t k = left.size(); k-- > 0;)
        if (is_adjacent(fan[i], left[k])) {
          fan.push_back(left[k]);
          left.erase(left.begin() + k);
        }
    fans.push_back(fan);
  }
  return fans;
}

/// Where a vertex holds several fans, only its largest stays.
void keep_largest_fans(std::size_t vertices, std::vector<Face>& faces) {
  constexpr int kMaxRounds = 8;
  for (int round = 0; round < kMaxRounds; ++round) {
    std::vector<std::vector<int>> faces_at(vertices);
    for (int f = 0; f < static_cast<int>(faces.size()); ++f)
      for (int v : faces[f]) faces_at[v].push_back(f);
    std::vector<char> is_dropped(faces.size(), 0);
    bool has_dropped = false;
    for (const std::vector<int>& around : faces_at) {
      const auto fans = fans_at(faces, around);
      std::size_t largest = 0;
      for (std::size_t i = 1; i < fans.size(); ++i)
        if (fans[i].size() > fans[largest].size()) largest = i;
      for (std::size_t i = 0; i < fans.size(); ++i)
        if (i != largest)
          for (int f : fans[i]) is_dropped[f] = has_dropped = true;
    }
    if (!has_dropped) return;
    std::vector<Face> kept;
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (!is_dropped[f]) kept.push_back(faces[f]);
    faces = kept;
  }
}

/// The component of each face, connected over edges; numbers are the first face of the component.
std::vector<int> edge_components(const std::vector<Face>& faces) {
  std::vector<std::array<int, 3>> edges;  // low, high, face
  for (int f = 0; f < static_cast<int>(faces.size()); ++f)
    for (int s = 0; s < 3; ++s) {
      const int a = faces[f][s], b = faces[f][(s + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), f});
    }
  std::sort(edges.begin(), edges.end());
  UnionFind sets(faces.size());
  for (std::size_t e = 1; e < edges.size(); ++e)
    if (edges[e][0] == edges[e - 1][0] && edges[e][1] == edges[e - 1][1])
      sets.unite(edges[e][2], edges[e - 1][2]);
  std::vector<int> component(faces.size());
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) component[f] = sets.find(f);
  return component;
}

void drop_small_components(std::vector<Face>& faces) {
  const std::vector<int> component = edge_components(faces);
  std::vector<std::size_t> size(faces.size(), 0);
  for (int c : component) ++size[c];
  std::vector<Face> kept;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (size[component[f]] >= kMinComponent) kept.push_back(faces[f]);
  faces = kept;
}

/// Closes boundary loops of a few edges by cutting off ears, shortest diagonal first.
void fill_small_holes(const std::vector<Sample>& samples, std::vector<Face>& faces) {
  constexpr std::size_t kMaxLoop = 8;
  std::set<std::pair<int, int>> sides;
  for (const Face& f : faces)
    for (int k = 0; k < 3; ++k) sides.insert({f[k], f[(k + 1) % 3]});
  std::map<int, int> next;  // around holes, against the faces
  for (const auto& [a, b] : sides)
    if (!sides.count({b, a})) next[b] = a;
  std::set<int> visited;
  for (const auto& [start, second] : next) {
    std::vector<int> loop;
    for (int v = start; next.count(v) && visited.insert(v).second; v = next.at(v))
      loop.push_back(v);
    if (loop.size() < 3 || loop.size() > kMaxLoop || next.at(loop.back()) != start) continue;
    while (loop.size() >= 3) {
      const std::size_t n = loop.size();
      std::size_t ear = n;
      double shortest = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < n; ++i) {
        const int a = loop[(i + n - 1) % n], b = loop[(i + 1) % n];
        const double length = (samples[a].point - samples[b].point).norm();
        const bool is_free = n == 3 || (!sides.count({a, b}) && !sides.count({b, a}));
        if (is_free && length < shortest) ear = i, shortest = length;
      }
      if (ear == n) break;
      const Face f = {loop[(ear + n - 1) % n], loop[ear], loop[(ear + 1) % n]};
      for (int k = 0; k < 3; ++k) sides.insert({f[k], f[(k + 1) % 3]});
      faces.push_back(f);
      if (n == 3) break;
      loop.erase(loop.begin() + ear);
    }
  }
}

}  // namespace

std::vector<Face> reconstruct(const std::vector<Sample>& samples, double longest_edge) {
  if (samples.size() < 4) return {};
  const std::vector<Candidate> candidates = find_candidates(samples, longest_edge);
  // Smooth and well-faced triangles first, then what closes corners.
  std::vector<char> is_used(candidates.size(), 0);
  Surface surface;
  const std::array<std::pair<double, double>, 4> passes = {
      {{0.6, 0.5}, {0.3, 0.0}, {0.0, -0.6}, {0.0, -0.95}}};
  for (const auto& [min_facing, min_fold_cosine] : passes)
    for (std::size_t i = 0; i < candidates.size(); ++i)
      if (!is_used[i] && candidates[i].facing >= min_facing)
        is_used[i] = surface.add(candidates[i], min_fold_cosine);
  std::vector<Face> faces = surface.faces;
  keep_largest_fans(samples.size(), faces);
  drop_small_components(faces);
  fill_small_holes(samples, faces);
  return faces;
}

}  // namespace colod::synth
