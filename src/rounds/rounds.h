// Between `read` and `planes`: what a source draws as flat sides around an axis: domes, onion
// spires, cones, round towers, apses, barrel vaults.
//
// A round shape is a profile of straight rows, turned about an axis in equal steps, and then
// perhaps narrowed along one level direction: an elliptical dome. Where a row and a column meet
// lies one flat side. It is known as exactly as its file, and fewer rows and columns make the same
// shape regular again.
#pragma once

#include <array>
#include <vector>

#include "core/geometry.h"
#include "core/rules.h"

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

/// The round shapes of a mesh that is exact to the millimetre, largest evidence first; each face is
/// in one at most. None in clouds and scans. Deterministic; about 1 s for 50,000 curved edges.
std::vector<RoundShape> find_rounds(const Source& source, const RuleSet& rules = RuleSet::all());

/// The same shape of fewer sides: no two neighbours turn by much more than `turn` radians. Closed
/// shapes keep their cross-section's area, open ones their ends. A side has the faces of those that
/// it stands for.
RoundShape reduce_round(const RoundShape& shape, double turn);

/// The largest turn that keeps the surface within `tolerance` metres of the shape's.
double turn_within(const RoundShape& shape, double tolerance);

}  // namespace colod
