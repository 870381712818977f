// Which planes each voxel sees: what is cast, whichever engine casts it
// (embree.cpp, sweep.cpp).
//
// Based on: Architectural Co-LOD Generation, ACM TOG 43(6), 2024, section 3.1, steps 1–4.
// Differs: from the paper: the box is grown by irrational fractions of its size, so that no
//   centroid lies at the height of a horizontal plane or in the line of a wall of the local frame's
//   grid; hits of voxels that are neither valid nor half surrounded by outer sides are dropped,
//   which is what makes the early stop exact; coplanar outlines that overlap are moved apart by a
//   hair, so that it is not rounding that decides which of them a ray meets. Robust
//   (`is_party_wall_rule`): a voxel whose rays leave through a missing party wall is valid all the
//   same.
// Notation: d_k direction at 2πk/n_r.
#include "visibility.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <cmath>
#include <numbers>
#include <tuple>

#include "core/error.h"
#include "parameters.h"
#include "parts.h"

namespace colod {
namespace {

using namespace parameters::visibility;

/// Of the box's size, before its lower and behind its upper corner.
constexpr double kGrowLow = 1e-4 * std::numbers::sqrt2, kGrowHigh = 1e-4 * std::numbers::phi;
/// A plane whose normal is this near to the vertical meets no horizontal ray.
constexpr double kHorizontal = 1e-6;
/// Coplanar outlines are told apart by this much, of the box's radius: more than single precision
/// rounds, a tenth of a millimetre for a house.
constexpr double kStep = 0x1p-17, kSameNormal = 0x1p-21;

bool is_on(const std::vector<char>& flags, std::size_t i, bool otherwise) {
  return flags.empty() ? otherwise : flags[i] != 0;
}

Box outlines_box(const Planes& planes, const std::vector<char>& is_active) {
  Box box;
  for (std::size_t p = 0; p < planes.planes.size(); ++p)
    if (is_on(is_active, p, true))
      for (const Vec3& v : planes.planes[p].outline.vertices)
        if (v.allFinite()) box.extend(v);
  return box;
}

Box grow(Box box) {
  if (box.is_empty()) return box;
  // A flat box gets some depth, so that its voxels have a volume.
  const Vec3 size = box.size().cwiseMax(1e-3 * box.diagonal()).cwiseMax(1e-6);
  box.min -= kGrowLow * size;
  box.max += kGrowHigh * size;
  return box;
}

/// The outline's vertices with those on its border moved outward by `width`, so that every edge
/// that only one triangle has moves by that. Where a spike or a hole is too narrow for it,
/// triangles turn over: they stay in the plane, and sides are told by the plane, so no harm is
/// done.
std::vector<Vec3> widened(const Plane& plane, double width) {
  std::vector<std::array<int, 2>> edges;
  for (const Face& f : plane.outline.triangles)
    for (int k = 0; k < 3; ++k) edges.push_back({f[k], f[(k + 1) % 3]});
  std::sort(edges.begin(), edges.end());
  std::vector<Vec3> vertices = plane.outline.vertices;
  std::vector<Vec3> outward(vertices.size(), Vec3::Zero());  // sum over the vertex's border edges
  for (const auto& [a, b] : edges) {
    if (std::binary_search(edges.begin(), edges.end(), std::array{b, a})) continue;
    const Vec3 out = (vertices[b] - vertices[a]).cross(plane.normal).normalized();
    outward[a] += out, outward[b] += out;
  }
  for (std::size_t i = 0; i < vertices.size(); ++i)
    vertices[i] += 2 * width / std::max(outward[i].squaredNorm(), kSharpest) * outward[i];
  return vertices;
}

/// Planes in one place, seen from the grid's centre: `normal` and `offset` up to their sign.
struct Place {
  double offset;
  Vec3 normal;
  Vec2 min, max;  ///< of the widened outline: along the plane's level line, and height
  std::size_t plane;
};

bool is_overlapping(const Place& a, const Place& b, double margin) {
  return ((a.min.array() + margin) < b.max.array()).all() &&
         ((b.min.array() + margin) < a.max.array()).all();
}

/// How far outward, in steps, each plane has to move so that no two of one place overlap: a ray
/// through both would meet either, by the rounding of whoever casts it. Seen from inside, the
/// plane of the lower index comes first. Outlines that only touch stay: no gap opens.
std::vector<int> layers_of_place(std::vector<Place> places, std::size_t count, double near) {
  std::vector<int> layer(count, 0);
  const auto is_before = [](const Place& a, const Place& b) { return a.offset < b.offset; };
  std::vector<std::size_t> by_plane(count, places.size());
  std::stable_sort(places.begin(), places.end(), is_before);
  for (std::size_t i = 0; i < places.size(); ++i) by_plane[places[i].plane] = i;
  for (std::size_t p = 0; p < count; ++p) {
    if (by_plane[p] == places.size()) continue;
    const Place& own = places[by_plane[p]];
    const auto first = std::lower_bound(places.begin(), places.end(),
                                        Place{own.offset - near, {}, {}, {}, 0}, is_before);
    for (auto other = first; other != places.end() && other->offset <= own.offset + near; ++other)
      if (other->plane < p && (other->normal - own.normal).cwiseAbs().maxCoeff() < kSameNormal &&
          is_overlapping(*other, own, 16 * near))
        layer[p] = std::max(layer[p], layer[other->plane] + 1);
  }
  return layer;
}

/// The outlines of the planes that are cast at; empty for the others.
std::vector<std::vector<Vec3>> cast_outlines(const Planes& planes,
                                             const std::vector<char>& is_active, double border,
                                             const Vec3& center, double radius) {
  std::vector<std::vector<Vec3>> outlines(planes.planes.size());
  std::vector<Place> places;
  for (std::size_t p = 0; p < planes.planes.size(); ++p) {
    const Plane& plane = planes.planes[p];
    const bool is_level = std::hypot(plane.normal.x(), plane.normal.y()) < kHorizontal;
    if (!is_on(is_active, p, true) || is_level) continue;
    outlines[p] = border > 0 ? widened(plane, border) : plane.outline.vertices;
    for (Vec3& v : outlines[p]) v -= center;
    const double offset = plane.offset - plane.normal.dot(center);
    if (!std::isfinite(offset)) continue;
    const double sign =
        std::tie(plane.normal.x(), plane.normal.y()) < std::tuple(0.0, 0.0) ? -1 : 1;
    Place place{sign * offset, sign * plane.normal, Vec2::Constant(1e300), -Vec2::Constant(1e300),
                p};
    const Vec2 along = Vec2(-place.normal.y(), place.normal.x()).normalized();
    for (const Vec3& v : outlines[p]) {
      const Vec2 at(along.dot(v.head<2>()), v.z());
      place.min = place.min.cwiseMin(at), place.max = place.max.cwiseMax(at);
    }
    places.push_back(place);
  }
  const double step = kStep * radius;
  const std::vector<int> layer = layers_of_place(std::move(places), outlines.size(), step / 4);
  for (std::size_t p = 0; p < outlines.size(); ++p)
    if (layer[p] > 0)
      for (Vec3& v : outlines[p]) v += layer[p] * step * planes.planes[p].normal;
  return outlines;
}

}  // namespace

namespace casting {

void Soup::add(const Vec3& a, const Vec3& b, const Vec3& c, std::size_t plane) {
  std::array<std::array<float, 3>, 3> rounded;
  int i = 0;
  for (const Vec3* v : {&a, &b, &c}) {
    if (!v->cast<float>().allFinite()) return;
    Eigen::Map<Eigen::Vector3f>(rounded[i++].data()) = v->cast<float>();
  }
  corners.insert(corners.end(), rounded.begin(), rounded.end());
  plane_of_triangle.push_back(static_cast<int>(plane));
}

Direction direction(int k, int nr) {
  const double angle = 2 * std::numbers::pi * k / nr;
  const auto snapped = [](double c) { return std::abs(c) < 1e-12 ? 0.0 : c; };
  return {snapped(std::cos(angle)), snapped(std::sin(angle))};
}

void join_pieces(std::vector<Piece>& pieces, HitGrid& grid) {
  for (std::size_t v = 0; v + 1 < grid.first.size(); ++v) grid.first[v + 1] += grid.first[v];
  grid.hits.reserve(grid.first.back());
  for (Piece& piece : pieces) {
    grid.hits.insert(grid.hits.end(), piece.hits.begin(), piece.hits.end());
    grid.rays += piece.rays;
    piece.hits = {};  // freed as we go: never all of the hits twice
  }
}

Job make_job(const Planes& planes, const VisibilityOptions& options,
             const std::vector<char>& is_active, const std::vector<char>& is_reversed,
             const Box& box) {
  Job job;
  job.center = box.center();
  job.rule = {options.nr, options.is_party_wall_rule};
  job.is_stopping = options.early_stop;
  const double border = std::max(0.0, options.border_ratio * planes.distance);
  const std::vector<std::vector<Vec3>> outlines =
      cast_outlines(planes, is_active, border, job.center, 0.5 * box.diagonal());
  for (std::size_t p = 0; p < planes.planes.size(); ++p) {
    const Plane& plane = planes.planes[p];
    const double sign = is_on(is_reversed, p, false) ? -1 : 1;
    job.normal.push_back({sign * plane.normal.x(), sign * plane.normal.y()});
    if (outlines[p].empty()) continue;
    for (const Face& f : plane.outline.triangles)
      job.soup.add(outlines[p][f[0]], outlines[p][f[1]], outlines[p][f[2]], p);
  }
  return job;
}

}  // namespace casting

HitGrid cast_visibility(const Planes& planes, const VisibilityOptions& options,
                        const std::vector<char>& is_active, const std::vector<char>& is_reversed) {
  assert(is_active.empty() || is_active.size() == planes.planes.size());
  assert(is_reversed.empty() || is_reversed.size() == planes.planes.size());
  if (options.ns < 1 || options.ns > 2048)
    throw Error(Stage::kUsage, "ns", "must be between 1 and 2048");
  if (options.nr < 1 || options.nr > 65535)
    throw Error(Stage::kUsage, "nr", "must be between 1 and 65535");
  HitGrid grid;
  grid.ns = options.ns;
  grid.nr = options.nr;
  grid.box = grow(outlines_box(planes, is_active));
  const auto n = static_cast<std::size_t>(options.ns);
  grid.first.assign(n * n * n + 1, 0);
  grid.is_valid.assign(n * n * n, 0);
  if (grid.box.is_empty()) return grid;

  const auto start = std::chrono::steady_clock::now();
  const casting::Job job = casting::make_job(planes, options, is_active, is_reversed, grid.box);
  if (options.engine == Visibility::kSweep)
    casting::cast_sweep(job, grid);
  else
    casting::cast_embree(job, options.engine == Visibility::kEmbreeSingle, grid);
  grid.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return grid;
}

}  // namespace colod
