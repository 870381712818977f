// The ray oracle over Embree 3.
//
// Based on: Wald, Woop, Benthin, Johnson, Ernst: Embree: a kernel framework for efficient CPU ray
//   tracing, ACM TOG 33(4), 2014 (library); Ericson: Real-Time Collision Detection, 2005, section
//   5.1.5 (regions of the nearest point on a triangle); González: Measurement of areas on a sphere
//   using Fibonacci and latitude-longitude lattices, Mathematical Geosciences 42, 2010.
// Differs: the same under both rules. An origin outside the soup's box is first moved to the box in
//   double precision, so that a far camera costs no digits. Equal distances go to the lower
//   triangle, so that the answer does not depend on how the tree was built.
// Notation: o origin, d unit direction, t distance, all relative to the soup's centre.
#include "rays.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "error.h"
#include "nearest.h"

namespace colod {
namespace {

/// Single precision in the traversal: what two distances may differ by and still be the same place.
constexpr double kRelativeError = 2e-6;
/// A triangle flatter than this (height over longest edge) is a line and is left out.
constexpr double kDegenerate = 1e-12;

RTCDevice shared_device() {
  static const RTCDevice device = rtcNewDevice("verbose=0");  // lives as long as the program
  if (!device) throw Error(Stage::kProcess, "rays", "the ray tracing library does not start");
  return device;
}

bool is_usable(const Vec3& a, const Vec3& b, const Vec3& c) {
  if (!(a.allFinite() && b.allFinite() && c.allFinite())) return false;
  const double longest =
      std::max({(b - a).squaredNorm(), (c - a).squaredNorm(), (c - b).squaredNorm()});
  return (b - a).cross(c - a).norm() > kDegenerate * longest;
}

/// A ray with the origin moved to the soup's box. `shift` is the distance moved.
struct LocalRay {
  Vec3 origin, direction;
  double shift = 0;
  bool is_missing = false;  ///< passes the box, or is not a ray
};

LocalRay enter_box(const Vec3& origin, const Vec3& direction, const Vec3& half_size) {
  LocalRay ray{origin, direction.normalized()};
  ray.is_missing = !ray.direction.allFinite() || !origin.allFinite() || direction.isZero(0);
  if (ray.is_missing) return ray;
  double enter = 0, leave = kInfinity;
  for (int i = 0; i < 3; ++i) {
    const double d = ray.direction[i];
    if (d == 0) {
      if (std::abs(origin[i]) > half_size[i]) ray.is_missing = true;
      continue;
    }
    const double t0 = (-half_size[i] - origin[i]) / d, t1 = (half_size[i] - origin[i]) / d;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  if (enter > leave) ray.is_missing = true;
  ray.shift = enter;
  ray.origin += enter * ray.direction;
  return ray;
}

RTCRay to_embree(const LocalRay& ray, double t_min, double t_max) {
  RTCRay r{};
  r.org_x = static_cast<float>(ray.origin.x());
  r.org_y = static_cast<float>(ray.origin.y());
  r.org_z = static_cast<float>(ray.origin.z());
  r.dir_x = static_cast<float>(ray.direction.x());
  r.dir_y = static_cast<float>(ray.direction.y());
  r.dir_z = static_cast<float>(ray.direction.z());
  r.tnear = static_cast<float>(std::max(0.0, t_min - ray.shift));
  r.tfar = static_cast<float>(t_max - ray.shift);
  r.mask = ~0u;
  return r;
}

/// What the filters below see of one query.
struct QueryContext {
  RTCIntersectContext embree;
  float best = std::numeric_limits<float>::infinity();
  unsigned best_triangle = RTC_INVALID_GEOMETRY_ID;
  std::vector<std::pair<float, unsigned>>* all = nullptr;  ///< every hit, instead of the first
};

/// A search for the nearest triangle as far as it has come.
struct NearestQuery {
  const Vec3* corners;  ///< three a triangle
  Vec3 query;
  double margin;  ///< what single precision may hide
  double best = kInfinity;
  unsigned triangle = 0;
  Vec3 point = Vec3::Zero();

  /// Whether the triangle's box is farther away than the best triangle, for certain.
  bool is_beyond(const Vec3* c) const {
    constexpr double kRounding = 1 + 1e-12;
    const Vec3 low = c[0].cwiseMin(c[1]).cwiseMin(c[2]), high = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
    const Vec3 apart = (low - query).cwiseMax(query - high).cwiseMax(0);
    return apart.squaredNorm() > kRounding * best * best;
  }

  /// Whether the triangle is nearer than the best one, or as near and the lower of both.
  bool improve(unsigned candidate) {
    const Vec3* c = corners + 3 * static_cast<std::size_t>(candidate);
    if (is_beyond(c)) return false;
    const Vec3 nearest = nearest_on_triangle(query, c[0], c[1], c[2]);
    const double distance = (nearest - query).norm();
    if (distance > best || (distance == best && candidate > triangle)) return false;
    best = distance, triangle = candidate, point = nearest;
    return true;
  }
};

/// Accepts the nearest hit, the lower triangle at equal distance; or collects and accepts none.
void filter_hit(const RTCFilterFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  auto* context = reinterpret_cast<QueryContext*>(args->context);
  const float t = RTCRayN_tfar(args->ray, args->N, 0);
  const unsigned triangle = RTCHitN_primID(args->hit, args->N, 0);
  if (context->all) {
    context->all->emplace_back(t, triangle);
    args->valid[0] = 0;
  } else if (t < context->best || (t == context->best && triangle < context->best_triangle)) {
    context->best = t;
    context->best_triangle = triangle;
  } else {
    args->valid[0] = 0;
  }
}

}  // namespace

struct RayScene::Impl {
  Vec3 center = Vec3::Zero();
  Vec3 half_size = Vec3::Zero();  ///< a little more than the soup's
  double scale = 0;               ///< half the soup's diagonal
  std::vector<Vec3> corners;      ///< three a triangle, about the centre
  std::vector<int> original;      ///< index in the caller's list
  RTCScene scene = nullptr;       ///< null: no triangle

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (scene) rtcReleaseScene(scene);
  }

