// *Based on:* own work.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include "looks.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.h"
#include "core/flat.h"
#include "core/parallel.h"
#include "core/point_tree.h"
#include "core/rays.h"
#include "face_samples.h"
#include "grains.h"
#include "looks_facets.h"

namespace colod {
namespace {

constexpr double kSamplesOfMesh = 8192;       // a mesh
constexpr std::size_t kMostPoints = 1 << 18;  // of a cloud that are asked
constexpr std::size_t kMostEdges = 100000;    // faces whose edges are measured
constexpr double kLeastSpacing = 0.02;        // metres
constexpr std::size_t kNoiseSeeds = 256;      // places where noise is looked at
constexpr std::size_t kNoisePoints = 16384;   // that are looked at from there
constexpr double kNoiseRadius = 2;            // metres: of bumps that are no part of a building
constexpr double kMostNoise = 0.5;            // metres
constexpr std::size_t kLeastNeighbours = 8;
constexpr double kSupport = 0.5, kSupportShare = 0.02;  // metres, of the diagonal
constexpr double kSpacings = 2;                         // of points: nearer is supported
constexpr double kThinSheet = 0.3;                      // metres
constexpr double kOpposed = -0.866;   // cosine: a thin body's sides face apart by 150° or more
constexpr double kFacing = 0.5;       // cosine: the source faces as the side does
constexpr double kSheets = 0.01;      // metres of noise: what a person drew may be sheets
constexpr double kLeastWidth = 0.01;  // metres
constexpr double kOffFacet = 2e-4;    // metres: no ray meets its own face
// What one sees in a picture (judge_looks).
constexpr double kSeenFlap = 0.5, kSeenUnsupported = 1;                    // m²
constexpr double kSeenLeaning = 0.05, kSeenEdges = 0.2, kSeenEaves = 0.1;  // shares

Mesh finite_part(const Mesh& mesh) {
  Mesh part{mesh.vertices, {}};
  for (const Face& f : mesh.faces)
    if (const double area = face_area(mesh, f); area > 0 && std::isfinite(area))
      part.faces.push_back(f);
  // Vertices that no face uses may be anything.
  if (!part.faces.empty())
    for (Vec3& v : part.vertices)
      if (!v.allFinite()) v = part.vertices[part.faces[0][0]];
  return part;
}

double spacing_of(const Mesh& mesh) {
  return std::max(kLeastSpacing, std::sqrt(surface_area(mesh) / kSamplesOfMesh));
}

double median_edge(const Mesh& mesh) {
  std::vector<double> lengths;
  const std::size_t step = mesh.faces.size() / kMostEdges + 1;
  for (std::size_t i = 0; i < mesh.faces.size(); i += step)
    for (int k = 0; k < 3; ++k)
      lengths.push_back(
          (mesh.vertices[mesh.faces[i][k]] - mesh.vertices[mesh.faces[i][(k + 1) % 3]]).norm());
  return median(std::move(lengths));
}

/// The source's highest point by squares in plan.
class Tops {
 public:
  Tops(const std::vector<Vec3>& points, double size) : size_(size) {
    Box box = bounding_box(points);
    origin_ = box.min.head<2>();
    nx_ = count(box.size().x()), ny_ = count(box.size().y());
    size_ = std::max({size_, box.size().x() / nx_, box.size().y() / ny_});
    top_.assign(static_cast<std::size_t>(nx_) * ny_, -std::numeric_limits<double>::infinity());
    for (const Vec3& p : points) {
      double& top = top_[cell(p.y() - origin_.y(), ny_) * nx_ + cell(p.x() - origin_.x(), nx_)];
      top = std::max(top, p.z());
    }
  }

  /// Whether the source is as high in p's square or one beside it.
  bool are_above(const Vec3& p) const {
    const int x = static_cast<int>(std::floor((p.x() - origin_.x()) / size_));
    const int y = static_cast<int>(std::floor((p.y() - origin_.y()) / size_));
    for (int j = std::max(0, y - 1); j <= std::min(ny_ - 1, y + 1); ++j)
      for (int i = std::max(0, x - 1); i <= std::min(nx_ - 1, x + 1); ++i)
        if (top_[static_cast<std::size_t>(j) * nx_ + i] >= p.z()) return true;
    return false;
  }

 private:
  static constexpr int kMostSquares = 4096;  // a side

