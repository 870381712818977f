// Based on: surfaces of revolution by the lines that all meet the axis (Pottmann & Wallner,
// "Computational Line Geometry", 2001); votes of pairs instead of a fit, since houses stand around.
// Differs: the paper knows planes only. Here (robust rules) the sides of a dome are found together:
// growing planes one by one joined neighbours into patches with chips between them.
// Notation: a meridian is an edge between two columns; seen along the axis it lies on the line that
// halves the angle of both sides, and that line meets the axis. Columns are counted
// counter-clockwise.
#include "rounds.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>

#include "core/flat.h"
#include "sides.h"
#include "stretches.h"

namespace colod {
namespace rounds {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kMostEdges = 50000;  // curved edges; scans have more
constexpr std::size_t kSamples = 96;  // meridians that votes begin with
constexpr std::size_t kPartners = 4;  // of each
constexpr int kMostShapes = 32;
constexpr std::size_t kMostDirections = 3;  // of level axes

/// An edge of a face with an area.
struct EdgeUse {
  int low, high, face;
};

/// By both vertices, then by face: put where their lower vertex says, of which few have many.
std::vector<EdgeUse> sorted_edges(const Facets& facets) {
  const Mesh& mesh = facets.mesh;
  const auto for_each = [&](auto&& take) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      for (std::size_t k = 0; facets.area[f] > 0 && k < 3; ++k) {
        const auto [low, high] = std::minmax(mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]);
        take(EdgeUse{low, high, static_cast<int>(f)});
      }
  };
  std::vector<std::size_t> first(mesh.vertices.size() + 1, 0);
  for_each([&](const EdgeUse& use) { ++first[static_cast<std::size_t>(use.low) + 1]; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<EdgeUse> out(first.back());
  std::vector<std::size_t> next = first;
  for_each([&](const EdgeUse& use) { out[next[static_cast<std::size_t>(use.low)]++] = use; });
  for (std::size_t v = 0; v + 1 < first.size(); ++v)
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(first[v]),
              out.begin() + static_cast<std::ptrdiff_t>(first[v + 1]),
              [](const EdgeUse& a, const EdgeUse& b) {
                return std::tie(a.high, a.face) < std::tie(b.high, b.face);
              });
  return out;
}

std::vector<BentEdge> bent_edges(const Facets& facets) {
  const std::vector<EdgeUse> uses = sorted_edges(facets);
  const double most = std::cos(kLeastBend), least = std::cos(kMostStep);
  std::vector<BentEdge> edges;
  for (std::size_t i = 0, end; i < uses.size(); i = end) {
    for (end = i;
         end < uses.size() && uses[end].low == uses[i].low && uses[end].high == uses[i].high;)
      ++end;
    if (end - i != 2) continue;
    const int f = uses[i].face, g = uses[i + 1].face;
    const double cosine = facets.normal[f].dot(facets.normal[g]);
    if (cosine > most || cosine < least) continue;
    const Vec3 &a = facets.mesh.vertices[uses[i].low], &b = facets.mesh.vertices[uses[i].high];
    edges.push_back({0.5 * (a + b), b - a, {f, g}});
  }
  return edges;
}

/// A meridian seen along the axis.
struct Meridian {
  Vec2 at, outward;  ///< unit: between both sides' directions
  double step;       ///< radians between these
  double weight;     ///< m² of both sides
  std::array<int, 2> faces;
};

std::vector<Meridian> meridians_along(const Facets& facets, const std::vector<BentEdge>& edges,
                                      const Axes& axes) {
  constexpr double kLevel = 0.01;  // a side that looks along the axis has no direction
  std::vector<Meridian> result;
  for (const BentEdge& e : edges) {
    if (facets.is_taken[e.faces[0]] || facets.is_taken[e.faces[1]]) continue;
    const Vec2 a = axes.flat(facets.normal[e.faces[0]]), b = axes.flat(facets.normal[e.faces[1]]);
    if (a.norm() < kLevel || b.norm() < kLevel) continue;
    const Vec2 out = a.normalized() + b.normalized();
    const double step = std::abs(std::atan2(cross(a, b), a.dot(b)));
    if (step < kLeastStep || step > kMostStep) continue;
    result.push_back({axes.flat(e.middle), out.normalized(), step,
                      facets.area[e.faces[0]] + facets.area[e.faces[1]], e.faces});
  }
  return result;
}

bool is_alike(const Meridian& m, double step) {
  return std::abs(m.step - step) <= kSameStep * step;
}

/// The meridians about one direction whose faces are not taken. A scan has tens of thousands, of
/// which few share a step.
class Meridians {
 public:
  explicit Meridians(std::vector<Meridian> all) : all_(std::move(all)), by_step_(all_.size()) {
    std::iota(by_step_.begin(), by_step_.end(), 0);
    std::sort(by_step_.begin(), by_step_.end(),
              [&](int a, int b) { return std::tie(all_[a].step, a) < std::tie(all_[b].step, b); });
  }
  const std::vector<Meridian>& all() const { return all_; }
  /// Those with a step, in the order of all.
  std::vector<Meridian> alike(double step) const;
  void drop_taken(const std::vector<char>& is_taken);

