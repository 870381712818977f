// *Based on:* own work.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include "looks_facets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "welded.h"

namespace colod {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kUpright_deg = 1;
constexpr double kSteep_deg = 70;  // a wall, whatever is below: it leans by less than mansards do
constexpr double kWall_deg = 45;   // no wall is less steep than this
constexpr double kFlat_deg = 5;    // all borders of a roof as flat as this are its eaves
constexpr double kFoot = 1;  // metres over the lowest point: what stands there stands on the ground
constexpr double kStanding = 0.5;  // of a leaning wall's lower border
constexpr double kLevel_deg = 1;
constexpr double kBend_deg = 2;            // less is no edge that is seen
constexpr double kDirection_deg = 2;       // about a plan direction
constexpr double kNearlyUpright_deg = 75;  // steeper edges have no plan direction
constexpr double kSloping_deg = 5;         // hips slope more
constexpr double kSecondPair = 0.1;        // of all edges that a second pair of directions explains
constexpr int kTurns = 360;                // of directions tried, over a right angle

struct Facet {
  Vec3 normal = Vec3::Zero();  // unit
  double area = 0, perimeter = 0;
  Vec3 centroid = Vec3::Zero();
  double slope_deg = 0;                 // 0 = level, looking up or down; 90 = upright
  double lower = 0, lower_at_foot = 0;  // metres of border, weighted by how far down they look
  bool is_wall = false;

  bool is_roof() const { return normal.z() > 0 && !is_wall; }
};

/// A piece of border between two facets; b is −1 where the surface ends.
struct Edge {
  int a = -1, b = -1;
  Vec3 from, to;      // a lies to the left
  Vec3 out_a, out_b;  // unit, in the facet's plane, out of it
  double length = 0;
};

double slope_deg(const Vec3& normal) {
  return std::acos(std::clamp(std::abs(normal.z()), 0.0, 1.0)) / kDegree;
}

/// Angle of a line over the horizon, 0..90.
double rise_deg(const Edge& e) {
  return std::asin(std::clamp(std::abs((e.to - e.from).z()) / e.length, 0.0, 1.0)) / kDegree;
}

std::vector<Facet> make_facets(const Welded& m, const std::vector<FaceShape>& shapes,
                               const std::vector<int>& facet_of_face) {
  const int count =
      facet_of_face.empty() ? 0 : *std::max_element(facet_of_face.begin(), facet_of_face.end()) + 1;
  std::vector<Facet> facets(count);
  for (std::size_t f = 0; f < m.faces.size(); ++f) {
    if (facet_of_face[f] < 0) continue;
    Facet& facet = facets[facet_of_face[f]];
    const Face& v = m.faces[f];
    facet.area += shapes[f].area;
    facet.normal += shapes[f].area * shapes[f].normal;
    facet.centroid += shapes[f].area / 3 * (m.points[v[0]] + m.points[v[1]] + m.points[v[2]]);
  }
  for (Facet& facet : facets) {
    facet.centroid /= facet.area;
    facet.normal.normalize();
    facet.slope_deg = slope_deg(facet.normal);
  }
  return facets;
}

std::vector<Edge> make_edges(const Welded& m, const std::vector<std::array<int, 3>>& neighbours,
                             const std::vector<int>& facet_of_face,
                             const std::vector<Facet>& facets) {
  std::vector<Edge> edges;
  for (std::size_t f = 0; f < m.faces.size(); ++f)
    for (int side = 0; side < 3; ++side) {
      const int next = neighbours[f][side];
      Edge e;
      e.a = facet_of_face[f], e.b = next >= 0 ? facet_of_face[next] : -1;
      if (e.a < 0 || e.a == e.b || (e.b >= 0 && next < static_cast<int>(f))) continue;
      e.from = m.points[m.faces[f][side]], e.to = m.points[m.faces[f][(side + 1) % 3]];
      e.length = (e.to - e.from).norm();
      const Vec3 along = (e.to - e.from) / e.length;
      e.out_a = along.cross(facets[e.a].normal);
      e.out_b = e.b >= 0 ? Vec3(-along.cross(facets[e.b].normal)) : Vec3(Vec3::Zero());
      edges.push_back(e);
    }
  return edges;
}

/// Steep facets are walls; less steep ones where they stand on the ground.
void tell_walls(const std::vector<Edge>& edges, std::vector<Facet>& facets) {
  double foot = std::numeric_limits<double>::infinity();
  for (const Edge& e : edges) foot = std::min(foot, e.from.z());
  const auto add = [&](Facet& f, const Edge& e, const Vec3& out) {
    const double weight = e.length * std::max(0.0, -out.z());
    f.lower += weight;
    if (std::max(e.from.z(), e.to.z()) < foot + kFoot) f.lower_at_foot += weight;
  };
  for (const Edge& e : edges) {
    add(facets[e.a], e, e.out_a);
    if (e.b >= 0) add(facets[e.b], e, e.out_b);
  }
  for (Facet& f : facets)
    f.is_wall = f.slope_deg > kSteep_deg ||
                (f.slope_deg > kWall_deg && f.lower_at_foot > kStanding * f.lower);
}

void keep_worst(LookFault fault, double size, const Vec3& place, Looks& looks) {
  FaultPlace& worst = looks.worst[static_cast<int>(fault)];
  if (size > worst.size) worst = {size, place};
}

void judge_walls(const std::vector<Facet>& facets, Looks& looks) {
  double upright = 0;
  for (const Facet& f : facets) {
    if (!f.is_wall) continue;
    looks.wall_area += f.area;
    if (f.slope_deg >= 90 - kUpright_deg)
      upright += f.area;
    else
      keep_worst(LookFault::kLeaning, f.area, f.centroid, looks);
  }
  if (looks.wall_area > 0) looks.upright = upright / looks.wall_area;
}

void judge_widths(const std::vector<Edge>& edges, double least_width, std::vector<Facet>& facets,
                  Looks& looks) {
  for (const Edge& e : edges) {
    facets[e.a].perimeter += e.length;
    if (e.b >= 0) facets[e.b].perimeter += e.length;
  }
  for (const Facet& f : facets)
    if (2 * f.area < least_width * f.perimeter)
      ++looks.narrow, keep_worst(LookFault::kNarrow, f.area, f.centroid, looks);
}

/// A line's direction in plan, degrees in [0, 180).
double heading_deg(const Edge& e) {
  const Vec3 d = e.to - e.from;
  const double heading = std::atan2(d.y(), d.x()) / kDegree;
  return std::fmod(heading + 360, 180);
}

/// How far apart two directions are that come back after `period` degrees.
double apart(double a, double b, double period) {
  const double d = std::fmod(std::abs(a - b), period);
  return std::min(d, period - d);
}

/// An edge that has a direction in plan.
struct Heading {
  double deg = 0, length = 0;
  bool is_sloping = false, is_explained = false;

