// Beside the rooms: what space a surface encloses as seen from outside, by voxels. Works on any
// soup: open below, boxes that overlap, rooms and furniture inside, holes of a scan.
#pragma once

#include <utility>
#include <vector>

#include "core/geometry.h"
#include "core/rays.h"

namespace colod {

/// A surface and what answers questions about it.
struct Surface {
  Mesh mesh;
  RayScene rays;

  Surface(Mesh m) : mesh(std::move(m)), rays(mesh) {}
};

/// Cubes of `size` metres from `origin` on; voxel (x, y, z) has the number (z · ny + y) · nx + x.
struct VoxelGrid {
  Vec3 origin = Vec3::Zero();
  double size = 1;
  int nx = 0, ny = 0, nz = 0;

  std::size_t count() const { return static_cast<std::size_t>(nx) * ny * nz; }
  bool holds(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < nx && y < ny && z < nz;
  }
  std::size_t number(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * ny + y) * nx + x;
  }
  Vec3 center(std::size_t voxel) const;
  double volume() const { return size * size * size; }  ///< m³ of one voxel
};

/// About `voxels` cubes over the box, at least 5 cm wide.
VoxelGrid make_grid(const Box& box, std::size_t voxels = 100000);

/// Per voxel whether it is solid: of 33 parallel views of the surface, from straight above and from
/// all sides down to the horizon, that from above does not see the voxel's middle and at most six
/// others do. No view is from below, where scans are open. Under a roof without walls hardly
/// anything is solid, and nothing is in a yard. 33 · (diagonal / size)² rays, in parallel.
std::vector<char> find_solid(const VoxelGrid& grid, const RayScene& surface);

/// Per voxel whether its middle is inside of a closed mesh that looks outward. A ray a column.
std::vector<char> find_inside(const VoxelGrid& grid, const RayScene& closed);

}  // namespace colod
