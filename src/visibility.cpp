// Room 3: which planes each voxel sees, by packets of horizontal rays.
//
// Based on: Architectural Co-LOD Generation, ACM TOG 43(6), 2024, section 3.1, steps 1–4; Wald,
// Woop,
//   Benthin, Johnson, Ernst: Embree, ACM TOG 33(4), 2014 (library); van der Corput:
//   Verteilungsfunktionen, 1935 (order of the directions).
// Differs: from the paper: the box is grown by irrational fractions of its size, so that no
// centroid
//   lies at the height of a horizontal plane or in the line of a wall of the local frame's grid;
//   hits of voxels that are neither valid nor half surrounded by outer sides are dropped, which is
//   what makes the early stop exact. Robust (`is_party_wall_rule`): a voxel whose rays leave
//   through a missing party wall is valid all the same.
// Notation: d_k direction at 2πk/n_r; in, out: a voxel's rays that met an inner or outer side; a
// tile
//   is a block of neighbouring voxels of one slice, a lane each; a band is a row of tiles.
#include "visibility.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <cmath>
#include <numbers>
#if defined(__SSE__)
#include <immintrin.h>
#endif

#include "error.h"
#include "parallel.h"

namespace colod {
namespace {

/// Of the box's size, before its lower and behind its upper corner.
constexpr double kGrowLow = 1e-4 * std::numbers::sqrt2, kGrowHigh = 1e-4 * std::numbers::phi;
/// A plane whose normal is this near to the vertical meets no horizontal ray.
constexpr double kHorizontal = 1e-6;
constexpr double kPartyInside = 0.35, kPartyOutside = 0.02;
constexpr int kTileX = 4;
/// Heights are stretched in the tree: horizontal rays do not notice, but the areas by which Embree
/// builds it become what such rays see of a box. A power of two costs no digits.
constexpr double kStretch = 64;

RTCDevice shared_device() {
  static const RTCDevice device = rtcNewDevice("verbose=0");  // lives as long as the program
  if (!device) throw Error(Stage::kProcess, "visibility", "the ray tracing library does not start");
  return device;
}

/// Denormals as zero on this thread for as long as it lives: they cost a hundredfold in packets.
class FlushDenormals {
 public:
#if defined(__SSE__)
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
#endif
};

/// What a voxel's counts make of it.
struct Rule {
  int nr;
  bool is_party;

  bool is_valid(int in, int out) const {
    return 2 * in >= nr || (is_party && in >= kPartyInside * nr && out <= kPartyOutside * nr);
  }
  bool is_kept(int in, int out) const { return is_valid(in, out) || 2 * out >= nr; }
  /// No outcome of the `left` rays still to cast makes the voxel kept. Counts only grow, so the
  /// best case of each condition is all of them inside, or all outside.
  bool is_hopeless(int in, int out, int left) const {
    return !is_valid(in + left, out) && 2 * (out + left) < nr;
  }
};

/// The outlines' triangles, and what a hit on one means.
struct Scene {
  RTCScene embree = nullptr;
  Vec3 center = Vec3::Zero();
  std::vector<int> plane_of_triangle;
  std::vector<std::array<double, 2>> normal;  ///< of each plane, its horizontal part, turned

  Scene() = default;
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  ~Scene() {
    if (embree) rtcReleaseScene(embree);
  }
};

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

/// The triangles that horizontal rays can meet, three corners each, about the scene's centre.
struct Soup {
  std::vector<Vec3> corners;
  std::vector<int> plane_of_triangle;

