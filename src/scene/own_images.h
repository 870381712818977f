// Part of a large mesh, whose images many parts share → the same with images of its own, which show
// no more than it wears.
#pragma once

#include <memory>

#include "core/geometry.h"
#include "image/cache.h"

namespace colod {

/// Where such images lie: as long as this is there.
class OwnImages {
 public:
  /// `memory`: bytes that decoded images may take.
  explicit OwnImages(std::size_t memory);
  ~OwnImages();

  /// Pieces of an image that faces wear move into a smaller one, where that is less than half as
  /// large; pixels stay as they are, but for a JPEG's one more encoding. What repeats beyond an
  /// image's border, or cannot be decoded, stays. Thread-safe.
  void give(Source& source) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colod
