// Based on: Gortler et al., The lumigraph, SIGGRAPH 1996 (push-pull).
// Differs: pulling ends at the level whose pixels are as wide as colours may be carried.
#include "fill.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace colod::bake {

namespace {

/// Sums of colours and how many they are of; row by row.
struct Level {
  int width, height;
  std::vector<Eigen::Vector4f> sums;

  const Eigen::Vector4f& at(int x, int y) const {
    return sums[static_cast<std::size_t>(std::min(y, height - 1)) * width + std::min(x, width - 1)];
  }
  Eigen::Vector4f& at(int x, int y) { return sums[static_cast<std::size_t>(y) * width + x]; }
};

Level half_of(int width, int height) {
  Level level{(width + 1) / 2, (height + 1) / 2, {}};
  level.sums.assign(static_cast<std::size_t>(level.width) * level.height, Eigen::Vector4f::Zero());
  return level;
}

/// Weights are at most one: many known pixels count no more than one.
void saturate(Level& level) {
  for (Eigen::Vector4f& s : level.sums)
    if (s[3] > 1) s /= s[3];
}

Level first_level(const Raster& raster, const std::vector<std::uint8_t>& is_known,
                  const Window& w) {
  Level level = half_of(w.width, w.height);
  for (int y = 0; y < w.height; ++y) {
    const std::uint8_t* known = &is_known[static_cast<std::size_t>(w.y + y) * raster.width + w.x];
    const std::uint8_t* p = raster.at(w.x, w.y + y);
    Eigen::Vector4f* sums = &level.at(0, y / 2);
    for (int x = 0; x < w.width; ++x, p += 3)
      if (known[x])
        sums[x / 2] += Eigen::Vector4f(to_linear(p[0]), to_linear(p[1]), to_linear(p[2]), 1);
  }
  saturate(level);
  return level;
}

/// A coarser level at the middle of a pixel of the finer one, bilinearly.
Eigen::Vector4f between(const Level& coarse, int x, int y) {
  const int x1 = std::clamp(x / 2 + (x % 2 ? 1 : -1), 0, coarse.width - 1);
  const int y1 = std::clamp(y / 2 + (y % 2 ? 1 : -1), 0, coarse.height - 1);
  return (9 * coarse.at(x / 2, y / 2) + 3 * coarse.at(x1, y / 2) + 3 * coarse.at(x / 2, y1) +
          coarse.at(x1, y1)) /
         16;
}

}  // namespace

void push_pull(Raster& raster, const std::vector<std::uint8_t>& is_known, const Window& w,
               double reach, const Light& far) {
  std::vector<Level> levels = {first_level(raster, is_known, w)};
  // A pixel of level l covers 2^(l+1); it is mixed from its neighbours' one level up.
  for (double side = 2; 2 * side <= reach && (levels.back().width > 1 || levels.back().height > 1);
       side *= 2) {
    const Level& fine = levels.back();
    Level coarse = half_of(fine.width, fine.height);
    for (int y = 0; y < fine.height; ++y)
      for (int x = 0; x < fine.width; ++x) coarse.at(x / 2, y / 2) += fine.at(x, y);
    saturate(coarse);
    levels.push_back(std::move(coarse));
  }
  for (Eigen::Vector4f& s : levels.back().sums)
    s += (1 - s[3]) * Eigen::Vector4f(far[0], far[1], far[2], 1);
  for (std::size_t l = levels.size() - 1; l-- > 0;)
    for (int y = 0; y < levels[l].height; ++y)
      for (int x = 0; x < levels[l].width; ++x) {
        Eigen::Vector4f& own = levels[l].at(x, y);
        if (own[3] < 1) own += (1 - own[3]) * between(levels[l + 1], x, y);
      }
  for (int y = 0; y < w.height; ++y)
    for (int x = 0; x < w.width; ++x) {
      if (is_known[static_cast<std::size_t>(w.y + y) * raster.width + w.x + x]) continue;
      const Eigen::Vector4f light = between(levels[0], x, y);
      for (int c = 0; c < 3; ++c) raster.at(w.x + x, w.y + y)[c] = to_srgb(light[c]);
    }
}

void fill_evenly(Raster& raster, const Window& w, const Light& light) {
  const std::array rgb{to_srgb(light[0]), to_srgb(light[1]), to_srgb(light[2])};
  for (int y = w.y; y < w.y + w.height; ++y)
    for (int x = w.x; x < w.x + w.width; ++x) std::ranges::copy(rgb, raster.at(x, y));
}

}  // namespace colod::bake
