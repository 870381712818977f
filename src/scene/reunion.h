// Inside room `scene` only: what is left of a face that was cut, in as few triangles as it takes.
#pragma once

#include <array>
#include <vector>

#include "core/geometry.h"

namespace colod {

/// A part of a face: its corners as weights of the face's own.
using FacePart = std::vector<Vec3>;

/// Triangles of what convex parts of a face cover together. Where parts meet nothing is left of
/// their borders, nor of corners on a straight one: neighbours of the face see no corner that they
/// do not have. The parts themselves, as fans, where they do not fit together.
std::vector<std::array<Vec3, 3>> reunite(const std::array<Vec3, 3>& face,
                                         const std::vector<FacePart>& parts);

}  // namespace colod
