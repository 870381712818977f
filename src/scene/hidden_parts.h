// What the files of the room `hidden` share.
#pragma once

#include "core/geometry.h"

namespace colod::hidden {

/// `mesh` with the flagged faces cut where other faces of `mesh` meet them; `face_of[i]` is the
/// face that face i is a piece of. New vertices are rounded to `grid` metres and equal ones merged.
/// Faces that none meets stay whole, and so do those in which too many lines would cross.
struct Pieces {
  Mesh mesh;
  std::vector<int> face_of;
  int left_whole;  ///< faces in which too many lines would cross
};
Pieces cut_faces(const Mesh& mesh, const std::vector<char>& is_cut, double grid);

}  // namespace colod::hidden
