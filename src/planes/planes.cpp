// Based on: paper section 3.1 ("primary planes"): region growing, a region's outline as α-shape.
// Differs: --rules paper takes what CGAL's region growing gives at the options' distance, angle and
// count, on points: a mesh is sampled (sampling.h). Robust grows on a mesh's faces, drops floaters,
// measures the noise and grows at three times a wall's residual, filters by area relative to the
// building, merges and aligns planes, and repairs their orientation by rays. Notation: item = face
// of a mesh or point of a cloud; region = items on a plane, not yet a Plane.
#include "planes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "growing.h"
#include "items.h"
#include "noise.h"
#include "orientation.h"
#include "outline.h"
#include "paper.h"
#include "parameters.h"
#include "region.h"
#include "regularize.h"
#include "relief_planes.h"
#include "round.h"
#include "sampling.h"

namespace colod {
namespace {

using namespace parameters::planes;
using namespace regions;

double used_area(const Items& items) {
  double sum = 0;
  for (int i = 0; i < items.size(); ++i)
    if (items.is_used[i]) sum += items.area[i];
  return sum;
}

Box used_box(const Items& items) {
  Box box;
  std::array<Vec3, 3> corner;
  for (int i = 0; i < items.size(); ++i)
    for (int k = items.is_used[i] ? items.corners(i, corner) : 0; k > 0; --k)
      box.extend(corner[k - 1]);
  return box;
}

double growing_distance(double noise, const Box& box, const PlaneOptions& options) {
  const double most =
      std::min({kMostDistance, options.distance, kMostDistanceShare * box.diagonal()});
  return std::min(std::max(kNoiseFactor * noise, kLeastDistance), most);
}

/// What noise excuses is aligned; an exact model keeps its planes, one of few planes each of them.
AlignOptions align_options(double noise, double distance, const Box& box, const RuleSet& rules) {
  const double most = kMoveShare * distance;
  const double excused = std::max(kLeastMove, kMoveShare * kNoiseFactor * noise);
  const double together = std::min(kLeastOffset, kLeastOffsetShare * box.diagonal());
  const double width = kOffsetWidth * distance;
  return {.least_move = std::min(excused, most),
          .most_move = most,
          .offset_width = distance > kPlainDistance ? std::max(width, together) : width,
          .is_strip_turned = rules.has(Rule::kNarrowStrips)};
}

/// The regions of an exact model of few planes, grown so tightly that walls which bend by a
/// centimetre stay two; none: it is not one.
std::vector<Region> plain_regions(const Items& items, Planes::Surface surface, double angle_deg) {
  if (surface != Planes::Surface::kExact) return {};
  std::vector<Region> regions = grow_regions(items, items.normal, {kPlainDistance, angle_deg});
  if (regions.size() > kFewPlanes) regions.clear();
  return regions;
}

/// m²: regions below are no planes. Rougher surfaces need larger ones.
double least_area(Planes::Surface surface, double distance, double total) {
  const double absolute = std::clamp(kAreaOfDistance * distance, kLeastArea, kLeastAreaRough);
  const double share = surface == Planes::Surface::kExact ? kLeastShareExact : kLeastShare;
  return std::min(std::max(absolute, share * total), kMostShare * total);
}

/// Drops small regions, but never the largest one. `least`: m², of a mesh's; `min_points`: of a
/// cloud's as well, and of a mesh's that are told by their count.
void drop_small(const Items& items, double least, int min_points, bool is_by_area,
                std::vector<Region>& regions) {
  const auto is_small = [&](const Region& r) {
    if (is_by_area && r.area < least) return true;
    return !(is_by_area && items.is_mesh()) && static_cast<int>(r.items.size()) < min_points;
  };
  const bool is_none = std::all_of(regions.begin(), regions.end(), is_small);
  if (is_none && !regions.empty())
    regions.resize(1);
  else
    std::erase_if(regions, is_small);
}

void limit_count(std::vector<Region>& regions, std::vector<std::string>& warnings) {
  if (regions.size() <= kMostPlanes) return;
  warnings.push_back("kept the largest " + std::to_string(kMostPlanes) + " of " +
                     std::to_string(regions.size()) + " planes");
  regions.resize(kMostPlanes);
}

void set_used(const std::vector<Region>& regions, bool is_used, Items& items) {
  for (const Region& r : regions)
    for (const int i : r.items) items.is_used[i] = is_used;
}

/// Regions of the items in use, before any is dropped for its size; sets the distance of growing
/// and what the surface is.
std::vector<Region> grow(const Items& items, const Box& box, double noise,
                         const PlaneOptions& options, Planes& result) {
  const RuleSet& rules = options.rules;
  const double found = growing_distance(noise, box, options);
  result.distance = rules.has(Rule::kNoise) ? found : options.distance;
  result.surface = rules.is_none() ? surface_at(options.distance) : judge_surface(noise, found);
  if (rules.has(Rule::kFewPlanes))
    if (std::vector<Region> regions = plain_regions(items, result.surface, options.angle_deg);
        !regions.empty()) {
      result.distance = std::min(kPlainDistance, result.distance);
      return regions;
    }
  if (!rules.has(Rule::kGrowing)) {
    PlaneOptions growing = options;
    growing.distance = result.distance;
    if (rules.has(Rule::kRegionArea)) growing.min_points = items.is_mesh() ? 1 : 3;
    return grow_with_cgal(items, growing);
  }
  const bool is_smooth = !rules.has(Rule::kSmoothNormals) || noise <= kSmoothedNoise;
  return grow_regions(items, smooth_normals(items, is_smooth ? 0 : 2),
                      {result.distance, options.angle_deg});
}

/// The regions of the items in use, which have a part of the building's `total` square metres.
std::vector<Region> flat_regions(const Items& items, const Box& box, double total,
                                 const PlaneOptions& options, Planes& result) {
  const double noise = options.rules.is_none() ? 0 : estimate_noise(items);
  std::vector<Region> regions = grow(items, box, noise, options, result);
  if (options.rules.is_none()) return regions;  // CGAL's are no smaller than it was told
  const bool is_by_area = options.rules.has(Rule::kRegionArea);
  const double least = least_area(result.surface, result.distance, total);
  drop_small(items, least / 4, options.min_points / 2, is_by_area, regions);
  limit_count(regions, result.warnings);
  regularize(items, result.distance, align_options(noise, result.distance, box, options.rules),
             options.rules, regions);
  drop_small(items, least, options.min_points, is_by_area, regions);
  return regions;
}

std::vector<Region> find_regions(Items& items, const PlaneOptions& options, Planes& result) {
  if (options.rules.has(Rule::kFloaters)) drop_floaters(items, result.warnings);
  const double total = used_area(items);
  const Box box = used_box(items);
  std::vector<Region> round;
  if (options.rules.has(Rule::kRoundSides)) round = round_regions(items, options.rules);
  set_used(round, false, items);
  std::vector<Region> regions = flat_regions(items, box, total, options, result);
  set_used(round, true, items);
  std::move(round.begin(), round.end(), std::back_inserter(regions));
  if (options.rules.has(Rule::kAbsorb)) absorb_rest(items, result.distance, regions);
  return regions;
}

/// Towards where most of the region's area looks.
void orient_by_items(const Items& items, std::vector<Region>& regions) {
  for (Region& r : regions) {
    double vote = 0;
    for (const int i : r.items) vote += items.area[i] * r.normal.dot(items.normal[i]);
    if (vote < 0) r.normal = -r.normal, r.offset = -r.offset;
  }
}

std::vector<Plane> to_planes(const Items& items, std::vector<Region>& regions, double distance,
                             const RuleSet& rules) {
  std::vector<Outline> outlines = make_outlines(items, regions, distance, rules);
  std::vector<Plane> planes;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (outlines[r].triangles.empty()) continue;
    Plane p;
    p.normal = regions[r].normal;
    p.offset = regions[r].offset;
    p.area = items.is_mesh() ? regions[r].area : outline_area(outlines[r]);
    const Vec3 c = regions[r].moments.mean();
    p.centroid = c - p.signed_distance(c) * p.normal;
    p.items = std::move(regions[r].items);
    p.outline = std::move(outlines[r]);
    planes.push_back(std::move(p));
  }
  return planes;
}

Error no_plane(const Source& source) { return {Stage::kProcess, source.name, kNoPlane}; }

/// The planes of points that stand for a mesh.
Planes planes_of_samples(const Source& source, const PlaneOptions& options) {
  const FaceSamples samples = sample_faces(source);
  if (samples.face.empty()) throw no_plane(source);
  Planes planes = detect_planes(samples.cloud, options);
  hand_to_faces(source, samples, planes);
  return planes;
}

}  // namespace

