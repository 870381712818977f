// Inside the doors of room `rounds`: a profile of straight rows, turned about an axis in equal
// steps. Where a row and a column meet lies one flat side.
#pragma once

#include <array>
#include <vector>

#include "core/geometry.h"

namespace colod {

struct RoundShape {
  /// What is said below, turned about the axis, becomes the source's by it: identity, or narrowed
  /// along one level direction, of which the longer axis keeps its length.
  Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
  Vec3 center = Vec3::Zero();   ///< on the axis
  Vec3 axis = Vec3::UnitZ();    ///< unit
  Vec3 across = Vec3::UnitX();  ///< unit, across the axis: where column 0 looks
  double step = 0;              ///< radians from one column to the next, counter-clockwise
  int columns = 0;
  bool is_closed = false;  ///< the columns go all the way round

  /// A straight piece of the profile in a column's middle: metres (away from the axis, against it
  /// where the sides look inward; along the axis). Outside is on the right of from → to.
  struct Row {
    Vec2 from, to;
    bool is_joined = false;  ///< begins where the row before it ends
    Vec2 normal() const { return Vec2((to - from).y(), -(to - from).x()).normalized(); }
  };
  std::vector<Row> rows;

  struct Side {
    int row, column;
    std::vector<int> faces;  ///< of the source, rising; never empty
    double area = 0;         ///< m² of them
  };
  std::vector<Side> sides;  ///< by row and column

  Vec3 direction(int column) const;        ///< before the stretch
  Vec3 normal(int row, int column) const;  ///< unit, in the source
  double offset(int row, int column) const;
  /// In the source, of a whole side, counter-clockwise seen from outside; two of them are one at an
  /// apex.
  std::array<Vec3, 4> corners(int row, int column) const;
};

}  // namespace colod
