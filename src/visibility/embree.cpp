// The rays of `--visibility embree`, in packets of neighbouring voxels with one direction.
//
// Based on: Wald, Woop, Benthin, Johnson, Ernst: Embree, ACM TOG 33(4), 2014 (library); van der
//   Corput: Verteilungsfunktionen, 1935 (order of the directions).
// Differs: from the paper: heights are stretched for the tree, and a voxel without hope is given up
//   (visibility.cpp).
// Notation: in, out: a voxel's rays that met an inner or outer side; a tile is a block of
//   neighbouring voxels of one slice, a lane each; a band is a row of tiles.
#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <limits>
#if defined(__SSE__)
#include <immintrin.h>
#endif

#include "core/error.h"
#include "core/parallel.h"
#include "parts.h"

namespace colod::casting {
namespace {

/// Heights are stretched in the tree: horizontal rays do not notice, but the areas by which Embree
/// builds it become what such rays see of a box. A power of two costs no digits.
constexpr float kStretch = 64;

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

void attach(RTCScene scene, const std::vector<std::array<float, 3>>& corners) {
  const RTCGeometry geometry = rtcNewGeometry(shared_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* xyz = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), corners.size()));
  auto* index = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), corners.size() / 3));
  if (!xyz || !index) throw Error(Stage::kProcess, "visibility", "out of memory");
  for (std::size_t i = 0; i < corners.size(); ++i) {
    xyz[3 * i] = corners[i][0];
    xyz[3 * i + 1] = corners[i][1];
    xyz[3 * i + 2] = kStretch * corners[i][2];
    index[i] = static_cast<unsigned>(i);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

/// The outlines' triangles as Embree holds them.
class Scene {
 public:
  explicit Scene(const std::vector<std::array<float, 3>>& corners)
      : embree_(rtcNewScene(shared_device())) {
    // Robust: a ray through the common edge of two triangles meets one of them. Embree sorts the
    // triangles of its leaves, so the tree is the same however many threads build it.
    rtcSetSceneFlags(embree_, RTC_SCENE_FLAG_ROBUST);
    if (!corners.empty()) attach(embree_, corners);
    rtcCommitScene(embree_);
    if (rtcGetDeviceError(shared_device()) != RTC_ERROR_NONE)
      throw Error(Stage::kProcess, "visibility", "the ray tracing library refuses the outlines");
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  ~Scene() { rtcReleaseScene(embree_); }

  RTCScene get() const { return embree_; }

 private:
  RTCScene embree_;
};

/// k = 0 … nr − 1 in bit-reversed order: any first rays look evenly round, so that hopeless voxels
/// show themselves early.
std::vector<int> order_of_directions(int nr) {
  std::vector<int> order;
  int bits = 0;
  while ((1 << bits) < nr) ++bits;
  for (int i = 0; i < 1 << bits; ++i) {
    int k = 0;
    for (int b = 0; b < bits; ++b) k |= (i >> b & 1) << (bits - 1 - b);
    if (k < nr) order.push_back(k);
  }
  return order;
}

/// N rays at once, coordinate by coordinate.
template <int N>
struct Packet {
  using RayHit = RTCRayHitNt<N>;
  static void intersect(const int* active, RTCScene scene, RTCIntersectContext* context,
                        RayHit* rays);
};

template <>
void Packet<16>::intersect(const int* active, RTCScene scene, RTCIntersectContext* context,
                           RayHit* rays) {
  rtcIntersect16(active, scene, context, reinterpret_cast<RTCRayHit16*>(rays));
}

template <>
void Packet<8>::intersect(const int* active, RTCScene scene, RTCIntersectContext* context,
                          RayHit* rays) {
  rtcIntersect8(active, scene, context, reinterpret_cast<RTCRayHit8*>(rays));
}

template <>
void Packet<1>::intersect(const int*, RTCScene scene, RTCIntersectContext* context, RayHit* rays) {
  rtcIntersect1(scene, context, reinterpret_cast<RTCRayHit*>(rays));
}

template <int kWidth>
class Caster {
 public:
  Caster(const Job& job, const Scene& scene, const HitGrid& grid)
      : job_(job), scene_(scene), order_(order_of_directions(grid.nr)), grid_(grid) {
    for (int k = 0; k < grid.nr; ++k) directions_.push_back(direction(k, grid.nr));
  }

  static int bands_per_slice(int ns) { return (ns + kTileY - 1) / kTileY; }

  /// Casts band b; writes is_valid and the number of hits (at first[v + 1]) of its voxels.
  Piece cast(std::size_t b, HitGrid& out) const {
    const FlushDenormals flush;
    Work work;
    work.seen.resize(static_cast<std::size_t>(grid_.nr) * kWidth);
    const int ns = grid_.ns, bands = bands_per_slice(ns);
    const int z = static_cast<int>(b) / bands, y0 = static_cast<int>(b) % bands * kTileY;
    const std::size_t first_voxel = voxel(0, y0, z);
    const int rows = std::min(kTileY, ns - y0);
    work.begin.assign(static_cast<std::size_t>(rows) * ns, 0);
    Piece band;
    for (int x0 = 0; x0 < ns; x0 += kTileX) {
      place(work, x0, y0, z);
      band.rays += cast_tile(work);
      store(work, first_voxel, out);
    }
    // From the order of the tiles to the order of the voxels.
    band.hits.reserve(work.hits.size());
    for (std::size_t i = 0; i < work.begin.size(); ++i) {
      const auto from = work.hits.begin() + static_cast<std::ptrdiff_t>(work.begin[i]);
      band.hits.insert(band.hits.end(), from,
                       from + static_cast<std::ptrdiff_t>(out.first[first_voxel + i + 1]));
    }
    return band;
  }

  /// Direction k from the voxel's tile: 2 × plane + (inner side), −1 nothing.
  int look(std::size_t v, int k) const {
    const FlushDenormals flush;
    Work work;
    const auto n = static_cast<std::size_t>(grid_.ns);
    const int x = static_cast<int>(v % n), y = static_cast<int>(v / n % n);
    place(work, x / kTileX * kTileX, y / kTileY * kTileY, static_cast<int>(v / n / n));
    intersect(work, k);
    return seen(work, x % kTileX + y % kTileY * kTileX, k);
  }

 private:
  static constexpr int kTileX = std::min(4, kWidth), kTileY = kWidth / kTileX;

  struct Work {
    alignas(64) typename Packet<kWidth>::RayHit rays{};
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
      const Vec3 c = grid_.center(voxel(x, y, z)) - job_.center;
      work.rays.ray.org_x[lane] = static_cast<float>(c.x());
      work.rays.ray.org_y[lane] = static_cast<float>(c.y());
      work.rays.ray.org_z[lane] = kStretch * static_cast<float>(c.z());
    }
  }

  /// All directions of a tile, or as many as matter. Returns the number of rays.
  std::uint64_t cast_tile(Work& work) const {
    std::uint64_t rays = 0;
    int left = grid_.nr;
    for (const int k : order_) {
      intersect(work, k);
      --left;
      const int cast = count(work, k, left);
      rays += static_cast<std::uint64_t>(cast);
      if (cast == 0) break;
    }
    return rays;
  }

  /// The active lanes' first hits in direction k.
  void intersect(Work& work, int k) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    const Direction& d = directions_[k];
    for (int lane = 0; lane < kWidth; ++lane) {
      work.rays.ray.dir_x[lane] = static_cast<float>(d.x);
      work.rays.ray.dir_y[lane] = static_cast<float>(d.y);
      work.rays.ray.dir_z[lane] = 0;
      work.rays.ray.tnear[lane] = 0;
      work.rays.ray.tfar[lane] = std::numeric_limits<float>::infinity();
      work.rays.ray.mask[lane] = ~0u;
      work.rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
    Packet<kWidth>::intersect(work.active, scene_.get(), &context, &work.rays);
  }

  /// What a lane met in direction k: 2 × plane + (inner side), −1 nothing.
  int seen(const Work& work, int lane, int k) const {
    if (work.rays.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) return -1;
    const int plane = job_.soup.plane_of_triangle[work.rays.hit.primID[lane]];
    return 2 * plane + directions_[k].is_inside(job_.normal[plane]);
  }

  /// Takes in what direction k met, retires lanes without hope. Returns the lanes cast.
  int count(Work& work, int k, int left) const {
    int cast = 0;
    for (int lane = 0; lane < kWidth; ++lane) {
      if (!work.active[lane]) continue;
      ++cast;
      const int met = work.seen[static_cast<std::size_t>(k) * kWidth + lane] = seen(work, lane, k);
      if (met >= 0) ++(met & 1 ? work.in : work.out)[lane];
      if (job_.is_stopping && job_.rule.is_hopeless(work.in[lane], work.out[lane], left))
        work.active[lane] = 0;
    }
    return cast;
  }

  /// Writes what the tile's voxels are, and the hits of the kept ones.
  void store(Work& work, std::size_t first_voxel, HitGrid& grid) const {
    for (int lane = 0; lane < kWidth; ++lane) {
      if (work.voxel[lane] < 0) continue;
      const auto v = static_cast<std::size_t>(work.voxel[lane]);
      const int in = work.in[lane], out = work.out[lane];
      // A retired lane has counts that can no longer be kept, so this asks the same of both.
      const bool is_kept = work.active[lane] && job_.rule.is_kept(in, out);
      grid.is_valid[v] = is_kept && job_.rule.is_valid(in, out);
      work.begin[v - first_voxel] = work.hits.size();
      if (is_kept) append_hits(work, lane);
      grid.first[v + 1] = work.hits.size() - work.begin[v - first_voxel];
    }
  }

  /// One lane's hits by rising plane. Neighbouring directions mostly see the same plane, and a
  /// voxel few planes in all, so a linear search over them is short.
  void append_hits(Work& work, int lane) const {
    const std::size_t begin = work.hits.size();
    std::size_t at = begin;
    for (int k = 0; k < grid_.nr; ++k) {
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

  const Job& job_;
  const Scene& scene_;
  std::vector<Direction> directions_;
  std::vector<int> order_;
  const HitGrid& grid_;
};

/// Packets of 16 run as such, not as two of 8.
bool is_wide_native() {
  return rtcGetDeviceProperty(shared_device(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
}

template <int kWidth>
void cast_all(const Job& job, const Scene& scene, HitGrid& grid) {
  const Caster<kWidth> caster(job, scene, grid);
  std::vector<Piece> bands(static_cast<std::size_t>(grid.ns) *
                           Caster<kWidth>::bands_per_slice(grid.ns));
  parallel_for(bands.size(), [&](std::size_t b) { bands[b] = caster.cast(b, grid); });
  join_pieces(bands, grid);
}

}  // namespace

struct Reference::Impl {
  Scene scene;
  Caster<16> wide;
  Caster<8> narrow;
  bool is_wide = is_wide_native();

  Impl(const Job& job, const HitGrid& grid)
      : scene(job.soup.corners), wide(job, scene, grid), narrow(job, scene, grid) {}
};

Reference::Reference(const Job& job, const HitGrid& grid)
    : impl_(std::make_unique<Impl>(job, grid)) {}
Reference::~Reference() = default;

int Reference::look(std::size_t voxel, int k) const {
  return impl_->is_wide ? impl_->wide.look(voxel, k) : impl_->narrow.look(voxel, k);
}

void cast_embree(const Job& job, bool is_single, HitGrid& grid) {
  const Scene scene(job.soup.corners);
  if (is_single)
    cast_all<1>(job, scene, grid);
  else if (is_wide_native())
    cast_all<16>(job, scene, grid);
  else
    cast_all<8>(job, scene, grid);
}

}  // namespace colod::casting
