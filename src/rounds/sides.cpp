// Based on: rounds.h.
// Differs: the paper has no such step.
// Notation: turned back by its column, a side is a straight line in the half-plane of (away from
// the axis, along it): normal n, distance d. All sides of a row are one line there.
#include "sides.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace colod::rounds {
namespace {

constexpr std::size_t kMostRows = 400;

/// A line in the half-plane, and who lies on it.
struct Line {
  Vec2 normal;
  double offset;
  std::vector<std::pair<int, int>> faces;  ///< (column, face)
};

/// The column that looks where the face does; −1: none.
int column_of(const RoundShape& shape, const Vec3& normal) {
  const Vec3 beside = shape.axis.cross(shape.across);
  const double x = shape.across.dot(normal), y = beside.dot(normal);
  if (std::hypot(x, y) < kSteepest) return -1;
  const int column = static_cast<int>(std::lround(std::atan2(y, x) / shape.step));
  if (shape.is_closed) return (column + shape.columns) % shape.columns;
  const int turn = static_cast<int>(std::lround(2 * std::numbers::pi / shape.step));
  const int unwrapped = column < 0 ? column + turn : column;
  return unwrapped < shape.columns ? unwrapped : -1;
}

/// What lines are made of, the same for every tolerance.
struct Material {
  std::vector<char> is_founder;            ///< per face
  std::vector<std::pair<int, int>> faces;  ///< (face, column): founders first, then by size
  std::vector<Vec3> directions;            ///< per column
};

Material gather(const Facets& facets, const std::vector<int>& founders, const RoundShape& shape) {
  Material m;
  m.is_founder.assign(facets.normal.size(), 0);
  for (const int f : founders) m.is_founder[f] = 1;
  for (int f = 0; f < static_cast<int>(facets.normal.size()); ++f) {
    if (facets.is_taken[f] || facets.area[f] <= 0) continue;
    const int column = column_of(shape, facets.normal[f]);
    if (column >= 0) m.faces.emplace_back(f, column);
  }
  std::stable_sort(m.faces.begin(), m.faces.end(), [&](const auto& a, const auto& b) {
    return std::make_pair(-m.is_founder[a.first], -facets.area[a.first]) <
           std::make_pair(-m.is_founder[b.first], -facets.area[b.first]);
  });
  for (int k = 0; k < shape.columns; ++k) m.directions.push_back(shape.direction(k));
  return m;
}

class Sorter {
 public:
  Sorter(const Facets& facets, const Material& material, const RoundShape& shape, double exact)
      : facets_(facets), material_(material), shape_(shape), exact_(exact) {}

  /// Large faces found the lines that small ones join.
  std::vector<Line> lines() {
    for (const auto& [face, column] : material_.faces) place(face, column);
    return std::move(lines_);
  }

 private:
  Vec2 turned_back(const Vec3& x, int column) const {
    return {material_.directions[column].dot(x), shape_.axis.dot(x)};
  }
  /// The farthest corner of a face from a line.
  double reach(int face, int column, const Vec2& normal, double offset) const {
    double most = 0;
    for (const int v : facets_.mesh.faces[face]) {
      const Vec2 x = turned_back(facets_.mesh.vertices[v] - shape_.center, column);
      most = std::max(most, std::abs(normal.dot(x) - offset));
    }
    return most;
  }
  void place(int face, int column) {
    const Vec2 own = turned_back(facets_.normal[face], column).normalized();
    double least = exact_;
    Line* nearest = nullptr;
    for (Line& line : lines_) {
      if (line.normal.dot(own) < kAlike) continue;
      const double r = reach(face, column, line.normal, line.offset);
      if (r < least) least = r, nearest = &line;
    }
    if (!nearest) {
      if (!material_.is_founder[face] || lines_.size() == kMostRows) return;
      double offset = 0;
      for (const int v : facets_.mesh.faces[face])
        offset += own.dot(turned_back(facets_.mesh.vertices[v] - shape_.center, column)) / 3;
      if (reach(face, column, own, offset) > exact_) return;
      nearest = &lines_.emplace_back(Line{own, offset, {}});
    }
    nearest->faces.emplace_back(column, face);
  }

