// Inside room `rounds`: how elliptical shapes were narrowed.
#pragma once

#include <array>
#include <vector>

#include "sides.h"

namespace colod::rounds {

/// An edge between two faces that bends a little.
struct BentEdge {
  Vec3 middle, along;
  std::array<int, 2> faces;
};

/// The stretches (RoundShape::stretch) of what may be elliptical about an upright axis: of curved
/// pieces, the largest first, by how their plan spreads. Few of them.
std::vector<Eigen::Matrix3d> find_stretches(const Facets& facets,
                                            const std::vector<BentEdge>& edges);

}  // namespace colod::rounds
