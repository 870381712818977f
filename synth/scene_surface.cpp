// *Based on:* S. F. Gibson: Constrained Elastic Surface Nets, MICCAI 1998: one vertex a cell that
// the surface crosses, here of the solid below the heights, blurred and shaken.
//
// *Differs:* vertices lie at the mean of the crossings and are not relaxed.
//
// *Notation:* i, j, k: nodes of the lattice along x, y and z, the same numbers in all tiles.
#include "scene_surface.h"

#include <algorithm>
#include <cmath>

#include "core/meshopt.h"
#include "materials.h"

namespace colod::synth {
namespace {

constexpr double kBulge = 0.075;    // m, sigma of waves of 1.5 to 7 m
constexpr double kJitter = 0.025;   // m, most, of single vertices
constexpr double kMostShift = 0.4;  // of a cell, so that nothing floats
constexpr double kThin = 0.11;      // of a cell: how far thinning may leave the surface
constexpr double kHoleSize = 2.6;   // m
constexpr double kHole = 0.9;       // of a noise of 0..1, from which on a wall is missing
constexpr std::array<double, 4> kBlur = {0.125, 0.375, 0.375, 0.125};

/// Waves that facades and roofs bulge by.
class Bulges {
 public:
  explicit Bulges(std::uint64_t seed) {
    Random r(seed * 977 + 11);
    for (Wave& w : waves_) {
      const double length = 1.5 * std::pow(7 / 1.5, r.uniform(0, 1));
      const double z = r.uniform(-0.7, 0.7), angle = r.uniform(0, 2 * M_PI);
      const double across = std::sqrt(1 - z * z);
      w.direction = 2 * M_PI / length * Vec3(across * std::cos(angle), across * std::sin(angle), z);
      w.phase = r.uniform(0, 2 * M_PI);
    }
  }
  double at(const Vec3& p) const {
    double sum = 0;
    for (const Wave& w : waves_) sum += std::sin(w.direction.dot(p) + w.phase);
    return kBulge * std::sqrt(2.0 / waves_.size()) * sum;
  }

 private:
  struct Wave {
    Vec3 direction;
    double phase;
  };
  std::array<Wave, 16> waves_;
};

/// Inside positive, outside negative, −0.5 … 0.5 and a shift.
class Solidity {
 public:
  Solidity(const SkyView& view, const TilePlace& place, std::uint64_t seed)
      : cell_(place.cell),
        i0_(place.i0 - 1),
        j0_(place.j0 - 1),
        columns_(place.columns + 2),
        rows_(place.rows + 2),
        bulges_(seed) {
    double least = INFINITY, most = -INFINITY;
    for (const double z : view.melted) least = std::min(least, z), most = std::max(most, z);
    k0_ = static_cast<int>(std::floor(least / cell_)) - 2;
    levels_ = static_cast<int>(std::ceil(most / cell_)) + 3 - k0_;
    values_.resize(size());
    for (int j = 0; j < rows_; ++j)
      for (int i = 0; i < columns_; ++i) fill_column(view, i0_ + i, j0_ + j);
  }

  std::size_t size() const { return static_cast<std::size_t>(columns_) * rows_ * levels_; }
  int k0() const { return k0_; }
  int levels() const { return levels_; }
  float at(int i, int j, int k) const { return values_[index(i, j, k)]; }
  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(j - j0_) * columns_ + (i - i0_)) * levels_ + (k - k0_);
  }

 private:
  void fill_column(const SkyView& view, int i, int j) {
    std::array<double, 16> z, weight;
    double least = INFINITY, most = -INFINITY;
    for (int n = 0; n < 16; ++n) {
      z[n] = view.melted[view.at(2 * i - 2 + n % 4, 2 * j - 2 + n / 4)];
      weight[n] = kBlur[n % 4] * kBlur[n / 4];
      least = std::min(least, z[n]), most = std::max(most, z[n]);
    }
    for (int k = k0_; k < k0_ + levels_; ++k) {
      const double at = k * cell_;
      double out = at > most + cell_ / 2 ? -0.5 : 0.5;
      if (at > least - cell_ / 2 && at < most + cell_ / 2) {
        out = -0.5;
        for (int n = 0; n < 16; ++n)
          out += weight[n] * std::clamp((z[n] - at) / cell_ + 0.5, 0.0, 1.0);
        const double shift = bulges_.at(cell_ * Vec3(i, j, k)) / cell_;
        out += std::clamp(shift, -kMostShift, kMostShift);
      }
      values_[index(i, j, k)] = static_cast<float>(out);
    }
  }

  double cell_;
  int i0_, j0_, columns_, rows_, k0_ = 0, levels_ = 0;
  Bulges bulges_;
  std::vector<float> values_;
};

class Net {
 public:
  Net(const Solidity& solid, const TilePlace& place, long seed)
      : solid_(solid),
        place_(place),
        cell_(place.cell),
        seed_(seed),
        vertex_of_(solid.size(), -1) {}

