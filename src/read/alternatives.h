// Inside room `read` only: whether two parts of a file show the same thing, one coarser than the
// other.
#pragma once

#include <vector>

#include "core/geometry.h"

namespace colod::mesh_io {

/// Whether `coarse` and `fine` (indices of `faces`) are levels of detail of one thing, by shape
/// alone: the coarser one has at most two thirds of the triangles, both have nearly the same box,
/// and most of each surface lies nearer to the other one than a wall is thick, so that an inner
/// shell or a cladding is none. Cost: a few thousand nearest points.
bool is_coarser_alternative(const std::vector<Vec3>& points, const std::vector<Face>& faces,
                            const std::vector<int>& coarse, const std::vector<int>& fine);

}  // namespace colod::mesh_io