 private:
  std::vector<Meridian> all_;
  std::vector<int> by_step_;
};

std::vector<Meridian> Meridians::alike(double step) const {
  auto begin = std::partition_point(by_step_.begin(), by_step_.end(), [&](int i) {
    return all_[i].step < step && !is_alike(all_[i], step);
  });
  const auto end =
      std::partition_point(begin, by_step_.end(), [&](int i) { return is_alike(all_[i], step); });
  std::vector<int> found(begin, end);
  std::sort(found.begin(), found.end());
  std::vector<Meridian> result;
  for (const int i : found) result.push_back(all_[i]);
  return result;
}

void Meridians::drop_taken(const std::vector<char>& is_taken) {
  std::vector<int> place(all_.size(), -1);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (is_taken[all_[i].faces[0]] || is_taken[all_[i].faces[1]]) continue;
    place[i] = static_cast<int>(kept);
    all_[kept++] = all_[i];
  }
  all_.resize(kept);
  std::erase_if(by_step_, [&](int i) { return place[i] < 0; });
  for (int& i : by_step_) i = place[i];
}

bool is_about(const Meridian& m, const Vec2& center) {
  return std::abs(cross(m.outward, m.at - center)) <= kOnAxis;
}

struct Center {
  Vec2 at = Vec2::Zero();
  double step = 0;
  double support = 0;  ///< m²
};

/// Of meridians with the step of one those nearest to it that may be of the same shape.
std::vector<int> partners_of(const std::vector<Meridian>& alike, const Meridian& m) {
  std::vector<std::pair<double, int>> near;
  const double least = std::sin(0.5 * m.step);
  for (std::size_t j = 0; j < alike.size(); ++j)
    if (std::abs(cross(alike[j].outward, m.outward)) > least)
      near.emplace_back((alike[j].at - m.at).squaredNorm(), static_cast<int>(j));
  const std::size_t count = std::min(kPartners, near.size());
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
  std::vector<int> partners;
  for (std::size_t k = 0; k < count; ++k) partners.push_back(near[k].second);
  return partners;
}

/// Every so many square metres one meridian, so that large shapes are surely asked.
std::vector<int> sample(const std::vector<Meridian>& all) {
  double total = 0, passed = 0;
  for (const Meridian& m : all) total += m.weight;
  std::vector<int> samples;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double before = std::floor(passed / total * kSamples);
    passed += all[i].weight;
    if (std::floor(passed / total * kSamples) > before) samples.push_back(static_cast<int>(i));
  }
  return samples;
}

Center vote(const Meridians& meridians) {
  Center best;
  for (const int i : sample(meridians.all())) {
    const Meridian& a = meridians.all()[static_cast<std::size_t>(i)];
    const std::vector<Meridian> alike = meridians.alike(a.step);
    for (const int j : partners_of(alike, a)) {
      const Meridian& b = alike[static_cast<std::size_t>(j)];
      const double t = cross(b.at - a.at, b.outward) / cross(a.outward, b.outward);
      Center trial{a.at + t * a.outward, a.step, 0};
      for (const Meridian& m : alike)
        if (is_about(m, trial.at)) trial.support += m.weight;
      if (trial.support > best.support) best = trial;
    }
  }
  return best;
}

/// The point that is nearest to all lines.
Vec2 meet(const std::vector<Meridian>& lines) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  Vec2 right = Vec2::Zero();
  for (const Meridian& m : lines) {
    const Vec2 n(-m.outward.y(), m.outward.x());
    sum += m.weight * n * n.transpose();
    right += m.weight * n * n.dot(m.at);
  }
  return sum.inverse() * right;
}

