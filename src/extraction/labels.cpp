// Based on: eq. 11 of the paper; the min-cut over cells of Chauve, Labatut & Pons, "Robust
// piecewise-planar 3D reconstruction and completion from large-scale unstructured point data",
// CVPR 2010; max-flow of Boykov & Kolmogorov, PAMI 2004 (Boost).
// Differs: paper rules: nr rays over the sphere from the centroid, inside where more than half are
// valid hits, nothing else. On scans without floor half the rays of a low cell leave through it, so
// that robust rules cast rays on rings at 0, 20 and 40 degrees, and steep ones upward that say
// whether a roof stands above (airborne clouds have nothing else); they add what each outline says
// of the two cells it separates, and smooth by a min-cut in whole numbers. Measured in November
// 2026 on five open scans: mean error 1.64 % of the diagonal with the sphere, 0.17 % so.
// Notation: v = vote of a cell, A = area of a piece, c = coverage of a piece.
#include "labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/parallel.h"

// GCC takes an optional of Boost's for uninitialised at -O3.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#pragma GCC diagnostic pop

namespace colod {
namespace {

constexpr std::array<double, 3> kElevations = {0, 20, 40};
constexpr std::array<double, 2> kSteep = {80, 88};
constexpr double kRoofVote = 0.7;    // of a ray that meets nothing, where a roof stands above
constexpr double kLocalVote = 0.25;  // of an outline for the cells it separates, per m²
constexpr double kDiscount = 0.9;    // of smoothness on a fully covered facet
constexpr double kThinCell = 0.1;    // metres: thinner cells follow their neighbours
constexpr double kSmallCell = 0.2, kLargeCell = 20;  // m³: one sample below, nine above

/// Vertices of each cell, rising.
std::vector<std::vector<int>> cell_vertices(const Partition& partition) {
  std::vector<std::vector<int>> vertices(partition.cells.size());
  for (const Partition::Piece& piece : partition.pieces)
    for (const int cell : piece.cells)
      if (cell >= 0)
        vertices[cell].insert(vertices[cell].end(), piece.polygon.begin(), piece.polygon.end());
  for (std::vector<int>& v : vertices) {
    std::sort(v.begin(), v.end());
    v.erase(std::unique(v.begin(), v.end()), v.end());
  }
  return vertices;
}

/// The centroid and, for large cells, points between it and vertices far from each other.
std::vector<Vec3> sample_cell(const Partition& partition, int cell,
                              const std::vector<int>& vertices) {
  const Partition::Cell& c = partition.cells[cell];
  std::vector<Vec3> chosen = {c.centroid}, samples = {c.centroid};
  const std::size_t wanted = c.volume < kSmallCell ? 1 : c.volume < kLargeCell ? 5 : 9;
  while (samples.size() < std::min(wanted, vertices.size() + 1)) {
    double best = -1;
    Vec3 farthest = c.centroid;
    for (const int v : vertices) {
      double d = std::numeric_limits<double>::infinity();
      for (const Vec3& p : chosen) d = std::min(d, (partition.points[v] - p).squaredNorm());
      if (d > best) best = d, farthest = partition.points[v];
    }
    chosen.push_back(farthest);
    samples.push_back(c.centroid + 0.6 * (farthest - c.centroid));
  }
  return samples;
}

struct Tally {
  double inside = 0, outside = 0;  ///< shares of the rays
};

Tally cast(const RayScene& rays, const Vec3& origin, const std::vector<Vec3>& directions) {
  int inside = 0, outside = 0;
  for (const Vec3& d : directions)
    if (const RayHit hit = rays.first_hit(origin, d)) ++(hit.is_inside ? inside : outside);
  const double n = static_cast<double>(directions.size());
  return {inside / n, outside / n};
}

/// Asks what points see, with the directions of the rules.
class Voter {
 public:
  Voter(const Sight& sight, const VoteOptions& options)
      : sight_(sight),
        is_paper_(options.is_paper),
        around_(options.is_paper ? sphere_directions(options.nr)
                                 : ring_directions(options.nr, kElevations)),
        steep_(ring_directions(std::max(8, options.nr / 5), kSteep)) {}

