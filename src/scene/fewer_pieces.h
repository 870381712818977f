// Inside room `scene` only: the same ground in fewer pieces.
#pragma once

#include <vector>

#include "territory.h"

namespace colod {

/// What pieces that meet corner to corner cover together, as triangles between corners of its
/// border: without those that are no farther than `tolerance` from it, in metres. Building: the
/// first piece's.
std::vector<Territories::Piece> fewer_pieces(const std::vector<Territories::Piece>& pieces,
                                             double tolerance);

}  // namespace colod
