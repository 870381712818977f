// Based on: normals of vertices weighted by angle (G. Thürmer, C. Wüthrich, 1998) within a crease
// angle; they are interpolated over a face as in Phong's shading.
#include "smooth_normals.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "parameters.h"

namespace colod::bake {

using namespace parameters::bake;

namespace {

double angle_at(const Mesh& mesh, const Face& f, int corner) {
  const Vec3& p = mesh.vertices[f[corner]];
  const Vec3 a = mesh.vertices[f[(corner + 1) % 3]] - p, b = mesh.vertices[f[(corner + 2) % 3]] - p;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

SmoothNormals::SmoothNormals(const Mesh& mesh) : mesh_(mesh), corners_(mesh.faces.size()) {
  std::vector<Vec3> own(mesh.faces.size());
  std::vector<int> begin(mesh.vertices.size() + 1, 0), faces(3 * mesh.faces.size());
  for (std::size_t t = 0; t < own.size(); ++t) {
    own[t] = face_cross(mesh, mesh.faces[t]).normalized();
    for (const int v : mesh.faces[t]) ++begin[static_cast<std::size_t>(v) + 1];
  }
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < faces.size(); ++i)
    faces[static_cast<std::size_t>(next[mesh.faces[i / 3][i % 3]]++)] = static_cast<int>(i);
  parallel_for(corners_.size(), [&](std::size_t t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto v = static_cast<std::size_t>(mesh.faces[t][c]);
      Vec3 sum = Vec3::Zero();
      for (int i = begin[v]; i < begin[v + 1]; ++i) {
        const auto other = static_cast<std::size_t>(faces[i] / 3);
        if (own[other].dot(own[t]) >= kCrease)
          sum += angle_at(mesh, mesh.faces[other], faces[i] % 3) * own[other];
      }
      corners_[t][c] = sum.norm() > 0 ? sum.normalized() : own[t];
    }
  });
}

Vec3 SmoothNormals::at(int face, const Vec3& point) const {
  const auto t = static_cast<std::size_t>(face);
  const Face& f = mesh_.faces[t];
  const Vec3 w = barycentric(mesh_, f, point);
  const Vec3 sum = w[0] * corners_[t][0] + w[1] * corners_[t][1] + w[2] * corners_[t][2];
  return sum.norm() > 0 ? sum.normalized() : corners_[t][0];
}

}  // namespace colod::bake