  Mesh build() {
    for (int j = place_.j0; j < place_.j0 + place_.rows; ++j)
      for (int i = place_.i0; i < place_.i0 + place_.columns; ++i)
        for (int k = solid_.k0() + 1; k + 1 < solid_.k0() + solid_.levels(); ++k)
          for (int axis = 0; axis < 3; ++axis) cross_edge({i, j, k}, axis);
    return std::move(mesh_);
  }

 private:
  using Node = std::array<int, 3>;

  float value(const Node& n) const { return solid_.at(n[0], n[1], n[2]); }

  /// The four cells about an edge of the lattice whose ends lie on either side of the surface.
  void cross_edge(const Node& from, int axis) {
    Node to = from;
    ++to[axis];
    const bool is_in = value(from) > 0;
    if (is_in == (value(to) > 0)) return;
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    std::array<int, 4> corner;
    for (int n = 0; n < 4; ++n) {
      Node base = from;
      if (n == 0 || n == 3) --base[b];
      if (n < 2) --base[c];
      corner[n] = vertex(base);
    }
    if (!is_in) std::swap(corner[1], corner[3]);
    add_quad(corner);
  }

  /// By the diagonal over which it folds less.
  void add_quad(const std::array<int, 4>& c) {
    const auto length = [&](int a, int b) {
      return (mesh_.vertices[a] - mesh_.vertices[b]).squaredNorm();
    };
    if (length(c[0], c[2]) <= length(c[1], c[3])) {
      mesh_.faces.push_back({c[0], c[1], c[2]});
      mesh_.faces.push_back({c[0], c[2], c[3]});
    } else {
      mesh_.faces.push_back({c[0], c[1], c[3]});
      mesh_.faces.push_back({c[1], c[2], c[3]});
    }
  }

  int vertex(const Node& base) {
    int& known = vertex_of_[solid_.index(base[0], base[1], base[2])];
    if (known >= 0) return known;
    Vec3 sum = Vec3::Zero();
    int crossings = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (int n = 0; n < 4; ++n) {
        Node from = base;
        from[(axis + 1) % 3] += n & 1, from[(axis + 2) % 3] += n >> 1;
        Node to = from;
        ++to[axis];
        const double a = value(from), b = value(to);
        if ((a > 0) == (b > 0)) continue;
        Vec3 p(from[0], from[1], from[2]);
        p[axis] += a / (a - b);
        sum += p, ++crossings;
      }
    Vec3 p = cell_ / std::max(crossings, 1) * sum;
    for (int k = 0; k < 3; ++k) {
      const long mix = 7919L * base[0] + 104729L * base[1];
      p[k] += kJitter * (2 * noise(mix, 3L * base[2] + k, seed_) - 1);
      p[k] = std::round(1000 * p[k]) / 1000;
    }
    mesh_.vertices.push_back(p);
    return known = static_cast<int>(mesh_.vertices.size()) - 1;
  }

  const Solidity& solid_;
  TilePlace place_;
  double cell_;
  long seed_;
  std::vector<int> vertex_of_;
  Mesh mesh_;
};

/// Vertices of edges with one face.
std::vector<char> on_border(const Mesh& mesh) {
  std::vector<std::pair<int, int>> edges;
  for (const Face& f : mesh.faces)
    for (int k = 0; k < 3; ++k) edges.push_back(std::minmax(f[k], f[(k + 1) % 3]));
  std::sort(edges.begin(), edges.end());
  std::vector<char> is_border(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    if (end == i + 1) is_border[edges[i].first] = is_border[edges[i].second] = 1;
    i = end;
  }
  return is_border;
}

/// Walls that no picture showed well.
void tear_holes(Mesh& mesh, long seed) {
  std::erase_if(mesh.faces, [&](const Face& f) {
    const Vec3 cross = face_cross(mesh, f);
    if (std::abs(cross.z()) > 0.6 * cross.norm()) return false;
    const Vec3 middle = (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3;
    return smooth_noise(middle / kHoleSize, seed) > kHole;
  });
}

/// Only vertices that faces use, in the faces' order.
Mesh compacted(const Mesh& mesh) {
  Mesh out;
  std::vector<int> number(mesh.vertices.size(), -1);
  for (const Face& f : mesh.faces) {
    Face g;
    for (int k = 0; k < 3; ++k) {
      if (number[f[k]] < 0) {
        number[f[k]] = static_cast<int>(out.vertices.size());
        out.vertices.push_back(mesh.vertices[f[k]]);
      }
      g[k] = number[f[k]];
    }
    out.faces.push_back(g);
  }
  return out;
}

Mesh thinned(const Mesh& mesh, const std::vector<char>& is_locked, double error) {
  if (mesh.faces.empty()) return mesh;
  const IndexedMesh m(mesh);
  return {mesh.vertices,
          faces_of(simplify_within(m.positions, m.indices, is_locked, static_cast<float>(error)))};
}

}  // namespace

Mesh reconstruct_tile(const SkyView& view, const TilePlace& place, std::uint64_t seed) {
  const long own = static_cast<long>(seed % 1000003);
  const Solidity solid(view, place, seed);
  Mesh mesh = Net(solid, place, own).build();
  const std::vector<char> is_locked = on_border(mesh);
  tear_holes(mesh, own);
  return compacted(thinned(mesh, is_locked, kThin * place.cell));
}

}  // namespace colod::synth