Planes::Surface surface_at(double distance) {
  return distance <= kLeastDistance ? Planes::Surface::kClean : Planes::Surface::kNoisy;
}

Planes detect_planes(const Source& source, const PlaneOptions& options) {
  if (source.is_mesh() && !options.rules.has(Rule::kFaces))
    return planes_of_samples(source, options);
  Planes result;
  Items items = collect_items(source);
  const RuleSet& rules = options.rules;
  std::vector<Region> regions = find_regions(items, options, result);
  orient_by_items(items, regions);
  result.planes = to_planes(items, regions, result.distance, rules);
  if (result.planes.empty()) throw no_plane(source);
  const bool is_airborne_told = !items.is_mesh() && rules.has(Rule::kAirborne);
  if (rules.has(Rule::kOrientation))
    if (const int flipped = repair_orientation(result.planes, is_airborne_told); flipped > 0)
      result.warnings.push_back("turned " + std::to_string(flipped) + " planes outward");
  sort_planes(result.planes);
  result.box = used_box(items);
  result.plane_of_item.assign(items.size(), -1);
  for (int i = 0; i < items.size(); ++i)
    if (items.is_floater[i]) result.plane_of_item[i] = kFloater;
  for (std::size_t p = 0; p < result.planes.size(); ++p)
    for (const int i : result.planes[p].items) result.plane_of_item[i] = static_cast<int>(p);
  for (const Plane& p : result.planes) result.total_area += items.is_mesh() ? 0 : p.area;
  if (items.is_mesh()) result.total_area = used_area(items);
  return result;
}

}  // namespace colod
