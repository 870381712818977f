// Based on: progressive densification (P. Axelsson, 2000) over a pyramid of block minima; gaps are
// filled by push and pull (S. Gortler et al., The Lumigraph, 1996).
// Differs: a place that leans as a whole is set level first; what was taken for ground and is
// bounded by steps downward is given up again.
#include "terrain.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "parameters.h"

namespace colod {

namespace {

using namespace parameters::terrain;

/// A grid of heights, NaN: none.
struct Grid {
  int width = 0, height = 0;
  std::vector<float> z;

  Grid(int w, int h) : width(w), height(h), z(static_cast<std::size_t>(w) * h, NAN) {}
  float& at(int x, int y) { return z[static_cast<std::size_t>(y) * width + x]; }
  float at(int x, int y) const { return z[static_cast<std::size_t>(y) * width + x]; }
  float clamped(int x, int y) const {
    return at(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1));
  }
  bool holds(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};

/// Half as wide and high: of four cells what `combine` makes of the known ones.
template <typename Combine>
Grid halved(const Grid& from, Combine combine) {
  Grid out((from.width + 1) / 2, (from.height + 1) / 2);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      std::vector<float> four;
      for (int k = 0; k < 4; ++k) {
        const int u = 2 * x + k % 2, v = 2 * y + k / 2;
        if (from.holds(u, v) && !std::isnan(from.at(u, v))) four.push_back(from.at(u, v));
      }
      if (!four.empty()) out.at(x, y) = combine(four);
    }
  return out;
}

/// The value between the middles of a grid of half the resolution.
float between(const Grid& coarse, int x, int y) {
  const int u = (x - 1) >> 1, v = (y - 1) >> 1;
  const float s = (x & 1) ? 0.25f : 0.75f, t = (y & 1) ? 0.25f : 0.75f;
  return (1 - t) * ((1 - s) * coarse.clamped(u, v) + s * coarse.clamped(u + 1, v)) +
         t * ((1 - s) * coarse.clamped(u, v + 1) + s * coarse.clamped(u + 1, v + 1));
}

/// Gaps take what lies around them, smoothly.
Grid filled(Grid grid) {
  const bool has_gap =
      std::any_of(grid.z.begin(), grid.z.end(), [](float z) { return std::isnan(z); });
  if (!has_gap) return grid;
  if (grid.width * grid.height <= 1) {
    std::fill(grid.z.begin(), grid.z.end(), 0.0f);
    return grid;
  }
  const Grid coarse = filled(halved(grid, [](const std::vector<float>& four) {
    float sum = 0;
    for (const float z : four) sum += z;
    return sum / static_cast<float>(four.size());
  }));
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x)
      if (std::isnan(grid.at(x, y))) grid.at(x, y) = between(coarse, x, y);
  return grid;
}

/// The middle one of up to nine neighbours: spikes and pits of one cell go.
Grid calmed(const HeightMap& map) {
  Grid in(map.width, map.height), out(map.width, map.height);
  in.z = map.top;
  for (int y = 0; y < in.height; ++y)
    for (int x = 0; x < in.width; ++x) {
      if (std::isnan(in.at(x, y))) continue;
      std::vector<float> near;
      for (int k = 0; k < 9; ++k)
        if (const float z = in.clamped(x + k % 3 - 1, y + k / 3 - 1); !std::isnan(z))
          near.push_back(z);
      std::nth_element(near.begin(), near.begin() + static_cast<long>(near.size() / 2), near.end());
      out.at(x, y) = near[near.size() / 2];
    }
  return out;
}

/// The least, or greatest, of nine cells.
Grid extreme(const Grid& from, bool is_least) {
  Grid out(from.width, from.height);
  for (int y = 0; y < from.height; ++y)
    for (int x = 0; x < from.width; ++x)
      for (int k = 0; k < 9; ++k) {
        const float z = from.clamped(x + k % 3 - 1, y + k / 3 - 1);
        float& best = out.at(x, y);
        if (std::isnan(best) || (is_least ? z < best : z > best)) best = z;
      }
  return out;
}

/// One level: blocks that lie near to what coarser ones expect are ground.
Grid refined(const Grid& least, const Grid& coarse, double side) {
  Grid ground(least.width, least.height);
  const auto allowed = static_cast<float>(kNoiseOfCell + kSlope * side);
  for (int y = 0; y < least.height; ++y)
    for (int x = 0; x < least.width; ++x)
      if (least.at(x, y) - between(coarse, x, y) <= allowed) ground.at(x, y) = least.at(x, y);
  return filled(std::move(ground));
}

/// Levels, parted by steps, and what each is bounded by.
class Levels {
 public:
  Levels(const Grid& top, double cell, std::vector<char>& is_ground)
      : top_(top), cell_(cell), is_ground_(is_ground) {}

  /// Hills: what goes on smoothly into ground, more than it drops, is ground; of what mostly walls
  /// rise from, as from streets and gardens, some of its rim is enough.
  void join_hills() {
    each_level(false, [&](const Level& level) {
      const bool is_foot = level.down < kFootRim * (level.down + level.up);
      const double least = is_foot ? kFootJoined : kJoined;
      if (level.smooth > least * (level.down + level.smooth)) mark(level, 1);
    });
  }

  /// Takes from the ground what is bounded by steps downward.
  void give_up_roofs() {
    each_level(true, [&](const Level& level) {
      const double area = static_cast<double>(level.cells.size()) * cell_ * cell_;
      const bool drops = level.down > kRoofRim * (level.down + level.up) &&
                         level.down * cell_ > kDropping * 4 * std::sqrt(area);
      if (area > kLeastLevel && drops) mark(level, 0);
    });
  }

