// Based on: hierarchical levels of detail by proxies; the rectangle of least area about a convex
// hull has a side on one of the hull's (Freeman, Shapira 1975).
// Differs: the error is measured both ways, against what the box stands for, and not guessed from
// its size.
// Notation: half.x() and half.y() half the sides, half.z() the height.
#include "standins.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/rays.h"
#include "measure/switching.h"

namespace colod {

namespace {

constexpr double kHeights[] = {1.0, 0.9, 0.8, 0.7, 0.6, 0.5};  // shares of the building's height
constexpr int kLattice = 16;  // steps along a box's side where it is measured
constexpr double kFinestStep = 0.1;
constexpr double kLeastHalf = 0.05;    // metres: a box has a volume
constexpr double kLeastStep = 1.2;     // from the coarsest level's gsd to its box's
constexpr double kLeastSample = 0.05;  // metres, of pictures that boxes are judged by …
constexpr double kSamples = 4;         // … or so many along the smallest pixel that matters

double cross(const Vec2& o, const Vec2& a, const Vec2& b) {
  return (a - o).x() * (b - o).y() - (a - o).y() * (b - o).x();
}

/// Counter-clockwise (Andrew's monotone chain).
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  const auto less = [](const Vec2& a, const Vec2& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  };
  std::sort(points.begin(), points.end(), less);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec2> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= start + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

Vec2 turned(const Vec2& p, double yaw) {
  return {std::cos(yaw) * p.x() - std::sin(yaw) * p.y(),
          std::sin(yaw) * p.x() + std::cos(yaw) * p.y()};
}

Vec3 to_world(const StandInBox& box, const Vec3& p) {
  const Vec2 xy = turned({p.x(), p.y()}, box.yaw);
  return box.origin + Vec3(xy.x(), xy.y(), p.z());
}

/// The upright box of this yaw about points.
StandInBox box_about(const std::vector<Vec3>& points, double yaw) {
  Box extent;
  for (const Vec3& p : points) {
    const Vec2 xy = turned({p.x(), p.y()}, -yaw);
    extent.extend(Vec3(xy.x(), xy.y(), p.z()));
  }
  const Vec2 middle = turned({extent.center().x(), extent.center().y()}, yaw);
  StandInBox box;
  box.origin = {middle.x(), middle.y(), extent.min.z()};
  box.yaw = yaw;
  const Vec3 size = extent.size();
  box.half = Vec3(0.5 * size.x(), 0.5 * size.y(), size.z()).cwiseMax(kLeastHalf);
  return box;
}

StandInBox least_box_about(const std::vector<Vec3>& points) {
  std::vector<Vec2> flat;
  for (const Vec3& p : points) flat.emplace_back(p.x(), p.y());
  const std::vector<Vec2> hull = convex_hull(std::move(flat));
  StandInBox best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 side = hull[(i + 1) % hull.size()] - hull[i];
    const StandInBox box = box_about(points, std::atan2(side.y(), side.x()));
    const double area = box.half.x() * box.half.y();
    if (!(area < (1 - 1e-9) * least)) continue;
    least = area;
    best = box;
  }
  return best;
}

/// To the box's surface, from inside or outside.
double distance(const StandInBox& box, const Vec3& p) {
  const Vec2 xy = turned(Vec2(p.x() - box.origin.x(), p.y() - box.origin.y()), -box.yaw);
  const double half_height = 0.5 * box.half.z();
  const Vec3 q(std::abs(xy.x()) - box.half.x(), std::abs(xy.y()) - box.half.y(),
               std::abs(p.z() - box.origin.z() - half_height) - half_height);
  return q.maxCoeff() <= 0 ? -q.maxCoeff() : q.cwiseMax(0).norm();
}

/// Points on all six sides.
std::vector<Vec3> lattice(const StandInBox& box) {
  std::vector<Vec3> out;
  const Vec3 middle(0, 0, 0.5 * box.half.z()), half(box.half.x(), box.half.y(), middle.z());
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
      for (int i = 0; i <= kLattice; ++i)
        for (int j = 0; j <= kLattice; ++j) {
          Vec3 p;
          p[axis] = side;
          p[(axis + 1) % 3] = 2.0 * i / kLattice - 1;
          p[(axis + 2) % 3] = 2.0 * j / kLattice - 1;
          out.push_back(to_world(box, middle + half.cwiseProduct(p)));
        }
  return out;
}

/// Points on a mesh, no farther apart than `spacing` along a triangle's edges.
std::vector<Vec3> points_on(const Mesh& mesh, double spacing) {
  std::vector<Vec3> out;
  for (const Face& f : mesh.faces) {
    const Vec3 &a = mesh.vertices[f[0]], u = mesh.vertices[f[1]] - a, v = mesh.vertices[f[2]] - a;
    const double longest = std::max({u.norm(), v.norm(), (u - v).norm()});
    const int n = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, 2 * kLattice);
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) out.push_back(a + (i * u + j * v) / n);
  }
  return out;
}

