// Based on: Co-LOD section 3.2 (dis, scale_d, Sim_co); Osada et al., "Matching 3D models with shape
// distributions", 2001 (D2); Kazhdan, Funkhouser, Rusinkiewicz, "Shape matching and anisotropy",
// 2004 (isotropic by anisotropic scaling).
//
// Differs: the paper leaves the histogram's range, bins and norm open, and they silently set η.
// Here, for both rules: 64 equal bins over the *unsquared* distance 0..6 in whitened units (the
// mean squared distance of two points is 6 by construction, so 2.4 is typical and what lies beyond
// 6 joins the last bin, at most 1–2 %). A range by the largest distance follows outliers. ‖·‖₂ is
// that of densities, ∫(h − h')² over the distance, which does not hang on the number of bins: with
// η = 4 the shape term of two segments is about 0.2–1, as scale_d is (measured in November 2026),
// so that 4 balances both as the paper says. Whitening has a floor of max((5 cm)², (2 %)² of the
// largest eigenvalue): without it a flat segment's noise would become its shape. The covariance is
// exact, not sampled. Points are stratified over the area (one in each of `pairs` equal parts, at
// random within it) and two such sets are paired by a random permutation: each pair is distributed
// as independent points, with less noise than independent draws.
//
// Notation: s segment, Σ covariance of its surface, λ eigenvalues of Σ, W whitening, v_e = λ.
#include "similarity.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "core/parallel.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::coanalysis;

constexpr double kRange = 6;  // whitened units

struct Triangle {
  Vec3 a, ab, ac;
  double area;
};

// The triangles of a segment that have a finite, positive area.
std::vector<Triangle> surface_of(const Planes& planes, const Segment& segment) {
  std::vector<Triangle> surface;
  for (const int p : segment.planes) {
    const Outline& outline = planes.planes[p].outline;
    for (const Face& f : outline.triangles) {
      const Vec3 a = outline.vertices[f[0]];
      const Vec3 ab = outline.vertices[f[1]] - a, ac = outline.vertices[f[2]] - a;
      const double area = 0.5 * ab.cross(ac).norm();
      if (std::isfinite(area) && area > 0) surface.push_back({a, ab, ac, area});
    }
  }
  return surface;
}

double total_area(const std::vector<Triangle>& surface) {
  double area = 0;
  for (const Triangle& t : surface) area += t.area;
  return area;
}

// ∫ (x−c)(x−c)ᵀ over the surface / area. For a triangle with centroid g and corners a, b, c it is
// (9 ggᵀ + aaᵀ + bbᵀ + ccᵀ)/12 about any origin; the first corner serves, to keep digits.
Eigen::Matrix3d covariance(const std::vector<Triangle>& surface, double area) {
  const Vec3 origin = surface.front().a;
  Vec3 mean = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const Triangle& t : surface) {
    const Vec3 a = t.a - origin, b = a + t.ab, c = a + t.ac, g = (a + b + c) / 3;
    const Eigen::Matrix3d m =
        9 * g * g.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose();
    mean += t.area / area * g;
    second += t.area / area / 12 * m;
  }
  return second - mean * mean.transpose();
}

