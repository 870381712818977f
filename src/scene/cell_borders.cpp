// Based on: D. Douglas, T. Peucker: Algorithms for the reduction of the number of points, 1973.
#include "cell_borders.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "parameters.h"

namespace colod {

namespace {

using parameters::outlines::kStraight;

using Corner = CellCorner;
using Sides = std::multimap<Corner, Corner>;

/// The border of a building's cells as directed sides: what is inside lies to the left.
std::vector<Sides> sides_of(const HeightMap& map, const std::vector<int>& number, int numbers) {
  std::vector<Sides> out(static_cast<std::size_t>(numbers));
  const auto owner = [&](int x, int y) {
    return x < 0 || y < 0 || x >= map.width || y >= map.height ? -1 : number[map.at(x, y)];
  };
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const int own = owner(x, y);
      if (own < 0) continue;
      auto& sides = out[static_cast<std::size_t>(own)];
      if (owner(x, y - 1) != own) sides.insert({{x, y}, {x + 1, y}});
      if (owner(x + 1, y) != own) sides.insert({{x + 1, y}, {x + 1, y + 1}});
      if (owner(x, y + 1) != own) sides.insert({{x + 1, y + 1}, {x, y + 1}});
      if (owner(x - 1, y) != own) sides.insert({{x, y + 1}, {x, y}});
    }
  return out;
}

/// Closed rings; where two meet in a corner each turns to its own side.
std::vector<std::vector<Corner>> rings_of(Sides sides) {
  std::vector<std::vector<Corner>> rings;
  while (!sides.empty()) {
    std::vector<Corner> ring = {sides.begin()->first};
    Corner at = sides.begin()->second, from = sides.begin()->first;
    sides.erase(sides.begin());
    while (at != ring.front()) {
      ring.push_back(at);
      auto [next, end] = sides.equal_range(at);
      const Corner along = {at[0] - from[0], at[1] - from[1]};
      for (auto other = next; other != end; ++other) {  // the one that turns left
        const Corner turn = {other->second[0] - at[0], other->second[1] - at[1]};
        if (along[0] * turn[1] - along[1] * turn[0] > 0) next = other;
      }
      from = at, at = next->second;
      sides.erase(next);
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

double distance(const Vec2& a, const Vec2& b, const Vec2& p) {
  const Vec2 along = b - a;
  const double length = along.squaredNorm();
  const double t = length > 0 ? std::clamp((p - a).dot(along) / length, 0.0, 1.0) : 0;
  return (a + t * along - p).norm();
}

/// Corners between `from` and `to` (both kept) that the line between leaves too far out.
void keep_far(const Ring& ring, std::size_t from, std::size_t to, std::vector<char>& is_kept) {
  std::vector<std::array<std::size_t, 2>> open = {{from, to}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    double most = kStraight;
    std::size_t far = a;
    for (std::size_t i = a + 1; i < b; ++i)
      if (const double d = distance(ring[a], ring[b % ring.size()], ring[i]); d > most)
        most = d, far = i;
    if (far == a) continue;
    is_kept[far] = 1;
    open.push_back({a, far}), open.push_back({far, b});
  }
}

}  // namespace

std::vector<std::vector<std::vector<CellCorner>>> borders_of(const HeightMap& map,
                                                             const std::vector<int>& number,
                                                             int numbers) {
  std::vector<std::vector<std::vector<CellCorner>>> out;
  for (Sides& sides : sides_of(map, number, numbers)) out.push_back(rings_of(std::move(sides)));
  return out;
}

Ring with_fewer_corners(const HeightMap& map, const std::vector<CellCorner>& corners) {
  Ring ring;
  for (const Corner& c : corners) ring.push_back(map.origin + map.cell * Vec2(c[0], c[1]));
  std::size_t far = 0;
  for (std::size_t i = 1; i < ring.size(); ++i)
    if ((ring[i] - ring[0]).norm() > (ring[far] - ring[0]).norm()) far = i;
  std::vector<char> is_kept(ring.size(), 0);
  is_kept[0] = is_kept[far] = 1;
  keep_far(ring, 0, far, is_kept);
  keep_far(ring, far, ring.size(), is_kept);
  Ring out;
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (is_kept[i]) out.push_back(ring[i]);
  // Where it began may be no corner.
  if (out.size() > 3 && distance(out.back(), out[1], out[0]) < kStraight) out.erase(out.begin());
  return out;
}

double main_direction(const Ring& ring) {
  constexpr int kBins = 90;
  std::array<double, kBins> length{};
  const auto bin = [](double angle) {
    const double part = angle / kQuarterTurn - std::floor(angle / kQuarterTurn);
    return std::min(kBins - 1, static_cast<int>(part * kBins));
  };
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 side = ring[(i + 1) % ring.size()] - ring[i];
    length[static_cast<std::size_t>(bin(std::atan2(side.y(), side.x())))] += side.norm();
  }
  double best = 0;
  int at = 0;
  for (int b = 0; b < kBins; ++b) {
    double sum = 0;
    for (int d = -3; d <= 3; ++d) sum += length[static_cast<std::size_t>((b + d + kBins) % kBins)];
    if (sum > best) best = sum, at = b;
  }
  // The mean of what lies near.
  double mean = 0, weight = 0;
  for (int d = -3; d <= 3; ++d) {
    const double l = length[static_cast<std::size_t>((at + d + kBins) % kBins)];
    mean += l * d, weight += l;
  }
  return (at + 0.5 + (weight > 0 ? mean / weight : 0)) * kQuarterTurn / kBins;
}

}  // namespace colod
