// Based on: space carving from depth maps (Kutulakos and Seitz, "A theory of shape by space
// carving", IJCV 38(3), 2000), but with a vote instead of a proof: one view in five may be wrong,
// since scans have holes and rooms have windows.
// Differs: the same under both rules.
// Notation: a view's direction points from the building to the viewer.
#include "solid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "grains.h"

namespace colod {
namespace {

constexpr double kLeastSize = 0.05;  // metres: nothing smaller is a part of a building's volume
constexpr int kMostSeen = 6;         // views besides the one from above
constexpr double kOffset = 0.382;    // of a pixel: no ray runs along an edge of a level grid
constexpr double kBeside = 0.081;    // of a voxel

/// What one view sees: per pixel the height along the direction of what is hit first.
struct View {
  Vec3 direction, u, v;
  double u_min = 0, v_min = 0, size = 1;
  int nu = 0, nv = 0;
  std::vector<double> height;  // −∞: nothing

  bool sees(const Vec3& p) const {
    const int x = std::clamp(static_cast<int>((p.dot(u) - u_min) / size), 0, nu - 1);
    const int y = std::clamp(static_cast<int>((p.dot(v) - v_min) / size), 0, nv - 1);
    return p.dot(direction) > height[static_cast<std::size_t>(y) * nu + x];
  }
};

std::array<Vec3, 8> corners(const VoxelGrid& g) {
  std::array<Vec3, 8> all;
  const Vec3 size = g.size * Vec3(g.nx, g.ny, g.nz);
  for (int i = 0; i < 8; ++i)
    all[i] = g.origin + Vec3((i & 1) * size.x(), (i >> 1 & 1) * size.y(), (i >> 2) * size.z());
  return all;
}

View look(const VoxelGrid& grid, const RayScene& surface, const Vec3& direction) {
  View view;
  view.direction = direction;
  view.size = grid.size;
  const auto basis = plane_basis(direction);
  view.u = basis[0], view.v = basis[1];
  Box box;  // in (u, v, direction)
  for (const Vec3& c : corners(grid))
    box.extend(Vec3(c.dot(view.u), c.dot(view.v), c.dot(direction)));
  view.u_min = box.min.x(), view.v_min = box.min.y();
  view.nu = static_cast<int>(box.size().x() / view.size) + 1;
  view.nv = static_cast<int>(box.size().y() / view.size) + 1;
  view.height.assign(static_cast<std::size_t>(view.nu) * view.nv,
                     -std::numeric_limits<double>::infinity());
  const double from = box.max.z() + box.diagonal();
  parallel_ranges(view.height.size(), kGrainOfRays, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double x = view.u_min + (static_cast<double>(i % view.nu) + kOffset) * view.size;
      const double y = view.v_min + (static_cast<double>(i / view.nu) + kOffset) * view.size;
      const RayHit hit = surface.first_hit(x * view.u + y * view.v + from * direction, -direction);
      if (hit) view.height[i] = from - hit.distance;
    }
  });
  return view;
}

/// Straight down first, then rings.
std::vector<Vec3> directions() {
  constexpr std::array<double, 3> kElevations_deg = {3, 27, 58};
  std::vector<Vec3> all = {Vec3::UnitZ()};
  for (const Vec3& d : ring_directions(32, kElevations_deg)) all.push_back(d);
  return all;
}

}  // namespace

Vec3 VoxelGrid::center(std::size_t voxel) const {
  const std::size_t x = voxel % nx, y = voxel / nx % ny, z = voxel / nx / ny;
  return origin + size * Vec3(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5,
                              static_cast<double>(z) + 0.5);
}

VoxelGrid make_grid(const Box& box, std::size_t voxels) {
  VoxelGrid grid;
  if (box.is_empty()) return grid;
  const Vec3 size = box.size();
  const auto most = static_cast<double>(voxels);
  const double area = std::max({size.x() * size.y(), size.y() * size.z(), size.z() * size.x()});
  grid.size = std::max(
      {kLeastSize, std::cbrt(size.prod() / most), std::sqrt(area / most), size.maxCoeff() / most});
  grid.origin = box.min;
  grid.nx = static_cast<int>(size.x() / grid.size) + 1;
  grid.ny = static_cast<int>(size.y() / grid.size) + 1;
  grid.nz = static_cast<int>(size.z() / grid.size) + 1;
  return grid;
}

std::vector<char> find_solid(const VoxelGrid& grid, const RayScene& surface) {
  std::vector<View> views;
  for (const Vec3& d : directions()) views.push_back(look(grid, surface, d));
  std::vector<char> is_solid(grid.count(), 0);
  parallel_ranges(is_solid.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 p = grid.center(i);
      if (views[0].sees(p)) continue;
      int seen = 0;
      for (std::size_t k = 1; k < views.size() && seen <= kMostSeen; ++k) seen += views[k].sees(p);
      is_solid[i] = seen <= kMostSeen;
    }
  });
  return is_solid;
}

std::vector<char> find_inside(const VoxelGrid& grid, const RayScene& closed) {
  std::vector<char> is_inside(grid.count(), 0);
  if (is_inside.empty()) return is_inside;
  const double far = 1e4 + 10 * grid.size * (grid.nx + grid.ny + grid.nz);
  parallel_for(
      static_cast<std::size_t>(grid.nx) * grid.ny,
      [&](std::size_t column) {
        // Beside the middle, where diagonals of a level grid's faces would be met twice.
        const Vec3 foot = grid.center(column) + kBeside * grid.size * Vec3(1, -0.53, 0);
        const Vec3 from = foot - Vec3(0, 0, far);
        int depth = 0;
        int z = 0;
        const auto fill = [&](double height) {
          for (; z < grid.nz && grid.size * z < height; ++z)
            if (depth > 0) is_inside[static_cast<std::size_t>(z) * grid.nx * grid.ny + column] = 1;
        };
        for (const RayHit& hit : closed.all_hits(from, Vec3::UnitZ())) {
          fill(hit.distance - far);
          depth += hit.is_inside ? -1 : 1;
        }
      },
      kGrainOfRays);
  return is_inside;
}

}  // namespace colod
