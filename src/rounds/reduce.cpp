// Based on: rounds.h.
// Differs: the paper's layers drop whole segments and keep every plane of the others. A round shape
// that stays gets fewer sides, as many as every other one of the layer.
// Notation: a run is a smooth part of the profile, whose rows follow each other with about the same
// length; a chord is a row of the result.
#include "reduce.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "parameters.h"
#include "sides.h"

namespace colod {
namespace {

using namespace parameters::round_layers;

using rounds::kMostStep;

/// Rows first … last − 1.
struct Run {
  int first, last;
};

double turn_between(const RoundShape::Row& a, const RoundShape::Row& b) {
  return std::acos(std::clamp(a.normal().dot(b.normal()), -1.0, 1.0));
}

/// Radians from row r − 1 to r, positive where the profile bulges; 0: too little to tell.
double bend_before(const std::vector<RoundShape::Row>& rows, int r) {
  const Vec2 a = rows[r - 1].to - rows[r - 1].from, b = rows[r].to - rows[r].from;
  const double bend = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  return std::abs(bend) < kLeastTurn ? 0 : bend;
}

std::vector<Run> find_runs(const std::vector<RoundShape::Row>& rows) {
  std::vector<Run> runs;
  double bend = 0;  // of the run so far: an onion's bulb ends where its tip begins
  for (int r = 0; r < static_cast<int>(rows.size()); ++r) {
    bool is_smooth = r > 0 && rows[r].is_joined;
    if (is_smooth) {
      const double a = (rows[r - 1].to - rows[r - 1].from).norm();
      const double b = (rows[r].to - rows[r].from).norm();
      is_smooth = turn_between(rows[r - 1], rows[r]) <= kMostStep &&
                  std::max(a, b) <= kSameLength * std::min(a, b) &&
                  bend * bend_before(rows, r) >= 0;
    }
    if (!is_smooth) {
      runs.push_back({r, r + 1});
      bend = 0;
      continue;
    }
    ++runs.back().last;
    if (bend == 0) bend = bend_before(rows, r);
  }
  return runs;
}

/// As many chords as the run's turn asks for.
int count_chords(const std::vector<RoundShape::Row>& rows, const Run& run, double turn) {
  const int n = run.last - run.first;
  if (n == 1) return 1;
  double total = 0;
  for (int r = run.first + 1; r < run.last; ++r) total += turn_between(rows[r - 1], rows[r]);
  total *= static_cast<double>(n) / (n - 1);   // half a turn at both ends
  const int least = total > turn / 2 ? 2 : 1;  // one alone would cut a bulb off
  const int chords = std::max(least, static_cast<int>(std::ceil(total / turn - 0.1)));
  return chords > kHardlyFewerSides * n ? n : chords;
}

Vec2 point_at(const std::vector<RoundShape::Row>& rows, const Run& run, double t) {
  const int r = std::clamp(run.first + static_cast<int>(std::floor(t)), run.first, run.last - 1);
  const double part = t - (r - run.first);
  return rows[r].from + part * (rows[r].to - rows[r].from);
}

/// Per old column the new one; sets step, columns and direction, returns what distances from the
/// axis are multiplied by.
double divide_columns(const RoundShape& shape, double turn, RoundShape& result,
                      std::vector<int>& column) {
  column.resize(shape.columns);
  for (int c = 0; c < shape.columns; ++c) column[c] = c;
  const double whole = shape.columns * shape.step;
  int count = std::max(shape.is_closed ? 4 : 2, static_cast<int>(std::lround(whole / turn)));
  if (shape.is_closed) count += count % 2;  // inner walls face a column
  if (count > kHardlyFewerSides * shape.columns) return 1;
  result.columns = count;
  result.step = whole / count;
  if (!shape.is_closed) {
    const double azimuth = 0.5 * (result.step - shape.step);
    result.across =
        std::cos(azimuth) * shape.across + std::sin(azimuth) * shape.axis.cross(shape.across);
    for (int c = 0; c < shape.columns; ++c)
      column[c] = std::min(count - 1, static_cast<int>((c + 0.5) * count / shape.columns));
    return std::cos(result.step / 2) / std::cos(shape.step / 2);
  }
  // All of a building look the same ways, along and across its walls.
  result.across = std::abs(shape.axis.z()) > 0.5 ? Vec3::UnitX() : Vec3::UnitZ();
  const Vec3 beside = shape.axis.cross(result.across);
  for (int c = 0; c < shape.columns; ++c) {
    const Vec3 d = shape.direction(c);
    const double azimuth = std::atan2(beside.dot(d), result.across.dot(d));
    column[c] = (static_cast<int>(std::floor(azimuth / result.step + 0.5 + 1e-6)) + count) % count;
  }
  return std::sqrt(shape.columns * std::tan(shape.step / 2) / (count * std::tan(result.step / 2)));
}

}  // namespace

RoundShape reduce_round(const RoundShape& shape, double turn) {
  RoundShape result = shape;
  std::vector<int> column, row(shape.rows.size());
  const double scale = divide_columns(shape, turn, result, column);
  const auto scaled = [scale](Vec2 x) { return Vec2(scale * x.x(), x.y()); };
  result.rows.clear();
  for (const Run& run : find_runs(shape.rows)) {
    const int n = run.last - run.first, chords = count_chords(shape.rows, run, turn);
    const int first = static_cast<int>(result.rows.size());
    for (int c = 0; c < chords; ++c)
      result.rows.push_back({scaled(point_at(shape.rows, run, static_cast<double>(c) * n / chords)),
                             scaled(point_at(shape.rows, run, (c + 1.0) * n / chords)),
                             c > 0 || shape.rows[run.first].is_joined});
    for (int r = 0; r < n; ++r)
      row[run.first + r] = first + static_cast<int>((r + 0.5) * chords / n);
  }
  std::map<std::pair<int, int>, RoundShape::Side> sides;
  for (const RoundShape::Side& old : shape.sides) {
    const int r = row[old.row], c = column[old.column];
    RoundShape::Side& side = sides.try_emplace({r, c}, RoundShape::Side{r, c, {}, 0}).first->second;
    side.faces.insert(side.faces.end(), old.faces.begin(), old.faces.end());
    side.area += old.area;
  }
  result.sides.clear();
  for (auto& [key, side] : sides) {
    std::sort(side.faces.begin(), side.faces.end());
    result.sides.push_back(std::move(side));
  }
  return result;
}

double turn_within(const RoundShape& shape, double tolerance) {
  double radius = tolerance;
  for (const RoundShape::Row& r : shape.rows)
    radius = std::max({radius, std::abs(r.from.x()), std::abs(r.to.x())});
  return 2 * std::acos(1 - tolerance / radius);
}

}  // namespace colod