  /// `whole`: the box about which is counted; the triangles' own where it is empty.
  void collect(const std::vector<Vec3>& vertices, const std::vector<Face>& triangles,
               const Box& whole);
  void commit();
  RayHit make_hit(unsigned triangle, double distance, const Vec3& direction) const {
    const Vec3* c = &corners[3 * static_cast<std::size_t>(triangle)];
    const bool is_inside = (c[1] - c[0]).cross(c[2] - c[0]).dot(direction) > 0;
    return {original[triangle], distance, is_inside};
  }
  NearestQuery query_at(const Vec3& place) const {
    const Vec3 local = place - center;
    return {corners.data(), local, kRelativeError * (local.norm() + scale)};
  }
  NearestPoint answer(const NearestQuery& q) const {
    if (q.best == kInfinity) return {};
    return {original[q.triangle], q.best, q.point + center};
  }
};

void RayScene::Impl::collect(const std::vector<Vec3>& vertices, const std::vector<Face>& triangles,
                             const Box& whole) {
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    assert(std::min({a, b, c}) >= 0 && std::max({a, b, c}) < static_cast<int>(vertices.size()));
    if (!is_usable(vertices[a], vertices[b], vertices[c])) continue;
    corners.insert(corners.end(), {vertices[a], vertices[b], vertices[c]});
    original.push_back(static_cast<int>(i));
  }
  if (corners.empty()) return;
  const Box box = whole.is_empty() ? bounding_box(corners) : whole;
  center = box.center();
  scale = 0.5 * box.diagonal();
  half_size = 0.5 * box.size() + Vec3::Constant(kRelativeError * scale);
  for (Vec3& c : corners) c -= center;
}

void RayScene::Impl::commit() {
  if (corners.empty()) return;
  const RTCDevice device = shared_device();
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* xyz = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), corners.size()));
  auto* index = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), corners.size() / 3));
  if (!xyz || !index) throw Error(Stage::kProcess, "rays", "out of memory");
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (int k = 0; k < 3; ++k) xyz[3 * i + k] = static_cast<float>(corners[i][k]);
    index[i] = static_cast<unsigned>(i);
  }
  rtcSetGeometryIntersectFilterFunction(geometry, filter_hit);
  rtcCommitGeometry(geometry);
  scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
    throw Error(Stage::kProcess, "rays", "the ray tracing library refuses the triangles");
}

RayScene::RayScene(const std::vector<Vec3>& vertices, const std::vector<Face>& triangles)
    : impl_(std::make_unique<Impl>()) {
  impl_->collect(vertices, triangles, {});
  impl_->commit();
}

