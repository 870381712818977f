// Inside room `visibility`: the rays of one direction, side by side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace colod::casting {

/// Voxels that share their candidates.
constexpr std::size_t kBlock = 64;

/// The voxels of some rows of a slice in the order of their offset across a direction.
class Order {
 public:
  std::vector<double> across, along;  ///< padded with zeros to whole blocks
  std::vector<std::uint32_t> voxel;   ///< counted from the rows' first; as many as there are

  /// `x` and `y` of the rows' voxels, `y` of each row.
  void make(const std::vector<double>& x, const double* y, std::size_t rows, double dx, double dy);

  /// How many offsets are below `t`, or not above it.
  std::size_t count_below(double t) const { return count_until(t, false); }
  std::size_t count_to(double t) const { return count_until(t, true); }

  static std::size_t bytes(std::size_t count) { return 24 * count; }

 private:
  std::size_t bin(double t) const;
  std::size_t count_until(double t, bool is_closed) const;

  double low_ = 0, scale_ = 0;
  std::vector<std::uint32_t> first_;  ///< of each of `count` + 1 bins, and behind the last
};

}  // namespace colod::casting
