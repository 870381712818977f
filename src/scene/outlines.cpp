// Sides near to a building's own two directions take them; where that changes its area by much the
// plain outline stays.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "cell_borders.h"
#include "classes.h"
#include "core/flat.h"
#include "parameters.h"

namespace colod {

namespace {

using namespace parameters::outlines;

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
    const double turned = direction + std::round((angle - direction) / kQuarterTurn) * kQuarterTurn;
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

Ring straightened(const HeightMap& map, const std::vector<CellCorner>& corners, double& direction) {
  const Ring ring = with_fewer_corners(map, corners);
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
  const auto borders = borders_of(map, classes.building, classes.buildings);
  for (std::size_t b = 0; b < borders.size(); ++b) {
    Footprint footprint;
    double direction = NAN, area = 0, largest = 0;
    std::vector<Ring> rings, outer, holes;
    for (const std::vector<CellCorner>& corners : borders[b]) {
      rings.push_back(straightened(map, corners, direction));
      if (!rings.back().empty()) largest = std::max(largest, signed_area(rings.back()));
    }
    for (Ring& ring : rings) {
      const double own = ring.empty() ? 0 : signed_area(ring);
      if (own > 0 && own >= std::min(kLeastPart, largest))
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