  const Facets& facets_;
  const Material& material_;
  const RoundShape& shape_;
  double exact_;
  std::vector<Line> lines_;
};

/// Several columns side by side have a face on it.
bool is_row(const Line& line, const RoundShape& shape) {
  std::vector<char> has(shape.columns, 0);
  for (const auto& [column, face] : line.faces) has[column] = 1;
  int together = 0;
  for (int k = 0; k < (shape.is_closed ? 2 : 1) * shape.columns; ++k) {
    together = has[k % shape.columns] ? together + 1 : 0;
    if (together >= kLeastTogether) return true;
  }
  return false;
}

/// The rows of a shape. Near an apex neighbours are millimetres apart, so that the tightest
/// tolerance counts at which hardly fewer faces find a row.
std::vector<Line> find_lines(const Facets& facets, const std::vector<int>& founders,
                             const RoundShape& shape) {
  const Material material = gather(facets, founders, shape);
  std::vector<Line> best;
  std::size_t most = 0;
  for (const double exact : {kOffPlane, kOffPlane / 3, kOffPlane / 15}) {
    std::vector<Line> lines = Sorter(facets, material, shape, exact).lines();
    std::erase_if(lines, [&](const Line& line) { return !is_row(line, shape); });
    std::size_t faces = 0;
    for (const Line& line : lines) faces += line.faces.size();
    if (faces < kHardlyFewer * most) break;
    most = std::max(most, faces);
    best = std::move(lines);
  }
  return best;
}

RoundShape::Row extent(const Facets& facets, const RoundShape& shape, const Line& line) {
  const Vec2 along(-line.normal.y(), line.normal.x());
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& [column, face] : line.faces)
    for (const int v : facets.mesh.faces[face]) {
      const Vec3 x = facets.mesh.vertices[v] - shape.center;
      const double t = along.dot(Vec2(shape.direction(column).dot(x), shape.axis.dot(x)));
      low = std::min(low, t), high = std::max(high, t);
    }
  return {line.offset * line.normal + low * along, line.offset * line.normal + high * along};
}

/// Rows that follow each other stand beside each other, and meet where their lines do.
std::vector<int> put_in_order(std::vector<RoundShape::Row>& rows) {
  const int n = static_cast<int>(rows.size());
  std::vector<int> next(n, -1), previous(n, -1), order;
  for (int a = 0; a < n; ++a) {
    double least = kJoined;
    for (int b = 0; b < n; ++b)
      if (const double d = (rows[a].to - rows[b].from).norm();
          b != a && previous[b] < 0 && d < least)
        least = d, next[a] = b;
    if (next[a] >= 0) previous[next[a]] = a;
  }
  std::vector<char> is_placed(n, 0);
  const auto follow = [&](int a) {
    for (; a >= 0 && !is_placed[a]; a = next[a]) is_placed[a] = 1, order.push_back(a);
  };
  for (int a = 0; a < n; ++a)
    if (previous[a] < 0) follow(a);
  for (int a = 0; a < n; ++a) follow(a);  // closed profiles
  std::vector<RoundShape::Row> sorted;
  for (std::size_t i = 0; i < order.size(); ++i) {
    sorted.push_back(rows[order[i]]);
    if (i == 0 || next[order[i - 1]] != order[i]) continue;
    sorted[i].is_joined = true;
    sorted[i - 1].to = sorted[i].from = 0.5 * (sorted[i - 1].to + sorted[i].from);
  }
  rows = std::move(sorted);
  return order;
}

void add_sides(const Facets& facets, int row, Line line, RoundShape& shape) {
  std::sort(line.faces.begin(), line.faces.end());
  for (const auto& [column, face] : line.faces) {
    if (shape.sides.empty() || shape.sides.back().row != row || shape.sides.back().column != column)
      shape.sides.push_back({row, column, {}, 0});
    shape.sides.back().faces.push_back(face);
    shape.sides.back().area += facets.area[face];
  }
}

}  // namespace

Facets collect_facets(const Mesh& mesh) {
  Facets facets{mesh, {}, {}, std::vector<char>(mesh.faces.size(), 0), 0};
  for (const Face& f : mesh.faces) {
    const Vec3 n = (mesh.vertices[f[1]] - mesh.vertices[f[0]])
                       .cross(mesh.vertices[f[2]] - mesh.vertices[f[0]]);
    const double length = n.norm();
    const bool is_good = std::isfinite(length) && length > 1e-12;
    facets.normal.push_back(is_good ? Vec3(n / length) : Vec3(Vec3::Zero()));
    facets.area.push_back(is_good ? 0.5 * length : 0);
    facets.total_area += facets.area.back();
  }
  return facets;
}

bool find_sides(const Facets& facets, const std::vector<int>& founders, RoundShape& shape) {
  std::vector<Line> lines = find_lines(facets, founders, shape);
  for (const Line& line : lines) shape.rows.push_back(extent(facets, shape, line));
  const std::vector<int> order = put_in_order(shape.rows);
  for (std::size_t i = 0; i < order.size(); ++i)
    add_sides(facets, static_cast<int>(i), std::move(lines[order[i]]), shape);
  return !shape.sides.empty();
}

}  // namespace colod::rounds