  bool fits(double pair_deg) const {
    return apart(deg, pair_deg, is_sloping ? 45 : 90) <= kDirection_deg;
  }
};

/// The pair of directions that explains most of what no other does yet; its length.
double explain_most(std::vector<Heading>& headings, double least) {
  double most = 0, best = 0;
  for (int i = 0; i < kTurns; ++i) {
    const double pair = i * 90.0 / kTurns;
    double length = 0;
    for (const Heading& h : headings)
      if (!h.is_explained && h.fits(pair)) length += h.length;
    if (length > most) most = length, best = pair;
  }
  if (most <= least) return 0;
  for (Heading& h : headings) h.is_explained = h.is_explained || h.fits(best);
  return most;
}

void judge_edges(const std::vector<Edge>& edges, const std::vector<Facet>& facets, Looks& looks) {
  const double most_cos = std::cos(kBend_deg * kDegree);
  std::vector<Heading> headings;
  double all = 0, aligned = 0;
  for (const Edge& e : edges) {
    if (e.b >= 0 && facets[e.a].normal.dot(facets[e.b].normal) > most_cos) continue;
    all += e.length;
    const double rise = rise_deg(e);
    if (rise <= kNearlyUpright_deg)
      headings.push_back({heading_deg(e), e.length, rise > kSloping_deg, false});
    else if (rise >= 90 - kDirection_deg)
      aligned += e.length;
  }
  if (all == 0) return;
  aligned += explain_most(headings, 0);
  aligned += explain_most(headings, kSecondPair * all);
  looks.aligned = aligned / all;
}

void judge_eaves(const std::vector<Edge>& edges, const std::vector<Facet>& facets, Looks& looks) {
  double all = 0, level = 0;
  const auto add = [&](const Edge& e, const Facet& roof, const Vec3& out, const Facet& below,
                       const Vec3& out_below) {
    if (!roof.is_roof() || !below.is_wall || out_below.z() <= 0) return;
    const bool is_lower = -out.z() > 0.5 * std::sin(roof.slope_deg * kDegree);
    if (roof.slope_deg > kFlat_deg && !is_lower) return;
    all += e.length;
    if (rise_deg(e) <= kLevel_deg) level += e.length;
  };
  for (const Edge& e : edges) {
    if (e.b < 0) continue;
    add(e, facets[e.a], e.out_a, facets[e.b], e.out_b);
    add(e, facets[e.b], e.out_b, facets[e.a], e.out_a);
  }
  if (all > 0) looks.level_eaves = level / all;
}

}  // namespace

std::vector<int> look_at_facets(const Mesh& mesh, double least_width, Looks& looks) {
  const Welded m = weld(mesh);
  std::vector<FaceShape> shapes;
  for (const Face& f : m.faces) shapes.push_back(face_shape(m, f));
  const auto neighbours = face_neighbours(m, sorted_edge_uses(m.faces));
  const std::vector<int> facet_of_face = find_polygons(m, neighbours, shapes);
  std::vector<Facet> facets = make_facets(m, shapes, facet_of_face);
  const std::vector<Edge> edges = make_edges(m, neighbours, facet_of_face, facets);
  tell_walls(edges, facets);
  judge_walls(facets, looks);
  judge_widths(edges, least_width, facets, looks);
  judge_edges(edges, facets, looks);
  judge_eaves(edges, facets, looks);
  return facet_of_face;
}

}  // namespace colod
