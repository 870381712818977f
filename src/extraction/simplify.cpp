// Based on: the description length of a piecewise planar model as in Verdie, Lafarge & Alliez, "LOD
// generation for urban scenes", ACM TOG 34(3), 2015: a facet must be worth its price.
// Differs: the paper takes the surface as it is labelled. A min-cut prices area, not facets: it
// leaves small steps and chips where planes cross beside an edge. Here (robust rules only) the
// cells under or over a facet change sides where that leaves fewer facets and neither moves the
// surface far nor gives away much volume that the rays are sure of.
// Notation: a facet is a set of connected pieces of one plane with the inside on one side; the
// stamp tells the pieces that one search has seen.
#include "simplify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "boundary.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::extraction::simplify;

constexpr int kRounds = 4;

void sort_unique(std::vector<int>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

/// Cells that may change sides together, and what lies around them.
struct Turn {
  std::vector<int> cells;
  std::vector<int> planes;                  ///< of all pieces around
  std::vector<int> old_pieces, new_pieces;  ///< where the surface runs before and after
  double cost = 0;                          ///< m³, weighted by the votes
};

class Simplifier {
 public:
  Simplifier(const Partition& partition, const Evidence& evidence,
             const std::vector<char>& is_forced_out, const SimplifyOptions& options,
             std::vector<char>& is_inside)
      : partition_(partition),
        evidence_(evidence),
        is_forced_out_(is_forced_out),
        options_(options),
        is_inside_(is_inside),
        neighbours_(partition.pieces.size()),
        pieces_of_cell_(partition.cells.size()),
        pieces_of_plane_(partition.planes.size()),
        seen_(partition.pieces.size(), 0),
        is_in_turn_(partition.cells.size(), 0) {
    for (const auto& [a, b] : BoundaryFinder(partition).find_neighbours())
      neighbours_[a].push_back(b), neighbours_[b].push_back(a);
    for (std::size_t p = 0; p < partition.pieces.size(); ++p) {
      pieces_of_plane_[partition.pieces[p].plane].push_back(static_cast<int>(p));
      for (const int cell : partition.pieces[p].cells)
        if (cell >= 0) pieces_of_cell_[cell].push_back(static_cast<int>(p));
    }
  }

  int run() {
    int saved = 0;
    for (int round = 0, before = -1; round < kRounds && saved > before; ++round) {
      before = saved;
      for (const int seed : seeds_by_area()) {
        if (side(seed) == 0) continue;
        const std::vector<int> facet = facet_of(seed);
        const int removed = try_turn(facet, true);
        saved += removed > 0 ? removed : try_turn(facet, false);
      }
    }
    return saved;
  }

 private:
  bool inside(int cell) const { return cell >= 0 && is_inside_[cell]; }

  /// 1: the surface runs here and looks where the plane's normal does; −1: against it; 0: it does
  /// not run here.
  int side(int piece) const {
    const auto [behind, before] = partition_.pieces[piece].cells;
    return static_cast<int>(inside(behind)) - static_cast<int>(inside(before));
  }

  /// The unseen pieces of the seed's facet, the seed first.
  std::vector<int> grow_facet(int seed) {
    std::vector<int> facet = {seed};
    const int way = side(seed);
    seen_[seed] = stamp_;
    for (std::size_t i = 0; i < facet.size(); ++i)
      for (const int p : neighbours_[facet[i]])
        if (seen_[p] != stamp_ && side(p) == way) seen_[p] = stamp_, facet.push_back(p);
    return facet;
  }
  std::vector<int> facet_of(int seed) {
    ++stamp_;
    return grow_facet(seed);
  }

  /// One piece of each facet, small facets first.
  std::vector<int> seeds_by_area() {
    ++stamp_;
    std::vector<std::pair<double, int>> facets;
    for (int p = 0; p < static_cast<int>(partition_.pieces.size()); ++p) {
      if (seen_[p] == stamp_ || side(p) == 0) continue;
      double area = 0;
      for (const int q : grow_facet(p)) area += evidence_.area[q];
      facets.emplace_back(area, p);
    }
    std::sort(facets.begin(), facets.end());
    std::vector<int> seeds;
    for (const auto& [area, p] : facets) seeds.push_back(p);
    return seeds;
  }

  int count_facets(const std::vector<int>& planes) {
    ++stamp_;
    int count = 0;
    for (const int plane : planes)
      for (const int p : pieces_of_plane_[plane])
        if (seen_[p] != stamp_ && side(p) != 0) grow_facet(p), ++count;
    return count;
  }

  double price(int cell) const {
    const double vote = inside_vote(evidence_.cells[cell]);
    return partition_.cells[cell].volume * std::max(kLeastVote, is_inside_[cell] ? vote : -vote);
  }

  /// The cells under (removing) or over the facet; none where one of them has to stay.
  std::vector<int> cells_beside(const std::vector<int>& facet, bool is_removing) const {
    std::vector<int> cells;
    for (const int p : facet)
      for (const int cell : partition_.pieces[p].cells) {
        if (inside(cell) != is_removing) continue;
        if (cell >= 0 && !evidence_.is_told.empty() && evidence_.is_told[cell]) return {};
        if (!is_removing && (cell < 0 || is_forced_out_[cell])) return {};
        cells.push_back(cell);
      }
    sort_unique(cells);
    return cells;
  }

  Turn make_turn(std::vector<int> cells) {
    Turn turn{std::move(cells), {}, {}, {}, 0};
    for (const int cell : turn.cells) is_in_turn_[cell] = 1, turn.cost += price(cell);
    for (const int cell : turn.cells)
      for (const int p : pieces_of_cell_[cell]) {
        const auto [a, b] = partition_.pieces[p].cells;
        const int other = a == cell ? b : a;
        if (other >= 0 && is_in_turn_[other]) continue;
        turn.planes.push_back(partition_.pieces[p].plane);
        (inside(other) == inside(cell) ? turn.new_pieces : turn.old_pieces).push_back(p);
      }
    for (const int cell : turn.cells) is_in_turn_[cell] = 0;
    sort_unique(turn.planes);
    return turn;
  }

  /// The farthest vertex or middle of some pieces from the nearest plane of others, metres.
  double reach(const std::vector<int>& from, const std::vector<int>& to) const {
    double most = 0;
    const auto measure = [&](const Vec3& x) {
      double least = std::numeric_limits<double>::infinity();
      for (const int q : to) {
        const auto& n = partition_.planes[partition_.pieces[q].plane].normal;
        const Vec3& on = partition_.points[partition_.pieces[q].polygon[0]];
        const Vec3 normal = Vec3(n[0], n[1], n[2]).normalized();
        least = std::min(least, std::abs(normal.dot(x - on)));
      }
      most = std::max(most, least);
    };
    for (const int p : from) {
      const std::vector<int>& polygon = partition_.pieces[p].polygon;
      Vec3 middle = Vec3::Zero();
      for (const int v : polygon) {
        middle += partition_.points[v] / static_cast<double>(polygon.size());
        measure(partition_.points[v]);
      }
      measure(middle);
    }
    return most;
  }
  /// How far the surface moves, metres.
  double depth(const Turn& turn) const {
    return std::max(reach(turn.old_pieces, turn.new_pieces),
                    reach(turn.new_pieces, turn.old_pieces));
  }

  bool is_fixed(const std::vector<int>& pieces) const {
    return !options_.is_fixed.empty() && std::any_of(pieces.begin(), pieces.end(), [&](int p) {
      return options_.is_fixed[partition_.pieces[p].plane] != 0;
    });
  }

  /// How many facets that saved; 0: nothing was turned.
  int try_turn(const std::vector<int>& facet, bool is_removing) {
    const Turn turn = make_turn(cells_beside(facet, is_removing));
    if (is_fixed(turn.old_pieces) || is_fixed(turn.new_pieces)) return 0;
    const double most_saved = 2.0 * static_cast<double>(turn.planes.size());  // hardly ever more
    if (turn.new_pieces.empty() || turn.cost > options_.facet_volume * most_saved) return 0;
    const auto flip = [&] {
      for (const int cell : turn.cells) is_inside_[cell] = !is_inside_[cell];
    };
    const int before = count_facets(turn.planes);
    flip();
    const int saved = before - count_facets(turn.planes);
    if (saved > 0 && turn.cost <= options_.facet_volume * saved && depth(turn) <= options_.depth)
      return saved;
    flip();
    return 0;
  }

  const Partition& partition_;
  const Evidence& evidence_;
  const std::vector<char>& is_forced_out_;
  const SimplifyOptions& options_;
  std::vector<char>& is_inside_;
  std::vector<std::vector<int>> neighbours_, pieces_of_cell_, pieces_of_plane_;
  std::vector<int> seen_;  ///< per piece: the stamp of the last search that came by
  std::vector<char> is_in_turn_;
  int stamp_ = 0;
};

/// Per plane of the partition whether it is a side of a round shape.
std::vector<char> sides_of(const Partition& partition, const Planes& planes) {
  std::vector<char> is_side;
  for (const Partition::IntPlane& p : partition.planes)
    is_side.push_back(p.source_plane >= 0 && planes.has_side(p.source_plane));
  return is_side;
}

}  // namespace

