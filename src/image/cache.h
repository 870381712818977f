// Images as they are sampled: decoded when they are needed, each with its mip chain, and let go of
// when others need the room.
#pragma once

#include <memory>

#include "image.h"

namespace colod {

/// Level 0 is the image; each further one half as wide and high, averaged in linear light, down to
/// one pixel.
struct Pyramid {
  std::vector<Raster> levels;
};

/// Stands for an image that a source names and nobody can find; messages call it `name`. No file is
/// ever opened for it.
ImagePlace missing_image(const std::string& name);
bool is_missing(const ImagePlace& place);

/// The encoded image. Throws std::runtime_error where it cannot be read.
std::string read_image(const ImagePlace& place, std::size_t most_bytes);

class ImageCache {
 public:
  struct Entry {
    std::shared_ptr<const Pyramid> pyramid;  ///< null: it cannot be read
    std::string problem;   ///< why not, or what is wrong with it; one line; empty: nothing
    bool is_lost = false;  ///< it, or a part of it, cannot be shown
  };

  /// `budget`: bytes that decoded images may take together, those in use included.
  explicit ImageCache(std::size_t budget);
  ~ImageCache();
  ImageCache(ImageCache&&) noexcept;

  /// Decodes it where it is not there. What is held by others stays in memory beyond the budget
  /// until they let go. Thread-safe.
  Entry get(const ImagePlace& place) const;
  /// Pixels that stand for a place of which no file is read; they stay, and take nothing of the
  /// budget. Thread-safe.
  void put(const ImagePlace& place, Raster raster);
  /// Width and height in pixels, 0 where it cannot be read, and what is wrong with it. Decodes it
  /// where nobody asked for it before.
  struct Facts {
    int width = 0, height = 0;
    std::string problem;
    bool is_lost = false;
  };
  Facts facts(const ImagePlace& place) const;
  /// Whether a pixel of it is not opaque; false where it cannot be read. Decodes it as `facts`
  /// does.
  bool has_alpha(const ImagePlace& place) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colod
