// How much of a change a viewer sees between two pictures of the same place, in pixels: the measure
// by which layers switch (docs/outputs.md says it in a sentence).
#pragma once

#include <vector>

namespace colod {

/// A picture in grey, rows from the top. Both values lie in 0..1; luminance is what the screen is
/// told (sRGB), sky included, coverage the share of a pixel that is no sky.
struct GreyPicture {
  int width = 0, height = 0;
  std::vector<float> luminance, coverage;  ///< width × height
};

/// The side of a square is what people can judge: a piece of n pixels at contrast c counts as a
/// square of √(n·c / kReferenceContrast) pixels.
constexpr double kReferenceContrast = 0.25;

/// Pixels. 0: nothing differs but by what moving a line by a pixel explains.
struct PictureDifference {
  double piece = 0;    ///< side of the largest change in one piece, weighed by its contrast
  double outline = 0;  ///< how far the outline against the sky moves, to 32 pixels

  /// Pixels that one bound N holds: pieces up to N × N, outlines up to N / 2.
  double pixels() const { return piece > 2 * outline ? piece : 2 * outline; }
};

/// Symmetric. Pictures of the same size; else an assertion fails. O(pixels).
PictureDifference compare_pictures(const GreyPicture& a, const GreyPicture& b);

}  // namespace colod
