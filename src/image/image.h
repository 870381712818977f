// Encoded images ↔ pixels.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/appearance.h"

namespace colod {

/// Pixels, sRGB, row by row from the top.
struct Raster {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;    ///< 3 a pixel
  std::vector<std::uint8_t> alpha;  ///< 1 a pixel, 255: opaque; empty: all are

  Raster() = default;
  Raster(int w, int h)
      : width(w), height(h), rgb(3 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

  std::uint8_t* at(int x, int y) { return &rgb[3 * (static_cast<std::size_t>(y) * width + x)]; }
  /// 0..1.
  float alpha_at(int x, int y) const {
    return alpha.empty() ? 1.f
                         : static_cast<float>(alpha[static_cast<std::size_t>(y) * width + x]) / 255;
  }
  const std::uint8_t* at(int x, int y) const {
    return &rgb[3 * (static_cast<std::size_t>(y) * width + x)];
  }
};

/// Half as wide and high, averaged in linear light; one pixel at least. What is transparent has no
/// part in the colour, unless all of a pixel is.
Raster halve(const Raster& fine);

enum class ImageFormat { kJpeg, kWebp, kPng, kKtx2 };

/// Whether the program basisu is on the PATH.
bool can_encode_ktx2();

/// "image/jpeg" …
const char* mime_of(ImageFormat format);
/// "jpg" …
const char* extension_of(ImageFormat format);

struct DecodedImage {
  Raster raster;
  std::string remark;       ///< what is wrong with it though it could be read; empty: nothing
  bool is_damaged = false;  ///< a part of it could not be read: that is what the remark says
};

/// JPEG (also progressive, grey, CMYK), PNG (of any kind) or WebP. Transparency is
/// kept, unless no pixel is opaque by half: then it means something else. Throws
/// std::runtime_error with the cause, also where its pixels take more than `most_bytes`, which is
/// known before any of them is decoded. Thread-safe.
DecodedImage decode_image(std::string_view bytes, std::size_t most_bytes);

/// `quality` 1..100, of all but PNG. The same pixels give the same bytes. KTX2 holds the whole mip
/// chain, and takes the program basisu, which compresses it. Throws std::runtime_error.
/// Thread-safe.
std::string encode_image(const Raster& raster, ImageFormat format, int quality);

}  // namespace colod
