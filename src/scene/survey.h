// The tiles of a scene → heights and colours on a grid, as seen from straight above.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry.h"
#include "image/cache.h"
#include "tiles.h"

namespace colod {

enum class SceneClass : std::uint8_t { kNothing, kGround, kBuilding, kPlant, kRest };

/// Row by row from the least y; NaN heights where nothing is.
struct HeightMap {
  Vec2 origin = Vec2::Zero();    ///< the corner of the first cell
  double cell = 0;               ///< metres
  int width = 0, height = 0;     ///< cells
  std::vector<float> top;        ///< metres, of the highest surface at the cell's middle
  std::vector<Rgb> color;        ///< of that surface; empty: nothing has a colour
  std::vector<SceneClass> told;  ///< what its source says that a cell shows, kNothing: nothing of
                                 ///< it; empty: it says nothing at all
  std::vector<float> ground;     ///< metres, where its source knows the ground, NaN: it does not;
                                 ///< empty: nowhere
  bool is_sharp = false;         ///< walls are steps from cell to cell, as of points; a measured
                                 ///< mesh melts them

  std::size_t size() const { return top.size(); }
  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
  Vec2 middle(int x, int y) const { return origin + cell * Vec2(x + 0.5, y + 0.5); }
};

/// Draws a mesh into a map whose grid stands and whose arrays are as long as it: what is higher
/// than what is there shows. What has no look is grey.
void draw_from_above(const Source& source, const ImageCache& images, HeightMap& map);

/// Reads every tile once, in parallel. Cells are larger where the scene is so large that its map
/// would take more than 64 million of them: 16 bytes a cell. `image_memory`: bytes that decoded
/// images may take.
HeightMap survey(const SceneTiles& tiles, std::size_t image_memory);

}  // namespace colod