  int count(double extent) const {
    return std::clamp(static_cast<int>(extent / size_) + 1, 1, kMostSquares);
  }
  std::size_t cell(double x, int n) const {
    return std::clamp(static_cast<int>(x / size_), 0, n - 1);
  }

  double size_;
  Vec2 origin_;
  int nx_, ny_;
  std::vector<double> top_;
};

double rms_from_plane(const std::vector<Vec3>& points) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points) spread += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread / points.size());
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
}

/// The facet with most of what is flagged, and there the point that is nearest to its middle.
FaultPlace worst_place(const std::vector<SurfaceSample>& points, const std::vector<char>& flags,
                       const std::vector<int>& facet_of_face, double unit) {
  std::vector<double> size(facet_of_face.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (flags[i]) size[facet_of_face[points[i].face]] += unit;
  const auto most = std::max_element(size.begin(), size.end());
  if (most == size.end() || *most == 0) return {};
  std::vector<Vec3> own;
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i)
    if (flags[i] && facet_of_face[points[i].face] == most - size.begin())
      own.push_back(points[i].point), sum += points[i].point;
  const Vec3 middle = sum / static_cast<double>(own.size());
  return {*most, *std::min_element(own.begin(), own.end(), [&](const Vec3& a, const Vec3& b) {
            return (a - middle).squaredNorm() < (b - middle).squaredNorm();
          })};
}

}  // namespace

struct LookGauge::Impl {
  SourceLooks looks;
  std::size_t faces = 0;      // of the source; 0: points
  std::vector<Vec3> samples;  // of its surface, or its points
  PointsSeen seen{samples};
  std::vector<Vec3> normals;         // of the samples; empty: none known
  std::unique_ptr<Surface> own;      // where none was given
  const Surface* surface = nullptr;  // of points: none
  std::unique_ptr<PointTree> tree;   // of points that have no surface
  double support = 0, thin = 0;
  std::optional<Tops> tops;

  Impl(const Source& source, const Surface* known);
  void sample_surface();
  void sample_points(const PointCloud& cloud);
  double spacing_of_points() const;
  double noise_at(std::size_t sample) const;
  void measure_noise();
  double nearest_sample(const Vec3& p) const;
  double distance(const Vec3& p) const;
  bool shows(const Vec3& p, const Vec3& normal) const;
  bool is_flap(const RayScene& body, const Mesh& mesh, const Vec3& p, const Vec3& normal) const;
  bool is_unsupported(const RayScene& body, const Vec3& p, const Vec3& normal) const;
  void look_at_surface(const Mesh& mesh, const std::vector<int>& facet_of_face, Looks& looks) const;
};

LookGauge::Impl::Impl(const Source& source, const Surface* known)
    : faces(source.mesh.faces.size()) {
  if (source.is_mesh()) {
    if (!known) own = std::make_unique<Surface>(finite_part(source.mesh));
    surface = known ? known : own.get();
    sample_surface();
  } else {
    sample_points(source.cloud);
  }
  if (samples.empty())
    throw Error(Stage::kInput, source.name, "no finite face with an area and no finite point");
  measure_noise();
  const Box box = bounding_box(surface ? surface->mesh.vertices : samples);
  support = std::max(kSupport, kSupportShare * box.diagonal());
  thin = std::max(kThinSheet, looks.noise);
  if (!surface) support = std::max(support, kSpacings * spacing_of_points());
  std::vector<Vec3> points = samples;
  if (surface)  // a top is no lower than its corners
    points.insert(points.end(), surface->mesh.vertices.begin(), surface->mesh.vertices.end());
  tops.emplace(points, support);
}

void LookGauge::Impl::sample_surface() {
  const Mesh& mesh = surface->mesh;
  if (mesh.faces.empty()) return;
  looks.edge = median_edge(mesh);
  for (const SurfaceSample& s : spread_over(mesh, spacing_of(mesh))) {
    samples.push_back(s.point);
    normals.push_back(face_cross(mesh, mesh.faces[s.face]).normalized());
  }
}

