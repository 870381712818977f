// Based on: nothing published.
// Differs: the same under both rules.
// Notation: none.
#include "sight.h"

#include <algorithm>
#include <bit>

#include "core/flat.h"

namespace colod {
namespace {

// Of all attempts on a building: twice the most seen on real ones (46 000, on 47 cut out of a drone
// scene, November 2026).
constexpr std::int64_t kMostCells = 100000;
// Of one partition: half as many again as seen. Simplifying takes the square of them.
constexpr std::int64_t kLargestPartition = 15000;

}  // namespace

bool is_spent(const Sight& sight) {
  return sight.cells > kMostCells || sight.most_cells > kLargestPartition;
}

void Sight::count(std::int64_t cells_of_partition) {
  cells += cells_of_partition;
  most_cells = std::max(most_cells, cells_of_partition);
}

Sight::Sight(const Planes& planes) : rays(outline_soup(planes.planes)) {}

std::size_t Sight::Hash::operator()(const Vec3& p) const {
  std::uint64_t h = 0;
  for (int i = 0; i < 3; ++i)
    h = (h ^ std::bit_cast<std::uint64_t>(p[i] + 0.0)) * 0x9E3779B97F4A7C15ull, h ^= h >> 29;
  return h;
}

}  // namespace colod
