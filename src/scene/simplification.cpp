// Based on: Garland & Heckbert, Surface simplification using quadric error metrics, 1997
// (meshoptimizer).
// Differs: what a quadric lets go too far is kept.
#include "simplification.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <tuple>

#include "core/meshopt.h"
#include "core/rays.h"
#include "lighter.h"
#include "parameters.h"

namespace colod {

namespace {

using namespace parameters::context;

/// Vertices that nothing uses are left out.
Work picked(const Work& from, const std::vector<std::uint32_t>& indices) {
  Work out;
  std::vector<int> number(from.mesh.vertices.size(), -1);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    Face face;
    for (std::size_t k = 0; k < 3; ++k) {
      int& n = number[indices[i + k]];
      if (n < 0) {
        n = static_cast<int>(out.mesh.vertices.size());
        out.mesh.vertices.push_back(from.mesh.vertices[indices[i + k]]);
        out.is_joint.push_back(from.is_joint[indices[i + k]]);
        if (!from.origin.empty()) out.origin.push_back(from.origin[indices[i + k]]);
      }
      face[k] = n;
    }
    out.mesh.faces.push_back(face);
  }
  return out;
}

/// Metres from places to a mesh.
std::vector<double> distances(const std::vector<Vec3>& places, const Mesh& to) {
  const RayScene scene(to);
  std::vector<double> out;
  for (const Vec3& p : places) out.push_back(scene.nearest(p).distance);
  return out;
}

/// Metres from the middles of a mesh's faces and edges to another one, at most: its vertices are
/// the other one's own.
double bulge(const Mesh& mesh, const Mesh& from) {
  std::vector<Vec3> middles;
  const std::size_t step = 1 + 4 * mesh.faces.size() / kMostMeasured;
  for (std::size_t f = 0; f < mesh.faces.size(); f += step) {
    const auto at = [&](std::size_t k) {
      return mesh.vertices[static_cast<std::size_t>(mesh.faces[f][k])];
    };
    middles.push_back((at(0) + at(1) + at(2)) / 3);
    for (std::size_t k = 0; k < 3; ++k) middles.push_back((at(k) + at((k + 1) % 3)) / 2);
  }
  double most = 0;
  for (const double d : distances(middles, from)) most = std::max(most, d);
  return most;
}

/// Per vertex a number of its connected piece: the lowest vertex of it. What lies on one place is
/// one, however many vertices that are.
std::vector<std::size_t> pieces_of(const Mesh& mesh) {
  std::vector<std::size_t> above(mesh.vertices.size());
  std::map<std::array<double, 3>, std::size_t> known;
  for (std::size_t v = 0; v < above.size(); ++v) {
    const Vec3& p = mesh.vertices[v];
    above[v] = known.try_emplace({p.x(), p.y(), p.z()}, v).first->second;
  }
  const auto top = [&](std::size_t v) {
    while (above[v] != v) v = above[v] = above[above[v]];
    return v;
  };
  for (const Face& f : mesh.faces)
    for (std::size_t k = 1; k < 3; ++k) {
      const std::size_t a = top(static_cast<std::size_t>(f[0])),
                        b = top(static_cast<std::size_t>(f[k]));
      above[std::max(a, b)] = std::min(a, b);
    }
  for (std::size_t v = 0; v < above.size(); ++v) above[v] = top(v);
  return above;
}

/// A vertex as clients see it: a place with a look.
struct Corner {
  int vertex = -1, material = -1;
  Vec2f uv = Vec2f(NAN, NAN);
  Rgb color = {};

  auto key() const {
    const auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
    return std::tuple(vertex, material, bits(uv.x()), bits(uv.y()), color);
  }
};

/// A textured mesh as one of corners, which come apart where looks do.
struct Corners {
  Work work;
  std::vector<Corner> looks;  ///< per vertex of it

