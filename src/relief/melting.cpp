// Based on: residuals of local planes, as in src/planes/noise.cpp. Differs: over pieces as wide as
// windows, so that bumps a metre wide count as noise, and of all walls and roofs but the roughest.
// Measured in November 2026 (flattest quarter, lean): 52 cut-outs of two drone scenes 0.06 to 0.24
// m, 0.07 to 0.16 for heights, -0.03 to 0.26 for a coarse mesh; simulated drone scans with edges of
// 0.02 to 0.2 m 0.007 to 0.04 m, 0.04 to 0.15; simulated photogrammetry from the street 0.015 to
// 0.024 m, 0 to 0.03; a church and a house by MVS 0.034 and 0.059 m, 0.02 and 0.01.
// Notation: –
#include "melting.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "core/drawn.h"
#include "core/flat.h"
#include "parameters.h"
#include "relief.h"

namespace colod {
namespace relief {
namespace {

using namespace parameters::relief;

struct Side {
  Vec3 center, normal;
  double area;
  int face;
};

std::vector<Side> sides_of(const Mesh& mesh) {
  std::vector<Side> sides;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face& t = mesh.faces[f];
    const Vec3 cross = face_cross(mesh, t);
    const double length = cross.norm();
    if (!(length > 1e-12)) continue;
    sides.push_back({(mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3,
                     cross / length, 0.5 * length, static_cast<int>(f)});
  }
  return sides;
}

/// Metres: nearly a third of the surface has shorter edges, about the median of a mesh of even
/// triangles. By area, since a mesh that was cut out of a place has slivers along its rim.
double typical_edge(const Mesh& mesh) {
  std::vector<std::pair<double, double>> areas;  // by length
  double total = 0, passed = 0;
  for (const Face& f : mesh.faces)
    for (int k = 0; k < 3; ++k) {
      const double length = (mesh.vertices[f[k]] - mesh.vertices[f[(k + 1) % 3]]).norm();
      areas.emplace_back(length, face_area(mesh, f));
      total += areas.back().second;
    }
  std::sort(areas.begin(), areas.end());
  for (const auto& [length, area] : areas)
    if ((passed += area) >= kEdgeShare * total) return length;
  return 0;
}

double mean_lean(const std::vector<Side>& sides) {
  double walls = 0, sum = 0;
  for (const Side& s : sides)
    if (std::abs(s.normal.z()) < kSteepest) walls += s.area, sum += s.area * s.normal.z();
  return walls > 0 ? sum / walls : 0;
}

/// Faces by where they are, in cubes.
class Cubes {
 public:
  Cubes(const std::vector<Side>& sides, double size) : sides_(sides), size_(size) {
    for (std::size_t i = 0; i < sides.size(); ++i)
      cubes_[key(sides[i].center)].push_back(static_cast<int>(i));
  }

  /// Root mean square distance of what looks the same way around a face from its plane; < 0: too
  /// little does.
  double residual(const Mesh& mesh, const Side& at) const {
    double weight = 0;
    Vec3 sum = Vec3::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    int count = 0;
    const auto add = [&](const Side& s) {
      ++count;
      for (const int v : mesh.faces[s.face]) {
        const Vec3 p = mesh.vertices[v] - at.center;
        weight += s.area, sum += s.area * p, squares += s.area * p * p.transpose();
      }
    };
    for_each_near(at, add);
    if (count < kLeastSides) return -1;
    const Vec3 mean = sum / weight;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
        squares / weight - mean * mean.transpose(), Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
  }

 private:
  using Key = std::array<int, 3>;
  Key key(const Vec3& p) const {
    return {static_cast<int>(std::floor(p.x() / size_)),
            static_cast<int>(std::floor(p.y() / size_)),
            static_cast<int>(std::floor(p.z() / size_))};
  }

