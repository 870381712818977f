#include "facet_colors.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/spread.h"

namespace colod::bake {

namespace {

constexpr double kColorSampleArea = 0.25;  // m² of a facet that a sample stands for
constexpr int kMostColorSamples = 256;

/// Light times area, and the area that was found.
using Sum = Eigen::Vector4d;

/// What is seen of a triangle, by samples spread over it.
Sum look_at(const Mesh& mesh, const Face& f, const Outlook& outlook) {
  const Vec3 turn = face_cross(mesh, f);
  const double area = 0.5 * turn.norm();
  Sum sum = Sum::Zero();
  if (!(area > 0)) return sum;
  const int n = std::clamp(static_cast<int>(area / kColorSampleArea), 4, kMostColorSamples);
  Lens lens(outlook.cache);
  const Probe::Holes holes = holes_in(outlook.sampler, lens);
  for (int k = 1; k <= n; ++k) {
    const Vec3 p =
        spread_on_triangle(mesh.vertices[f[0]], mesh.vertices[f[1]], mesh.vertices[f[2]], k);
    const Found found = outlook.probe.find(p, turn.normalized(), outlook.reach, holes);
    if (found.how == Finding::kNone) continue;
    const Light light =
        outlook.sampler.sample(found.face, found.point, std::sqrt(kColorSampleArea), lens);
    sum += area / n * Sum(light[0], light[1], light[2], 1);
  }
  return sum;
}

}  // namespace

std::vector<Rgb> colors_of_facets(const PolygonMesh& mesh, const Outlook& outlook) {
  const Mesh plain = mesh.mesh();
  std::vector<Sum> of_triangle(mesh.triangles.size());
  parallel_for(of_triangle.size(),
               [&](std::size_t t) { of_triangle[t] = look_at(plain, mesh.triangles[t], outlook); });
  std::vector<Sum> sums(mesh.facets.size(), Sum::Zero());
  Sum all = Sum::Zero();
  for (std::size_t t = 0; t < of_triangle.size(); ++t) {
    sums[static_cast<std::size_t>(mesh.facet_of_triangle[t])] += of_triangle[t];
    all += of_triangle[t];
  }
  std::vector<Rgb> colors;
  for (const Sum& s : sums) {
    const Sum& used = s[3] > 0 ? s : all;
    Rgb rgb = {128, 128, 128};
    for (int c = 0; c < 3 && used[3] > 0; ++c)
      rgb[static_cast<std::size_t>(c)] = to_srgb(static_cast<float>(used[c] / used[3]));
    colors.push_back(rgb);
  }
  return colors;
}

}  // namespace colod::bake
