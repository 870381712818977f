// *Based on:* what photogrammetry does to buildings: only what two cameras see is there, noise lies
// along the line of sight, glass is worst, holes and floating pieces remain. The surface is chosen
// greedily among Delaunay triangles by the smallest empty sphere, as in Cohen-Steiner, Da, "A
// greedy Delaunay-based surface reconstruction algorithm", 2004.
//
// *Differs:* from Cohen-Steiner and Da in growing everywhere at once and in knowing which side is
// outside, hence no front (CGAL's breaks ties by memory address: not the same bytes twice). No
// --rules here. A simulation, to be named as such beside every figure.
//
// *Notation:* sigma: SynthOptions::noise.
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "parallel.h"
#include "rays.h"
#include "synth_internal.h"

namespace colod::synth {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangulation = CGAL::Delaunay_triangulation_3<
    Kernel,
    CGAL::Triangulation_data_structure_3<CGAL::Triangulation_vertex_base_with_info_3<int, Kernel>,
                                         CGAL::Delaunay_triangulation_cell_base_3<Kernel>>>;

constexpr double kHoleShare = 0.03;        // of the seen surface
constexpr double kGlassNoise = 2.2;        // times sigma
constexpr double kGlassDropout = 0.15;     // of the samples on windows
constexpr double kFlyingShare = 0.004;     // samples far off along the line of sight
constexpr double kMinCosine = 0.2;         // a camera sees nothing flatter
constexpr std::size_t kMinComponent = 12;  // faces; smaller pieces are not kept

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

struct Sample {
  Vec3 point, normal;
  int object = -1;
  Vec3 to_camera = Vec3::Zero();  ///< of the camera that sees it best; zero: seen by less than two
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

/// A triangle of the points' Delaunay tetrahedra, turned as the surface that its corners were taken
/// from.
struct Candidate {
  double radius;  ///< squared, of the smallest empty sphere through it
  Face face;
  Vec3 normal;    ///< unit
  double facing;  ///< cosine against the mean normal of its samples
};

/// The triangulation hands out facets from either side: corners are sorted, or rounding would tell.
double empty_radius(const std::vector<Sample>& samples, Face corners, std::array<int, 2> apexes) {
  const auto point = [&](int i) {
    const Vec3& p = samples[i].point;
    return Kernel::Point_3(p.x(), p.y(), p.z());
  };
  std::sort(corners.begin(), corners.end());
  const auto p = point(corners[0]), q = point(corners[1]), r = point(corners[2]);
  double radius = std::numeric_limits<double>::infinity();
  bool is_gabriel = true;
  for (int apex : apexes) {
    if (apex < 0) continue;
    is_gabriel =
        is_gabriel && CGAL::side_of_bounded_sphere(p, q, r, point(apex)) != CGAL::ON_BOUNDED_SIDE;
    radius = std::min(radius, CGAL::squared_radius(p, q, r, point(apex)));
  }
  return is_gabriel ? CGAL::squared_radius(p, q, r) : radius;
}

/// False where the triangle is too long, has no area or joins the two faces of a thin wall.
bool make_candidate(const std::vector<Sample>& samples, double longest_edge, Candidate& c) {
  constexpr double kMinAgreement = 1.2;  // length of the sum of three unit directions
  const Sample* s[3] = {&samples[c.face[0]], &samples[c.face[1]], &samples[c.face[2]]};
  for (int k = 0; k < 3; ++k)
    if ((s[k]->point - s[(k + 1) % 3]->point).norm() > longest_edge) return false;
  const Vec3 towards = s[0]->normal + s[1]->normal + s[2]->normal;
  const Vec3 cross = (s[1]->point - s[0]->point).cross(s[2]->point - s[0]->point);
  if (towards.norm() < kMinAgreement || !(cross.norm() > 1e-9)) return false;
  c.normal = cross.normalized();
  c.facing = c.normal.dot(towards.normalized());
  if (c.facing < 0) {
    std::swap(c.face[1], c.face[2]);
    c.normal = -c.normal, c.facing = -c.facing;
  }
  return true;
}

/// Ordered by radius, then by corners.
std::vector<Candidate> find_candidates(const std::vector<Sample>& samples, double longest_edge) {
  std::vector<std::pair<Kernel::Point_3, int>> points;
  for (int i = 0; i < static_cast<int>(samples.size()); ++i) {
    const Vec3& p = samples[i].point;
    points.push_back({{p.x(), p.y(), p.z()}, i});
  }
  const Triangulation triangulation(points.begin(), points.end());
  const auto apex = [&](const Triangulation::Facet& facet) {
    const auto vertex = facet.first->vertex(facet.second);
    return triangulation.is_infinite(vertex) ? -1 : vertex->info();
  };
  std::vector<Candidate> candidates;
  for (auto it = triangulation.finite_facets_begin(); it != triangulation.finite_facets_end();
       ++it) {
    Candidate c;
    for (int k = 0; k < 3; ++k) c.face[k] = it->first->vertex((it->second + k + 1) % 4)->info();
    std::sort(c.face.begin(), c.face.end());
    if (!make_candidate(samples, longest_edge, c)) continue;
    c.radius = empty_radius(samples, c.face, {apex(*it), apex(triangulation.mirror_facet(*it))});
    candidates.push_back(c);
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.radius, a.face) < std::tie(b.radius, b.face);
  });
  return candidates;
}