  Vote vote(const Vec3& point) const {
    const auto known = sight_.votes.find(point);
    if (known != sight_.votes.end()) return known->second;
    const Tally around = cast(sight_.rays, point, around_);
    if (is_paper_) return {2 * around.inside - 1, 0, 0};
    const Tally above = cast(sight_.rays, point, steep_);
    const double roof = std::clamp(above.inside - above.outside, 0.0, 1.0);
    const double escaped = 1 - around.inside - around.outside;
    return {around.inside - around.outside, escaped * roof, escaped * (1 - roof)};
  }

 private:
  const Sight& sight_;
  bool is_paper_;
  std::vector<Vec3> around_, steep_;
};

/// The mean vote of each cell's points; what was seen is kept in `sight`.
std::vector<Vote> vote_on_cells(const Partition& partition, Sight& sight,
                                const VoteOptions& options) {
  const std::vector<std::vector<int>> vertices = cell_vertices(partition);
  const Voter voter(sight, options);
  std::vector<std::vector<std::pair<Vec3, Vote>>> seen(partition.cells.size());
  const auto ask = [&](std::size_t cell) {
    const std::vector<Vec3> points =
        options.is_paper ? std::vector<Vec3>{partition.cells[cell].centroid}
                         : sample_cell(partition, static_cast<int>(cell), vertices[cell]);
    for (const Vec3& p : points) seen[cell].emplace_back(p, voter.vote(p));
  };
  parallel_for(seen.size(), ask, 16);
  std::vector<Vote> mean(seen.size());
  for (std::size_t cell = 0; cell < seen.size(); ++cell)
    for (const auto& [point, vote] : seen[cell]) {
      const double share = 1.0 / static_cast<double>(seen[cell].size());
      mean[cell].seen += share * vote.seen;
      mean[cell].sheltered += share * vote.sheltered;
      mean[cell].exposed += share * vote.exposed;
      sight.votes.emplace(point, vote);
    }
  return mean;
}

}  // namespace

Evidence gather_evidence(const Partition& partition, Sight& sight, const VoteOptions& options) {
  const std::size_t n = partition.cells.size();
  Evidence e;
  e.area.resize(partition.pieces.size());
  e.weight.assign(n, 0);
  e.coverage.assign(partition.pieces.size(), 0);
  e.reversed.assign(partition.pieces.size(), 0);
  for (std::size_t p = 0; p < partition.pieces.size(); ++p) {
    const Partition::Piece& piece = partition.pieces[p];
    Vec3 sum = Vec3::Zero();
    const Vec3& a = partition.points[piece.polygon[0]];
    for (std::size_t i = 1; i + 1 < piece.polygon.size(); ++i)
      sum += (partition.points[piece.polygon[i]] - a)
                 .cross(partition.points[piece.polygon[i + 1]] - a);
    e.area[p] = 0.5 * sum.norm();
    for (const int cell : piece.cells)
      if (cell >= 0) e.weight[cell] += e.area[p];
  }
  for (std::size_t c = 0; c < n; ++c)
    e.weight[c] = std::min(e.weight[c], 2 * partition.cells[c].volume / kThinCell);
  e.cells = vote_on_cells(partition, sight, options);
  return e;
}

namespace {

/// Area of a triangle inside a convex counter-clockwise polygon.
double clipped_area(const std::vector<Vec2>& convex, const std::array<Vec2, 3>& triangle) {
  const auto cross = [](const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); };
  std::vector<Vec2> poly(triangle.begin(), triangle.end()), next;
  for (std::size_t i = 0; i < convex.size() && poly.size() > 2; ++i) {
    const Vec2 a = convex[i], d = convex[(i + 1) % convex.size()] - a;
    next.clear();
    for (std::size_t j = 0; j < poly.size(); ++j) {
      const Vec2 &p = poly[j], &q = poly[(j + 1) % poly.size()];
      const double sp = cross(d, p - a), sq = cross(d, q - a);
      if (sp >= 0) next.push_back(p);
      if ((sp < 0) != (sq < 0)) next.push_back(p + sp / (sp - sq) * (q - p));
    }
    poly.swap(next);
  }
  double sum = 0;
  for (std::size_t j = 1; j + 1 < poly.size(); ++j)
    sum += cross(poly[j] - poly[0], poly[j + 1] - poly[0]);
  return 0.5 * std::abs(sum);
}

/// One outline in the coordinates of an integer plane.
struct FlatOutline {
  std::vector<std::array<Vec2, 3>> triangles;
  bool is_reversed;
};

}  // namespace

