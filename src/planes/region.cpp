// Based on: the covariance of triangles and points about a plane.
// Differs: the same under both rules.
// Notation: none.
#include "region.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace colod::regions {

void Moments::add(const Moments& other) {
  weight += other.weight;
  sum += other.sum;
  squares += other.squares;
}

void Moments::add_item(const Items& items, int item) {
  std::array<Vec3, 3> p;
  const int count = items.corners(item, p);
  const double w = items.area[item];
  weight += w;
  sum += w * items.center[item];
  if (count == 1) {
    squares += w * p[0] * p[0].transpose();
    return;
  }
  const Vec3 s = p[0] + p[1] + p[2];
  squares += w / 12 *
             (p[0] * p[0].transpose() + p[1] * p[1].transpose() + p[2] * p[2].transpose() +
              s * s.transpose());
}

Eigen::Matrix3d Moments::covariance() const {
  if (weight <= 0) return Eigen::Matrix3d::Zero();
  const Vec3 c = mean();
  return squares / weight - c * c.transpose();
}

Vec3 Moments::fit(const Vec3& like) const {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance());
  // A region that is a line so far has no plane of its own yet.
  if (solver.info() != Eigen::Success || solver.eigenvalues()[1] < 1e-9) return like;
  const Vec3 n = solver.eigenvectors().col(0).normalized();
  return n.dot(like) < 0 ? Vec3(-n) : n;
}

double Moments::rms(const Vec3& normal, double offset) const {
  const double shift = normal.dot(mean()) - offset;
  return std::sqrt(std::max(0.0, normal.dot(covariance() * normal)) + shift * shift);
}

void Region::refit() {
  normal = moments.fit(normal);
  offset = normal.dot(moments.mean());
}

}  // namespace colod::regions
