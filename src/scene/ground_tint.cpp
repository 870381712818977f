// Based on: push and pull (S. Gortler et al., The Lumigraph, 1996).
#include "ground_tint.h"

#include <algorithm>
#include <cmath>

#include "parameters.h"

namespace colod {

using namespace parameters::closing;

GroundTint::GroundTint(const HeightMap& map, const SceneClasses& classes) {
  if (map.color.empty()) return;
  origin_ = map.origin, cell_ = kTintCells * map.cell;
  gather(map, classes);
  while (levels_.back().cells.size() > 1) halve();
  fill();
}

void GroundTint::gather(const HeightMap& map, const SceneClasses& classes) {
  Level level{
      (map.width + kTintCells - 1) / kTintCells, (map.height + kTintCells - 1) / kTintCells, {}};
  level.cells.assign(static_cast<std::size_t>(level.width) * level.height, Eigen::Vector4f::Zero());
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const std::size_t i = map.at(x, y);
      if (classes.of_cell[i] != SceneClass::kGround) continue;
      if (!(std::abs(map.top[i] - classes.ground[i]) < kBare)) continue;
      const Rgb& rgb = map.color[i];
      level.cells[static_cast<std::size_t>(y / kTintCells) * level.width + x / kTintCells] +=
          Eigen::Vector4f(rgb[0], rgb[1], rgb[2], 1);
    }
  levels_.push_back(std::move(level));
}

void GroundTint::halve() {
  const Level& fine = levels_.back();
  Level out{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
  out.cells.assign(static_cast<std::size_t>(out.width) * out.height, Eigen::Vector4f::Zero());
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x)
      out.cells[static_cast<std::size_t>(y / 2) * out.width + x / 2] +=
          fine.cells[static_cast<std::size_t>(y) * fine.width + x];
  levels_.push_back(std::move(out));
}

void GroundTint::fill() {
  Eigen::Vector4f& all = levels_.back().cells[0];
  all = all[3] > 0 ? Eigen::Vector4f(all / all[3]) : Eigen::Vector4f(128, 128, 128, 1);
  for (std::size_t k = levels_.size() - 1; k-- > 0;) {
    Level& level = levels_[k];
    for (int y = 0; y < level.height; ++y)
      for (int x = 0; x < level.width; ++x) {
        Eigen::Vector4f& c = level.cells[static_cast<std::size_t>(y) * level.width + x];
        c = c[3] > 0 ? Eigen::Vector4f(c / c[3])
                     : levels_[k + 1].between((x + 0.5) / 2, (y + 0.5) / 2);
      }
  }
}

const Eigen::Vector4f& GroundTint::Level::clamped(int x, int y) const {
  return cells[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * width +
               std::clamp(x, 0, width - 1)];
}

/// Coordinates in cells from the first one's corner.
Eigen::Vector4f GroundTint::Level::between(double x, double y) const {
  const int u = static_cast<int>(std::floor(x - 0.5)), v = static_cast<int>(std::floor(y - 0.5));
  const auto s = static_cast<float>(x - 0.5 - u), t = static_cast<float>(y - 0.5 - v);
  return (1 - t) * ((1 - s) * clamped(u, v) + s * clamped(u + 1, v)) +
         t * ((1 - s) * clamped(u, v + 1) + s * clamped(u + 1, v + 1));
}

Rgb GroundTint::at(const Vec2& p) const {
  const Vec2 at = (p - origin_) / cell_;
  const Level& level = levels_[0];
  const Eigen::Vector4f c = level.between(std::clamp(at.x(), 0.0, double(level.width)),
                                          std::clamp(at.y(), 0.0, double(level.height)));
  Rgb out;
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = static_cast<std::uint8_t>(std::lround(c[static_cast<int>(k)]));
  return out;
}

}  // namespace colod