void measure_coverage(const Partition& partition, const Planes& planes,
                      const std::vector<int>& input, Evidence& evidence) {
  std::vector<std::array<Vec3, 2>> basis;
  for (const auto& plane : partition.planes)
    basis.push_back(
        plane_basis(Vec3(plane.normal[0], plane.normal[1], plane.normal[2]).normalized()));
  const auto flat = [&](int plane, const Vec3& p) {
    return Vec2(basis[plane][0].dot(p), basis[plane][1].dot(p));
  };
  std::vector<std::vector<FlatOutline>> outlines(partition.planes.size());
  for (std::size_t i = 0; i < input.size(); ++i) {
    const Partition::Cut& cut = partition.cuts[i];
    if (input[i] < 0 || cut.plane < 0) continue;
    const Outline& outline = planes.planes[input[i]].outline;
    outlines[cut.plane].push_back({{}, cut.is_reversed});
    for (const Face& f : outline.triangles)
      outlines[cut.plane].back().triangles.push_back({flat(cut.plane, outline.vertices[f[0]]),
                                                      flat(cut.plane, outline.vertices[f[1]]),
                                                      flat(cut.plane, outline.vertices[f[2]])});
  }
  parallel_for(
      partition.pieces.size(),
      [&](std::size_t p) {
        const Partition::Piece& piece = partition.pieces[p];
        if (outlines[piece.plane].empty() || evidence.area[p] <= 0) return;
        std::vector<Vec2> polygon;
        for (const int v : piece.polygon) polygon.push_back(flat(piece.plane, partition.points[v]));
        Eigen::AlignedBox2d box;
        for (const Vec2& q : polygon) box.extend(q);
        for (const FlatOutline& outline : outlines[piece.plane]) {
          double sum = 0;
          for (const auto& t : outline.triangles) {
            Eigen::AlignedBox2d other;
            for (const Vec2& q : t) other.extend(q);
            if (box.intersects(other)) sum += clipped_area(polygon, t);
          }
          double& share = (outline.is_reversed ? evidence.reversed : evidence.coverage)[p];
          share = std::min(1.0, share + sum / evidence.area[p]);
        }
      },
      64);
}

double inside_vote(const Vote& vote, double escape) {
  return vote.seen + kRoofVote * vote.sheltered - escape * vote.exposed;
}

std::vector<char> threshold_cells(const Evidence& evidence,
                                  const std::vector<char>& is_forced_out) {
  std::vector<char> is_inside(evidence.cells.size());
  for (std::size_t c = 0; c < is_inside.size(); ++c)
    is_inside[c] = evidence.cells[c].seen > 0 && !is_forced_out[c];
  return is_inside;
}