RayScene::RayScene(const Mesh& part, const Box& whole) : impl_(std::make_unique<Impl>()) {
  impl_->collect(part.vertices, part.faces, whole);
  impl_->commit();
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

RayHit RayScene::first_hit(const Vec3& origin, const Vec3& direction, double t_min,
                           double t_max) const {
  if (!impl_->scene) return {};
  const LocalRay ray = enter_box(origin - impl_->center, direction, impl_->half_size);
  if (ray.is_missing || !(t_max > ray.shift)) return {};
  RTCRayHit r{};
  r.ray = to_embree(ray, t_min, t_max);
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  QueryContext context;
  rtcInitIntersectContext(&context.embree);
  rtcIntersect1(impl_->scene, &context.embree, &r);
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return impl_->make_hit(r.hit.primID, r.ray.tfar + ray.shift, ray.direction);
}

bool RayScene::is_occluded(const Vec3& origin, const Vec3& direction, double t_min,
                           double t_max) const {
  if (!impl_->scene) return false;
  const LocalRay ray = enter_box(origin - impl_->center, direction, impl_->half_size);
  if (ray.is_missing || !(t_max > ray.shift)) return false;
  RTCRay r = to_embree(ray, t_min, t_max);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(impl_->scene, &context, &r);
  return r.tfar < 0;  // Embree's sign for "something is there"
}

std::vector<RayHit> RayScene::all_hits(const Vec3& origin, const Vec3& direction, int limit) const {
  if (!impl_->scene || limit <= 0) return {};
  const LocalRay ray = enter_box(origin - impl_->center, direction, impl_->half_size);
  if (ray.is_missing) return {};
  std::vector<std::pair<float, unsigned>> found;
  RTCRayHit r{};
  r.ray = to_embree(ray, 0, kInfinity);
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  QueryContext context;
  rtcInitIntersectContext(&context.embree);
  context.all = &found;
  rtcIntersect1(impl_->scene, &context.embree, &r);
  std::sort(found.begin(), found.end());

  const double same = kRelativeError * impl_->scale;
  std::vector<RayHit> hits;
  for (const auto& [t, triangle] : found) {
    const RayHit hit = impl_->make_hit(triangle, t + ray.shift, ray.direction);
    bool is_known = false;  // the neighbour across a shared edge or corner
    for (auto known = hits.rbegin(); known != hits.rend() && !is_known; ++known) {
      if (hit.distance - known->distance > same) break;
      is_known = known->is_inside == hit.is_inside;
    }
    if (is_known) continue;
    if (static_cast<int>(hits.size()) == limit) break;
    hits.push_back(hit);
  }
  return hits;
}

namespace {

bool visit_triangle(RTCPointQueryFunctionArguments* args) {
  auto* q = static_cast<NearestQuery*>(args->userPtr);
  if (!q->improve(args->primID)) return false;
  const float radius = static_cast<float>(q->best + q->margin);
  if (radius >= args->query->radius) return false;
  args->query->radius = radius;
  return true;
}

/// Looks at all triangles that may be nearer than `within`.
void search(RTCScene scene, double within, NearestQuery& q) {
  RTCPointQuery embree{};
  embree.x = static_cast<float>(q.query.x());
  embree.y = static_cast<float>(q.query.y());
  embree.z = static_cast<float>(q.query.z());
  embree.radius = static_cast<float>(within + q.margin);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene, &embree, &context, visit_triangle, &q);
}

}  // namespace

NearestPoint RayScene::nearest(const Vec3& query, double within) const {
  if (!impl_->scene || !query.allFinite()) return {};
  NearestQuery q = impl_->query_at(query);
  search(impl_->scene, within, q);
  return impl_->answer(q);
}

NearestPoint NearestInTurn::operator()(const Vec3& query, double within) {
  const RayScene::Impl& impl = *scene_.impl_;
  if (!impl.scene || !query.allFinite()) return {};
  NearestQuery q = impl.query_at(query);
  if (last_ >= 0) q.improve(static_cast<unsigned>(last_));
  search(impl.scene, std::min(within, q.best), q);
  if (q.best < kInfinity) last_ = q.triangle;
  if (q.best > within) return {};
  return impl.answer(q);
}

std::vector<Vec3> sphere_directions(int n) {
  std::vector<Vec3> directions;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (2.0 * i + 1) / n, r = std::sqrt(std::max(0.0, 1 - z * z));
    directions.emplace_back(r * std::cos(golden * i), r * std::sin(golden * i), z);
  }
  return directions;
}

std::vector<Vec3> ring_directions(int n, std::span<const double> elevations_deg) {
  std::vector<Vec3> directions;
  const int rings = static_cast<int>(elevations_deg.size());
  for (int r = 0; r < rings; ++r) {
    const int count = n / rings + (r < n % rings ? 1 : 0);
    const double elevation = elevations_deg[r] * std::numbers::pi / 180;
    // Each ring starts at its own fraction of a step: no direction lies along an axis, and no two
    // rings stand above one another.
    const double phase = std::fmod((r + 1) * std::numbers::phi, 1.0);
    for (int k = 0; k < count; ++k) {
      const double angle = 2 * std::numbers::pi * (k + phase) / count;
      directions.emplace_back(std::cos(elevation) * std::cos(angle),
                              std::cos(elevation) * std::sin(angle), std::sin(elevation));
    }
  }
  return directions;
}

}  // namespace colod
