// Based on: own work.
#include "cutter.h"

#include <algorithm>

namespace colod {

namespace {

constexpr double kSameOnEdge = 1e-6;  // metres

}  // namespace

Cutter::Cutter(const Source& from) : from_(from), number_(from.mesh.vertices.size(), -1) {
  out_.path = from.path;
  out_.look.images = from.look.images;
  out_.look.materials = from.look.materials;
}

void Cutter::add_whole(std::size_t f) {
  Face face;
  for (std::size_t k = 0; k < 3; ++k) face[k] = old_vertex(from_.mesh.faces[f][k]);
  add(f, face, {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()});
}

void Cutter::add_part(std::size_t f, const std::vector<Vec3>& polygon) {
  std::vector<int> numbers;
  for (const Vec3& w : polygon) numbers.push_back(vertex(f, w));
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
    add(f, {numbers[0], numbers[k], numbers[k + 1]}, {polygon[0], polygon[k], polygon[k + 1]});
}

int Cutter::old_vertex(int v) {
  int& number = number_[static_cast<std::size_t>(v)];
  if (number < 0) {
    number = static_cast<int>(out_.mesh.vertices.size());
    out_.mesh.vertices.push_back(from_.mesh.vertices[static_cast<std::size_t>(v)]);
  }
  return number;
}

int Cutter::vertex(std::size_t f, const Vec3& w) {
  const Face& face = from_.mesh.faces[f];
  for (int k = 0; k < 3; ++k)
    if (w[k] == 1) return old_vertex(face[static_cast<std::size_t>(k)]);
  Vec3 p = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    p += w[k] * from_.mesh.vertices[static_cast<std::size_t>(face[static_cast<std::size_t>(k)])];
  for (std::size_t k = 0; k < 3; ++k)
    if (w[static_cast<int>(k)] == 0) return on_edge(face[(k + 1) % 3], face[(k + 2) % 3], p);
  const auto [at, is_new] =
      cut_.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(out_.mesh.vertices.size()));
  if (is_new) out_.mesh.vertices.push_back(p);
  return at->second;
}

/// The two faces of an edge come to one place by different ways: it is one all the same.
int Cutter::on_edge(int a, int b, const Vec3& p) {
  std::vector<int>& known = on_edges_[{std::min(a, b), std::max(a, b)}];
  for (const int v : known)
    if ((out_.mesh.vertices[static_cast<std::size_t>(v)] - p).norm() < kSameOnEdge) return v;
  known.push_back(static_cast<int>(out_.mesh.vertices.size()));
  out_.mesh.vertices.push_back(p);
  return known.back();
}

void Cutter::add(std::size_t f, const Face& face, const std::array<Vec3, 3>& weights) {
  if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) return;
  if (!(face_area(out_.mesh, face) > kLeastFace)) return;
  out_.mesh.faces.push_back(face);
  if (!from_.face_object.empty()) out_.face_object.push_back(from_.face_object[f]);
  add_look(f, weights);
}

void Cutter::add_look(std::size_t f, const std::array<Vec3, 3>& weights) {
  const Appearance& look = from_.look;
  if (!look.face_material.empty()) out_.look.face_material.push_back(look.face_material[f]);
  if (!look.uvs.empty()) {
    std::array<Vec2f, 3> uvs;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3f w = weights[k].cast<float>();
      uvs[k] = w[0] * look.uvs[f][0] + w[1] * look.uvs[f][1] + w[2] * look.uvs[f][2];
    }
    out_.look.uvs.push_back(uvs);
  }
  if (look.colors.empty()) return;
  std::array<Rgb, 3> colors;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0.5;
      for (std::size_t j = 0; j < 3; ++j)
        sum += weights[k][static_cast<int>(j)] * look.colors[f][j][c];
      colors[k][c] = static_cast<std::uint8_t>(std::clamp(sum, 0.0, 255.0));
    }
  out_.look.colors.push_back(colors);
}

}  // namespace colod
