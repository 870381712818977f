// Ground where none was seen: below buildings, and below all that stands.
#pragma once

#include <memory>

#include "classes.h"
#include "territory.h"

namespace colod {

class GroundTint;

/// Keeps references to what it is given.
class ClosingGround {
 public:
  ClosingGround(const HeightMap& map, const SceneClasses& classes);
  ~ClosingGround();

  /// Over pieces of the plan: the surface where it is bare, else the terrain below what stands
  /// there, cut into squares. Colours as the map has them; of what nobody has seen those
  /// around.
  Source below(const std::vector<Territories::Piece>& pieces) const;

  /// The same over the map's cells from (x0, y0) to (x1, y1), both included, where there is
  /// anything; without colours.
  Source terrain(int x0, int y0, int x1, int y1) const;

  /// Of a mesh over the scene: the faces that are bare ground.
  Source bare(const Source& source) const;

  /// Metres: of the surface and the terrain about a place what is lowest.
  double lowest(const Vec2& p) const;

 private:
  void add_face(const std::array<Vec2, 3>& corners, Source& out) const;
  std::array<int, 2> cell_at(const Vec2& p) const;
  std::size_t index_at(const Vec2& p) const;
  bool is_bare(std::size_t cell) const;
  double height(std::size_t cell) const;
  double height_at(const Vec2& p) const;
  Rgb color_at(const Vec2& p) const;

  const HeightMap& map_;
  const SceneClasses& classes_;
  std::unique_ptr<const GroundTint> tint_;
};

}  // namespace colod