/// Both ways between a box and those that it replaces.
double deviation(const StandInBox& merged, const StandInBox& a, const StandInBox& b) {
  double worst = 0;
  for (const Vec3& p : lattice(merged))
    worst = std::max(worst, std::min(distance(a, p), distance(b, p)));
  for (const StandInBox* part : {&a, &b})
    for (const Vec3& p : lattice(*part)) worst = std::max(worst, distance(merged, p));
  return worst;
}

std::vector<Vec3> corners(const StandInBox& box) {
  std::vector<Vec3> out;
  for (int c = 0; c < 8; ++c)
    out.push_back(to_world(box, {c & 1 ? box.half.x() : -box.half.x(),
                                 c & 2 ? box.half.y() : -box.half.y(), c & 4 ? box.half.z() : 0}));
  return out;
}

/// The smaller of the boxes about both in either's direction, as high as their mean by footprint.
StandInBox box_about_both(const StandInBox& a, const StandInBox& b) {
  std::vector<Vec3> points = corners(a);
  const std::vector<Vec3> more = corners(b);
  points.insert(points.end(), more.begin(), more.end());
  StandInBox box = box_about(points, a.yaw);
  const StandInBox other = box_about(points, b.yaw);
  if (other.half.x() * other.half.y() < (1 - 1e-9) * box.half.x() * box.half.y()) box = other;
  const double wa = a.half.x() * a.half.y(), wb = b.half.x() * b.half.y();
  const double top =
      (wa * (a.origin.z() + a.half.z()) + wb * (b.origin.z() + b.half.z())) / (wa + wb);
  box.half.z() = std::max(kLeastHalf, top - box.origin.z());
  return box;
}

StandInBox joined(const StandInBox& a, const StandInBox& b) {
  StandInBox box = box_about_both(a, b);
  std::merge(a.buildings.begin(), a.buildings.end(), b.buildings.begin(), b.buildings.end(),
             std::back_inserter(box.buildings));
  return box;
}

/// What merging costs, quickly: how far corners and middles of the joined box's sides lie from the
/// two, or the change of height.
double cost(const StandInBox& a, const StandInBox& b) {
  const StandInBox box = box_about_both(a, b);
  double worst = std::max(std::abs(a.origin.z() + a.half.z() - box.origin.z() - box.half.z()),
                          std::abs(b.origin.z() + b.half.z() - box.origin.z() - box.half.z()));
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) {
      const Vec3 p = to_world(box, {i * box.half.x(), j * box.half.y(), box.half.z()});
      worst = std::max(worst, std::min(distance(a, p), distance(b, p)));
    }
  return worst + std::max(a.error, b.error);
}

/// `coarsest`: the gsd of the level before which the box stands.
double stand_in_gsd(const StandInBox& box, const Mesh& finest, double coarsest,
                    const SwitchFacts& facts) {
  const double least = kLeastStep * coarsest;
  if (facts.measure != "visual") return std::max(least, box.error / facts.pixel_error);
  Mesh mesh = mesh_of(box).mesh();
  for (Vec3& p : mesh.vertices) p += box.origin;
  const double sample = std::max(kLeastSample, least / kSamples);
  return std::max(least, visible_gsd(measure_profile(mesh, finest, sample), facts.visual_error));
}

}  // namespace

