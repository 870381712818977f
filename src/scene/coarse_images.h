// A coarse tile of a source → the same with one image, no finer than the pixels that it is seen at.
#pragma once

#include <memory>

#include "core/geometry.h"
#include "image/cache.h"

namespace colod {

/// Where such images lie: as long as this is there.
class CoarseImages {
 public:
  /// `memory`: bytes that decoded images may take.
  explicit CoarseImages(std::size_t memory);
  ~CoarseImages();

  /// The charts that faces wear move into one JPEG, each as it is or, where its texels are finer
  /// than `texel` in the mean, as small as makes them so; what nobody wears has no part in a mean.
  /// Where charts would take more room than their images these are one chart each. The source is
  /// left as it is where that saves less than a tenth of its texels and most of them are worn; so
  /// is an image that is transparent, tinted, repeated or cannot be decoded. `texel`: metres.
  /// With `has_mip_levels` the sides are powers of two, since clients would raise them.
  /// Thread-safe.
  void give(Source& source, double texel, bool has_mip_levels) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colod