int simplify_cells(const Partition& partition, const Evidence& evidence,
                   const std::vector<char>& is_forced_out, const SimplifyOptions& options,
                   std::vector<char>& is_inside) {
  return Simplifier(partition, evidence, is_forced_out, options, is_inside).run();
}

Draft simplify(Draft draft, const Planes& planes, const ExtractionOptions& options) {
  const double price = kFacetPrice * options.tolerance * surface_area(draft.shell.mesh.mesh());
  const bool is_capped =
      options.is_finest && options.rules.has(Rule::kPriceCap) && planes.is_clean();
  std::vector<char> is_inside = draft.labels.is_inside;
  simplify_cells(draft.partition, draft.labels.evidence, draft.labels.is_forced_out,
                 {.facet_volume = is_capped ? std::min(price, kMostPrice) : price,
                  .depth = kMostMoved * options.tolerance,
                  .is_fixed = sides_of(draft.partition, planes)},
                 is_inside);
  Shell shell = make_surface(draft.partition, is_inside, options.rules);
  const bool is_leaner = !shell.mesh.facets.empty() &&
                         shell.mesh.facets.size() < draft.shell.mesh.facets.size() &&
                         keeps_volume(draft.shell.mesh, shell.mesh);
  if (is_leaner) draft.labels.is_inside = std::move(is_inside), draft.shell = std::move(shell);
  return draft;
}

}  // namespace colod