StandInBox stand_in_for(const ExportBuilding& building, int index, const SwitchFacts& facts) {
  const Mesh coarsest = building.levels.front().mesh.mesh();
  const Mesh finest = building.levels.back().mesh.mesh();
  StandInBox box = least_box_about(coarsest.vertices);
  const RayScene coarse_scene(coarsest), fine_scene(finest);
  const double spacing =
      std::max(kFinestStep, bounding_box(finest.vertices).diagonal() / (4 * kLattice));
  std::vector<Vec3> points = points_on(finest, spacing);
  const std::vector<Vec3> more = points_on(coarsest, spacing);  // what it gives way to
  points.insert(points.end(), more.begin(), more.end());
  const double height = box.half.z();
  double least = std::numeric_limits<double>::infinity();
  StandInBox best;
  for (const double share : kHeights) {
    box.half.z() = std::max(kLeastHalf, share * height);
    double lacking = 0;
    for (const Vec3& p : points) lacking = std::max(lacking, distance(box, p));
    box.error = lacking;
    for (const Vec3& p : lattice(box)) {  // what the box adds
      if (box.error >= least) break;      // another height is better
      box.error =
          std::max({box.error, fine_scene.nearest(p).distance, coarse_scene.nearest(p).distance});
    }
    if (box.error < least) best = box, least = box.error;
  }
  best.gsd = stand_in_gsd(best, finest, building.levels.front().gsd, facts);
  best.origin += building.origin;
  best.buildings = {index};
  return best;
}

std::optional<double> shared_gsd(const std::vector<double>& own, const SwitchFacts& facts) {
  if (facts.scope != "scene" || own.empty()) return {};
  const double coarsest = facts.layer_gsd.empty() ? 0 : facts.layer_gsd.front();
  return std::max(kLeastStep * coarsest, value_at_share(own, facts.share));
}

std::vector<StandInBox> merge_stand_ins(std::vector<StandInBox> boxes, std::size_t most,
                                        double pixel_error) {
  struct Pair {
    double cost;
    std::size_t other;
  };
  // The cheapest partner with a greater number, of each.
  const auto partner = [&](std::size_t i) {
    Pair best{kInfinity, i};
    for (std::size_t j = i + 1; j < boxes.size(); ++j)
      if (const double c = cost(boxes[i], boxes[j]); c < best.cost) best = {c, j};
    return best;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; boxes.size() > most && i < boxes.size(); ++i) pairs.push_back(partner(i));
  while (boxes.size() > most) {
    std::size_t first = 0;
    for (std::size_t i = 1; i < pairs.size(); ++i)
      if (pairs[i].cost < pairs[first].cost) first = i;
    const std::size_t second = pairs[first].other;
    StandInBox box = joined(boxes[first], boxes[second]);
    const double added = deviation(box, boxes[first], boxes[second]);
    box.error = added + std::max(boxes[first].error, boxes[second].error);
    box.gsd = std::max({added / pixel_error, boxes[first].gsd, boxes[second].gsd});
    boxes[first] = std::move(box);
    boxes.erase(boxes.begin() + static_cast<long>(second));
    pairs.erase(pairs.begin() + static_cast<long>(second));
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const bool was_one = i == first || pairs[i].other == first || pairs[i].other == second;
      if (pairs[i].other > second) --pairs[i].other;
      if (was_one) {
        pairs[i] = partner(i);
      } else if (i < first) {
        const double c = cost(boxes[i], boxes[first]);
        if (c < pairs[i].cost) pairs[i] = {c, first};
      }
    }
  }
  return boxes;
}

PolygonMesh mesh_of(const StandInBox& box) {
  static constexpr int kSides[5][4] = {
      {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}, {4, 5, 7, 6}};
  PolygonMesh mesh;
  for (const Vec3& p : corners(box)) mesh.vertices.push_back(p - box.origin);
  for (const auto& s : kSides) {
    const int facet = static_cast<int>(mesh.facets.size());
    const Vec3 normal = (mesh.vertices[s[1]] - mesh.vertices[s[0]])
                            .cross(mesh.vertices[s[3]] - mesh.vertices[s[0]])
                            .normalized();
    mesh.facets.push_back({normal, -1, {{s[0], s[1], s[2], s[3]}}});
    mesh.triangles.push_back({s[0], s[1], s[2]});
    mesh.triangles.push_back({s[0], s[2], s[3]});
    mesh.facet_of_triangle.insert(mesh.facet_of_triangle.end(), 2, facet);
  }
  return mesh;
}

}  // namespace colod
