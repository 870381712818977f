// Based on: Co-LOD, section 3.3 (eq. 11): binary space partition, rays, the largest interior
// component.
// Differs: paper rules take the largest component of the cells that more than half of nr rays see
// from inside. Robust rules add candidate planes, a min-cut and several trials before giving up
// (extraction_candidates.cpp, extraction_labels.cpp). Both mend the boundary to a 2-manifold
// (extraction_repair.cpp) and write it in the same way (extraction_surface.cpp).
// Notation: a cell is a convex piece of space between the layer's planes.
#include "extraction.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "error.h"
#include "extraction_candidates.h"
#include "extraction_labels.h"
#include "extraction_surface.h"

namespace colod {
namespace {

constexpr double kShortest = 1e-3;  // metres: shorter edges are contracted
constexpr std::array<double, 4> kEscapes = {1.0, 0.6, 0.3, 0.1};
constexpr double kEnough = 0.6;       // share of the outlines on the surface that ends the search
constexpr double kWorthwhile = 0.1;   // share that another trial must add
constexpr double kLittle = 0.2;       // share of the outlines below which a warning is due
constexpr double kMuchMended = 0.02;  // share of the volume turned round that asks for a warning

std::vector<char> forced_outside(const Partition& partition, const CuttingPlan& plan) {
  std::vector<char> is_forced(partition.cells.size(), 0);
  for (std::size_t c = 0; c < is_forced.size(); ++c)
    for (const CuttingPlan::Limit& limit : plan.limits)
      if (limit.normal.dot(partition.cells[c].centroid) > limit.offset) is_forced[c] = 1;
  return is_forced;
}

/// The inside; escaping rays count less where that explains clearly more of the outlines; empty
/// when nothing is inside at all.
std::vector<char> label(const Partition& partition, const CuttingPlan& plan, const Planes& planes,
                        const RayScene& rays, const ExtractionOptions& options,
                        std::vector<std::string>& warnings) {
  const std::vector<char> is_forced = forced_outside(partition, plan);
  std::vector<char> is_inside;
  if (options.is_paper) {
    is_inside = threshold_cells(
        gather_evidence(partition, rays, {.is_paper = true, .nr = options.nr}), is_forced);
    return keep_largest_component(partition, is_inside) ? is_inside : std::vector<char>();
  }
  Evidence evidence = gather_evidence(partition, rays, {.nr = options.nr});
  measure_coverage(partition, planes, plan.input, evidence);
  double best = -1;
  for (const double escape : kEscapes) {
    std::vector<char> trial = cut_cells(partition, evidence, is_forced,
                                        {.smoothness = options.smoothness, .escape = escape});
    if (!keep_largest_component(partition, trial)) continue;
    const double share = explained_share(partition, evidence, trial);
    if (share > best + kWorthwhile) best = share, is_inside = std::move(trial);
    if (best > kEnough) break;
  }
  if (best < kLittle) warnings.push_back("little of the layer lies on its surface");
  if (!is_inside.empty()) return is_inside;
  warnings.push_back("no ray sees an inside: the layer is the box around its planes");
  is_inside.resize(partition.cells.size());
  for (std::size_t c = 0; c < is_inside.size(); ++c) is_inside[c] = !is_forced[c];
  return keep_largest_component(partition, is_inside) ? is_inside : std::vector<char>();
}

}  // namespace

Extraction extract_layer(const Planes& planes, const std::vector<int>& layer_planes,
                         const RayScene& rays, const ExtractionOptions& options) {
  Extraction result;
  const CuttingPlan plan = plan_cuts(planes, layer_planes, rays, options);
  const Partition partition =
      partition_space(plan.planes, plan.box, {.max_cells = options.max_cells});
  result.cells = static_cast<std::int64_t>(partition.cells.size());
  result.warnings = partition.warnings;
  std::vector<char> is_inside = label(partition, plan, planes, rays, options, result.warnings);
  if (is_inside.empty())
    throw Error(Stage::kProcess, "extraction", "no cell is seen from inside by most rays");
  double mended = 0;
  result.mesh = extract_surface(partition, is_inside, options.is_paper, &mended);
  result.is_manifold = is_closed_manifold(result.mesh.triangles);
  const double share = mended / std::max(1e-9, signed_volume(result.mesh.mesh()));
  if (share > kMuchMended)
    result.warnings.push_back(std::to_string(std::lround(100 * share)) +
                              " % of the volume was turned round to make the surface a 2-manifold");
  return result;
}

PolygonMesh extract_surface(const Partition& partition, std::vector<char> is_inside,
                            bool keeps_cavities, double* mended_volume) {
  assert(is_inside.size() == partition.cells.size());
  if (!keeps_cavities) fill_cavities(partition, is_inside);
  const double mended = mend_pinches(partition, is_inside);
  if (mended_volume) *mended_volume = mended;
  if (!keep_largest_component(partition, is_inside)) return {};
  if (!keeps_cavities) fill_cavities(partition, is_inside);
  PolygonMesh mesh = build_surface(partition, BoundaryFinder(partition).find(is_inside));
  contract_short_edges(mesh, kShortest);
  return mesh;
}

Mesh outline_soup(const Planes& planes, std::vector<int>* plane_of_triangle) {
  Mesh soup;
  if (plane_of_triangle) plane_of_triangle->clear();
  for (std::size_t p = 0; p < planes.planes.size(); ++p) {
    const Outline& outline = planes.planes[p].outline;
    const int first = static_cast<int>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), outline.vertices.begin(), outline.vertices.end());
    for (const Face& f : outline.triangles) {
      soup.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
      if (plane_of_triangle) plane_of_triangle->push_back(static_cast<int>(p));
    }
  }
  return soup;
}

}  // namespace colod
