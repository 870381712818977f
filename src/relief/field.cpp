// Based on: height fields of airborne data, as in Zhou & Neumann, "2.5D dual contouring", ECCV
// 2010. Differs: the field is drawn by rays from a mesh. Notation: –
#include "field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "parameters.h"

namespace colod::relief {
namespace {

using namespace parameters::relief;

const Vec3 kDown = -Vec3::UnitZ();

/// Metres a metre, from the cells on both sides.
double slope(const Field& f, int i) {
  double most = 0;
  const auto around = f.beside(i);
  for (int axis = 0; axis < 2; ++axis) {
    const int a = around[2 * axis], b = around[2 * axis + 1];
    const bool has_a = a >= 0 && f.has(a), has_b = b >= 0 && f.has(b);
    if (!has_a && !has_b) continue;
    const double from = has_a ? f.height[a] : f.height[i], to = has_b ? f.height[b] : f.height[i];
    most = std::max(most, std::abs(to - from) / (f.cell * (int{has_a} + int{has_b})));
  }
  return most;
}

/// Root mean square distance in height of the window around a cell from its plane; < 0: unknown.
double window_residual(const Field& f, int i) {
  const int reach = std::max(1, static_cast<int>(std::lround(kRoom / f.cell)));
  const int column = i % f.columns, row = i / f.columns;
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (int r = std::max(0, row - reach); r <= std::min(f.rows - 1, row + reach); ++r)
    for (int c = std::max(0, column - reach); c <= std::min(f.columns - 1, column + reach); ++c) {
      const int j = r * f.columns + c;
      if (!f.has(j) || f.is_steep[j] || std::abs(f.height[j] - f.height[i]) > kRoom) continue;
      const Eigen::Vector4d v(c - column, r - row, f.height[j] - f.height[i], 1);
      sum += v * v.transpose();
    }
  const double n = sum(3, 3);
  if (n < 0.5 * (2 * reach + 1) * (2 * reach + 1)) return -1;
  const Eigen::Vector3d mean = sum.block<3, 1>(0, 3) / n;
  const Eigen::Matrix3d c = sum.block<3, 3>(0, 0) / n - mean * mean.transpose();
  const Eigen::Matrix2d xy = c.block<2, 2>(0, 0) + 1e-9 * Eigen::Matrix2d::Identity();
  const Vec2 xz = c.block<2, 1>(0, 2);
  return std::sqrt(std::max(0.0, c(2, 2) - xz.dot(xy.inverse() * xz)));
}

/// Metres of height a metre, towards where it rises.
Vec2 gradient(const Field& f, int i) {
  const auto around = f.beside(i);
  const auto along = [&](int a, int b) {
    const bool has_a = a >= 0 && f.has(a), has_b = b >= 0 && f.has(b);
    if (!has_a && !has_b) return 0.0;
    return ((has_b ? f.height[b] : f.height[i]) - (has_a ? f.height[a] : f.height[i])) /
           (f.cell * (int{has_a} + int{has_b}));
  };
  return {along(around[0], around[1]), along(around[2], around[3])};
}

/// What is steep up and down from a cell, in a straight line.
struct SteepRun {
  double length = 0, rise = 0;  // metres
};

SteepRun run_through(const Field& f, const std::vector<char>& is_steep, int cell, const Vec2& up) {
  const auto end = [&](double way) {
    int last = cell;
    for (double off = f.cell; off < kLongestRun; off += f.cell) {
      const int at = f.at(f.center(cell) + way * off * up);
      if (at < 0 || !is_steep[at] || way * (f.height[at] - f.height[last]) < 0) break;
      last = at;
    }
    return last;
  };
  const int low = end(-1), high = end(1);
  return {(f.center(high) - f.center(low)).norm(), f.height[high] - f.height[low]};
}

/// Steep cells of a raster that are no wall.
void keep_steep_roofs(Field& f, double raster) {
  const std::vector<char> is_steep = f.is_steep;
  for (int i = 0; i < f.size(); ++i) {
    if (!is_steep[i]) continue;
    const Vec2 slope = gradient(f, i);
    const double tilt = slope.norm();
    if (!(tilt > 0)) continue;
    const SteepRun run = run_through(f, is_steep, i, slope / tilt);
    if (run.length > kSteepRun * raster && tilt * run.length < kWallOfRun * run.rise)
      f.is_steep[i] = 0;
  }
}

}  // namespace

int Field::at(const Vec2& p) const {
  const Vec2 q = (p - origin) / cell;
  if (q.x() < 0 || q.y() < 0 || q.x() >= columns || q.y() >= rows) return -1;
  return static_cast<int>(q.y()) * columns + static_cast<int>(q.x());
}

std::array<int, 4> Field::beside(int i) const {
  const int c = i % columns, r = i / columns;
  return {c > 0 ? i - 1 : -1, c + 1 < columns ? i + 1 : -1, r > 0 ? i - columns : -1,
          r + 1 < rows ? i + columns : -1};
}

Field make_field(const Mesh& mesh, const RayScene& rays, double edge, double raster) {
  const Box box = bounding_box(mesh.vertices);
  const Vec3 size = box.size();
  Field f;
  f.cell = std::max(std::clamp(kCellShare * edge, kLeastCell, kMostCell),
                    std::max(size.x(), size.y()) / kMostCells);
  f.columns = static_cast<int>(size.x() / f.cell) + 1;
  f.rows = static_cast<int>(size.y() / f.cell) + 1;
  f.origin = box.center().head<2>() - 0.5 * f.cell * Vec2(f.columns, f.rows);
  f.height.assign(f.size(), std::numeric_limits<double>::quiet_NaN());
  f.face.assign(f.size(), -1);
  f.is_steep.assign(f.size(), 0);
  const double top = box.max.z() + 1;
  parallel_ranges(f.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec2 p = f.center(static_cast<int>(i));
      const RayHit hit = rays.first_hit({p.x(), p.y(), top}, kDown);
      if (hit) f.face[i] = hit.triangle, f.height[i] = top - hit.distance;
    }
  });
  for (int i = 0; i < f.size(); ++i) f.is_steep[i] = f.has(i) && slope(f, i) > kSteep;
  if (raster > 0) keep_steep_roofs(f, raster);
  return f;
}

double roof_noise(const Field& f) {
  std::vector<int> flat;
  for (int i = 0; i < f.size(); ++i)
    if (f.has(i) && !f.is_steep[i]) flat.push_back(i);
  const std::size_t step = std::max<std::size_t>(1, flat.size() / kSamples);
  std::vector<double> residuals;
  for (std::size_t k = step / 2; k < flat.size(); k += step)
    if (const double r = window_residual(f, flat[k]); r >= 0) residuals.push_back(r);
  if (residuals.empty()) return 0;
  std::sort(residuals.begin(), residuals.end());
  return residuals[static_cast<std::size_t>(kNoiseQuantile * residuals.size())];
}

}  // namespace colod::relief
