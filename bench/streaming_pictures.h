// What a stop looks like: our own pictures of it, and those that clients took.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/rays.h"
#include "measure/picture_difference.h"
#include "measure/picture_errors.h"
#include "picture/picture.h"
#include "streaming_tileset.h"

namespace colod::bench {

/// Tiles as one soup, ready to be looked at.
class Scenery {
 public:
  Scenery(const Tileset& tileset, const std::vector<int>& tiles);

  /// Luminance of what lies in this direction from the eye; −1: sky.
  double luminance(const Vec3& eye, const Vec3& direction, const Vec3& light) const;

 private:
  Mesh mesh_;
  RayScene rays_;
};

/// Pixels from (x0, y0) up to, without, (x1, y1).
struct Window {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool is_empty() const { return x0 >= x1 || y0 >= y1; }
};

struct PictureOptions {
  int width = 1920, height = 1080;
  int samples = 2;  ///< rays along a pixel's side
};

/// Where pictures can differ: about all drawn tiles that something finer could replace, with a
/// margin as wide as compare_pictures looks.
Window window_of_change(const Tileset& tileset, const std::vector<int>& drawn, const Camera& camera,
                        const PictureOptions& options);

/// Where a box in the tileset's frame is seen, with a few pixels of margin and within `outer`.
Window window_of(const Box& box, const Camera& camera, const PictureOptions& options,
                 const Window& outer);

/// The part of a picture that shows `inner`, of one that shows `outer`.
GreyPicture cropped(const GreyPicture& picture, const Window& outer, const Window& inner);

/// Flat shaded with the light over the viewer's left shoulder, as the measure behind
/// `--switch visual` draws. In parallel.
GreyPicture draw(const Scenery& scenery, const Camera& camera, const Window& window,
                 const PictureOptions& options);

/// A client's screenshot: grey buildings before pure blue, as the pages of streaming_clients draw.
GreyPicture read_screenshot(const std::string& path);

/// A client's screenshot in its colours; what is nearly pure blue is the sky.
ColorPicture read_colors(const std::string& path);

/// Both pictures and where they differ, side by side.
Image side_by_side(const GreyPicture& a, const GreyPicture& b);

}  // namespace colod::bench
