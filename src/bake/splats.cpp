// Based on: Pfister, Zwicker, van Baar, Gross, Surfels, SIGGRAPH 2000; nanoflann.
// Differs: squares that overlap, one colour each; the nearest to a facet is seen.
#include <algorithm>
#include <cmath>

#include "bake.h"
#include "core/parallel.h"
#include "core/point_tree.h"
#include "parameters.h"

namespace colod {

using namespace parameters::bake;

namespace {

/// Metres, per point: the mean distance to its neighbours.
std::vector<double> spacings(const std::vector<Vec3>& points) {
  constexpr std::size_t kLeaf = 16, kGrain = 256;
  const PointsSeen seen{points};
  PointTree tree(3, seen, nanoflann::KDTreeSingleIndexAdaptorParams(kLeaf));
  tree.buildIndex();
  std::vector<double> out(points.size(), 0);
  parallel_for(
      points.size(),
      [&](std::size_t i) {
        std::array<std::size_t, kNeighbours + 1> found;
        std::array<double, kNeighbours + 1> squared;
        const std::size_t n =
            tree.knnSearch(points[i].data(), found.size(), found.data(), squared.data());
        for (std::size_t k = 1; k < n; ++k)
          out[i] += std::sqrt(squared[k]) / static_cast<double>(n - 1);
      },
      kGrain);
  return out;
}

}  // namespace

Splats splat_points(const PointCloud& cloud, const std::vector<std::array<Rgb, 3>>& colors) {
  const std::vector<double> spacing = spacings(cloud.points);
  std::vector<double> sorted = spacing;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  Splats out{{}, {}, *middle};
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vec3& n = cloud.normals[i];
    const Vec3 side = n.cross(std::abs(n.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitX()).normalized();
    // A lone point stands for no more than its neighbours would.
    const double half = kSplat * std::min(spacing[i], 2 * out.spacing);
    const Vec3 u = half * side, v = half * n.cross(side);
    const int first = static_cast<int>(out.mesh.vertices.size());
    for (const Vec3& corner : {Vec3(-u - v), Vec3(u - v), Vec3(u + v), Vec3(v - u)})
      out.mesh.vertices.push_back(cloud.points[i] + corner);
    out.mesh.faces.push_back({first, first + 1, first + 2});
    out.mesh.faces.push_back({first, first + 2, first + 3});
    out.look.colors.insert(out.look.colors.end(), 2, colors[i]);
  }
  return out;
}

}  // namespace colod