  template <typename Add>
  void for_each_near(const Side& at, const Add& add) const {
    const Key middle = key(at.center);
    for (int k = 0; k < 27; ++k) {
      const auto cube =
          cubes_.find({middle[0] + k / 9 - 1, middle[1] + k / 3 % 3 - 1, middle[2] + k % 3 - 1});
      if (cube == cubes_.end()) continue;
      const std::size_t step = 1 + cube->second.size() / kMostSides;
      for (std::size_t i = 0; i < cube->second.size(); i += step) {
        const Side& s = sides_[cube->second[i]];
        if ((s.center - at.center).norm() < size_ && s.normal.dot(at.normal) > kAlike) add(s);
      }
    }
  }

  const std::vector<Side>& sides_;
  double size_;
  std::map<Key, std::vector<int>> cubes_;
};

double measure_bulge(const Mesh& mesh, const std::vector<Side>& sides, double edge) {
  const Cubes cubes(sides, std::max(kWindow, kWindowEdges * edge));
  double total = 0, passed = 0;
  for (const Side& s : sides) total += s.area;
  std::vector<double> residuals;
  for (const Side& s : sides) {
    const double before = std::floor(passed / total * kSamples);
    passed += s.area;
    if (std::floor(passed / total * kSamples) == before) continue;
    if (const double r = cubes.residual(mesh, s); r >= 0) residuals.push_back(r);
  }
  if (residuals.empty()) return 0;
  std::sort(residuals.begin(), residuals.end());
  return residuals[residuals.size() / 4];
}

/// A face seen from above: twice its area, and its sides by length.
struct Shadow {
  double twice = 0;
  std::array<double, 3> sides{};

  /// Half a square of so many metres.
  bool is_half_of(double cell) const {
    const auto is_near = [&](double side, double times) {
      return std::abs(side - times * cell) < kSameCell * cell;
    };
    return is_near(sides[0], 1) && is_near(sides[1], 1) && is_near(sides[2], M_SQRT2);
  }
};

Shadow shadow_of(const Mesh& mesh, const Face& face) {
  Shadow shadow{face_cross(mesh, face).z()};
  for (std::size_t k = 0; k < 3; ++k)
    shadow.sides[k] = (mesh.vertices[face[k]] - mesh.vertices[face[(k + 1) % 3]]).head<2>().norm();
  std::sort(shadow.sides.begin(), shadow.sides.end());
  return shadow;
}

}  // namespace

bool Melting::is_leaning() const { return lean > kLeastLean; }
bool Melting::is_wide() const { return edge > kWide && bulge > kWideBulge; }
bool Melting::is_coarse() const {
  return is_wide() || (bulge > kCoarseBulge && std::max(edge, kToldBulges * bulge) > kCoarse);
}
bool Melting::is_melted() const {
  return bulge > kExactBulge && drawn < kLeastDrawn && (is_leaning() || is_coarse());
}
double Melting::reach() const {
  return std::max({kLeastReach, kReachBulges * bulge, kReachEdges * edge});
}

Melting measure_melting(const Mesh& mesh) {
  const std::vector<Side> sides = sides_of(mesh);
  if (sides.empty()) return {};
  const double edge = typical_edge(mesh);
  return {edge, measure_bulge(mesh, sides, edge), mean_lean(sides), drawn_share(mesh),
          raster_cell(mesh)};
}

}  // namespace relief

double raster_cell(const Mesh& mesh) {
  using namespace relief;
  if (mesh.faces.size() < kLeastRaster) return 0;
  std::vector<Shadow> shadows;
  std::vector<double> cells;
  double area = 0, other = 0;  // twice, of faces that do not look up: there is more than heights
  for (const Face& f : mesh.faces) {
    shadows.push_back(shadow_of(mesh, f));
    const Shadow& s = shadows.back();
    if (s.is_half_of(s.sides[0])) cells.push_back(s.sides[0]);
    const double own = face_cross(mesh, f).norm();
    area += own, other += s.twice < kUpright * own ? own : 0;
  }
  if (cells.empty()) return 0;
  const double cell = median(std::move(cells));
  double plan = 0, whole = 0;
  for (const Shadow& s : shadows) plan += s.twice, whole += s.is_half_of(cell) ? s.twice : 0;
  return other < kMostOther * area && whole > kWholeCells * plan ? cell : 0;
}

}  // namespace colod
