// Inside room `planes`: items on a plane.
#pragma once

#include <vector>

#include "core/geometry.h"
#include "items.h"

namespace colod::regions {

/// Weighted sums over a region's surface from which its plane follows.
struct Moments {
  double weight = 0;
  Vec3 sum = Vec3::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();

  void add(const Moments& other);
  void add_item(const Items& items, int item);
  Vec3 mean() const { return weight > 0 ? Vec3(sum / weight) : Vec3(Vec3::Zero()); }
  Eigen::Matrix3d covariance() const;
  /// Unit normal of the least-squares plane, turned towards `like`; `like` itself when undefined.
  Vec3 fit(const Vec3& like) const;
  /// Root mean square distance from the plane.
  double rms(const Vec3& normal, double offset) const;
};

struct Region {
  std::vector<int> items;  ///< rising once grown
  Moments moments;
  Vec3 normal = Vec3::UnitZ();
  double offset = 0;
  double area = 0;  ///< m²: of the items

  void refit();
};

}  // namespace colod::regions
