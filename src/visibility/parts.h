// What the engines of room `visibility` share: which triangles the rays meet, from where and in
// which directions, and what a voxel's counts make of it. Not for other rooms.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "parameters.h"
#include "visibility.h"

namespace colod::casting {

using namespace parameters::visibility;

/// What a voxel's counts make of it.
struct VoxelRule {
  int nr = 0;
  bool is_party = true;

  bool is_valid(int in, int out) const {
    return 2 * in >= nr || (is_party && in >= kPartyInside * nr && out <= kPartyOutside * nr);
  }
  bool is_kept(int in, int out) const { return is_valid(in, out) || 2 * out >= nr; }
  /// No outcome of the `left` rays still to cast makes the voxel kept. Counts only grow, so the
  /// best case of each condition is all of them inside, or all outside.
  bool is_hopeless(int in, int out, int left) const {
    return !is_valid(in + left, out) && 2 * (out + left) < nr;
  }
};

/// The triangles that horizontal rays can meet, in single precision about the job's centre: every
/// engine sees the very same.
struct Soup {
  std::vector<std::array<float, 3>> corners;  ///< three a triangle
  std::vector<int> plane_of_triangle;         ///< rising

  /// Left out when a corner is not finite.
  void add(const Vec3& a, const Vec3& b, const Vec3& c, std::size_t plane);
};

/// d_k = (x, y) at 2πk/n_r.
struct Direction {
  double x, y;
  bool is_inside(const std::array<double, 2>& normal) const {
    return x * normal[0] + y * normal[1] > 0;
  }
};
Direction direction(int k, int nr);

/// What is to be cast.
struct Job {
  Soup soup;
  Vec3 center = Vec3::Zero();                 ///< of the grid's box
  std::vector<std::array<double, 2>> normal;  ///< of each plane, its horizontal part, turned
  VoxelRule rule{};
  bool is_stopping = true;
};
/// The arguments of cast_visibility; `box` of the grid.
Job make_job(const Planes& planes, const VisibilityOptions& options,
             const std::vector<char>& is_active, const std::vector<char>& is_reversed,
             const Box& box);

/// The hits of a run of neighbouring voxels' kept ones, in the order of the voxels.
struct Piece {
  std::vector<Hit> hits;
  std::uint64_t rays = 0;
};

/// Ends a grid of which `first[v + 1]` holds the number of hits of voxel v: `pieces` in the order
/// of the voxels become its hits.
void join_pieces(std::vector<Piece>& pieces, HitGrid& grid);

/// What cast_embree sees along single rays, to the bit where its packet is whole. Safe from several
/// threads.
class Reference {
 public:
  Reference(const Job& job, const HitGrid& grid);
  ~Reference();
  /// 2 × plane + (inner side) of the first hit from a voxel's centre in direction k; −1 nothing.
  int look(std::size_t voxel, int k) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Both fill is_valid, first, hits and rays of a grid of which the rest is set and those are zero.
void cast_embree(const Job& job, bool is_single, HitGrid& grid);
void cast_sweep(const Job& job, HitGrid& grid);

}  // namespace colod::casting