 private:
  struct Level {
    std::vector<std::size_t> cells;
    double down = 0, up = 0, smooth = 0;  // sides of cells along its rim
  };

  template <typename Body>
  void each_level(bool is_ground, Body body) {
    std::vector<char> is_seen(is_ground_.size(), 0);
    const std::vector<char> before = is_ground_;
    for (std::size_t start = 0; start < before.size(); ++start)
      if (before[start] == is_ground && !is_seen[start] && !std::isnan(top_.z[start]))
        body(walk(start, before, is_seen));
  }

  void mark(const Level& level, char is_ground) {
    for (const std::size_t i : level.cells) is_ground_[i] = is_ground;
  }

  Level walk(std::size_t start, const std::vector<char>& before, std::vector<char>& is_seen) const {
    Level level;
    level.cells = {start};
    is_seen[start] = 1;
    for (std::size_t n = 0; n < level.cells.size(); ++n) {
      const std::size_t i = level.cells[n];
      const int x = static_cast<int>(i % static_cast<std::size_t>(top_.width));
      const int y = static_cast<int>(i / static_cast<std::size_t>(top_.width));
      for (const auto& [u, v] : {std::pair{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}}) {
        if (!top_.holds(u, v) || std::isnan(top_.at(u, v))) continue;
        const std::size_t j = static_cast<std::size_t>(v) * top_.width + u;
        const bool is_even = std::abs(top_.z[j] - top_.z[i]) < kLevelStep;
        if (before[j] == before[start] && is_even) {
          if (!is_seen[j]) is_seen[j] = 1, level.cells.push_back(j);
          continue;
        }
        level.smooth += is_even;
        level.down += extreme_near(u, v, false) - top_.z[i] < -kWall;
        level.up += extreme_near(u, v, true) - top_.z[i] > kWall;
      }
    }
    return level;
  }

  /// Walls melt over some cells.
  float extreme_near(int x, int y, bool is_high) const {
    constexpr int kReach = 4, kSide = 2 * kReach + 1;
    float best = top_.at(x, y);
    for (int k = 0; k < kSide * kSide; ++k) {
      const float z = top_.clamped(x + k % kSide - kReach, y + k / kSide - kReach);
      if (is_high ? z > best : z < best) best = z;
    }
    return best;
  }

  const Grid& top_;
  double cell_;
  std::vector<char>& is_ground_;
};

/// Heights a + b · x + c · y over a grid's cells.
Vec3 fitted_plane(const Grid& grid, const Vec3& before, double reach) {
  Eigen::Matrix3d squares = 1e-9 * Eigen::Matrix3d::Identity();
  Vec3 sums = Vec3::Zero();
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      const float z = grid.at(x, y);
      if (std::isnan(z)) continue;
      const Vec3 at(1, x, y);
      const double above = std::max(0.0, z - before.dot(at)) / reach;
      const double weight = 1 / (1 + above * above);
      squares += weight * at * at.transpose();
      sums += weight * z * at;
    }
  return squares.ldlt().solve(sums);
}

/// How the whole place leans, by the lowest heights of its blocks: of a slope's blocks the lowest
/// places lie at their lower ends, which would be taken for the ground of all of a block. What
/// stands above, as blocks without any ground do, counts little. What leans little is level enough,
/// or terraces.
Vec3 lean_of(Grid least, double cell) {
  double side = cell;
  for (; side < kLeanBlock; side *= 2)
    least = halved(least, [](const std::vector<float>& four) {
      return *std::min_element(four.begin(), four.end());
    });
  Vec3 plane = fitted_plane(least, Vec3::Zero(), 1e9);
  for (int i = 0; i < kLeanRounds; ++i) plane = fitted_plane(least, plane, kLeanReach);
  if (plane.tail<2>().norm() < kLeastLean * side) return Vec3::Zero();
  return Vec3(0, plane[1] * cell / side, plane[2] * cell / side);
}

/// Adds what a plane has at each cell, so many times.
void tilt(std::vector<float>& z, int width, const Vec3& plane, double times) {
  for (std::size_t i = 0; i < z.size(); ++i) {
    const auto w = static_cast<std::size_t>(width);
    z[i] += static_cast<float>(
        times * (plane[1] * static_cast<double>(i % w) + plane[2] * static_cast<double>(i / w)));
  }
}

}  // namespace

std::vector<float> find_terrain(const HeightMap& map) {
  if (!map.ground.empty()) {
    Grid told(map.width, map.height);
    told.z = map.ground;
    return filled(std::move(told)).z;
  }
  std::vector<Grid> least = {calmed(map)};
  const Vec3 lean = lean_of(least[0], map.cell);
  tilt(least[0].z, map.width, lean, -1);
  std::vector<double> side = {map.cell};
  while (side.back() < kWidest && std::min(least.back().width, least.back().height) > 2) {
    least.push_back(halved(least.back(), [](const std::vector<float>& four) {
      return *std::min_element(four.begin(), four.end());
    }));
    side.push_back(2 * side.back());
  }
  Grid ground = extreme(extreme(filled(least.back()), true), false);
  for (std::size_t k = least.size() - 1; k-- > 0;) ground = refined(least[k], ground, side[k]);
  std::vector<char> is_ground(map.size(), 0);
  for (std::size_t i = 0; i < is_ground.size(); ++i)
    is_ground[i] = least[0].z[i] - ground.z[i] < kAboveGround;
  const Grid top = calmed(map);
  Levels levels(top, map.cell, is_ground);
  levels.join_hills();
  levels.give_up_roofs();
  Grid known(map.width, map.height);
  for (std::size_t i = 0; i < is_ground.size(); ++i)
    if (is_ground[i]) known.z[i] = top.z[i];
  return filled(std::move(known)).z;
}

}  // namespace colod
