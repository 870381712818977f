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
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "core/flat.h"
#include "core/parallel.h"
#include "core/spread.h"
#include "extraction.h"

namespace colod {
namespace {

// Of mean distance, what a facet must save, and one of a body of its own: to which layer that
// belongs was found among its like. A box on a face adds five facets.
constexpr double kFacetWorth = 2.5e-4, kBodyWorth = 8e-4;
constexpr std::size_t kBodyPlanes = 4;  // so many planes are a body …
constexpr int kBodyFacets = 5;          // … or so many facets more
constexpr double kMissed = 3e-4;        // mean distance that spares must make up to be tried
constexpr int kTrials = 4;
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

class Joiner {
 public:
  Joiner(const Planes& planes, const std::vector<std::vector<int>>& spares, Sight& sight,
         const ExtractionOptions& options)
      : planes_(planes),
        spares_(spares),
        sight_(sight),
        options_(options),
        is_tried_(spares.size(), 0),
        is_joined_(spares.size(), 0),
        points_of_(spares.size()) {
    std::vector<int> plane_of_triangle;
    const Samples outlines = spread(outline_soup(planes.planes, &plane_of_triangle));
    points_ = outlines.points;
    for (std::size_t s = 0; s < spares.size(); ++s)
      for (std::size_t i = 0; i < points_.size(); ++i)
        if (std::binary_search(spares[s].begin(), spares[s].end(),
                               plane_of_triangle[outlines.faces[i]]))
          points_of_[s].push_back(points_[i]);
  }

  /// `layer` grows by what joins.
  Extraction run(std::vector<int>& layer) {
    Extraction best = extract_layer(planes_, layer, sight_, options_);
    std::optional<double> distance;
    for (int trial = 0; trial < kTrials && !is_spent(sight_); ++trial) {
      const int chosen = most_missed(best);
      if (chosen < 0) break;
      is_tried_[chosen] = 1;
      if (!distance) distance = mean_distance(best);
      std::vector<int> more = layer;
      for (const int p : spares_[chosen])
        if (std::find(layer.begin(), layer.end(), p) == layer.end()) more.push_back(p);
      Extraction next = extract_layer(planes_, more, sight_, options_);
      const double next_distance = mean_distance(next);
      const int added =
          static_cast<int>(next.mesh.facets.size()) - static_cast<int>(best.mesh.facets.size());
      const bool is_body = added >= kBodyFacets || spares_[chosen].size() >= kBodyPlanes;
      const double worth = (is_body ? kBodyWorth : kFacetWorth) * std::max(1, added);
      if (*distance - next_distance < worth || next.warnings.size() > best.warnings.size())
        continue;
      best = std::move(next);
      layer = std::move(more);
      distance = next_distance;
      std::fill(is_tried_.begin(), is_tried_.end(), 0);  // what did not pay alone may pay now
      is_joined_[chosen] = 1;
    }
    return best;
  }

 private:
  /// What one sample's metres are of the mean.
  double share() const { return 1 / (kSamples * planes_.box.diagonal()); }

  /// The spares whose outlines, far from the surface, add most to the mean distance; −1: none adds
  /// enough.
  int most_missed(const Extraction& extraction) const {
    int chosen = -1;
    double most = kMissed;
    std::optional<RayScene> surface;
    for (std::size_t s = 0; s < spares_.size(); ++s) {
      if (is_tried_[s] || is_joined_[s] || points_of_[s].empty()) continue;
      if (!surface) surface.emplace(extraction.mesh.mesh());
      const double missed = share() * summed_distance(points_of_[s], *surface);
      if (missed > most) most = missed, chosen = static_cast<int>(s);
    }
    return chosen;
  }

  /// Between all outlines and the surface, both ways.
  double mean_distance(const Extraction& extraction) const {
    const Mesh mesh = extraction.mesh.mesh();
    return 0.5 * share() *
           (summed_distance(points_, RayScene(mesh)) +
            summed_distance(spread(mesh).points, sight_.rays));
  }

  const Planes& planes_;
  const std::vector<std::vector<int>>& spares_;
  Sight& sight_;
  const ExtractionOptions& options_;
  std::vector<char> is_tried_, is_joined_;    ///< tried: since the last one joined
  std::vector<std::vector<Vec3>> points_of_;  ///< those of `points_` on each set of spares
  std::vector<Vec3> points_;                  ///< on all outlines
};

}  // namespace

Extraction extract_layer(const Planes& planes, const std::vector<int>& layer_planes,
                         const std::vector<std::vector<int>>& spares, Sight& sight,
                         const ExtractionOptions& options, std::vector<int>& joined) {
  joined.clear();
  if (spares.empty()) return extract_layer(planes, layer_planes, sight, options);
  std::vector<int> layer = layer_planes;
  Extraction result = Joiner(planes, spares, sight, options).run(layer);
  joined.assign(layer.begin() + static_cast<std::ptrdiff_t>(layer_planes.size()), layer.end());
  return result;
}

}  // namespace colod
