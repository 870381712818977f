// Based on: own work; the cube is a morphological opening of the outside (Serra, "Image Analysis
// and Mathematical Morphology", 1982), as an alpha wrap's ball is (Portaneri et al., "Alpha
// wrapping with an offset", ACM TOG 41(4), 2022), which follows the windows' edges instead.
// Differs: --rules robust only; the paper is given shells.
// Notation: opening: the voxels that the cube covers somewhere on its way.
#include "hidden.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "core/drawn.h"
#include "core/parallel.h"
#include "core/rays.h"
#include "core/spread.h"
#include "hidden_parts.h"
#include "left_out.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::hidden;

constexpr double kGrid = 1.0 / 65536;  // metres: the local frame's (read/frame.h)

/// The space about a building in voxels: which of them are outside.
class Surroundings {
 public:
  explicit Surroundings(const Mesh& mesh) {
    Box box = bounding_box(mesh.vertices);
    const Vec3 room = box.size() + Vec3::Constant(2 * kCube);
    voxel_ = std::max(kFinest, std::cbrt(room.prod() / kMostVoxels));
    half_ = std::max(1, static_cast<int>(std::lround((kCube / voxel_ - 1) / 2)));
    const double margin = (2 * half_ + 2) * voxel_;
    origin_ = box.min - Vec3(margin, margin, 0);
    const Vec3 size = box.max + Vec3::Constant(margin) - origin_;
    for (int k = 0; k < 3; ++k) n_[k] = static_cast<int>(std::ceil(size[k] / voxel_)) + 1;
    std::vector<char> solid = surface(mesh);
    is_outside_ = open(solid);
    add_sky(solid);
    add_niches(solid);
  }

  /// Whether a ray that is free for `reach` metres meets the outside. Its end stays out: there it
  /// may already look through a corner that the surface cuts off a voxel. Below the building all is
  /// outside.
  bool leads_outside(const Vec3& from, const Vec3& direction, double reach) const {
    const double end = std::max(0.0, reach - voxel_ / 2);
    const int steps = std::max(1, static_cast<int>(std::ceil(2 * end / voxel_)));
    for (int i = 0; i <= steps; ++i)
      if (is_outside(from + (end * i / steps) * direction)) return true;
    return false;
  }

  /// Metres within which a point must meet the outside to be seen.
  double reach() const { return kDepth + 2 * voxel_; }

  bool is_outside(const Vec3& p) const {
    std::array<int, 3> c;
    for (int k = 0; k < 3; ++k) {
      const double x = std::floor((p[k] - origin_[k]) / voxel_);
      if (x < 0 || x >= n_[k]) return true;
      c[k] = static_cast<int>(x);
    }
    return is_outside_[index(c[0], c[1], c[2])];
  }

