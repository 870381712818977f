// Based on: the paper, section 4: "the minimum region size requiring 20 inside points", for "a raw
// point cloud or mesh" (section 3.1).
// Differs: --rules paper only, and nothing on purpose. The paper does not say how many points stand
// for a mesh; here they stand 10 cm apart, half of the paper's growing distance: a region of 20
// points has 0.2 m².
// Notation: –
#include "sampling.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/spread.h"
#include "parameters.h"

namespace colod::regions {
namespace {

using namespace parameters::planes;

double finite_area(const Mesh& mesh, const Face& face) {
  const double area = face_area(mesh, face);
  return std::isfinite(area) ? area : 0;
}

/// Points a square metre.
double density_on(const Mesh& mesh) {
  double total = 0;
  for (const Face& f : mesh.faces) total += finite_area(mesh, f);
  if (!(total > 0)) return 0;
  return std::clamp(kSampleDensity, kLeastSamples / total,
                    std::max(kLeastSamples, kMostSamples) / total);
}

/// What most of the points say, −1 where there are none; of equal ones the first plane.
int most_frequent(const std::map<int, int>& votes) {
  int best = -1, most = 0;
  for (const auto& [plane, count] : votes)
    if (count > most) best = plane, most = count;
  return best;
}

}  // namespace

FaceSamples sample_faces(const Source& source) {
  FaceSamples samples;
  samples.cloud.name = source.name, samples.cloud.path = source.path;
  const Mesh& mesh = source.mesh;
  const double density = density_on(mesh);
  double until = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    until += density * finite_area(mesh, mesh.faces[f]);
    const auto& [a, b, c] = mesh.faces[f];
    const Vec3 normal = face_cross(mesh, mesh.faces[f]).normalized();
    while (static_cast<double>(samples.face.size()) + 0.5 < until) {
      samples.cloud.cloud.points.push_back(
          spread_on_triangle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c],
                             static_cast<double>(samples.face.size())));
      samples.cloud.cloud.normals.push_back(normal);
      samples.face.push_back(static_cast<int>(f));
    }
  }
  return samples;
}

void hand_to_faces(const Source& source, const FaceSamples& samples, Planes& planes) {
  std::vector<std::map<int, int>> votes(source.mesh.faces.size());
  for (std::size_t i = 0; i < samples.face.size(); ++i)
    ++votes[samples.face[i]][planes.plane_of_item[i]];
  planes.plane_of_item.clear();
  for (Plane& p : planes.planes) p.items.clear();
  planes.total_area = 0;
  for (std::size_t f = 0; f < votes.size(); ++f) {
    const int plane = most_frequent(votes[f]);
    planes.plane_of_item.push_back(plane);
    if (plane >= 0) planes.planes[plane].items.push_back(static_cast<int>(f));
    if (plane != kFloater) planes.total_area += finite_area(source.mesh, source.mesh.faces[f]);
  }
}

}  // namespace colod::regions
