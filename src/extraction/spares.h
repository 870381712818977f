// Inside room `extraction`: planes of finer layers that a coarse one cannot do without.
#pragma once

#include <vector>

#include "core/rays.h"
#include "planes/planes.h"

namespace colod {

/// Tells how much sets of planes are missed by a surface. Distances are shares of the building's
/// diagonal.
class SpareGauge {
 public:
  /// `sets` are rising plane indices; they and `outlines`, the scene of all outlines, have to stay.
  SpareGauge(const Planes& planes, const std::vector<std::vector<int>>& sets,
             const RayScene& outlines);

  /// The set whose outlines, far from the surface, add most to the mean distance; −1: none adds
  /// enough. Those that `is_out` are not asked.
  int most_missed(const PolygonMesh& surface, const std::vector<char>& is_out) const;

  /// Between all outlines and the surface, both ways.
  double mean_distance(const PolygonMesh& surface) const;

  /// Coming nearer by `saved` is worth the facets that a set has added.
  bool pays(int set, const PolygonMesh& before, const PolygonMesh& after, double saved) const;

 private:
  double share() const;

  const std::vector<std::vector<int>>& sets_;
  const RayScene& outlines_;
  double diagonal_;                           ///< metres
  std::vector<std::vector<Vec3>> points_of_;  ///< those of `points_` on each set
  std::vector<Vec3> points_;                  ///< on all outlines
};

}  // namespace colod
