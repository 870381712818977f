// Based on: own work; exporters of games and scans write levels of detail side by side under any
// names.
// Differs: --rules does not matter here.
#include "alternatives.h"

#include <algorithm>

#include "core/rays.h"

namespace colod::mesh_io {

namespace {

constexpr double kFewer = 2.0 / 3;      // of the finer one's triangles
constexpr double kSameBox = 0.05;       // of the diagonal: a chimney may be missing
constexpr double kSameSurface = 0.02;   // of the diagonal …
constexpr double kThinnestWall = 0.15;  // … and metres: shells nearer than this are no two things
constexpr double kMostOf = 0.7;         // of the area: recesses and small parts may be missing
constexpr std::size_t kAsked = 500;     // triangles of each, four points on each

Box box_of(const std::vector<Vec3>& points, const std::vector<Face>& faces,
           const std::vector<int>& chosen) {
  Box box;
  for (const int t : chosen)
    for (const int v : faces[t]) box.extend(points[v]);
  return box;
}

/// Share of the area of some triangles that lies within `reach` of the scene.
double share_near(const std::vector<Vec3>& points, const std::vector<Face>& faces,
                  const std::vector<int>& chosen, const RayScene& scene, double reach) {
  const std::size_t step = std::max<std::size_t>(1, chosen.size() / kAsked);
  double near = 0, total = 0;
  for (std::size_t i = 0; i < chosen.size(); i += step) {
    const Face& f = faces[chosen[i]];
    const Vec3 &a = points[f[0]], &b = points[f[1]], &c = points[f[2]];
    const Vec3 middle = (a + b + c) / 3;
    const double area = 0.5 * (b - a).cross(c - a).norm();
    for (const Vec3& p :
         {middle, Vec3(0.5 * (middle + a)), Vec3(0.5 * (middle + b)), Vec3(0.5 * (middle + c))}) {
      total += area;
      if (scene.nearest(p).distance <= reach) near += area;
    }
  }
  return total > 0 ? near / total : 0;
}

RayScene scene_of(const std::vector<Vec3>& points, const std::vector<Face>& faces,
                  const std::vector<int>& chosen) {
  Mesh mesh;
  for (const int t : chosen) {
    const int first = static_cast<int>(mesh.vertices.size());
    for (const int v : faces[t]) mesh.vertices.push_back(points[v]);
    mesh.faces.push_back({first, first + 1, first + 2});
  }
  return RayScene(mesh);
}

}  // namespace

bool is_coarser_alternative(const std::vector<Vec3>& points, const std::vector<Face>& faces,
                            const std::vector<int>& coarse, const std::vector<int>& fine) {
  if (static_cast<double>(coarse.size()) > kFewer * static_cast<double>(fine.size())) return false;
  const Box a = box_of(points, faces, coarse), b = box_of(points, faces, fine);
  const double slack = kSameBox * b.diagonal();
  if (!((a.min - b.min).cwiseAbs().maxCoeff() <= slack) ||
      !((a.max - b.max).cwiseAbs().maxCoeff() <= slack))
    return false;
  const double reach = std::min(kThinnestWall, kSameSurface * b.diagonal());
  return share_near(points, faces, coarse, scene_of(points, faces, fine), reach) >= kMostOf &&
         share_near(points, faces, fine, scene_of(points, faces, coarse), reach) >= kMostOf;
}

}  // namespace colod::mesh_io
