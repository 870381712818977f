// Ground where none was seen: below buildings, and below all that stands.
#pragma once

#include "classes.h"
#include "territory.h"

namespace colod {

/// Keeps references to what it is given.
class ClosingGround {
 public:
  ClosingGround(const HeightMap& map, const SceneClasses& classes);

  /// Over pieces of the plan: the surface where it is bare, else the terrain below what stands
  /// there. Colours as the map has them; of what nobody has seen the mean of all bare ground.
  Source below(const std::vector<Territories::Piece>& pieces) const;

  /// The same over the map's cells from (x0, y0) to (x1, y1), both included, where there is
  /// anything; without colours.
  Source terrain(int x0, int y0, int x1, int y1) const;

  /// Of a mesh over the scene: the faces that are bare ground.
  Source bare(const Source& source) const;

 private:
  void add_face(const std::array<Vec2, 3>& corners, Source& out) const;
  std::size_t cell_at(const Vec2& p) const;
  bool is_bare(std::size_t cell) const;
  double height(std::size_t cell) const;

  const HeightMap& map_;
  const SceneClasses& classes_;
  Rgb mean_ = {128, 128, 128};
};

}  // namespace colod
