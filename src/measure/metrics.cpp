// *Based on:* sampled Hausdorff distance as in Cignoni, Rocchini, Scopigno, "Metro: measuring error
// on simplified surfaces", 1998, with evenly spread samples. Validity is in metrics_validity.cpp.
//
// *Differs:* no --rules here; the paper's HD is `relative`.
//
// *Notation:* none.
#include "metrics.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/meshopt.h"
#include "core/parallel.h"
#include "core/point_tree.h"
#include "core/rays.h"
#include "grains.h"

namespace colod {
namespace {

/// The i-th of points that fill the unit square evenly from whichever one on: an additive
/// recurrence by the plastic number (M. Roberts, The unreasonable effectiveness of quasirandom
/// sequences, 2018).
std::array<double, 2> spread_point(std::uint64_t seed, std::uint64_t i) {
  constexpr std::uint64_t kStepX = 0xC13FA9A902A6328Full, kStepY = 0x91E10DA5C79E7B1Dull;
  const std::uint64_t n = i + seed * 0x9E3779B97F4A7C15ull;
  const auto share = [](std::uint64_t z) { return static_cast<double>(z >> 11) * 0x1p-53; };
  return {share(n * kStepX), share(n * kStepY)};
}

/// The finite faces with an area, and the vertices that they use; `original`, when asked for,
/// receives their numbers in the mesh.
Mesh usable_part(const Mesh& mesh, const char* name, std::vector<std::size_t>* original = nullptr) {
  Mesh part;
  std::vector<int> index(mesh.vertices.size(), -1);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Face& f = mesh.faces[i];
    const double area = face_area(mesh, f);
    if (!(area > 0) || !std::isfinite(area)) continue;
    if (original) original->push_back(i);
    Face g;
    for (int k = 0; k < 3; ++k) {
      if (index[f[k]] < 0) {
        index[f[k]] = static_cast<int>(part.vertices.size());
        part.vertices.push_back(mesh.vertices[f[k]]);
      }
      g[k] = index[f[k]];
    }
    part.faces.push_back(g);
  }
  if (part.faces.empty())
    throw Error(Stage::kInput, name, "no finite face with an area to measure distances on");
  return part;
}

PointCloud usable_part(const PointCloud& cloud, const char* name,
                       std::vector<std::size_t>* original) {
  PointCloud part;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (cloud.points[i].allFinite()) part.points.push_back(cloud.points[i]), original->push_back(i);
  if (part.points.empty()) throw Error(Stage::kInput, name, "no finite point or face to measure");
  return part;
}

/// The flags of the items that are usable; none where there are none.
std::vector<char> picked(const std::vector<char>& flags, const std::vector<std::size_t>& items) {
  std::vector<char> out;
  if (flags.empty()) return out;
  for (const std::size_t i : items) out.push_back(flags[i]);
  return out;
}

/// What a side's distances are taken at: area samples first, then vertices.
struct Probes {
  std::vector<Vec3> points;
  std::size_t samples = 0;
  std::vector<char> is_left_out;     ///< per point; empty: none
  std::vector<std::uint32_t> order;  ///< in which they are looked at: neighbours one after another
};

/// A vertex is left out with all its faces.
void add_vertices(const Mesh& mesh, const std::vector<char>& is_left_out, Probes& probes) {
  probes.points.insert(probes.points.end(), mesh.vertices.begin(), mesh.vertices.end());
  if (is_left_out.empty()) return;
  probes.is_left_out.resize(probes.points.size(), 1);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (const int v : mesh.faces[f]) probes.is_left_out[probes.samples + v] &= is_left_out[f];
}

/// Sample i falls in the i-th of n equal shares of the area, taken in order of faces. `is_left_out`
/// is per face or empty.
Probes sample_surface(const Mesh& mesh, const DistanceOptions& options,
                      const std::vector<char>& is_left_out = {}) {
  std::vector<double> area_until;
  double total = 0;
  for (const Face& f : mesh.faces) area_until.push_back(total += face_area(mesh, f));
  Probes probes;
  probes.samples = static_cast<std::size_t>(std::max(options.samples, 1));
  probes.points.resize(probes.samples);
  if (!is_left_out.empty()) probes.is_left_out.resize(probes.samples);
  const auto place = [&](std::size_t i) {
    const double share =
        (static_cast<double>(i) + 0.5) / static_cast<double>(probes.samples) * total;
    const auto found = std::upper_bound(area_until.begin(), area_until.end(), share);
    const std::size_t last = mesh.faces.size() - 1;
    const std::size_t face = std::min<std::size_t>(found - area_until.begin(), last);
    const Face& f = mesh.faces[face];
    if (!is_left_out.empty()) probes.is_left_out[i] = is_left_out[face];
    const auto [u, t] = spread_point(options.seed, i);
    const double r = std::sqrt(u);
    const Vec3 &a = mesh.vertices[f[0]], &b = mesh.vertices[f[1]], &c = mesh.vertices[f[2]];
    probes.points[i] = a + r * (1 - t) * (b - a) + r * t * (c - a);
  };
  parallel_for(probes.samples, place, kGrainOfQueries);
  add_vertices(mesh, is_left_out, probes);
  probes.order = order_in_space(probes.points);
  return probes;
}

struct OneSided {
  double max = 0, mean = 0, rms = 0;
  Spread taken;
};

/// Of the distances at the probes that are not left out; all zero where every one is.
Spread spread_of(const Probes& probes, const std::vector<double>& distances) {
  Spread spread;
  std::vector<double> taken;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (!probes.is_left_out.empty() && probes.is_left_out[i]) continue;
    spread.max = std::max(spread.max, distances[i]);
    if (i >= probes.samples) continue;
    taken.push_back(distances[i]);
    spread.mean += distances[i];
  }
  if (taken.empty()) return spread;
  spread.mean /= static_cast<double>(taken.size());
  const auto at = [&](double share) {
    const auto place =
        taken.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(taken.size() - 1));
    std::nth_element(taken.begin(), place, taken.end());
    return *place;
  };
  spread.p95 = at(0.95);
  spread.p99 = at(0.99);
  return spread;
}

