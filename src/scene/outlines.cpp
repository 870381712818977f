// Based on: D. Douglas, T. Peucker: Algorithms for the reduction of the number of points, 1973.
// Differs: sides near to a building's own two directions take them; where that changes its area by
// much the plain outline stays.
#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <map>
#include <numbers>
#include <sstream>

#include "classes.h"
#include "core/flat.h"
#include "parameters.h"

namespace colod {

namespace {

using namespace parameters::outlines;
using Ring = std::vector<Vec2>;

using Corner = std::array<int, 2>;

/// The border of a building's cells as directed sides: what is inside lies to the left.
std::vector<std::multimap<Corner, Corner>> borders_of(const HeightMap& map,
                                                      const SceneClasses& classes) {
  std::vector<std::multimap<Corner, Corner>> out(static_cast<std::size_t>(classes.buildings));
  const auto owner = [&](int x, int y) {
    return x < 0 || y < 0 || x >= map.width || y >= map.height ? -1
                                                               : classes.building[map.at(x, y)];
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
std::vector<std::vector<Corner>> rings_of(std::multimap<Corner, Corner> sides) {
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

Ring with_fewer_corners(const Ring& ring) {
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

constexpr double kQuarter = std::numbers::pi / 2;

/// Of most of a ring's length, modulo a quarter turn.
double main_direction(const Ring& ring) {
  constexpr int kBins = 90;
  std::array<double, kBins> length{};
  const auto bin = [](double angle) {
    const double part = angle / kQuarter - std::floor(angle / kQuarter);
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
  return (at + 0.5 + (weight > 0 ? mean / weight : 0)) * kQuarter / kBins;
}

struct Line {
  Vec2 point, along;
};

/// Sides near to the main directions take them; two that follow each other in one direction get a
/// step between them.
Ring squared(const Ring& ring, double direction) {
  std::vector<Line> lines;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 a = ring[i], b = ring[(i + 1) % ring.size()];
    const double angle = std::atan2(b.y() - a.y(), b.x() - a.x());
    const double turned = direction + std::round((angle - direction) / kQuarter) * kQuarter;
    const double used = std::abs(turned - angle) < kSquare ? turned : angle;
    lines.push_back({(a + b) / 2, {std::cos(used), std::sin(used)}});
  }
  Ring out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Line &a = lines[i], &b = lines[(i + 1) % lines.size()];
    const double sine = a.along.x() * b.along.y() - a.along.y() * b.along.x();
    const Vec2 corner = ring[(i + 1) % ring.size()];
    if (std::abs(sine) < 0.2) {  // no crossing that could be trusted
      for (const Line* line : {&a, &b})
        out.push_back(line->point + line->along.dot(corner - line->point) * line->along);
      continue;
    }
    const Vec2 gap = b.point - a.point;
    out.push_back(a.point + (gap.x() * b.along.y() - gap.y() * b.along.x()) / sine * a.along);
  }
  return out;
}

Ring straightened(const HeightMap& map, const std::vector<Corner>& corners, double& direction) {
  Ring ring;
  for (const Corner& c : corners) ring.push_back(map.origin + map.cell * Vec2(c[0], c[1]));
  ring = with_fewer_corners(ring);
  if (ring.size() < 3) return {};
  if (std::isnan(direction)) direction = main_direction(ring);
  const Ring square = squared(ring, direction);
  const bool is_alike =
      std::abs(signed_area(square) - signed_area(ring)) < kAreaChange * std::abs(signed_area(ring));
  return is_alike ? square : ring;
}

std::string number(double value) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(1) << value;
  return out.str();
}

}  // namespace

std::vector<Footprint> outline_buildings(const HeightMap& map, const SceneClasses& classes) {
  std::vector<Footprint> out;
  std::vector<double> height(static_cast<std::size_t>(classes.buildings), 0), cells = height;
  for (std::size_t i = 0; i < map.size(); ++i)
    if (const int b = classes.building[i]; b >= 0) {
      height[static_cast<std::size_t>(b)] += map.top[i] - classes.ground[i];
      ++cells[static_cast<std::size_t>(b)];
    }
  const auto borders = borders_of(map, classes);
  for (std::size_t b = 0; b < borders.size(); ++b) {
    Footprint footprint;
    double direction = NAN, area = 0;
    std::vector<Ring> outer, holes;
    for (const std::vector<Corner>& corners : rings_of(borders[b])) {
      Ring ring = straightened(map, corners, direction);
      const double own = ring.empty() ? 0 : signed_area(ring);
      if (own > kLeastPart)
        outer.push_back(std::move(ring));
      else if (own < -kLeastHole)
        holes.push_back(std::move(ring));
      else
        continue;
      area += own;
    }
    if (outer.empty()) continue;
    std::stable_sort(outer.begin(), outer.end(),
                     [](const Ring& u, const Ring& v) { return signed_area(u) > signed_area(v); });
    for (Ring& ring : outer) footprint.parts.push_back({std::move(ring)});
    for (Ring& hole : holes) footprint.parts[0].push_back(std::move(hole));
    footprint.id = "building-" + std::to_string(out.size() + 1);
    footprint.attributes = {{"id", footprint.id},
                            {"height_m", number(height[b] / cells[b])},
                            {"area_m2", number(area)}};
    out.push_back(std::move(footprint));
  }
  return out;
}

}  // namespace colod
