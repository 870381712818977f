// Based on: the trade of distance against complexity as in Verdie, Lafarge & Alliez, "LOD
// generation for urban scenes", ACM TOG 34(3), 2015; samples on the R2 sequence (M. Roberts, 2018).
//
// Differs: robust rules only; the paper's layers are the planes of their segments, come what may.
// Segments are told apart by what rays meet, not by what a surface needs: the inner side of a
// passage's wall, the end of a cross gable, the roof behind a gable wall that belongs to the body
// may wait for finer layers than what they carry, and the min-cut took the wall away, or closed the
// gap with a fin. Here planes of finer layers join where that brings the surface nearer to all
// outlines by more than the facets that it adds are worth; so the coarsest layer is asked, finer
// ones inherit.
//
// Notation: lengths are shares of the building's diagonal; spares are sets of planes that may join.
#include "spares.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "core/flat.h"
#include "core/parallel.h"
#include "core/spread.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::extraction::spares;

constexpr int kSamples = 1000;      // of all outlines, and of a mesh
constexpr std::size_t kGrain = 64;  // queries a task takes

struct Samples {
  std::vector<Vec3> points;
  std::vector<int> faces;  ///< that they lie on, rising
};

/// Points spread evenly over a mesh; none where it has no faces.
Samples spread(const Mesh& mesh) {
  std::vector<double> until;
  double total = 0;
  for (const Face& f : mesh.faces) until.push_back(total += face_area(mesh, f));
  Samples samples;
  if (mesh.faces.empty()) return samples;
  for (int i = 0; i < kSamples; ++i) {
    const auto found = std::upper_bound(until.begin(), until.end(), (i + 0.5) / kSamples * total);
    const auto last = static_cast<std::ptrdiff_t>(until.size()) - 1;
    const int face = static_cast<int>(std::min(found - until.begin(), last));
    const Vec2 at = spread_in_square(i, 0.5);
    const double r = std::sqrt(at.x()), t = at.y();
    const auto& [a, b, c] = mesh.faces[face];
    samples.points.push_back((1 - r) * mesh.vertices[a] + r * (1 - t) * mesh.vertices[b] +
                             r * t * mesh.vertices[c]);
    samples.faces.push_back(face);
  }
  return samples;
}

/// Of all points, metres. Neighbours in the list are mostly neighbours in space.
double summed_distance(const std::vector<Vec3>& points, const RayScene& to) {
  std::vector<double> distance(points.size());
  parallel_ranges(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    double bound = std::numeric_limits<double>::infinity();
    for (std::size_t i = begin; i < end; ++i) {
      if (i > begin) bound = distance[i - 1] + (points[i] - points[i - 1]).norm();
      distance[i] = to.nearest(points[i], bound).distance;
    }
  });
  return std::accumulate(distance.begin(), distance.end(), 0.0);
}

}  // namespace

SpareGauge::SpareGauge(const Planes& planes, const std::vector<std::vector<int>>& sets,
                       const RayScene& outlines)
    : sets_(sets), outlines_(outlines), diagonal_(planes.box.diagonal()), points_of_(sets.size()) {
  std::vector<int> plane_of_triangle;
  const Samples samples = spread(outline_soup(planes.planes, &plane_of_triangle));
  points_ = samples.points;
  for (std::size_t s = 0; s < sets.size(); ++s)
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (std::binary_search(sets[s].begin(), sets[s].end(), plane_of_triangle[samples.faces[i]]))
        points_of_[s].push_back(points_[i]);
}

/// What one sample's metres are of the mean.
double SpareGauge::share() const { return 1 / (kSamples * diagonal_); }

int SpareGauge::most_missed(const PolygonMesh& surface, const std::vector<char>& is_out) const {
  int chosen = -1;
  double most = kMissed;
  std::optional<RayScene> scene;
  for (std::size_t s = 0; s < sets_.size(); ++s) {
    if (is_out[s] || points_of_[s].empty()) continue;
    if (!scene) scene.emplace(surface.mesh());
    const double missed = share() * summed_distance(points_of_[s], *scene);
    if (missed > most) most = missed, chosen = static_cast<int>(s);
  }
  return chosen;
}

double SpareGauge::mean_distance(const PolygonMesh& surface) const {
  const Mesh mesh = surface.mesh();
  return 0.5 * share() *
         (summed_distance(points_, RayScene(mesh)) +
          summed_distance(spread(mesh).points, outlines_));
}

bool SpareGauge::pays(int set, const PolygonMesh& before, const PolygonMesh& after,
                      double saved) const {
  const int added = static_cast<int>(after.facets.size()) - static_cast<int>(before.facets.size());
  const bool is_body = added >= kBodyFacets || sets_[set].size() >= kBodyPlanes;
  return !(saved < (is_body ? kBodyWorth : kFacetWorth) * std::max(1, added));
}

}  // namespace colod