void LookGauge::Impl::sample_points(const PointCloud& cloud) {
  const std::size_t step = cloud.points.size() / kMostPoints + 1;
  for (std::size_t i = 0; i < cloud.points.size(); i += step) {
    if (!cloud.points[i].allFinite()) continue;
    samples.push_back(cloud.points[i]);
    if (!cloud.normals.empty()) normals.push_back(cloud.normals[i]);
  }
  if (samples.empty()) return;
  tree = std::make_unique<PointTree>(3, seen, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  tree->buildIndex();
}

/// The median distance from a point to the next one.
double LookGauge::Impl::spacing_of_points() const {
  std::vector<double> gaps;
  const std::size_t step = samples.size() / kNoiseSeeds + 1;
  for (std::size_t i = 0; i < samples.size(); i += step) {
    std::size_t index[2];
    double squared[2];
    if (tree->knnSearch(samples[i].data(), 2, index, squared) == 2)
      gaps.push_back(std::sqrt(squared[1]));
  }
  return median(std::move(gaps));
}

/// Root of the mean squared distance from the best plane; negative: too few points to tell.
double LookGauge::Impl::noise_at(std::size_t sample) const {
  const std::size_t step = samples.size() / kNoisePoints + 1;
  std::vector<Vec3> around;
  for (std::size_t i = 0; i < samples.size(); i += step)
    if ((samples[i] - samples[sample]).squaredNorm() < kNoiseRadius * kNoiseRadius &&
        (normals.empty() || normals[sample].dot(normals[i]) > M_SQRT1_2))
      around.push_back(samples[i]);
  return around.size() < kLeastNeighbours ? -1 : rms_from_plane(around);
}

void LookGauge::Impl::measure_noise() {
  const std::size_t step = samples.size() / kNoiseSeeds + 1;
  std::vector<double> all((samples.size() + step - 1) / step);
  parallel_for(all.size(), [&](std::size_t i) { all[i] = noise_at(i * step); });
  std::erase_if(all, [](double rms) { return rms < 0; });
  looks.noise = std::min(kMostNoise, median(std::move(all)));
}

double LookGauge::Impl::nearest_sample(const Vec3& p) const {
  std::size_t index = 0;
  double squared = std::numeric_limits<double>::infinity();
  tree->knnSearch(p.data(), 1, &index, &squared);
  return std::sqrt(squared);
}

double LookGauge::Impl::distance(const Vec3& p) const {
  return surface ? surface->rays.nearest(p).distance : nearest_sample(p);
}

/// Whether the source has surface here that faces this way.
bool LookGauge::Impl::shows(const Vec3& p, const Vec3& normal) const {
  if (!surface) return false;
  const NearestPoint near = surface->rays.nearest(p, thin);
  if (near.triangle < 0 || near.distance > thin) return false;
  if (looks.noise < kSheets) return true;
  const Vec3 cross = face_cross(surface->mesh, surface->mesh.faces[near.triangle]);
  return cross.normalized().dot(normal) > kFacing;
}

bool LookGauge::Impl::is_flap(const RayScene& body, const Mesh& mesh, const Vec3& p,
                              const Vec3& normal) const {
  const RayHit hit = body.first_hit(p, -normal, kOffFacet, thin);
  if (!hit || !hit.is_inside) return false;
  // Under the upper edge of a lean-to, or in any sharp corner, a body is thin, but it is no sheet.
  const Vec3 behind = face_cross(mesh, mesh.faces[hit.triangle]).normalized();
  if (normal.dot(behind) > kOpposed) return false;
  return !(shows(p, normal) && shows(p - hit.distance * normal, -normal));
}

bool LookGauge::Impl::is_unsupported(const RayScene& body, const Vec3& p,
                                     const Vec3& normal) const {
  if (distance(p) <= support || tops->are_above(p)) return false;
  constexpr std::array<double, 3> kElevations_deg = {3, 30, 60};
  static const std::vector<Vec3> views = [&] {
    std::vector<Vec3> rings = ring_directions(24, kElevations_deg);
    rings.push_back(Vec3::UnitZ());
    return rings;
  }();
  return std::any_of(views.begin(), views.end(), [&](const Vec3& view) {
    return view.dot(normal) > 0 &&
           !body.is_occluded(p, view, kOffFacet, std::numeric_limits<double>::infinity());
  });
}

void LookGauge::Impl::look_at_surface(const Mesh& m, const std::vector<int>& facet_of_face,
                                      Looks& l) const {
  const RayScene body(m);
  const std::vector<SurfaceSample> points = spread_over(m, spacing_of(m));
  std::vector<char> is_thin(points.size(), 0), is_alone(points.size(), 0);
  parallel_ranges(points.size(), kGrainOfRays, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3& p = points[i].point;
      const Vec3 normal = face_cross(m, m.faces[points[i].face]).normalized();
      is_thin[i] = is_flap(body, m, p, normal);
      is_alone[i] = is_unsupported(body, p, normal);
    }
  });
  const double unit = surface_area(m) / std::max<double>(1, static_cast<double>(points.size()));
  l.flaps = unit * static_cast<double>(std::count(is_thin.begin(), is_thin.end(), 1));
  l.unsupported = unit * static_cast<double>(std::count(is_alone.begin(), is_alone.end(), 1));
  for (std::size_t i = 0; i < points.size(); ++i) l.ragged += is_thin[i] || is_alone[i] ? unit : 0;
  l.worst[static_cast<int>(LookFault::kFlap)] = worst_place(points, is_thin, facet_of_face, unit);
  l.worst[static_cast<int>(LookFault::kUnsupported)] =
      worst_place(points, is_alone, facet_of_face, unit);
}