  void add(const Vec3& a, const Vec3& b, const Vec3& c, std::size_t plane) {
    if (!(a.allFinite() && b.allFinite() && c.allFinite())) return;
    corners.insert(corners.end(), {a, b, c});
    plane_of_triangle.push_back(static_cast<int>(plane));
  }
};

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
  constexpr double kSharpest = 0.5;  // corners sharper than some 40° move by less
  for (std::size_t i = 0; i < vertices.size(); ++i)
    vertices[i] += 2 * width / std::max(outward[i].squaredNorm(), kSharpest) * outward[i];
  return vertices;
}

Soup collect_triangles(const Planes& planes, const std::vector<char>& is_active, const Vec3& center,
                       double border) {
  Soup soup;
  for (std::size_t p = 0; p < planes.planes.size(); ++p) {
    const Plane& plane = planes.planes[p];
    const bool is_level = std::hypot(plane.normal.x(), plane.normal.y()) < kHorizontal;
    if (!is_on(is_active, p, true) || is_level) continue;
    const std::vector<Vec3> v = border > 0 ? widened(plane, border) : plane.outline.vertices;
    for (const Face& f : plane.outline.triangles)
      soup.add(v[f[0]] - center, v[f[1]] - center, v[f[2]] - center, p);
  }
  return soup;
}

void attach(RTCScene scene, const std::vector<Vec3>& corners) {
  const RTCGeometry geometry = rtcNewGeometry(shared_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* xyz = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), corners.size()));
  auto* index = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), corners.size() / 3));
  if (!xyz || !index) throw Error(Stage::kProcess, "visibility", "out of memory");
  for (std::size_t i = 0; i < corners.size(); ++i) {
    xyz[3 * i] = static_cast<float>(corners[i].x());
    xyz[3 * i + 1] = static_cast<float>(corners[i].y());
    xyz[3 * i + 2] = static_cast<float>(kStretch * corners[i].z());
    index[i] = static_cast<unsigned>(i);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

void build_scene(const Planes& planes, const std::vector<char>& is_active,
                 const std::vector<char>& is_reversed, double border, Scene& scene) {
  for (std::size_t p = 0; p < planes.planes.size(); ++p) {
    const double sign = is_on(is_reversed, p, false) ? -1 : 1;
    const Vec3& n = planes.planes[p].normal;
    scene.normal.push_back({sign * n.x(), sign * n.y()});
  }
  Soup soup = collect_triangles(planes, is_active, scene.center, border);
  scene.plane_of_triangle = std::move(soup.plane_of_triangle);
  scene.embree = rtcNewScene(shared_device());
  // Robust: a ray through the common edge of two triangles meets one of them. Embree sorts the
  // triangles of its leaves, so the tree is the same however many threads build it.
  rtcSetSceneFlags(scene.embree, RTC_SCENE_FLAG_ROBUST);
  if (!soup.corners.empty()) attach(scene.embree, soup.corners);
  rtcCommitScene(scene.embree);
  if (rtcGetDeviceError(shared_device()) != RTC_ERROR_NONE)
    throw Error(Stage::kProcess, "visibility", "the ray tracing library refuses the outlines");
}

struct Direction {
  double x, y;
  int k;
};

/// d_k in bit-reversed order of k: any first rays look evenly round, so that hopeless voxels show
/// themselves early.
std::vector<Direction> make_directions(int nr) {
  std::vector<Direction> directions;
  int bits = 0;
  while ((1 << bits) < nr) ++bits;
  for (int i = 0; i < 1 << bits; ++i) {
    int k = 0;
    for (int b = 0; b < bits; ++b) k |= (i >> b & 1) << (bits - 1 - b);
    if (k >= nr) continue;
    const double angle = 2 * std::numbers::pi * k / nr;
    const auto snapped = [](double c) { return std::abs(c) < 1e-12 ? 0.0 : c; };
    directions.push_back({snapped(std::cos(angle)), snapped(std::sin(angle)), k});
  }
  return directions;
}

struct Packet16 {
  static constexpr int kWidth = 16;
  using RayHit = RTCRayHit16;
  static void intersect(const int* valid, RTCScene scene, RTCIntersectContext* context,
                        RayHit* rays) {
    rtcIntersect16(valid, scene, context, rays);
  }
};

struct Packet8 {
  static constexpr int kWidth = 8;
  using RayHit = RTCRayHit8;
  static void intersect(const int* valid, RTCScene scene, RTCIntersectContext* context,
                        RayHit* rays) {
    rtcIntersect8(valid, scene, context, rays);
  }
};

/// The hits of a band's kept voxels, in the order of the voxels.
struct Band {
  std::vector<Hit> hits;
  std::uint64_t rays = 0;
};

template <typename Packet>
class Caster {
 public:
  static constexpr int kWidth = Packet::kWidth, kTileY = kWidth / kTileX;

  Caster(const Scene& scene, const VisibilityOptions& options, HitGrid& grid)
      : scene_(scene),
        rule_{options.nr, options.is_party_wall_rule},
        is_stopping_(options.early_stop),
        directions_(make_directions(options.nr)),
        grid_(grid) {}

  static int bands_per_slice(int ns) { return (ns + kTileY - 1) / kTileY; }

  /// Casts band b; writes is_valid and the number of hits (at first[v + 1]) of its voxels.
  Band cast(std::size_t b) const {
    const FlushDenormals flush;
    Work work;
    work.seen.resize(static_cast<std::size_t>(rule_.nr) * kWidth);
    const int ns = grid_.ns, bands = bands_per_slice(ns);
    const int z = static_cast<int>(b) / bands, y0 = static_cast<int>(b) % bands * kTileY;
    const std::size_t first_voxel = voxel(0, y0, z);
    const int rows = std::min(kTileY, ns - y0);
    work.begin.assign(static_cast<std::size_t>(rows) * ns, 0);
    Band band;
    for (int x0 = 0; x0 < ns; x0 += kTileX) {
      place(work, x0, y0, z);
      band.rays += cast_tile(work);
      store(work, first_voxel);
    }
    // From the order of the tiles to the order of the voxels.
    band.hits.reserve(work.hits.size());
    for (std::size_t i = 0; i < work.begin.size(); ++i) {
      const auto from = work.hits.begin() + static_cast<std::ptrdiff_t>(work.begin[i]);
      band.hits.insert(band.hits.end(), from,
                       from + static_cast<std::ptrdiff_t>(grid_.first[first_voxel + i + 1]));
    }
    return band;
  }

 private:
  struct Work {
    alignas(64) typename Packet::RayHit rays{};
    alignas(64) int active[kWidth];  ///< Embree's mask: −1 cast, 0 done or outside the box
    std::array<std::int64_t, kWidth> voxel;  ///< −1: outside the box
    std::array<int, kWidth> in, out;
    std::vector<int> seen;           ///< by k, then lane: 2 × plane + (inner side), −1 nothing
    std::vector<Hit> hits;           ///< of the band's kept voxels, in the order of the tiles
    std::vector<std::size_t> begin;  ///< where those of each of the band's voxels start
  };

  std::size_t voxel(int x, int y, int z) const {
    const auto n = static_cast<std::size_t>(grid_.ns);
    return static_cast<std::size_t>(x) + n * (static_cast<std::size_t>(y) + n * z);
  }

  void place(Work& work, int x0, int y0, int z) const {
    for (int lane = 0; lane < kWidth; ++lane) {
      const int x = x0 + lane % kTileX, y = y0 + lane / kTileX;
      const bool is_in = x < grid_.ns && y < grid_.ns;
      work.voxel[lane] = is_in ? static_cast<std::int64_t>(voxel(x, y, z)) : -1;
      work.active[lane] = is_in ? -1 : 0;
      work.in[lane] = work.out[lane] = 0;
      if (!is_in) continue;
      const Vec3 c = grid_.center(voxel(x, y, z)) - scene_.center;
      work.rays.ray.org_x[lane] = static_cast<float>(c.x());
      work.rays.ray.org_y[lane] = static_cast<float>(c.y());
      work.rays.ray.org_z[lane] = static_cast<float>(kStretch * c.z());
    }
  }

  /// All directions of a tile, or as many as matter. Returns the number of rays.
  std::uint64_t cast_tile(Work& work) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    std::uint64_t rays = 0;
    int left = rule_.nr;
    for (const Direction& d : directions_) {
      for (int lane = 0; lane < kWidth; ++lane) {
        work.rays.ray.dir_x[lane] = static_cast<float>(d.x);
        work.rays.ray.dir_y[lane] = static_cast<float>(d.y);
        work.rays.ray.dir_z[lane] = 0;
        work.rays.ray.tnear[lane] = 0;
        work.rays.ray.tfar[lane] = std::numeric_limits<float>::infinity();
        work.rays.ray.mask[lane] = ~0u;
        work.rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      }
      Packet::intersect(work.active, scene_.embree, &context, &work.rays);
      --left;
      const int cast = count(work, d, left);
      rays += static_cast<std::uint64_t>(cast);
      if (cast == 0) break;
    }
    return rays;
  }

  /// Takes in what direction d met, retires lanes without hope. Returns the lanes cast.
  int count(Work& work, const Direction& d, int left) const {
    int cast = 0;
    for (int lane = 0; lane < kWidth; ++lane) {
      if (!work.active[lane]) continue;
      ++cast;
      int& seen = work.seen[static_cast<std::size_t>(d.k) * kWidth + lane];
      seen = -1;
      if (work.rays.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID) {
        const int plane = scene_.plane_of_triangle[work.rays.hit.primID[lane]];
        const bool is_inside = d.x * scene_.normal[plane][0] + d.y * scene_.normal[plane][1] > 0;
        seen = 2 * plane + is_inside;
        ++(is_inside ? work.in : work.out)[lane];
      }
      if (is_stopping_ && rule_.is_hopeless(work.in[lane], work.out[lane], left))
        work.active[lane] = 0;
    }
    return cast;
  }

  /// Writes what the tile's voxels are, and the hits of the kept ones.
  void store(Work& work, std::size_t first_voxel) const {
    for (int lane = 0; lane < kWidth; ++lane) {
      if (work.voxel[lane] < 0) continue;
      const auto v = static_cast<std::size_t>(work.voxel[lane]);
      const int in = work.in[lane], out = work.out[lane];
      // A retired lane has counts that can no longer be kept, so this asks the same of both.
      const bool is_kept = work.active[lane] && rule_.is_kept(in, out);
      grid_.is_valid[v] = is_kept && rule_.is_valid(in, out);
      work.begin[v - first_voxel] = work.hits.size();
      if (is_kept) append_hits(work, lane);
      grid_.first[v + 1] = work.hits.size() - work.begin[v - first_voxel];
    }
  }

  /// One lane's hits by rising plane. Neighbouring directions mostly see the same plane, and a
  /// voxel few planes in all, so a linear search over them is short.
  void append_hits(Work& work, int lane) const {
    const std::size_t begin = work.hits.size();
    std::size_t at = begin;
    for (int k = 0; k < rule_.nr; ++k) {
      const int seen = work.seen[static_cast<std::size_t>(k) * kWidth + lane];
      if (seen < 0) continue;
      const auto plane = static_cast<std::uint32_t>(seen / 2);
      if (at == work.hits.size() || work.hits[at].plane != plane) {
        at = begin;
        while (at < work.hits.size() && work.hits[at].plane != plane) ++at;
        if (at == work.hits.size()) work.hits.push_back({plane, 0, 0});
      }
      ++(seen & 1 ? work.hits[at].inside : work.hits[at].outside);
    }
    std::sort(work.hits.begin() + static_cast<std::ptrdiff_t>(begin), work.hits.end(),
              [](const Hit& a, const Hit& b) { return a.plane < b.plane; });
  }

  const Scene& scene_;
  Rule rule_;
  bool is_stopping_;
  std::vector<Direction> directions_;
  HitGrid& grid_;
};

