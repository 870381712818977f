// Based on: Co-LOD, section 3.3 (eq. 11): binary space partition, rays, the largest interior
// component.
// Differs: paper rules take the largest component of the cells that more than half of nr rays see
// from inside. Robust rules add candidate planes, a min-cut and several trials before giving up
// (candidates.cpp, labels.cpp), and cut anew without the planes that carry
// only slivers or uncovered facets (on 15 clean models a quarter of the polygons and two thirds of
// the facets under 5 cm; measured in November 2026), cut planes near a larger one along that one
// (leaders.cpp) and drop facets that hardly matter (simplify.cpp). Both mend
// the boundary to a 2-manifold (repair.cpp) and write it in the same way
// (surface.cpp). Notation: a cell is a convex piece of space between the layer's planes.
#include "extraction.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>

#include "candidates.h"
#include "core/error.h"
#include "core/flat.h"
#include "labels.h"
#include "sheets.h"
#include "surface.h"

namespace colod {
namespace {

constexpr double kClipShare = 1.0 / 3;   // of the growing distance: what a cut must reach into
constexpr double kShortest = 3e-3;       // metres: shorter edges are contracted …
constexpr double kShortestPaper = 1e-3;  // … under the paper's rules
constexpr double kNarrowest = 2.5e-3;    // metres: edges of narrower facets likewise
constexpr std::array<double, 4> kEscapes = {1.0, 0.6, 0.3, 0.1};
constexpr double kEnough = 0.6;         // share of the outlines on the surface that ends the search
constexpr double kWorthwhile = 0.1;     // share that another trial must add
constexpr double kLittle = 0.2;         // share of the outlines below which a warning is due
constexpr double kSliver = 0.05;        // metres: facets narrower than this carry no plane
constexpr double kLeastCovered = 0.15;  // of a plane's facets that must lie under its outline
constexpr double kMostLost = 0.03;      // of surface and volume when planes are left out
constexpr double kSubstantial = 0.05;   // of the largest component: one that is kept besides it
constexpr double kNoOther = 2;          // likewise: none is
constexpr double kFacetPrice = 0.002;   // of tolerance × surface: volume that a facet must shape
constexpr double kMostPrice = 0.02;     // m³, likewise: on the finest layer of an exact model
constexpr double kMostMoved = 4;        // times the tolerance: how far saving a facet may go
constexpr int kPruningRounds = 2;
// Of all attempts on a building: twice the most seen on real ones (46 000, on 47 cut out of a drone
// scene, November 2026).
constexpr std::int64_t kMostCells = 100000;
// Of one partition: half as many again as seen. Simplifying takes the square of them.
constexpr std::int64_t kLargestPartition = 15000;
constexpr double kMuchMended = 0.02;  // share of the volume turned round that asks for a warning

std::vector<char> forced_outside(const Partition& partition, const CuttingPlan& plan) {
  std::vector<char> is_forced(partition.cells.size(), 0);
  for (std::size_t c = 0; c < is_forced.size(); ++c)
    for (const CuttingPlan::Limit& limit : plan.limits)
      if (limit.normal.dot(partition.cells[c].centroid) > limit.offset) is_forced[c] = 1;
  return is_forced;
}

/// A surface and what it was made from.
struct Attempt {
  Partition partition;
  Evidence evidence;
  std::vector<char> is_forced_out;
  std::vector<char> is_inside;  ///< empty: nothing is
  PolygonMesh mesh;
  double mended = 0;  ///< m³
  std::vector<std::string> warnings;
};

/// The inside; escaping rays count less where that explains clearly more of the outlines; empty
/// when nothing is inside at all.
std::vector<char> label(const CuttingPlan& plan, const Planes& planes, Sight& sight,
                        const ExtractionOptions& options, Attempt& attempt) {
  const Partition& partition = attempt.partition;
  const std::vector<char>& is_forced = attempt.is_forced_out;
  const double least_share = options.is_paper ? kNoOther : kSubstantial;
  std::vector<char> is_inside;
  if (options.is_paper) {
    is_inside = threshold_cells(
        gather_evidence(partition, sight, {.is_paper = true, .nr = options.nr}), is_forced);
    return keep_largest_components(partition, is_inside, least_share) ? is_inside
                                                                      : std::vector<char>();
  }
  attempt.evidence = gather_evidence(partition, sight, {.nr = options.nr});
  const Evidence& evidence = attempt.evidence;
  measure_coverage(partition, planes, plan.input, attempt.evidence);
  ask_elements(partition, plan.elements, attempt.evidence);
  double best = -1;
  for (const double escape : kEscapes) {
    std::vector<char> trial = cut_cells(partition, evidence, is_forced,
                                        {.smoothness = options.smoothness, .escape = escape});
    if (!keep_largest_components(partition, trial, least_share)) continue;
    const double share = explained_share(partition, evidence, trial);
    if (share > best + kWorthwhile) best = share, is_inside = std::move(trial);
    if (best > kEnough) break;
  }
  if (best < kLittle) attempt.warnings.push_back("little of the layer lies on its surface");
  if (!is_inside.empty()) return is_inside;
  attempt.warnings.push_back("no ray sees an inside: the layer is the box around its planes");
  is_inside.resize(partition.cells.size());
  for (std::size_t c = 0; c < is_inside.size(); ++c) is_inside[c] = !is_forced[c];
  return keep_largest_components(partition, is_inside, least_share) ? is_inside
                                                                    : std::vector<char>();
}

/// Where planes are known to the millimetre, what reaches a millimetre into a cell cuts it.
Partition cut(const CuttingPlan& plan, const Planes& planes, const ExtractionOptions& options) {
  PartitionOptions cutting{.max_cells = options.max_cells};
  if (!options.is_paper)
    cutting.clip_tolerance = std::min(cutting.clip_tolerance, kClipShare * planes.distance);
  return partition_space(plan.planes, plan.box, cutting);
}

Attempt try_plan(const CuttingPlan& plan, const Planes& planes, Sight& sight,
                 const ExtractionOptions& options) {
  Attempt attempt;
  attempt.partition = cut(plan, planes, options);
  const auto cells = static_cast<std::int64_t>(attempt.partition.cells.size());
  sight.cells += cells, sight.most_cells = std::max(sight.most_cells, cells);
  attempt.warnings = attempt.partition.warnings;
  attempt.is_forced_out = forced_outside(attempt.partition, plan);
  attempt.is_inside = label(plan, planes, sight, options, attempt);
  if (!attempt.is_inside.empty())
    attempt.mesh =
        extract_surface(attempt.partition, attempt.is_inside, options.is_paper, &attempt.mended);
  return attempt;
}

/// m² of the surface per input plane that lies under the plane's own outline.
std::vector<double> explained_areas(const Attempt& attempt, std::size_t planes) {
  std::vector<double> area(planes, 0);
  const auto inside = [&](int cell) { return cell >= 0 && attempt.is_inside[cell]; };
  for (std::size_t p = 0; p < attempt.partition.pieces.size(); ++p) {
    const Partition::Piece& piece = attempt.partition.pieces[p];
    const int source = attempt.partition.planes[piece.plane].source_plane;
    if (source < 0 || inside(piece.cells[0]) == inside(piece.cells[1])) continue;
    const auto& share =
        inside(piece.cells[0]) ? attempt.evidence.coverage : attempt.evidence.reversed;
    area[source] += attempt.evidence.area[p] * share[p];
  }
  return area;
}

/// Per input plane whether the surface is worth its cut: one facet that is no sliver, and enough of
/// the plane's facets under its outline; or it bounds a element, or is one of
/// many sides that only together are round.
std::vector<char> worthwhile_planes(const Attempt& attempt, const Planes& planes,
                                    const std::vector<Element>& elements,
                                    const std::vector<double>& explained) {
  std::vector<char> is_wide(explained.size(), 0);
  std::vector<double> total(explained.size(), 0);
  for (const PolygonMesh::Facet& facet : attempt.mesh.facets) {
    if (facet.plane < 0) continue;
    const FacetSize size = measure_facet(attempt.mesh, facet);
    total[facet.plane] += size.area;
    is_wide[facet.plane] |= size.width() > kSliver;
  }
  for (std::size_t p = 0; p < is_wide.size(); ++p)
    is_wide[p] = is_wide[p] && explained[p] >= kLeastCovered * total[p];
  for (const Element& element : elements)
    for (const int p : element.bounds) is_wide[p] = 1;
  for (std::size_t p = 0; p < is_wide.size(); ++p)
    is_wide[p] |= planes.has_side(static_cast<int>(p));
  return is_wide;
}

/// The plan without the planes that the surface does not need.
CuttingPlan leaner(const CuttingPlan& plan, const Attempt& attempt,
                   const std::vector<char>& is_worthwhile) {
  CuttingPlan lean{{}, {}, plan.box, plan.limits, plan.elements};
  for (std::size_t i = 0; i < plan.planes.size(); ++i) {
    const int plane = attempt.partition.cuts[i].plane;
    const int source = plane < 0 ? -1 : attempt.partition.planes[plane].source_plane;
    if (!plan.planes[i].hull.empty() && source >= 0 && !is_worthwhile[source]) continue;
    lean.planes.push_back(plan.planes[i]);
    lean.input.push_back(plan.input[i]);
  }
  return lean;
}

/// Planes that only slivers or uncovered facets lie on are left out and the rest is cut anew, while
/// the other planes keep their surface.
void prune(CuttingPlan& plan, const Planes& planes, Sight& sight, const ExtractionOptions& options,
           Attempt& best) {
  for (int round = 0; round < kPruningRounds && !is_spent(sight); ++round) {
    const std::vector<double> before = explained_areas(best, planes.planes.size());
    const std::vector<char> is_worthwhile = worthwhile_planes(best, planes, plan.elements, before);
    CuttingPlan lean = leaner(plan, best, is_worthwhile);
    if (lean.planes.size() == plan.planes.size()) return;
    Attempt next = try_plan(lean, planes, sight, options);
    if (next.is_inside.empty() || next.warnings.size() > best.warnings.size()) return;
    const std::vector<double> after = explained_areas(next, planes.planes.size());
    double wanted = 0, reached = 0;
    for (std::size_t p = 0; p < before.size(); ++p)
      if (is_worthwhile[p]) wanted += before[p], reached += std::min(before[p], after[p]);
    const double volume = signed_volume(best.mesh.mesh());
    if (reached < (1 - kMostLost) * wanted ||
        std::abs(signed_volume(next.mesh.mesh()) - volume) > kMostLost * volume)
      return;
    best = std::move(next);
    plan = std::move(lean);
  }
}

/// Per plane of the partition whether it is a side of a round shape.
std::vector<char> sides_of(const Partition& partition, const Planes& planes) {
  std::vector<char> is_side;
  for (const Partition::IntPlane& p : partition.planes)
    is_side.push_back(p.source_plane >= 0 && planes.has_side(p.source_plane));
  return is_side;
}

/// Facets that are not worth their price at the layer's tolerance go.
void simplify(const Planes& planes, const ExtractionOptions& options, bool is_exact,
              Attempt& attempt) {
  const double area = surface_area(attempt.mesh.mesh());
  const double volume = signed_volume(attempt.mesh.mesh());
  const double price = kFacetPrice * options.tolerance * area;
  std::vector<char> is_inside = attempt.is_inside;
  simplify_cells(
      attempt.partition, attempt.evidence, attempt.is_forced_out,
      {.facet_volume = is_exact && options.is_finest ? std::min(price, kMostPrice) : price,
       .depth = kMostMoved * options.tolerance,
       .is_fixed = sides_of(attempt.partition, planes)},
      is_inside);
  double mended = 0;
  PolygonMesh mesh = extract_surface(attempt.partition, is_inside, false, &mended);
  if (mesh.facets.empty() || mesh.facets.size() >= attempt.mesh.facets.size() ||
      std::abs(signed_volume(mesh.mesh()) - volume) > kMostLost * volume)
    return;
  attempt.is_inside = std::move(is_inside);
  attempt.mesh = std::move(mesh);
  attempt.mended = mended;
}

/// Sheets that the surface lacks become thin bodies on it.
void keep_sheets(CuttingPlan plan, const Planes& planes, const std::vector<int>& layer_planes,
                 const Sight& sight, const ExtractionOptions& options, Attempt& attempt) {
  const SheetScene scene{planes, attempt.mesh, sight.rays, options.tolerance};
  const std::vector<Sheet> sheets = find_sheets(scene, layer_planes);
  if (sheets.empty()) return;
  const std::size_t first = plan.planes.size();
  add_slabs(planes, sheets, plan);
  Partition partition = cut(plan, planes, options);
  if (partition.warnings.size() > attempt.partition.warnings.size()) return;
  std::vector<char> is_inside = fill_slabs(scene, partition, sheets, first, attempt.is_inside);
  double mended = 0;
  PolygonMesh mesh = extract_surface(partition, is_inside, false, &mended);
  const double volume = signed_volume(attempt.mesh.mesh());
  if (!is_closed_manifold(mesh.triangles) ||
      std::abs(signed_volume(mesh.mesh()) - volume) > kMostLost * volume)
    return;
  attempt.partition = std::move(partition);
  attempt.is_inside = std::move(is_inside);
  attempt.mesh = std::move(mesh);
  attempt.mended = mended;
}

}  // namespace

Extraction extract_layer(const Planes& planes, const std::vector<int>& layer_planes, Sight& sight,
                         const ExtractionOptions& options) {
  CuttingPlan plan = plan_cuts(planes, layer_planes, sight.rays, options);
  Attempt attempt = try_plan(plan, planes, sight, options);
  if (attempt.is_inside.empty())
    throw Error(Stage::kProcess, "extraction", "no cell is seen from inside by most rays");
  if (!options.is_paper) prune(plan, planes, sight, options, attempt);
  const bool is_exact = !options.is_paper && planes.is_clean();
  if (options.tolerance > 0 && !is_spent(sight)) simplify(planes, options, is_exact, attempt);
  if (options.is_finest && is_exact)
    keep_sheets(std::move(plan), planes, layer_planes, sight, options, attempt);
  Extraction result;
  result.mesh = std::move(attempt.mesh);
  result.cells = static_cast<std::int64_t>(attempt.partition.cells.size());
  result.warnings = std::move(attempt.warnings);
  result.is_manifold = is_closed_manifold(result.mesh.triangles);
  if (is_spent(sight) && !options.is_paper)
    result.warnings.push_back(
        "its planes make too many cells (" + std::to_string(sight.cells) +
        " in all attempts so far) to look for a leaner surface: small facets "
        "may be left; a larger --distance or --min-points makes fewer planes");
  const double share = attempt.mended / std::max(1e-9, signed_volume(result.mesh.mesh()));
  if (share > kMuchMended)
    result.warnings.push_back(std::to_string(std::lround(100 * share)) +
                              " % of the volume was turned round to make the surface a 2-manifold");
  return result;
}

PolygonMesh extract_surface(const Partition& partition, std::vector<char> is_inside, bool is_paper,
                            double* mended_volume) {
  assert(is_inside.size() == partition.cells.size());
  const double least_share = is_paper ? kNoOther : kSubstantial;
  if (!is_paper) fill_cavities(partition, is_inside);
  const double mended = mend_pinches(partition, is_inside);
  if (mended_volume) *mended_volume = mended;
  if (!keep_largest_components(partition, is_inside, least_share)) return {};
  if (!is_paper) fill_cavities(partition, is_inside);
  PolygonMesh mesh = build_surface(partition, BoundaryFinder(partition).find(is_inside));
  contract_short_edges(mesh, is_paper ? kShortestPaper : kShortest);
  if (!is_paper) contract_narrow_facets(mesh, kNarrowest);
  return mesh;
}

bool is_spent(const Sight& sight) {
  return sight.cells > kMostCells || sight.most_cells > kLargestPartition;
}

Sight::Sight(const Planes& planes) : rays(outline_soup(planes.planes)) {}

std::size_t Sight::Hash::operator()(const Vec3& p) const {
  std::uint64_t h = 0;
  for (int i = 0; i < 3; ++i)
    h = (h ^ std::bit_cast<std::uint64_t>(p[i] + 0.0)) * 0x9E3779B97F4A7C15ull, h ^= h >> 29;
  return h;
}

}  // namespace colod