  Corners(const Source& source, const std::vector<char>& is_joint);
  Source source_of(const Work& kept, const Source& from) const;
};

Corner corner_of(const Source& source, std::size_t f, std::size_t k) {
  const Appearance& look = source.look;
  Corner out{.vertex = source.mesh.faces[f][k]};
  if (!look.face_material.empty()) out.material = look.face_material[f];
  if (!look.uvs.empty()) out.uv = look.uvs[f][k];
  if (!look.colors.empty()) out.color = look.colors[f][k];
  return out;
}

Corners::Corners(const Source& source, const std::vector<char>& is_joint) {
  std::map<decltype(Corner{}.key()), int> numbers;
  for (std::size_t f = 0; f < source.mesh.faces.size(); ++f) {
    Face face;
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner corner = corner_of(source, f, k);
      const auto [at, is_new] = numbers.try_emplace(corner.key(), static_cast<int>(looks.size()));
      face[k] = at->second;
      if (!is_new) continue;
      const auto v = static_cast<std::size_t>(corner.vertex);
      work.origin.push_back(static_cast<std::uint32_t>(looks.size()));
      looks.push_back(corner);
      work.mesh.vertices.push_back(source.mesh.vertices[v]);
      work.is_joint.push_back(is_joint[v]);
    }
    work.mesh.faces.push_back(face);
  }
}

/// One vertex a place again; images and materials are those of `from`.
Source Corners::source_of(const Work& kept, const Source& from) const {
  Source out;
  out.path = from.path;
  out.warnings = from.warnings;
  out.look.images = from.look.images;
  out.look.materials = from.look.materials;
  std::map<int, int> numbers;
  for (const Face& f : kept.mesh.faces) {
    Face face;
    std::array<Vec2f, 3> uvs;
    std::array<Rgb, 3> colors;
    int material = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner& corner = looks[kept.origin[static_cast<std::size_t>(f[k])]];
      const auto [at, is_new] =
          numbers.try_emplace(corner.vertex, static_cast<int>(out.mesh.vertices.size()));
      if (is_new)
        out.mesh.vertices.push_back(from.mesh.vertices[static_cast<std::size_t>(corner.vertex)]);
      face[k] = at->second;
      uvs[k] = corner.uv, colors[k] = corner.color, material = corner.material;
    }
    out.mesh.faces.push_back(face);
    if (!from.look.face_material.empty()) out.look.face_material.push_back(material);
    if (!from.look.uvs.empty()) out.look.uvs.push_back(uvs);
    if (!from.look.colors.empty()) out.look.colors.push_back(colors);
  }
  return out;
}

}  // namespace

Work without_small(const Work& from, double size) {
  const std::vector<std::size_t> piece = pieces_of(from.mesh);
  std::vector<Box> boxes(piece.size());
  std::vector<char> is_kept(piece.size(), 0);
  for (std::size_t v = 0; v < piece.size(); ++v) {
    boxes[piece[v]].extend(from.mesh.vertices[v]);
    is_kept[piece[v]] |= from.is_joint[v];
  }
  double largest = 0;
  std::vector<std::uint32_t> indices;
  for (const Face& f : from.mesh.faces) {
    const std::size_t own = piece[static_cast<std::size_t>(f[0])];
    const double across = boxes[own].size().norm();
    if (is_kept[own] || across > size)
      for (const int v : f) indices.push_back(static_cast<std::uint32_t>(v));
    else
      largest = std::max(largest, across);
  }
  if (indices.empty()) return from;
  Work out = picked(from, indices);
  out.deviation = largest;
  return out;
}

Work collapsed(const Work& from, double error) {
  const IndexedMesh mesh(from.mesh);
  std::vector<char> is_locked = from.is_joint;
  Work out;
  for (int i = 0; i < kMostKept; ++i) {
    out = picked(
        from, simplify_within(mesh.positions, mesh.indices, is_locked, static_cast<float>(error)));
    if (out.mesh.faces.empty()) return from;
    const std::vector<double> off = distances(from.mesh.vertices, out.mesh);
    out.deviation = *std::max_element(off.begin(), off.end());
    if (out.deviation <= kFarthest * error) break;
    for (std::size_t v = 0; v < off.size(); ++v) is_locked[v] |= off[v] > kFarthest * error;
  }
  out.deviation = std::max(out.deviation, bulge(out.mesh, from.mesh));
  return out;
}

Source lighter(const Source& source, const std::vector<char>& is_joint, double error) {
  if (source.mesh.faces.empty()) return source;
  const Corners corners(source, is_joint);
  return corners.source_of(collapsed(without_small(corners.work, error), error), source);
}

}  // namespace colod
