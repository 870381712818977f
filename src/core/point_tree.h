// The nearest of many points, by nanoflann.
#pragma once

#include <cstddef>
#include <nanoflann.hpp>
#include <vector>

#include "geometry.h"

namespace colod {

/// Points as nanoflann wants to see them; they must outlive it.
struct PointsSeen {
  const std::vector<Vec3>& points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<int>(axis)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using PointTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointsSeen>,
                                        PointsSeen, 3, std::size_t>;

}  // namespace colod
