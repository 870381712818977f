// *Based on:* what photogrammetry does to buildings: only what two cameras see is there, noise lies
// along the line of sight, glass is worst, holes and floating pieces remain.
//
// *Differs:* no --rules here. A simulation, to be named as such beside every figure.
//
// *Notation:* sigma: SynthOptions::noise.
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/parallel.h"
#include "core/rays.h"
#include "internal.h"

namespace colod::synth {
namespace {

constexpr double kHoleShare = 0.03;     // of the seen surface
constexpr double kGlassNoise = 2.2;     // times sigma
constexpr double kGlassDropout = 0.15;  // of the samples on windows
constexpr double kFlyingShare = 0.004;  // samples far off along the line of sight
constexpr double kMinCosine = 0.2;      // a camera sees nothing flatter

/// Numbers that depend on (seed, stream, index) only (SplitMix64, Steele et al. 2014).
struct Hash {
  std::uint64_t seed;

  double uniform(int stream, std::uint64_t index) const {
    std::uint64_t z = (seed + stream * 0xA0761D6478BD642Full) * 0xD1342543DE82EF95ull +
                      (index + 1) * 0x9E3779B97F4A7C15ull;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  double between(double low, double high, int stream, std::uint64_t index) const {
    return low + (high - low) * uniform(stream, index);
  }
  double gauss(int stream, std::uint64_t index) const {
    const double r = std::sqrt(-2 * std::log(1 - uniform(stream, index)));
    return r * std::cos(2 * M_PI * uniform(stream + 1, index));
  }
  Vec3 direction(int stream, std::uint64_t index) const {
    const double z = between(-1, 1, stream, index), r = std::sqrt(1 - z * z);
    const double angle = 2 * M_PI * uniform(stream + 1, index);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
};
enum Stream {  // gauss and direction take two numbers each
  kPlace,
  kBarycentricA,
  kBarycentricB,
  kOrder,
  kGauss,
  kGauss2,
  kDropout,
  kFlying,
  kFlyingSize,
  kDisc,
  kDiscSize,
  kBlob,
  kBlobSize,
  kBlobAway,
  kBlobTilt,
  kBlobTilt2,
  kBlobCount,
  kBlobPoint,
  kBlobPoint2,
  kBlobNoise,
  kBlobNoise2,
  kWave,
  kWave2,
  kWaveLength,
  kWavePhase
};

/// A subset no two of which are nearer than `radius`, greedy in the order of hashes.
std::vector<Sample> thin_out(const std::vector<Sample>& candidates, double radius,
                             const Hash& hash) {
  std::vector<std::pair<double, int>> order;
  for (int i = 0; i < static_cast<int>(candidates.size()); ++i)
    order.push_back({hash.uniform(kOrder, i), i});
  std::sort(order.begin(), order.end());
  const auto cell_key = [](std::int64_t x, std::int64_t y, std::int64_t z) {
    return ((x & 0x1fffff) << 42) | ((y & 0x1fffff) << 21) | (z & 0x1fffff);
  };
  std::unordered_map<std::int64_t, std::vector<int>> cells;
  std::vector<Sample> kept;
  for (const auto& [key, i] : order) {
    const Vec3& p = candidates[i].point;
    const Eigen::Array3d cell = (p / radius).array().floor();
    bool is_free = true;
    for (int n = 0; n < 27 && is_free; ++n) {
      const auto found = cells.find(cell_key(static_cast<std::int64_t>(cell.x()) + n % 3 - 1,
                                             static_cast<std::int64_t>(cell.y()) + n / 3 % 3 - 1,
                                             static_cast<std::int64_t>(cell.z()) + n / 9 - 1));
      if (found == cells.end()) continue;
      for (int k : found->second)
        is_free = is_free && (kept[k].point - p).squaredNorm() >= radius * radius;
    }
    if (!is_free) continue;
    cells[cell_key(static_cast<std::int64_t>(cell.x()), static_cast<std::int64_t>(cell.y()),
                   static_cast<std::int64_t>(cell.z()))]
        .push_back(static_cast<int>(kept.size()));
    kept.push_back(candidates[i]);
  }
  return kept;
}

std::vector<Sample> sample_surface(const Source& source, double density, const Hash& hash) {
  constexpr double kOversampling = 4, kRadius = 0.77;  // together about `density` samples remain
  const Mesh& mesh = source.mesh;
  std::vector<double> area_until;
  double total = 0;
  for (const Face& f : mesh.faces) area_until.push_back(total += face_area(mesh, f));
  const auto n = static_cast<std::size_t>(std::ceil(kOversampling * density * total));
  std::vector<Sample> candidates(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double share = (i + hash.uniform(kPlace, i)) / n * total;
    const std::size_t face = std::min<std::size_t>(
        std::upper_bound(area_until.begin(), area_until.end(), share) - area_until.begin(),
        mesh.faces.size() - 1);
    const Face& f = mesh.faces[face];
    const double r = std::sqrt(hash.uniform(kBarycentricA, i));
    const double t = hash.uniform(kBarycentricB, i);
    const Vec3 &a = mesh.vertices[f[0]], &b = mesh.vertices[f[1]], &c = mesh.vertices[f[2]];
    candidates[i].point = a + r * (1 - t) * (b - a) + r * t * (c - a);
    candidates[i].normal = face_cross(mesh, f).normalized();
    candidates[i].object = source.face_object[face];
  }
  return thin_out(candidates, kRadius / std::sqrt(density), hash);
}

/// From the air straight down and on two rings, from the street before the house.
std::vector<Vec3> place_cameras(const Box& box, const Vec3& to_street) {
  const Vec3 center = box.center(), along(-to_street.y(), to_street.x(), 0);
  std::vector<Vec3> cameras;
  for (int i = -1; i <= 1; ++i) cameras.push_back(center + Vec3(0, 0, 65) + 14.0 * i * along);
  for (int i = 0; i < 12; ++i) {
    const double angle = 2 * M_PI * i / 12, elevation = (i % 2 ? 48 : 28) * M_PI / 180;
    cameras.push_back(center + 60 * Vec3(std::cos(elevation) * std::cos(angle),
                                         std::cos(elevation) * std::sin(angle),
                                         std::sin(elevation)));
  }
  const double before =
      0.5 * (std::abs(to_street.x()) * box.size().x() + std::abs(to_street.y()) * box.size().y()) +
      6.5;
  for (int i = -3; i <= 3; ++i) {
    Vec3 camera = center + before * to_street + 4.5 * i * along;
    camera.z() = box.min.z() + 1.7;
    cameras.push_back(camera);
  }
  return cameras;
}

void find_best_camera(Sample& sample, const std::vector<Vec3>& cameras, const RayScene& scene) {
  constexpr double kOffset = 5e-3;  // m off the surface, above the rays' single precision
  const Vec3 origin = sample.point + kOffset * sample.normal;
  int seen_by = 0;
  double best = 0;
  Vec3 best_direction = Vec3::Zero();
  for (const Vec3& camera : cameras) {
    const double distance = (camera - origin).norm();
    const Vec3 direction = (camera - origin) / distance;
    const double cosine = direction.dot(sample.normal);
    if (cosine < kMinCosine || scene.is_occluded(origin, direction, 1e-3, distance)) continue;
    ++seen_by;
    if (cosine > best) best = cosine, best_direction = direction;
  }
  if (seen_by >= 2) sample.to_camera = best_direction;
}

/// A few long waves; between −2 and 2.
struct Waves {
  std::array<Vec3, 4> wave;
  std::array<double, 4> phase;

  explicit Waves(const Hash& hash) {
    for (int i = 0; i < 4; ++i) {
      wave[i] = 2 * M_PI / hash.between(2.5, 7, kWaveLength, i) * hash.direction(kWave, i);
      phase[i] = 2 * M_PI * hash.uniform(kWavePhase, i);
    }
  }
  double at(const Vec3& p) const {
    double sum = 0;
    for (int i = 0; i < 4; ++i) sum += 0.5 * std::sin(wave[i].dot(p) + phase[i]);
    return sum;
  }
};

/// Round holes until they make up their share.
void drop_discs(std::vector<Sample>& samples, double density, const Hash& hash) {
  const double target = kHoleShare * samples.size() / density;  // m²
  std::vector<std::pair<Vec3, double>> discs;
  double area = 0;
  for (int i = 0; area < target && i < 10000 && !samples.empty(); ++i) {
    const double radius = hash.between(0.25, 0.75, kDiscSize, i);
    const auto k = static_cast<std::size_t>(hash.uniform(kDisc, i) * samples.size());
    discs.push_back({samples[k].point, radius});
    area += M_PI * radius * radius;
  }
  std::erase_if(samples, [&](const Sample& s) {
    return std::any_of(discs.begin(), discs.end(), [&](const auto& disc) {
      return (s.point - disc.first).squaredNorm() < disc.second * disc.second;
    });
  });
}

void add_noise(std::vector<Sample>& samples, const std::vector<char>& is_glass, double sigma,
               const Vec3& center, const Hash& hash) {
  const Waves waves(hash);
  std::vector<Sample> noisy;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    Sample s = samples[i];
    const bool on_glass = is_glass[s.object];
    if (on_glass && hash.uniform(kDropout, i) < kGlassDropout) continue;
    double off = sigma * (on_glass ? kGlassNoise : 1.0) * hash.gauss(kGauss, i);
    if (hash.uniform(kFlying, i) < kFlyingShare)
      off = hash.between(0.2, 1.2, kFlyingSize, i), s.object = -1;
    s.point += off * s.to_camera + sigma * waves.at(s.point - center) * s.normal;
    noisy.push_back(s);
  }
  samples = noisy;
}

/// Crumpled patches in the air before the surface.
void add_floaters(std::vector<Sample>& samples, double density, const Hash& hash) {
  const std::size_t surface = samples.size();
  if (surface == 0) return;
  const int blobs = 3 + static_cast<int>(6 * hash.uniform(kBlobCount, 0));
  std::uint64_t index = 0;
  for (int b = 0; b < blobs; ++b) {
    const Sample near = samples[static_cast<std::size_t>(hash.uniform(kBlob, b) * surface)];
    const Vec3 center = near.point + hash.between(0.7, 3, kBlobAway, b) * near.normal;
    const double radius = hash.between(0.3, 0.9, kBlobSize, b);
    const auto basis = plane_basis(hash.direction(kBlobTilt, b));
    const int n = std::max(20, static_cast<int>(M_PI * radius * radius * density));
    for (int i = 0; i < n; ++i, ++index) {
      const double r = radius * std::sqrt(hash.uniform(kBlobPoint, index));
      const double angle = 2 * M_PI * hash.uniform(kBlobPoint2, index);
      Sample s = near;
      s.object = -1;
      s.normal = basis[0].cross(basis[1]);
      s.point = center + r * std::cos(angle) * basis[0] + r * std::sin(angle) * basis[1] +
                0.05 * hash.gauss(kBlobNoise, index) * s.normal;
      samples.push_back(s);
    }
  }
}

/// What at least two corners belong to; else the first corner's.
int vote(const Sample& a, const Sample& b, const Sample& c) {
  return b.object == c.object ? b.object : a.object;
}

void write_mesh(const std::vector<Sample>& samples, const std::vector<Face>& faces,
                Source& source) {
  std::vector<int> index(samples.size(), -1);
  source.mesh = {};
  source.face_object.clear();
  for (const Face& f : faces) {
    Face g;
    for (int k = 0; k < 3; ++k) {
      if (index[f[k]] < 0) {
        index[f[k]] = static_cast<int>(source.mesh.vertices.size());
        source.mesh.vertices.push_back(
            samples[f[k]].point.unaryExpr([](double x) { return std::round(x * 1e6) / 1e6; }));
      }
      g[k] = index[f[k]];
    }
    source.mesh.faces.push_back(g);
    source.face_object.push_back(vote(samples[f[0]], samples[f[1]], samples[f[2]]));
  }
}

void scan_building(SynthBuilding& building, const Vec3& to_street, const RayScene& scene,
                   const SynthOptions& options, const Hash& hash) {
  const Box box = bounding_box(building.source.mesh.vertices);
  const std::vector<Vec3> cameras = place_cameras(box, to_street);
  std::vector<Sample> samples = sample_surface(building.source, options.density, hash);
  parallel_for(
      samples.size(), [&](std::size_t i) { find_best_camera(samples[i], cameras, scene); }, 256);
  std::erase_if(samples, [](const Sample& s) { return s.to_camera.isZero(); });
  drop_discs(samples, options.density, hash);
  std::vector<char> is_glass;
  for (const SynthPart& p : building.parts) is_glass.push_back(p.kind == ElementKind::kWindow);
  add_noise(samples, is_glass, options.noise, box.center(), hash);
  add_floaters(samples, options.density, hash);
  const std::vector<Face> faces = reconstruct(samples, 3 / std::sqrt(options.density));
  write_mesh(samples, faces, building.source);
}

}  // namespace

Box scan_reach(const Box& building, const Vec3& to_street) {
  Box reach = building;
  for (const Vec3& camera : place_cameras(building, to_street)) reach.extend(camera);
  return reach;
}

void scan_buildings(std::vector<SynthBuilding>& buildings, int number, const Mesh& around,
                    const Box& whole, const std::vector<Vec3>& to_street,
                    const SynthOptions& options) {
  const RayScene scene(around, whole);
  parallel_for(buildings.size(), [&](std::size_t i) {
    scan_building(buildings[i], to_street[i], scene, options,
                  {options.seed * 0x9E3779B97F4A7C15ull + number + i});
  });
}

}  // namespace colod::synth
