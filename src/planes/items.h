// Inside room `planes`: the faces of a mesh or the points of a cloud.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/geometry.h"

namespace colod::regions {

/// The faces of a mesh or the points of a cloud, with who lies beside whom.
struct Items {
  const Source* source = nullptr;
  std::vector<Vec3> center;      ///< face centroid or point
  std::vector<Vec3> normal;      ///< unit; zero where unknown
  std::vector<double> area;      ///< m²; of a point: what its neighbours leave it
  std::vector<char> is_floater;  ///< parted from the building; not used either
  std::vector<char> is_used;     ///< no floater, not degenerate, finite
  std::vector<int> first;        ///< neighbours of i: neighbor[first[i] .. first[i + 1])
  std::vector<int> neighbor;     ///< across an edge, or among the nearest points
  std::vector<signed char> way;  ///< beside `neighbor`: +1 wound alike across the edge, −1 not,
                                 ///< 0 unknown (points)
  double spacing = 0;            ///< metres: median distance of neighbouring points; mesh: 0

  int size() const { return static_cast<int>(center.size()); }
  bool is_mesh() const { return source->is_mesh(); }
  /// The points whose distance from a plane counts: three corners, or the point.
  int corners(int item, std::array<Vec3, 3>& out) const;
};

Items collect_items(const Source& source);
/// Marks small components far from the rest as unused, and lumps that hang in the air; says how
/// many in a warning.
void drop_floaters(Items& items, std::vector<std::string>& warnings);

}  // namespace colod::regions