 private:
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * n_[1] + y) * n_[0] + x;
  }
  std::size_t size() const { return static_cast<std::size_t>(n_[0]) * n_[1] * n_[2]; }

  /// Calls visit(index) for the voxels that share a side with this one.
  template <typename Visit>
  void for_each_neighbour(std::size_t i, const Visit& visit) const {
    const std::size_t row = n_[0], slice = index(0, 0, 1);
    const std::size_t x = i % row, y = i / row % n_[1], z = i / slice;
    if (x > 0) visit(i - 1);
    if (x + 1 < row) visit(i + 1);
    if (y > 0) visit(i - row);
    if (y + 1 < static_cast<std::size_t>(n_[1])) visit(i + row);
    if (z > 0) visit(i - slice);
    if (z + 1 < static_cast<std::size_t>(n_[2])) visit(i + slice);
  }

  /// Voxels that the surface passes through.
  std::vector<char> surface(const Mesh& mesh) const {
    std::vector<char> solid(size(), 0);
    for (const Face& f : mesh.faces) {
      const Vec3 &a = mesh.vertices[f[0]], u = mesh.vertices[f[1]] - a, v = mesh.vertices[f[2]] - a;
      const double longest = std::max({u.norm(), v.norm(), (u - v).norm()});
      const int n = static_cast<int>(std::ceil(2 * longest / voxel_)) + 1;
      for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
          const Vec3 c = (a + u * i / n + v * j / n - origin_) / voxel_;
          solid[index(static_cast<int>(c.x()), static_cast<int>(c.y()), static_cast<int>(c.z()))] =
              1;
        }
    }
    return solid;
  }

  /// Sets what lies within half_ voxels of a set one along every axis: a cube about each.
  void dilate(std::vector<char>& set) const {
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t stride = axis == 0 ? 1 : axis == 1 ? n_[0] : index(0, 0, 1);
      const int n = n_[axis], nu = n_[axis == 0 ? 1 : 0], nv = n_[axis == 2 ? 1 : 2];
      parallel_for(static_cast<std::size_t>(nv), [&](std::size_t v) {
        std::vector<char> line(n);
        for (int u = 0; u < nu; ++u) {
          const int w = static_cast<int>(v);
          const std::size_t start = axis == 0   ? index(0, u, w)
                                    : axis == 1 ? index(u, 0, w)
                                                : index(u, w, 0);
          int last = -n;  // the set voxel that was passed last
          for (int i = 0; i < n + half_; ++i) {
            if (i < n && set[start + i * stride]) last = i;
            if (i >= half_) line[i - half_] = i - last <= 2 * half_;
          }
          for (int i = 0; i < n; ++i) set[start + i * stride] = line[i];
        }
      });
    }
  }

  /// Where a cube can stand that comes from around or from above, not through the floor.
  std::vector<char> open(std::vector<char> solid) const {
    dilate(solid);
    std::vector<char> reached(size(), 0);
    std::vector<std::size_t> stack = {index(0, 0, n_[2] - 1)};
    reached[stack[0]] = 1;
    while (!stack.empty()) {
      const std::size_t c = stack.back();
      stack.pop_back();
      for_each_neighbour(c, [&](std::size_t next) {
        if (solid[next] || reached[next]) return;
        reached[next] = 1;
        stack.push_back(next);
      });
    }
    dilate(reached);
    return reached;
  }

  /// What the sky stands open above.
  void add_sky(const std::vector<char>& solid) {
    for (int y = 0; y < n_[1]; ++y)
      for (int x = 0; x < n_[0]; ++x)
        for (int z = n_[2] - 1; z >= 0 && !solid[index(x, y, z)]; --z)
          is_outside_[index(x, y, z)] = 1;
  }

  /// Cavities that stand open widely for the walls about them.
  void add_niches(const std::vector<char>& solid) {
    std::vector<char> is_known(size(), 0);
    std::vector<std::size_t> niches;
    for (std::size_t i = 0; i < size(); ++i) {
      if (solid[i] || is_outside_[i] || is_known[i]) continue;
      std::vector<std::size_t> cavity = {i};
      is_known[i] = 1;
      std::size_t open = 0, closed = 0;
      for (std::size_t k = 0; k < cavity.size(); ++k)
        for_each_neighbour(cavity[k], [&](std::size_t next) {
          open += is_outside_[next];
          closed += solid[next];
          if (solid[next] || is_outside_[next] || is_known[next]) return;
          is_known[next] = 1;
          cavity.push_back(next);
        });
      if (static_cast<double>(open) > kOpenShare * static_cast<double>(closed))
        niches.insert(niches.end(), cavity.begin(), cavity.end());
    }
    for (const std::size_t c : niches) is_outside_[c] = 1;
  }

  double voxel_;
  int half_;  // voxels from the cube's middle to its side
  Vec3 origin_;
  std::array<int, 3> n_;
  std::vector<char> is_outside_;
};

class Lookout {
 public:
  explicit Lookout(const Mesh& mesh)
      : surroundings_(mesh), rays_(mesh), directions_(sphere_directions(kRays)) {}