template <typename Packet>
void cast_all(const Scene& scene, const VisibilityOptions& options, HitGrid& grid) {
  const Caster<Packet> caster(scene, options, grid);
  const std::size_t count =
      static_cast<std::size_t>(grid.ns) * Caster<Packet>::bands_per_slice(grid.ns);
  std::vector<Band> bands(count);
  parallel_for(count, [&](std::size_t b) { bands[b] = caster.cast(b); });

  for (std::size_t v = 0; v + 1 < grid.first.size(); ++v) grid.first[v + 1] += grid.first[v];
  grid.hits.reserve(grid.first.back());
  for (Band& band : bands) {
    grid.hits.insert(grid.hits.end(), band.hits.begin(), band.hits.end());
    grid.rays += band.rays;
    band.hits = {};  // freed as we go: never all of the hits twice
  }
}

}  // namespace

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
  Scene scene;
  scene.center = grid.box.center();
  const double border =
      options.is_party_wall_rule ? std::max(0.0, options.border_ratio * planes.distance) : 0;
  build_scene(planes, is_active, is_reversed, border, scene);
  const bool is_wide =
      rtcGetDeviceProperty(shared_device(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
  if (is_wide)
    cast_all<Packet16>(scene, options, grid);
  else
    cast_all<Packet8>(scene, options, grid);
  grid.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return grid;
}

}  // namespace colod
