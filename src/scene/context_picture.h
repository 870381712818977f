// Inside room `scene` only: what a tile looks like from above, as its texture.
#pragma once

#include <string>
#include <vector>

#include "context_chain.h"
#include "image/cache.h"

namespace colod {

/// Where on the plan a picture lies: its first pixel is the one of least x and y.
struct PictureFrame {
  Vec2 origin = Vec2::Zero();
  double texel = 0;           ///< metres
  int width = 0, height = 0;  ///< pixels
};

/// A JPEG of what tiles look like over a box, and where it lies; empty where none has a look.
std::string draw_context(const std::vector<ChainPart>& parts, const Box& box, double texel,
                         const ImageCache& images, PictureFrame& frame);

/// The mesh wears the picture.
void wear(const PictureFrame& frame, const ImagePlace& picture, Source& source);

}  // namespace colod
