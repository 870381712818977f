// Based on: own work.
// Differs: the same under both rules.
// Notation: none.
#include "left_out.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/parallel.h"
#include "core/rays.h"
#include "core/union_find.h"

namespace colod {
namespace {

constexpr std::size_t kGrain = 256;  // queries a task takes
constexpr double kMuchGround = 0.5, kMuchAfloat = 0.02;

/// Largest distance of the points to the scene. Neighbours in the list are mostly neighbours in
/// space, so that each tells how far the next one can be.
double farthest_from(const std::vector<Vec3>& points, const RayScene& scene) {
  std::vector<double> distance(points.size(), 0);
  parallel_ranges(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    double within = std::numeric_limits<double>::infinity();
    for (std::size_t i = begin; i < end; ++i) {
      if (i > begin) within = distance[i - 1] + (points[i] - points[i - 1]).norm();
      if (points[i].allFinite()) distance[i] = scene.nearest(points[i], within).distance;
    }
  });
  return distance.empty() ? 0 : *std::max_element(distance.begin(), distance.end());
}

/// m³ that the closed ones of the flagged pieces enclose; −1: none is closed.
double closed_volume(const Mesh& mesh, const std::vector<char>& is_left_out) {
  UnionFind pieces(mesh.vertices.size());
  std::map<std::pair<int, int>, int> balance;  // of an edge: uses one way less those the other way
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    if (!is_left_out[i]) continue;
    const Face& f = mesh.faces[i];
    for (int k = 0; k < 3; ++k) {
      const int a = f[k], b = f[(k + 1) % 3];
      pieces.unite(a, b);
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  std::vector<char> is_open(mesh.vertices.size(), 0);
  for (const auto& [edge, uses] : balance)
    if (uses != 0) is_open[pieces.find(edge.first)] = 1;
  std::map<int, double> closed;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const auto& [a, b, c] = mesh.faces[i];
    if (const int piece = pieces.find(a); is_left_out[i] && !is_open[piece])
      closed[piece] += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6;
  }
  double volume = closed.empty() ? -1 : 0;
  for (const auto& [piece, signed_one] : closed) volume += std::abs(signed_one);
  return volume;
}

LeftOut measure_faces(const Mesh& mesh, const std::vector<char>& is_left_out) {
  LeftOut out;
  std::vector<char> is_shown(mesh.vertices.size(), 0);
  std::vector<Vec3> points;
  std::vector<Face> kept;
  double total = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const double area = face_area(mesh, mesh.faces[i]);
    if (std::isfinite(area)) total += area;
    if (!is_left_out[i]) {
      kept.push_back(mesh.faces[i]);
      continue;
    }
    if (std::isfinite(area)) out.area += area;
    for (const int v : mesh.faces[i])
      if (!is_shown[v]) is_shown[v] = 1, points.push_back(mesh.vertices[v]);
  }
  out.share = total > 0 ? out.area / total : 0;
  if (!kept.empty()) out.farthest = farthest_from(points, RayScene(mesh.vertices, kept));
  return out;
}

/// Points have no area: the share is of their number, the distance that to the others' box.
LeftOut measure_points(const std::vector<Vec3>& points, const std::vector<char>& is_left_out) {
  LeftOut out;
  Box kept;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!is_left_out[i] && points[i].allFinite()) kept.extend(points[i]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_left_out[i]) continue;
    out.share += 1.0 / static_cast<double>(points.size());
    const Vec3 beyond = (kept.min - points[i]).cwiseMax(points[i] - kept.max).cwiseMax(0.0);
    if (beyond.allFinite()) out.farthest = std::max(out.farthest, beyond.norm());
  }
  return out;
}

}  // namespace

const char* to_string(LeftOut::Reason reason) {
  switch (reason) {
    case LeftOut::Reason::kGround:
      return "ground";
    case LeftOut::Reason::kFloater:
      return "floater";
    case LeftOut::Reason::kInside:
      return "inside";
    case LeftOut::Reason::kLost:
      return "lost";
  }
  return "";
}

bool is_loss(const LeftOut& l) {
  if (l.reason == LeftOut::Reason::kInside) return false;
  return l.volume_share > kMostLostVolume ||
         (l.reason == LeftOut::Reason::kLost && l.volume < 0 && l.share > kMostLostSurface);
}

double warning_weight(const LeftOut& l) {
  const double share = std::max(l.share, l.volume_share);
  switch (l.reason) {
    case LeftOut::Reason::kGround:
      return l.share > kMuchGround ? l.share : 0;
    case LeftOut::Reason::kFloater:
      return share > kMuchAfloat ? share : 0;
    case LeftOut::Reason::kInside:
      return 0;
    case LeftOut::Reason::kLost:
      return share;
  }
  return 0;
}

LeftOut total_of(const std::vector<LeftOut>& parts) {
  LeftOut total;
  for (const LeftOut& l : parts) {
    total.area += l.area;
    total.share += l.share;
    total.farthest = std::max(total.farthest, l.farthest);
    if (l.volume >= 0) total.volume = std::max(total.volume, 0.0) + l.volume;
    if (l.volume_share >= 0)
      total.volume_share = std::max(total.volume_share, 0.0) + l.volume_share;
  }
  return total;
}

LeftOut measure_left_out(const Source& source, const std::vector<char>& is_left_out,
                         LeftOut::Reason reason, const std::vector<LeftOut>& before) {
  LeftOut out = source.is_mesh() ? measure_faces(source.mesh, is_left_out)
                                 : measure_points(source.cloud.points, is_left_out);
  out.reason = reason;
  if (source.is_mesh() && reason == LeftOut::Reason::kFloater)
    out.volume = closed_volume(source.mesh, is_left_out);
  for (const LeftOut& b : before) out.share *= 1 - b.share;
  return out;
}

}  // namespace colod
