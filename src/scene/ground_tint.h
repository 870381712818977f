// Inside room `scene` only: the colour of ground that nobody has seen.
#pragma once

#include "classes.h"

namespace colod {

/// Bare ground as it is, averaged over a few cells, and smoothly what lies around it elsewhere.
class GroundTint {
 public:
  /// A map without colours has none.
  GroundTint(const HeightMap& map, const SceneClasses& classes);

  bool is_empty() const { return levels_.empty(); }
  Rgb at(const Vec2& p) const;

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<Eigen::Vector4f> cells;  // sums of colours and how many; then means
    const Eigen::Vector4f& clamped(int x, int y) const;
    Eigen::Vector4f between(double x, double y) const;
  };
  void gather(const HeightMap& map, const SceneClasses& classes);
  void halve();
  void fill();

  Vec2 origin_ = Vec2::Zero();
  double cell_ = 0;
  std::vector<Level> levels_;
};

}  // namespace colod