/// Equal steps through the meridians' azimuths.
struct Division {
  double first = 0, step = 0;  ///< radians: azimuth of the first meridian
  int count = 0;               ///< from the first to the last
  int found = 0;               ///< different ones
};

Division divide(const std::vector<Meridian>& lines) {
  std::vector<double> azimuths, steps;
  for (const Meridian& m : lines)
    azimuths.push_back(std::atan2(m.outward.y(), m.outward.x())), steps.push_back(m.step);
  std::sort(azimuths.begin(), azimuths.end());
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                   steps.end());
  const double step = steps[steps.size() / 2];
  // The row begins behind the widest gap.
  std::size_t begin = 0;
  double widest = azimuths.front() + 2 * std::numbers::pi - azimuths.back();
  for (std::size_t i = 1; i < azimuths.size(); ++i)
    if (azimuths[i] - azimuths[i - 1] > widest) widest = azimuths[i] - azimuths[i - 1], begin = i;
  std::rotate(azimuths.begin(), azimuths.begin() + static_cast<std::ptrdiff_t>(begin),
              azimuths.end());
  for (std::size_t i = 1; i < azimuths.size(); ++i)
    while (azimuths[i] < azimuths[i - 1]) azimuths[i] += 2 * std::numbers::pi;
  std::vector<int> number(azimuths.size(), 0);
  Division result{0, step, 1, 1};
  double n = 0, k1 = 0, k2 = 0, a1 = 0, ka = 0;
  for (std::size_t i = 0; i < azimuths.size(); ++i) {
    const long ahead = i > 0 ? std::lround((azimuths[i] - azimuths[i - 1]) / step) : 0;
    number[i] = i > 0 ? number[i - 1] + static_cast<int>(ahead) : 0;
    result.found += ahead > 0;
    const double k = number[i];
    n += 1, k1 += k, k2 += k * k, a1 += azimuths[i], ka += k * azimuths[i];
  }
  const double spread = n * k2 - k1 * k1;
  if (spread <= 0) return result;
  result.step = (n * ka - k1 * a1) / spread;
  result.first = (a1 - result.step * k1) / n;
  result.count = number.back() + 1;
  // Closed: the number of sides is whole.
  const double sides = 2 * std::numbers::pi / result.step;
  if (std::abs(sides - std::round(sides)) < 0.01 * sides &&
      result.found >= kClosedShare * std::round(sides)) {
    result.count = static_cast<int>(std::round(sides));
    result.step = 2 * std::numbers::pi / result.count;
    result.first = a1 / n - result.step * k1 / n;
  }
  return result;
}

/// The shape around the best centre, without its rows; no columns: there is none. `founders`: the
/// faces beside its meridians.
RoundShape around(const Axes& axes, const Meridians& meridians, std::vector<int>& founders) {
  RoundShape shape;
  Center center = vote(meridians);
  std::vector<Meridian> lines;
  for (int round = 0; round < 2; ++round) {
    lines = meridians.alike(center.step);
    std::erase_if(lines, [&](const Meridian& m) { return !is_about(m, center.at); });
    if (lines.size() < kLeastMeridians) return shape;
    center.at = meet(lines);
    if (!center.at.allFinite()) return shape;
  }
  const Division division = divide(lines);
  if (division.found < kLeastMeridians) return shape;
  shape.step = division.step;
  shape.is_closed = std::abs(division.count * division.step - 2 * std::numbers::pi) < 1e-9;
  shape.columns = shape.is_closed ? division.count : division.count + 1;
  shape.center = center.at.x() * axes.u + center.at.y() * axes.v;
  shape.axis = axes.w;
  founders.clear();
  for (const Meridian& m : lines) founders.insert(founders.end(), m.faces.begin(), m.faces.end());
  const double azimuth = division.first - 0.5 * division.step;
  shape.across = std::cos(azimuth) * axes.u + std::sin(azimuth) * axes.v;
  return shape;
}

Axes axes_of(const Vec3& w) {
  const Vec3 u = std::abs(w.z()) > 0.5 ? Vec3::UnitX() : Vec3(Vec3::UnitZ().cross(w).normalized());
  return {u, w.cross(u), w};
}

