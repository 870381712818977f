// Inside room `bake` only: how a source's surface is turned at a place, for normal maps.
#pragma once

#include <array>
#include <vector>

#include "core/geometry.h"

namespace colod::bake {

/// Normals at the corners of a surface's faces: smooth where faces meet gently, apart at creases.
class SmoothNormals {
 public:
  /// Keeps a reference to the mesh. O(corners · faces about a vertex), in parallel.
  explicit SmoothNormals(const Mesh& mesh);
  /// Unit, at a point of a face; the face's own where it has no area.
  Vec3 at(int face, const Vec3& point) const;

 private:
  const Mesh& mesh_;
  std::vector<std::array<Vec3, 3>> corners_;
};

}  // namespace colod::bake