/// `make_distance` makes what is asked for the distances of neighbours, one after another.
template <typename MakeDistance>
OneSided measure(const Probes& probes, const MakeDistance& make_distance) {
  std::vector<double> distances(probes.points.size());
  parallel_ranges(probes.points.size(), kGrainOfQueries, [&](std::size_t begin, std::size_t end) {
    auto distance = make_distance();
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t probe = probes.order[i];
      distances[probe] = distance(probes.points[probe]);
    }
  });
  OneSided side;
  double squares = 0;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    side.max = std::max(side.max, distances[i]);
    if (i >= probes.samples) continue;
    side.mean += distances[i];
    squares += distances[i] * distances[i];
  }
  side.mean /= static_cast<double>(probes.samples);
  side.rms = std::sqrt(squares / static_cast<double>(probes.samples));
  side.taken = spread_of(probes, distances);
  return side;
}

OneSided measure_to_mesh(const Probes& probes, const RayScene& target) {
  return measure(probes, [&] {
    return [nearest = NearestInTurn(target)](const Vec3& p) mutable { return nearest(p).distance; };
  });
}

OneSided measure_to_cloud(const Probes& probes, const PointTree& target) {
  return measure(probes, [&] {
    return [&](const Vec3& p) {
      std::size_t nearest = 0;
      double squared = 0;
      target.knnSearch(p.data(), 1, &nearest, &squared);
      return std::sqrt(squared);
    };
  });
}

Distances combine(const OneSided& a_to_b, const OneSided& b_to_a, const Box& box_a) {
  Distances d;
  d.a_to_b = a_to_b.max, d.b_to_a = b_to_a.max;
  d.taken = a_to_b.taken;
  d.mean_a_to_b = a_to_b.mean, d.mean_b_to_a = b_to_a.mean;
  d.rms_a_to_b = a_to_b.rms, d.rms_b_to_a = b_to_a.rms;
  const double diagonal = box_a.diagonal();
  d.relative = std::max(d.a_to_b, d.b_to_a) / (diagonal > 0 ? diagonal : 1);
  return d;
}

}  // namespace

struct DistanceGauge::Impl {
  DistanceOptions options;
  Box box;
  Probes probes;
  std::unique_ptr<RayScene> mesh;  ///< null: a cloud
  const PointsSeen points{probes.points};
  std::unique_ptr<PointTree> cloud;

  Impl(const Mesh& a, const DistanceOptions& o, const std::vector<char>& is_left_out = {})
      : options(o) {
    std::vector<std::size_t> original;
    const Mesh from = usable_part(a, "first mesh", &original);
    box = bounding_box(from.vertices);
    probes = sample_surface(from, options, picked(is_left_out, original));
    mesh = std::make_unique<RayScene>(from);
  }
  Impl(const PointCloud& a, const std::string& name, const DistanceOptions& o,
       const std::vector<char>& is_left_out)
      : options(o) {
    std::vector<std::size_t> original;
    probes.points = usable_part(a, name.empty() ? "source" : name.c_str(), &original).points;
    probes.samples = probes.points.size();
    probes.order = order_in_space(probes.points);
    probes.is_left_out = picked(is_left_out, original);
    box = bounding_box(probes.points);
    cloud = std::make_unique<PointTree>(3, points);
    cloud->buildIndex();
  }
};

DistanceGauge::DistanceGauge(const Mesh& a, const DistanceOptions& options)
    : impl_(std::make_unique<Impl>(a, options)) {}
DistanceGauge::DistanceGauge(const Source& a, const DistanceOptions& options,
                             const std::vector<char>& is_left_out)
    : impl_(a.is_mesh() ? std::make_unique<Impl>(a.mesh, options, is_left_out)
                        : std::make_unique<Impl>(a.cloud, a.name, options, is_left_out)) {}
DistanceGauge::~DistanceGauge() = default;

Distances DistanceGauge::measure_to(const Mesh& b) const {
  const Mesh to = usable_part(b, "second mesh");
  const OneSided there = measure_to_mesh(impl_->probes, RayScene(to));
  const Probes back = sample_surface(to, impl_->options);
  return combine(
      there,
      impl_->mesh ? measure_to_mesh(back, *impl_->mesh) : measure_to_cloud(back, *impl_->cloud),
      impl_->box);
}

Distances measure_distances(const Mesh& a, const Mesh& b, const DistanceOptions& options) {
  return DistanceGauge(a, options).measure_to(b);
}

Distances measure_distances(const Source& a, const Mesh& b, const DistanceOptions& options) {
  return DistanceGauge(a, options).measure_to(b);
}

}  // namespace colod