/// Triangles chosen one by one; every edge keeps at most two, in opposite directions, not folded.
class Surface {
 public:
  bool add(const Candidate& c, double min_fold_cosine) {
    for (int k = 0; k < 3; ++k) {
      const int a = c.face[k], b = c.face[(k + 1) % 3];
      if (normal_of_side_.count(key(a, b))) return false;
      const auto other = normal_of_side_.find(key(b, a));
      if (other != normal_of_side_.end() && other->second.dot(c.normal) < min_fold_cosine)
        return false;
    }
    for (int k = 0; k < 3; ++k)
      normal_of_side_.emplace(key(c.face[k], c.face[(k + 1) % 3]), c.normal);
    faces.push_back(c.face);
    return true;
  }
  std::vector<Face> faces;

 private:
  static std::uint64_t key(int a, int b) {
    return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
  }
  std::unordered_map<std::uint64_t, Vec3> normal_of_side_;  // by directed edge
};

/// Smooth and well-faced triangles first, then what closes corners.
std::vector<Face> reconstruct(const std::vector<Sample>& samples, double longest_edge) {
  if (samples.size() < 4) return {};
  const std::vector<Candidate> candidates = find_candidates(samples, longest_edge);
  std::vector<char> is_used(candidates.size(), 0);
  Surface surface;
  const std::array<std::pair<double, double>, 4> passes = {
      {{0.6, 0.5}, {0.3, 0.0}, {0.0, -0.6}, {0.0, -0.95}}};
  for (const auto& [min_facing, min_fold_cosine] : passes)
    for (std::size_t i = 0; i < candidates.size(); ++i)
      if (!is_used[i] && candidates[i].facing >= min_facing)
        is_used[i] = surface.add(candidates[i], min_fold_cosine);
  return surface.faces;
}

/// The faces around a vertex, parted into fans connected over edges at it.
std::vector<std::vector<int>> fans_at(const std::vector<Face>& faces, std::vector<int> left) {
  const auto is_adjacent = [&](int f, int g) {
    int shared = 0;
    for (int v : faces[f]) shared += std::count(faces[g].begin(), faces[g].end(), v) > 0;
    return shared >= 2;
  };
  std::vector<std::vector<int>> fans;
  while (!left.empty()) {
    std::vector<int> fan = {left.back()};
    left.pop_back();
    for (std::size_t i = 0; i < fan.size(); ++i)
      for (std::size_t k = left.size(); k-- > 0;)
        if (is_adjacent(fan[i], left[k])) {
          fan.push_back(left[k]);
          left.erase(left.begin() + k);
        }
    fans.push_back(fan);
  }
  return fans;
}

/// Where a vertex holds several fans, only its largest stays.
void keep_largest_fans(std::size_t vertices, std::vector<Face>& faces) {
  constexpr int kMaxRounds = 8;
  for (int round = 0; round < kMaxRounds; ++round) {
    std::vector<std::vector<int>> faces_at(vertices);
    for (int f = 0; f < static_cast<int>(faces.size()); ++f)
      for (int v : faces[f]) faces_at[v].push_back(f);
    std::vector<char> is_dropped(faces.size(), 0);
    bool has_dropped = false;
    for (const std::vector<int>& around : faces_at) {
      const auto fans = fans_at(faces, around);
      std::size_t largest = 0;
      for (std::size_t i = 1; i < fans.size(); ++i)
        if (fans[i].size() > fans[largest].size()) largest = i;
      for (std::size_t i = 0; i < fans.size(); ++i)
        if (i != largest)
          for (int f : fans[i]) is_dropped[f] = has_dropped = true;
    }
    if (!has_dropped) return;
    std::vector<Face> kept;
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (!is_dropped[f]) kept.push_back(faces[f]);
    faces = kept;
  }
}

/// The component of each face, connected over edges; numbers are a face of the component.
std::vector<int> edge_components(const std::vector<Face>& faces) {
  std::vector<std::array<int, 3>> edges;  // low, high, face
  for (int f = 0; f < static_cast<int>(faces.size()); ++f)
    for (int s = 0; s < 3; ++s) {
      const int a = faces[f][s], b = faces[f][(s + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), f});
    }
  std::sort(edges.begin(), edges.end());
  std::vector<int> parent(faces.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t e = 1; e < edges.size(); ++e)
    if (edges[e][0] == edges[e - 1][0] && edges[e][1] == edges[e - 1][1])
      parent[find(edges[e][2])] = find(edges[e - 1][2]);
  std::vector<int> component(faces.size());
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) component[f] = find(f);
  return component;
}

void drop_small_components(std::vector<Face>& faces) {
  const std::vector<int> component = edge_components(faces);
  std::vector<std::size_t> size(faces.size(), 0);
  for (int c : component) ++size[c];
  std::vector<Face> kept;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (size[component[f]] >= kMinComponent) kept.push_back(faces[f]);
  faces = kept;
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
  for (const SynthPart& p : building.parts) is_glass.push_back(p.type == "window");
  add_noise(samples, is_glass, options.noise, box.center(), hash);
  add_floaters(samples, options.density, hash);
  std::vector<Face> faces = reconstruct(samples, 3 / std::sqrt(options.density));
  keep_largest_fans(samples.size(), faces);
  drop_small_components(faces);
  write_mesh(samples, faces, building.source);
}

}  // namespace

void scan_neighbourhood(std::vector<SynthBuilding>& buildings, const std::vector<Vec3>& to_street,
                        const SynthOptions& options) {
  Mesh all;
  for (const SynthBuilding& b : buildings) {
    const int base = static_cast<int>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), b.source.mesh.vertices.begin(),
                        b.source.mesh.vertices.end());
    for (const Face& f : b.source.mesh.faces)
      all.faces.push_back({f[0] + base, f[1] + base, f[2] + base});
  }
  const RayScene scene(all);
  parallel_for(buildings.size(), [&](std::size_t i) {
    scan_building(buildings[i], to_street[i], scene, options,
                  {options.seed * 0x9E3779B97F4A7C15ull + i});
  });
}

}  // namespace colod::synth