std::uint64_t mix(std::uint64_t x) {  // the finaliser of splitmix64
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

// Stable over machines: the same building and planes get the same points, whatever else is there.
std::uint64_t segment_seed(std::uint64_t seed, const std::string& building,
                           const Segment& segment) {
  std::uint64_t h = mix(seed);
  for (const char c : building) h = mix(h ^ static_cast<unsigned char>(c));
  h = mix(h ^ 0x100);  // the name ends here
  for (const int p : segment.planes) h = mix(h ^ static_cast<std::uint64_t>(p));
  return h;
}

double unit(std::uint64_t bits32) { return (static_cast<double>(bits32) + 0.5) / 4294967296.0; }

// One point, whitened, in each of n parts of equal area.
std::vector<Vec3> stratified_points(const std::vector<Triangle>& surface, double area, int n,
                                    const Eigen::Matrix3d& whitening, std::mt19937_64& random) {
  std::vector<Vec3> points(n);
  std::size_t t = 0;
  double passed = 0;  // area of the triangles before t
  for (int i = 0; i < n; ++i) {
    const double at = (i + unit(random() >> 32)) / n * area;
    while (t + 1 < surface.size() && passed + surface[t].area <= at) passed += surface[t++].area;
    const std::uint64_t bits = random();
    double u = unit(bits >> 32), v = unit(bits & 0xffffffffULL);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    points[i] = whitening * (surface[t].a + u * surface[t].ab + v * surface[t].ac);
  }
  return points;
}

std::array<double, 64> pair_histogram(const std::vector<Triangle>& surface, double area, int pairs,
                                      const Eigen::Matrix3d& whitening, std::mt19937_64& random) {
  const std::vector<Vec3> p = stratified_points(surface, area, pairs, whitening, random);
  std::vector<Vec3> q = stratified_points(surface, area, pairs, whitening, random);
  std::array<std::int64_t, 64> count{};
  for (int i = pairs - 1; i >= 0; --i) {  // Fisher–Yates; the multiply maps 32 bits to 0..i
    const auto j =
        static_cast<std::size_t>(((random() >> 32) * (static_cast<std::uint64_t>(i) + 1)) >> 32);
    std::swap(q[i], q[j]);
    const double bin = (p[i] - q[i]).norm() * (64 / kRange);
    ++count[std::min(63, static_cast<int>(bin))];
  }
  std::array<double, 64> share{};
  for (int b = 0; b < 64; ++b) share[b] = static_cast<double>(count[b]) / pairs;
  return share;
}

/// See Descriptor::context.
Vec3 context(const Planes& planes, const Segment& segment) {
  double up = 0, area = 0, low = planes.box.max.z(), high = planes.box.min.z();
  for (const int p : segment.planes) {
    const Plane& plane = planes.planes[p];
    up += plane.area * std::max(0.0, plane.normal.z()), area += plane.area;
    for (const Vec3& v : plane.outline.vertices)
      low = std::min(low, v.z()), high = std::max(high, v.z());
  }
  const double height = std::max(kThin, planes.box.size().z());
  return {area > 0 ? up / area : 0, (low - planes.box.min.z()) / height,
          (high - planes.box.min.z()) / height};
}

Descriptor describe(const Planes& planes, const Segment& segment, std::uint64_t seed, int pairs) {
  Descriptor d;
  d.kind = segment.kind;
  d.area = std::isfinite(segment.area) ? segment.area : 0;
  d.volume = std::isfinite(segment.volume) ? segment.volume : 0;
  std::vector<Triangle> surface = surface_of(planes, segment);
  const double area = total_area(surface);
  d.is_flat = true;
  d.d2[0] = 1;  // no surface: every pair of its points coincides
  if (surface.empty() || !std::isfinite(area)) return d;

  d.context = context(planes, segment);
  const Vec3 origin = surface.front().a;  // whitened coordinates stay small
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance(surface, area));
  if (!solver.eigenvalues().allFinite()) return d;
  const Vec3 rising = solver.eigenvalues().cwiseMax(0);
  d.eigenvalues = rising.reverse();
  d.extent = std::sqrt(d.eigenvalues[0]);
  d.is_flat = segment.planes.size() < 2 || std::sqrt(rising[0]) < kThin;

  const double floor = std::max(kThin * kThin, kThinRelative * kThinRelative * d.eigenvalues[0]);
  const Vec3 scale = rising.cwiseMax(floor).cwiseSqrt().cwiseInverse();
  const Eigen::Matrix3d whitening = scale.asDiagonal() * solver.eigenvectors().transpose();
  for (Triangle& t : surface) t.a -= origin;
  std::mt19937_64 random(seed);
  d.d2 = pair_histogram(surface, area, std::max(1, pairs), whitening, random);
  return d;
}

}  // namespace

std::vector<Descriptor> describe_segments(const Planes& planes, const Segments& segments,
                                          const std::string& building,
                                          const DescriptorOptions& options) {
  std::vector<Descriptor> result(segments.segments.size());
  parallel_for(result.size(), [&](std::size_t i) {
    const Segment& s = segments.segments[i];
    result[i] = describe(planes, s, segment_seed(options.seed, building, s), options.pairs);
  });
  return result;
}

bool has_kind(const Descriptor& d) { return d.kind != ElementKind::kPlain; }

double shape_distance(const Descriptor& a, const Descriptor& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.d2.size(); ++i) {
    const double difference = a.d2[i] - b.d2[i];
    sum += difference * difference;
  }
  return kDensity * std::sqrt(sum);
}

bool is_one_kind(const Descriptor& a, const Descriptor& b) {
  return has_kind(a) && a.kind == b.kind;
}

double segment_distance(const Descriptor& a, const Descriptor& b, double eta) {
  if (is_one_kind(a, b)) return 0;
  const double sum = a.eigenvalues.lpNorm<1>() + b.eigenvalues.lpNorm<1>();
  const double scale = sum > 0 ? (a.eigenvalues - b.eigenvalues).lpNorm<1>() / sum : 0;
  return eta * shape_distance(a, b) + scale;
}

double segment_similarity(const Descriptor& a, const Descriptor& b, double eta) {
  return std::exp(-segment_distance(a, b, eta));
}

double kind_distance(const Descriptor& a, const Descriptor& b, double eta) {
  if (is_one_kind(a, b)) return 0;
  return segment_distance(a, b, eta) + (a.context - b.context).norm() +
         (has_kind(a) && has_kind(b) ? 1 : 0);
}

double kind_similarity(const Descriptor& a, const Descriptor& b, double eta) {
  return std::exp(-kind_distance(a, b, eta));
}

}  // namespace colod