namespace {

using Capacity = std::int64_t;
using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
using Graph = boost::adjacency_list<
    boost::vecS, boost::vecS, boost::directedS,
    boost::property<boost::vertex_index_t, long,
                    boost::property<boost::vertex_color_t, boost::default_color_type,
                                    boost::property<boost::vertex_distance_t, long,
                                                    boost::property<boost::vertex_predecessor_t,
                                                                    Traits::edge_descriptor>>>>,
    boost::property<
        boost::edge_capacity_t, Capacity,
        boost::property<boost::edge_residual_capacity_t, Capacity,
                        boost::property<boost::edge_reverse_t, Traits::edge_descriptor>>>>;

/// Costs are whole square millimetres: sums do not depend on their order.
Capacity whole(double square_metres) {
  return static_cast<Capacity>(std::llround(1e6 * std::max(0.0, square_metres)));
}

void add_arcs(Graph& graph, long a, long b, Capacity forth, Capacity back) {
  const auto e = add_edge(a, b, graph).first, r = add_edge(b, a, graph).first;
  put(boost::edge_capacity, graph, e, forth), put(boost::edge_capacity, graph, r, back);
  put(boost::edge_reverse, graph, e, r), put(boost::edge_reverse, graph, r, e);
}

/// What the residual graph still reaches from the source: the smallest of all minimal cuts.
std::vector<char> source_side(const Graph& graph, long source) {
  std::vector<char> is_reached(num_vertices(graph), 0);
  std::vector<long> stack = {source};
  is_reached[source] = 1;
  while (!stack.empty()) {
    const long v = stack.back();
    stack.pop_back();
    for (auto [e, end] = out_edges(static_cast<unsigned long>(v), graph); e != end; ++e) {
      const long w = static_cast<long>(target(*e, graph));
      if (is_reached[w] || get(boost::edge_residual_capacity, graph, *e) <= 0) continue;
      is_reached[w] = 1;
      stack.push_back(w);
    }
  }
  return is_reached;
}

}  // namespace

std::vector<char> cut_cells(const Partition& partition, const Evidence& evidence,
                            const std::vector<char>& is_forced_out, const CutOptions& options) {
  const long n = static_cast<long>(partition.cells.size()), source = n, sink = n + 1;
  std::vector<Capacity> for_inside(n), for_outside(n);
  for (long c = 0; c < n; ++c) {
    const double v = inside_vote(evidence.cells[c], options.escape) * evidence.weight[c];
    for_inside[c] = whole(v), for_outside[c] = whole(-v);
  }
  Graph graph(n + 2);
  for (std::size_t p = 0; p < partition.pieces.size(); ++p) {
    const double area = evidence.area[p];
    const double along = evidence.coverage[p], against = evidence.reversed[p];
    // Behind the outline's outer side lies the inside.
    for (const int k : {0, 1}) {
      const int cell = partition.pieces[p].cells[k];
      if (cell < 0) continue;
      for_inside[cell] += whole(kLocalVote * area * (k == 0 ? along : against));
      for_outside[cell] += whole(kLocalVote * area * (k == 0 ? against : along));
    }
    const Capacity forth = whole(options.smoothness * area * (1 - kDiscount * along));
    const Capacity back = whole(options.smoothness * area * (1 - kDiscount * against));
    const auto [a, b] = partition.pieces[p].cells;
    if (a >= 0 && b >= 0)
      add_arcs(graph, a, b, forth, back);
    else if (a >= 0)
      for_outside[a] += forth;
    else if (b >= 0)
      for_outside[b] += back;
  }
  for (long c = 0; c < n; ++c) {
    const Capacity common = std::min(for_inside[c], for_outside[c]);
    if (is_forced_out[c])
      for_inside[c] = 0, for_outside[c] = Capacity{1} << 50;
    else
      for_inside[c] -= common, for_outside[c] -= common;
    if (for_inside[c] > 0) add_arcs(graph, source, c, for_inside[c], 0);
    if (for_outside[c] > 0) add_arcs(graph, c, sink, for_outside[c], 0);
  }
  boost::boykov_kolmogorov_max_flow(graph, static_cast<unsigned long>(source),
                                    static_cast<unsigned long>(sink));
  std::vector<char> is_inside = source_side(graph, source);
  is_inside.resize(n);
  return is_inside;
}

double explained_share(const Partition& partition, const Evidence& evidence,
                       const std::vector<char>& is_inside) {
  double total = 0, on_surface = 0;
  const auto inside = [&](int cell) { return cell >= 0 && is_inside[cell]; };
  for (std::size_t p = 0; p < partition.pieces.size(); ++p) {
    const auto [behind, before] = partition.pieces[p].cells;
    total += evidence.area[p] * (evidence.coverage[p] + evidence.reversed[p]);
    if (inside(behind) && !inside(before)) on_surface += evidence.area[p] * evidence.coverage[p];
    if (!inside(behind) && inside(before)) on_surface += evidence.area[p] * evidence.reversed[p];
  }
  return total > 0 ? on_surface / total : 0;
}

}  // namespace colod