/// Level directions of many bent edges, the longest together first: axes of vaults.
std::vector<Vec3> level_directions(const std::vector<BentEdge>& edges) {
  constexpr double kSame = 0.2 * kDegree;
  std::map<int, std::pair<double, Vec3>> bins;
  for (const BentEdge& e : edges) {
    const double length = e.along.norm();
    if (std::abs(e.along.z()) > 1e-3 * length) continue;
    double azimuth = std::atan2(e.along.y(), e.along.x());
    if (azimuth < -1e-6) azimuth += std::numbers::pi;
    if (azimuth > std::numbers::pi - kSame / 2) azimuth -= std::numbers::pi;
    auto& [sum, along] =
        bins.try_emplace(static_cast<int>(std::lround(azimuth / kSame)), 0, Vec3(Vec3::Zero()))
            .first->second;
    sum += length;
    along += along.dot(e.along) < 0 ? Vec3(-e.along) : e.along;
  }
  std::vector<std::pair<double, int>> order;
  for (const auto& [bin, value] : bins) order.emplace_back(-value.first, bin);
  std::sort(order.begin(), order.end());
  std::vector<Vec3> directions;
  for (std::size_t i = 0; i < std::min(kMostDirections, order.size()); ++i) {
    Vec3 d = bins[order[i].second].second;
    d.z() = 0;
    directions.push_back(d.normalized());
  }
  return directions;
}

bool is_substantial(const RoundShape& shape, double total) {
  double area = 0;
  for (const RoundShape::Side& s : shape.sides) area += s.area;
  return area >= std::max(kLeastArea, kLeastShare * total);
}

/// The shapes about axes of one direction; their faces are taken.
std::vector<RoundShape> find_along(const Vec3& direction, const std::vector<BentEdge>& edges,
                                   Facets& facets) {
  std::vector<RoundShape> shapes;
  const Axes axes = axes_of(direction);
  Meridians meridians(meridians_along(facets, edges, axes));
  for (int trial = 0; trial < kMostShapes; ++trial) {
    std::vector<int> founders;
    RoundShape shape = around(axes, meridians, founders);
    if (shape.columns == 0 || !find_sides(facets, founders, shape)) break;
    for (const RoundShape::Side& s : shape.sides)
      for (const int f : s.faces) facets.is_taken[f] = 1;
    meridians.drop_taken(facets.is_taken);
    if (is_substantial(shape, facets.total_area)) shapes.push_back(std::move(shape));
  }
  return shapes;
}

/// Upright shapes that a stretch makes elliptical: in the mesh without it they are round, all the
/// way, since a part of nearly any curve is nearly round.
std::vector<RoundShape> find_stretched(const Eigen::Matrix3d& stretch, Facets& facets) {
  Mesh mesh = facets.mesh;
  const Eigen::Matrix3d back = stretch.inverse();
  for (Vec3& v : mesh.vertices) v = back * v;
  Facets without = collect_facets(mesh);
  without.is_taken = facets.is_taken;
  std::vector<RoundShape> shapes = find_along(Vec3::UnitZ(), bent_edges(without), without);
  std::erase_if(shapes, [](const RoundShape& s) { return !s.is_closed; });
  for (RoundShape& shape : shapes) {
    shape.stretch = stretch;
    for (RoundShape::Side& side : shape.sides) {
      side.area = 0;
      for (const int f : side.faces) side.area += facets.area[f], facets.is_taken[f] = 1;
    }
  }
  return shapes;
}

}  // namespace
}  // namespace rounds

std::vector<RoundShape> find_rounds(const Source& source, const RuleSet& rules) {
  using namespace rounds;
  std::vector<RoundShape> shapes;
  if (!source.is_mesh()) return shapes;
  Facets facets = collect_facets(source.mesh);
  const std::vector<BentEdge> edges = bent_edges(facets);
  if (edges.size() < kLeastMeridians || edges.size() > kMostEdges) return shapes;
  const auto add = [&](std::vector<RoundShape> more) {
    std::move(more.begin(), more.end(), std::back_inserter(shapes));
  };
  if (rules.has(Rule::kEllipses))
    for (const Eigen::Matrix3d& stretch : find_stretches(facets, edges))
      add(find_stretched(stretch, facets));
  add(find_along(Vec3::UnitZ(), edges, facets));
  for (const Vec3& direction : level_directions(edges)) add(find_along(direction, edges, facets));
  return shapes;
}

}  // namespace colod