const char* to_string(LookFault fault) {
  constexpr std::array<const char*, kLookFaults> kNames = {
      "flap", "unsupported", "leaning", "narrow", "edges", "eaves", "triangles"};
  return kNames[static_cast<int>(fault)];
}

LookVerdict judge_looks(const Looks& l) {
  constexpr double kMostOfOne = 10;  // of one fault, so that none hides the others
  const std::array<double, kLookFaults> times = {l.flaps / kSeenFlap,
                                                 l.unsupported / kSeenUnsupported,
                                                 (1 - l.upright) / kSeenLeaning,
                                                 static_cast<double>(l.narrow),
                                                 (1 - l.aligned) / kSeenEdges,
                                                 (1 - l.level_eaves) / kSeenEaves,
                                                 l.triangles_ratio};
  LookVerdict verdict;
  for (int i = 0; i < kLookFaults; ++i) {
    const auto fault = static_cast<LookFault>(i);
    const bool is_seen = fault == LookFault::kTriangles ? times[i] > 1 : times[i] >= 1;
    if (!is_seen) continue;
    verdict.faults.push_back(fault);
    verdict.points += std::min(kMostOfOne, times[i]);
  }
  std::stable_sort(verdict.faults.begin(), verdict.faults.end(), [&](LookFault a, LookFault b) {
    return times[static_cast<int>(a)] > times[static_cast<int>(b)];
  });
  return verdict;
}

LookGauge::LookGauge(const Source& source) : impl_(std::make_unique<Impl>(source, nullptr)) {}
LookGauge::LookGauge(const Source& source, const Surface& surface)
    : impl_(std::make_unique<Impl>(source, &surface)) {}
LookGauge::~LookGauge() = default;

const SourceLooks& LookGauge::source() const { return impl_->looks; }

Looks LookGauge::look_at(const Mesh& mesh) const {
  Looks looks;
  const Mesh shown = finite_part(mesh);
  if (shown.faces.empty()) return looks;
  if (impl_->faces > 0)
    looks.triangles_ratio =
        static_cast<double>(mesh.faces.size()) / static_cast<double>(impl_->faces);
  const std::vector<int> facet_of_face =
      look_at_facets(shown, std::max(kLeastWidth, impl_->looks.noise), looks);
  impl_->look_at_surface(shown, facet_of_face, looks);
  return looks;
}

std::string looks_json(const Looks& l) {
  nlohmann::ordered_json json = {{"triangles_ratio", l.triangles_ratio},
                                 {"wall_area", l.wall_area},
                                 {"upright", l.upright},
                                 {"aligned", l.aligned},
                                 {"level_eaves", l.level_eaves},
                                 {"narrow", l.narrow},
                                 {"unsupported", l.unsupported},
                                 {"flaps", l.flaps},
                                 {"ragged", l.ragged}};
  json["worst"] = nlohmann::ordered_json::object();
  for (int i = 0; i < kPlacedFaults; ++i)
    if (const FaultPlace& w = l.worst[i]; w.size > 0)
      json["worst"][to_string(static_cast<LookFault>(i))] = {
          {"size", w.size}, {"place", {w.place.x(), w.place.y(), w.place.z()}}};
  const LookVerdict verdict = judge_looks(l);
  json["points"] = verdict.points;
  json["faults"] = nlohmann::ordered_json::array();
  for (const LookFault fault : verdict.faults) json["faults"].push_back(to_string(fault));
  return json.dump();
}

}  // namespace colod
