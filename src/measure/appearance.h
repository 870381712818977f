// How alike two textured meshes look, from all sides, at the size of a pixel.
#pragma once

#include <cstdint>

#include "core/geometry.h"

namespace colod {

class LookSampler;

/// Over the pixels that either of both covers, of all pictures together.
struct AppearanceDifference {
  int directions = 0;
  double gsd = 0;                             ///< metres a pixel
  std::int64_t pixels = 0;                    ///< that either covers
  double psnr = 0;                            ///< dB, of sRGB; infinite: nothing differs
  double ssim = 1;                            ///< of luminance, 1: nothing differs
  double flip = 0;                            ///< 0..1, at 67 pixels a degree; 0: nothing differs
  double only_reference = 0, only_model = 0;  ///< shares of the pixels that one alone covers
};

/// Pictures without light of their own, orthographic, on grey, from 24 directions: eight each at
/// 10, 35 and 60 degrees above the horizon. Back faces are not seen. Runs in parallel,
/// deterministic. Throws Error{kUsage} where a picture has more than 4096 pixels a side.
AppearanceDifference compare_appearance(const Mesh& reference, const LookSampler& reference_look,
                                        const Mesh& model, const LookSampler& model_look,
                                        double gsd);

}  // namespace colod
