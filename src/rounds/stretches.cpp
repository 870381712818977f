// Based on: rounds.h. A regular polygon's area spreads alike in all directions, so that of an
// elliptical plan the spread says how it was narrowed.
// Differs: the paper has no such step.
// Notation: –
#include "stretches.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/flat.h"
#include "core/union_find.h"

namespace colod::rounds {
namespace {

constexpr std::size_t kMostPieces = 8;

/// Pieces of curved surface that are connected, each its faces, by falling area.
std::vector<std::vector<int>> curved_pieces(const Facets& facets,
                                            const std::vector<BentEdge>& edges) {
  UnionFind sets(facets.area.size());
  std::set<int> faces;
  for (const BentEdge& e : edges) {
    sets.unite(e.faces[0], e.faces[1]);
    faces.insert(e.faces.begin(), e.faces.end());
  }
  std::map<int, std::pair<double, std::vector<int>>> by_root;
  for (const int f : faces) {
    auto& [area, members] = by_root[sets.find(f)];
    area += facets.area[f];
    members.push_back(f);
  }
  std::vector<std::pair<double, std::vector<int>>> order;
  for (auto& [root, piece] : by_root) order.push_back(std::move(piece));
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::vector<int>> pieces;
  for (auto& [area, members] : order)
    if (pieces.size() < kMostPieces) pieces.push_back(std::move(members));
  return pieces;
}

std::vector<Vec2> plan_of(const Mesh& mesh, const std::vector<int>& faces) {
  std::vector<Vec2> points;
  for (const int f : faces)
    for (const int v : mesh.faces[f]) points.push_back(mesh.vertices[v].head<2>());
  return convex_hull(std::move(points));
}

/// Second moments of a polygon's area about its centroid, but for a factor.
Eigen::Matrix2d spread_of(const std::vector<Vec2>& polygon) {
  double area = 0;
  Vec2 first = Vec2::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  const Vec2 origin = polygon[0];
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vec2 a = polygon[i] - origin, b = polygon[i + 1] - origin, sum = a + b;
    const double twice = cross(a, b);
    area += twice;
    first += twice / 3 * sum;
    second += twice / 12 * (a * a.transpose() + b * b.transpose() + sum * sum.transpose());
  }
  const Vec2 centroid = first / area;
  return second / area - centroid * centroid.transpose();
}

}  // namespace

std::vector<Eigen::Matrix3d> find_stretches(const Facets& facets,
                                            const std::vector<BentEdge>& edges) {
  std::vector<Eigen::Matrix3d> stretches;
  for (const std::vector<int>& piece : curved_pieces(facets, edges)) {
    const std::vector<Vec2> plan = plan_of(facets.mesh, piece);
    if (plan.size() < kLeastCorners) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spread(spread_of(plan));
    const Vec2 axes = spread.eigenvalues().cwiseMax(0).cwiseSqrt();
    const double narrow = axes[0] / axes[1];
    if (!(narrow >= kNarrowest && narrow <= kRound)) continue;
    Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
    stretch.topLeftCorner<2, 2>() =
        spread.eigenvectors() * Vec2(narrow, 1).asDiagonal() * spread.eigenvectors().transpose();
    if (std::none_of(stretches.begin(), stretches.end(), [&](const auto& s) {
          return (s - stretch).cwiseAbs().maxCoeff() < kSameStretch;
        }))
      stretches.push_back(stretch);
  }
  return stretches;
}

}  // namespace colod::rounds
