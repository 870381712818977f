// Own work: what differs on both sides of a straight line, by medians along it, as heights in one
// place are a chimney or a dormer.
#include "party_walls.h"

#include <algorithm>
#include <cmath>

#include "cell_borders.h"
#include "core/flat.h"
#include "parameters.h"

namespace colod {

namespace {

using namespace parameters::party_walls;

/// A building's cells turned so that its facades run along rows and columns.
struct Turned {
  const HeightMap& map;
  Vec2 along, across;  ///< of a row and of a column
  Vec2 corner;         ///< of both, in their own metres
  int width = 0, height = 0;
  std::vector<int> cell;  ///< of the map; −1: not the building's

  int at(int x, int y) const {
    if (x < 0 || y < 0 || x >= width || y >= height) return -1;
    return cell[static_cast<std::size_t>(y) * width + x];
  }
  float top(int x, int y) const { return map.top[static_cast<std::size_t>(at(x, y))]; }
  /// Between the columns x − 1 and x, at row y.
  Vec2 place(double x, double y) const {
    const Vec2 own = corner + map.cell * Vec2(x, y);
    return own.x() * along + own.y() * across;
  }
};

Turned turned(const HeightMap& map, const std::vector<int>& building,
              const std::vector<std::size_t>& cells, double direction) {
  Turned out{map, {std::cos(direction), std::sin(direction)}, {}, {}, 0, 0, {}};
  out.across = Vec2(-out.along.y(), out.along.x());
  const auto w = static_cast<std::size_t>(map.width);
  const auto middle = [&](std::size_t i) {
    return map.middle(static_cast<int>(i % w), static_cast<int>(i / w));
  };
  Vec2 low(INFINITY, INFINITY), high(-INFINITY, -INFINITY);
  for (const std::size_t i : cells) {
    const Vec2 own(middle(i).dot(out.along), middle(i).dot(out.across));
    low = low.cwiseMin(own), high = high.cwiseMax(own);
  }
  out.corner = low - Vec2::Constant(map.cell / 2);
  const Vec2 size = (high - low) / map.cell;
  out.width = static_cast<int>(size.x()) + 2, out.height = static_cast<int>(size.y()) + 2;
  out.cell.assign(static_cast<std::size_t>(out.width) * out.height, -1);
  const int number = building[cells[0]];
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const Vec2 p = (out.place(x + 0.5, y + 0.5) - map.origin) / map.cell;
      const int u = static_cast<int>(std::floor(p.x())), v = static_cast<int>(std::floor(p.y()));
      if (u < 0 || v < 0 || u >= map.width || v >= map.height) continue;
      if (building[map.at(u, v)] == number)
        out.cell[static_cast<std::size_t>(y) * out.width + x] = static_cast<int>(map.at(u, v));
    }
  return out;
}

/// Cells beside a line that count: beyond what is blurred.
struct Strip {
  int near, far;
  explicit Strip(double cell)
      : near(static_cast<int>(std::ceil(kBlurred / cell))),
        far(std::max(near + 1, static_cast<int>(kStripEnd / cell))) {}
};

/// A piece of a line: how a value steps across it, and how much of that slopes on either side make.
struct Step {
  double whole = 0, of_slope = 0;
  /// Over what slopes may make of it.
  double rest() const { return std::copysign(std::max(0.0, std::abs(whole) - of_slope), whole); }
};

/// Over the rows `from` … `to` of a line.
template <typename Value>
Step step_of(const std::vector<int>& rows, std::size_t from, std::size_t to, const Strip& strip,
             Value value) {
  const int depth = strip.far - strip.near;
  double step = 0, left = 0, right = 0;
  for (std::size_t r = from; r < to; ++r) {
    const int y = rows[r];
    for (int k = strip.near; k <= strip.far; ++k)
      step += (value(k, y) - value(-1 - k, y)) / (depth + 1);
    left += value(-1 - strip.near, y) - value(-1 - strip.far, y);
    right += value(strip.far, y) - value(strip.near, y);
  }
  const double span = static_cast<double>(strip.near + strip.far + 1) / depth;
  const double count = static_cast<double>(to - from);
  return {step / count, std::max(std::abs(left), std::abs(right)) * span / count};
}

/// How a value steps across a line, besides what it changes by on either side of it: per piece of
/// the line, since roofs slope another way farther on; none where few pieces step alike, or where
/// it does not step at both ends, as beside a roof house.
template <typename Value>
double step_across(const std::vector<int>& rows, const Strip& strip, double cell, Value value) {
  const auto cells = [cell](double metres) {
    return static_cast<std::size_t>(std::max(1L, std::lround(metres / cell)));
  };
  const std::size_t piece = cells(kPiece), end = std::min(rows.size(), cells(kEnd));
  std::vector<double> steps;
  for (std::size_t i = 0; i + piece / 2 < rows.size(); i += piece)
    steps.push_back(step_of(rows, i, std::min(rows.size(), i + piece), strip, value).rest());
  if (steps.empty()) return 0;
  const double middle = upper_median(steps);
  const auto is_alike = [middle](double step) {
    return step * middle > 0 && step / middle > kAlikeStep;
  };
  const auto alike = std::count_if(steps.begin(), steps.end(), is_alike);
  if (static_cast<double>(alike) < kAlike * static_cast<double>(steps.size()) ||
      !is_alike(step_of(rows, 0, end, strip, value).whole) ||
      !is_alike(step_of(rows, rows.size() - end, rows.size(), strip, value).whole))
    return 0;
  return std::abs(middle);
}

double score_of(const Turned& t, const std::vector<int>& rows, int x, const Strip& strip) {
  const double step =
      step_across(rows, strip, t.map.cell, [&](int k, int y) { return double(t.top(x + k, y)); });
  double tint = 0;
  for (std::size_t c = 0; c < 3 && !t.map.color.empty(); ++c)
    tint = std::max(tint, step_across(rows, strip, t.map.cell, [&](int k, int y) {
                      return double(t.map.color[static_cast<std::size_t>(t.at(x + k, y))][c]);
                    }));
  return std::hypot(step / kLeastStep, tint / kLeastTint);
}

struct Candidate {
  int x, from, to;
  double score;
};

/// Metres that the building goes on for beyond an end of a line, on one side of it: there the line
/// is where a wing begins.
double overhang(const Turned& t, int x, int from, int to, int beside) {
  int most = 0;
  for (const int column : {x + beside, x - 1 - beside}) {
    int below = 0, above = 0;
    while (t.at(column, from - 1 - below) >= 0) ++below;
    while (t.at(column, to + above) >= 0) ++above;
    most = std::max({most, below, above});
  }
  return most * t.map.cell;
}

/// All lines between two columns, from border to border.
std::vector<Candidate> candidates_of(const Turned& t, bool is_small) {
  const Strip strip(t.map.cell);
  const int beside = static_cast<int>(kHouseWidth / t.map.cell);
  std::vector<Candidate> out;
  for (int x = 1; x < t.width; ++x)
    for (int y = 0; y < t.height; ++y) {
      if (t.at(x, y) < 0 || t.at(x - 1, y) < 0) continue;
      const int from = y;
      while (t.at(x, y) >= 0 && t.at(x - 1, y) >= 0) ++y;
      const double length = (y - from) * t.map.cell;
      if (length < kShortest || length > kLongest) continue;
      std::vector<int> rows;
      for (int v = from; v < y; ++v) {
        bool is_in = true;
        for (int k = 0; k <= beside; ++k) is_in &= t.at(x + k, v) >= 0 && t.at(x - 1 - k, v) >= 0;
        if (is_in) rows.push_back(v);
      }
      if (static_cast<double>(rows.size()) < kWhole * (y - from)) continue;
      if (is_small && overhang(t, x, from, y, strip.far) > kWing) continue;
      const double score = score_of(t, rows, x, strip);
      if (score >= 1) out.push_back({x, from, y, score});
    }
  return out;
}

/// The strongest of those that lie beside each other.
std::vector<Candidate> strongest(std::vector<Candidate> all, double cell) {
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<Candidate> out;
  for (const Candidate& c : all) {
    const bool is_beside = std::any_of(out.begin(), out.end(), [&](const Candidate& o) {
      const int shared = std::min(o.to, c.to) - std::max(o.from, c.from);
      return std::abs(o.x - c.x) * cell < kNarrowest &&
             2 * shared > std::min(o.to - o.from, c.to - c.from);
    });
    if (!is_beside) out.push_back(c);
  }
  return out;
}

}  // namespace

std::vector<PartyWall> find_party_walls(const HeightMap& map, const std::vector<int>& building,
                                        const std::vector<std::size_t>& cells, double direction) {
  std::vector<PartyWall> out;
  const bool is_small = static_cast<double>(cells.size()) * map.cell * map.cell < kWingedHouse;
  for (const double turn : {0.0, kQuarterTurn}) {
    const Turned t = turned(map, building, cells, direction + turn);
    for (const Candidate& c : strongest(candidates_of(t, is_small), map.cell))
      out.push_back({t.place(c.x, c.from - kBeyond), t.place(c.x, c.to + kBeyond), c.score});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const PartyWall& a, const PartyWall& b) { return a.score > b.score; });
  return out;
}

}  // namespace colod
