// Based on: own work.
// Differs: the same under both rules.
// Notation: none.
#include "left_out.h"

#include <algorithm>

#include "parallel.h"
#include "rays.h"

namespace colod {
namespace {

constexpr std::size_t kGrain = 256;  // queries a task takes

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
  }
  return "";
}

LeftOut measure_left_out(const Source& source, const std::vector<char>& is_left_out,
                         LeftOut::Reason reason, const std::vector<LeftOut>& before) {
  LeftOut out = source.is_mesh() ? measure_faces(source.mesh, is_left_out)
                                 : measure_points(source.cloud.points, is_left_out);
  out.reason = reason;
  for (const LeftOut& b : before) out.share *= 1 - b.share;
  return out;
}

}  // namespace colod
