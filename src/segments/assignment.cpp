// Based on: Architectural Co-LOD Generation (ACM TOG 43(6), 2024), section 3.1, last paragraph:
// each
//   plane goes to the segment with most valid hits on it.
// Differs: robust. A dormer or a chimney is open towards the attic, whose thousands of voxels
//   outvote its own few; and horizontal planes get no hits at all from horizontal rays. So a plane
//   goes to whatever lies right behind it. The guard of alcoves has no counterpart in the paper.
// Notation: n outward unit normal of a plane.
#include "assignment.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "core/spread.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::segments;

constexpr int kMostSamples = 4096;  // a plane

struct Sample {
  Vec3 point;
  double area;
};

/// Points spread evenly over the outline (the R2 sequence in each triangle), about one a voxel.
std::vector<Sample> sample_outline(const Outline& outline, double spacing) {
  double total = 0;
  const Mesh soup{outline.vertices, outline.triangles};
  for (const Face& f : soup.faces) total += face_area(soup, f);
  const double share = std::max(spacing * spacing, total / kMostSamples);
  std::vector<Sample> samples;
  for (const Face& f : soup.faces) {
    const double area = face_area(soup, f);
    if (!(area > 0)) continue;
    const int n = std::max(1, static_cast<int>(std::ceil(area / share)));
    const Vec3 &a = soup.vertices[f[0]], &b = soup.vertices[f[1]], &c = soup.vertices[f[2]];
    for (int i = 0; i < n; ++i)  // from the centroid on
      samples.push_back({spread_on_triangle(a, b, c, i, 1.0 / 3), area / n});
  }
  return samples;
}

/// Metres along `direction` that are one voxel.
double voxel_step(const HitGrid& grid, const Vec3& direction) {
  const Vec3 size = grid.voxel_size();
  double squared = 0;
  for (int k = 0; k < 3; ++k)
    if (size[k] > 0) squared += (direction[k] / size[k]) * (direction[k] / size[k]);
  return squared > 0 ? 1 / std::sqrt(squared) : 0;
}

PlaneSide look_beside(const Plane& plane, const HitGrid& grid,
                      const std::vector<int>& group_of_voxel, Side side) {
  const Vec3 direction = side == Side::kBehind ? Vec3(-plane.normal) : plane.normal;
  const double step = voxel_step(grid, direction);
  std::vector<std::pair<int, double>> area_of;  // group, area; few
  double total = 0;
  for (const Sample& s : sample_outline(plane.outline, step)) {
    total += s.area;
    for (double k : kSteps) {
      const std::int64_t v = voxel_around(grid, s.point + k * step * direction);
      if (v < 0 || group_of_voxel[v] < 0) continue;
      const int g = group_of_voxel[v];
      const auto at = std::find_if(area_of.begin(), area_of.end(),
                                   [g](const auto& entry) { return entry.first == g; });
      if (at == area_of.end())
        area_of.emplace_back(g, s.area);
      else
        at->second += s.area;
      break;
    }
  }
  PlaneSide best;
  double most = 0;
  for (const auto& [g, area] : area_of)
    if (area > most || (area == most && g < best.group)) best.group = g, most = area;
  if (total > 0) best.share = most / total;
  return best;
}

}  // namespace

std::vector<int> assign_to_most_hits(std::size_t planes, const VoxelGroups& groups) {
  std::vector<int> group(planes, -1);
  std::vector<std::uint64_t> most(planes, 0);
  for (std::size_t g = 0; g < groups.groups.size(); ++g)
    for (const PlaneHits& h : groups.groups[g].hits)
      if (h.hits > most[h.plane]) most[h.plane] = h.hits, group[h.plane] = static_cast<int>(g);
  return group;
}

std::vector<PlaneSide> look_beside_planes(const Planes& planes, const HitGrid& grid,
                                          const std::vector<int>& group_of_voxel, Side side) {
  std::vector<PlaneSide> sides(planes.planes.size());
  parallel_for(sides.size(), [&](std::size_t p) {
    sides[p] = look_beside(planes.planes[p], grid, group_of_voxel, side);
  });
  return sides;
}

std::vector<int> guard_alcoves(const Planes& planes, std::vector<int> alcove_of_plane,
                               int alcoves) {
  std::vector<std::vector<int>> members(alcoves);
  for (std::size_t p = 0; p < alcove_of_plane.size(); ++p)
    if (alcove_of_plane[p] >= 0) members[alcove_of_plane[p]].push_back(static_cast<int>(p));
  for (const std::vector<int>& own : members) {
    bool has_facing = false, has_crossing = false;
    for (int p : own)
      for (int q : own) {
        const double cosine = planes.planes[p].normal.dot(planes.planes[q].normal);
        has_facing |= cosine < kFacing;
        has_crossing |= std::abs(cosine) < kParallel;
      }
    if (own.size() < kLeastPlanes || !has_facing || !has_crossing)
      for (int p : own) alcove_of_plane[p] = -1;
  }
  return alcove_of_plane;
}

}  // namespace colod
