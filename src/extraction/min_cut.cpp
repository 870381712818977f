// Based on: the min-cut over cells of Chauve, Labatut & Pons, "Robust piecewise-planar 3D
// reconstruction and completion from large-scale unstructured point data", CVPR 2010; max-flow of
// Boykov & Kolmogorov, PAMI 2004 (Boost).
// Differs: robust rules only. What each outline says of the two cells that it separates is added,
// and costs are whole numbers.
// Notation: v = vote of a cell.
#include "min_cut.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "parameters.h"

// GCC takes an optional of Boost's for uninitialised at -O3.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#pragma GCC diagnostic pop

namespace colod {
namespace {

using namespace parameters::extraction::min_cut;

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

}  // namespace colod
