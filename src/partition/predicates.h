// Inside room `partition`: integer planes, their meeting points, and the table that gives equal
// points equal ids. No bounds are checked at run time; predicates.cpp derives them.
#pragma once

#include <cstddef>
#include <vector>

#include "partition.h"

namespace colod {

using HomogeneousPoint = std::array<__int128, 4>;  ///< (X, Y, Z, W), W > 0, gcd 1

inline constexpr int kNormalBits = 23;      ///< |normal| ≈ 2^23
inline constexpr int kCoordinateBits = 24;  ///< |coordinate| ≤ 2^24 grid units

/// −1, 0, 1: behind the plane, on it, where its normal looks.
inline int side_of(const Partition::IntPlane& plane, const HomogeneousPoint& p) {
  const __int128 value =
      plane.normal[0] * p[0] + plane.normal[1] * p[1] + plane.normal[2] * p[2] + plane.d * p[3];
  return (value > 0) - (value < 0);
}

/// The point of three planes. \pre they meet in one point.
HomogeneousPoint meet(const Partition::IntPlane& a, const Partition::IntPlane& b,
                      const Partition::IntPlane& c);

/// Ids for points, equal for equal points, in the order of first use.
class VertexTable {
 public:
  explicit VertexTable(std::vector<Partition::Vertex>& vertices);
  int id(const HomogeneousPoint& point);

 private:
  void grow();
  std::vector<Partition::Vertex>& vertices_;
  std::vector<int> slots_;  ///< open addressing, −1: free; a power of two long
};

/// Rounds the box and the planes to integers: fills grid, origin, box, planes, cuts and warnings.
void round_to_grid(const std::vector<CutPlane>& cut_planes, const Box& box, Partition& partition);

}  // namespace colod