  /// 0 … 1: the share of the face's samples that are seen.
  double seen_share(const Mesh& mesh, const Face& f) const {
    const Vec3 normal = face_cross(mesh, f).normalized();
    const double area = face_area(mesh, f);
    const int n = std::clamp(static_cast<int>(std::ceil(area / kSampleArea)), 1, kMostSamples);
    int seen = 0;
    for (int k = 0; k < n; ++k) {
      const Vec3 p =
          n == 1 ? Vec3((mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3)
                 : spread_on_triangle(mesh.vertices[f[0]], mesh.vertices[f[1]], mesh.vertices[f[2]],
                                      k + 1);
      seen += is_seen(p, normal);
    }
    return static_cast<double>(seen) / n;
  }

  /// Of the area, by samples spread over all of it.
  double hidden_share(const Mesh& mesh) const {
    std::vector<double> passed;  // area up to and with each face
    for (const Face& f : mesh.faces)
      passed.push_back((passed.empty() ? 0 : passed.back()) + face_area(mesh, f));
    std::vector<char> is_hidden(kGateSamples, 0);
    parallel_for(is_hidden.size(), [&](std::size_t k) {
      const double at = (static_cast<double>(k) + 0.5) / kGateSamples * passed.back();
      const std::size_t i = std::upper_bound(passed.begin(), passed.end(), at) - passed.begin();
      const Face& f = mesh.faces[std::min(i, passed.size() - 1)];
      const Vec3 p = spread_on_triangle(mesh.vertices[f[0]], mesh.vertices[f[1]],
                                        mesh.vertices[f[2]], static_cast<double>(k) + 1);
      is_hidden[k] = !is_seen(p, face_cross(mesh, f).normalized());
    });
    return static_cast<double>(std::count(is_hidden.begin(), is_hidden.end(), 1)) / kGateSamples;
  }

 private:
  bool is_seen(const Vec3& p, const Vec3& normal) const {
    const double reach = surroundings_.reach();
    int seen = 0;
    for (const Vec3& d : directions_) {
      const double slope = d.dot(normal);
      if (std::abs(slope) < 0.05) continue;
      const Vec3 from = p + std::copysign(kLift, slope) * normal;
      const RayHit hit = rays_.first_hit(from, d, 0, reach);
      if (!surroundings_.leads_outside(from, d, hit ? hit.distance : reach)) continue;
      if (++seen == kSeen) return true;
    }
    return false;
  }

  Surroundings surroundings_;
  RayScene rays_;
  std::vector<Vec3> directions_;
};

std::vector<double> seen_shares(const Lookout& lookout, const Mesh& mesh) {
  std::vector<double> shares(mesh.faces.size());
  parallel_for(
      shares.size(), [&](std::size_t i) { shares[i] = lookout.seen_share(mesh, mesh.faces[i]); },
      64);
  return shares;
}

/// How a piece of a face looks, by where its corners lie in the face.
void cut_look(const Mesh& before, const hidden::Pieces& pieces, Appearance& look) {
  const Appearance whole = look;
  look.pick(pieces.face_of);
  for (std::size_t i = 0; i < pieces.face_of.size(); ++i) {
    const auto face = static_cast<std::size_t>(pieces.face_of[i]);
    const Face &f = before.faces[face], &piece = pieces.mesh.faces[i];
    if (piece == f) continue;
    for (int c = 0; c < 3; ++c) {
      const Vec3 weight = barycentric(before, f, pieces.mesh.vertices[piece[c]]);
      if (!whole.uvs.empty()) {
        const auto& uv = whole.uvs[face];
        look.uvs[i][c] = (weight[0] * uv[0].cast<double>() + weight[1] * uv[1].cast<double>() +
                          weight[2] * uv[2].cast<double>())
                             .cast<float>();
      }
      for (int k = 0; k < 3 && !whole.colors.empty(); ++k) {
        double value = 0;
        for (int w = 0; w < 3; ++w) value += weight[w] * whole.colors[face][w][k];
        look.colors[i][c][k] = static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
      }
    }
  }
}

/// Faces that are seen in part become their pieces; `source.face_object` and `look` follow.
void cut_half_seen(const std::vector<double>& shares, Source& source) {
  std::vector<char> is_cut;
  for (const double share : shares) is_cut.push_back(share > 0 && share < 1);
  hidden::Pieces pieces = hidden::cut_faces(source.mesh, is_cut, kGrid);
  if (pieces.left_whole > 0)
    source.warnings.push_back(
        std::to_string(pieces.left_whole) +
        " faces are met by so many others that they were not cut where they are hidden: is this "
        "one building? --split parts it");
  if (!source.face_object.empty()) {
    std::vector<int> object;
    for (const int f : pieces.face_of) object.push_back(source.face_object[f]);
    source.face_object = std::move(object);
  }
  if (!source.look.is_empty()) cut_look(source.mesh, pieces, source.look);
  source.mesh = std::move(pieces.mesh);
}

void drop_faces(const std::vector<char>& is_dropped, Source& source) {
  std::size_t kept = 0;
  std::vector<int> faces;
  for (std::size_t i = 0; i < is_dropped.size(); ++i) {
    if (is_dropped[i]) continue;
    faces.push_back(static_cast<int>(i));
    source.mesh.faces[kept] = source.mesh.faces[i];
    if (!source.face_object.empty()) source.face_object[kept] = source.face_object[i];
    ++kept;
  }
  source.mesh.faces.resize(kept);
  if (!source.face_object.empty()) source.face_object.resize(kept);
  source.look.pick(faces);
}

}  // namespace

Source remove_hidden(Source source) {
  if (!source.is_mesh()) return source;
  const Lookout lookout(source.mesh);
  const double least = drawn_share(source.mesh) < kLeastDrawn ? kLeastHidden : kLeastHiddenDrawn;
  if (lookout.hidden_share(source.mesh) < least) return source;
  cut_half_seen(seen_shares(lookout, source.mesh), source);
  std::vector<char> is_hidden;
  for (const double share : seen_shares(lookout, source.mesh))
    is_hidden.push_back(share < kMostlySeen);
  const LeftOut out =
      measure_left_out(source, is_hidden, LeftOut::Reason::kInside, source.left_out);
  if (out.share >= kLeastHidden) {
    char text[160];
    std::snprintf(
        text, sizeof text,
        "left out %.0f m2 of surface that nobody sees from outside (%.0f %% of the input): "
        "--rules paper keeps it",
        out.area, 100 * out.share);
    source.warnings.push_back(text);
  }
  source.left_out.push_back(out);
  drop_faces(is_hidden, source);
  return source;
}

}  // namespace colod
