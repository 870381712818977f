// Based on: libpng's simplified API, which turns palettes, grey and 16 bits into 8 bits of sRGB.
#include <png.h>

#include "codecs.h"

namespace colod::codecs {

namespace {

/// Gives libpng's memory back.
struct Image : png_image {
  Image() : png_image{} { version = PNG_IMAGE_VERSION; }
  ~Image() { png_image_free(this); }
  Image(const Image&) = delete;
  Image& operator=(const Image&) = delete;

  [[noreturn]] void fail() const {
    throw std::runtime_error(std::string("is damaged: ") + message);
  }
};

}  // namespace

DecodedImage decode_png(std::string_view bytes, std::size_t most_bytes) {
  Image image;
  if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size())) image.fail();
  check_size(image.width, image.height, most_bytes);
  image.format = PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> rgba(PNG_IMAGE_SIZE(image));
  if (!png_image_finish_read(&image, nullptr, rgba.data(), 0, nullptr)) image.fail();
  return {split_alpha(rgba, static_cast<int>(image.width), static_cast<int>(image.height)), {}};
}

std::string encode_png(const Raster& raster) {
  Image image;
  image.width = static_cast<png_uint_32>(raster.width);
  image.height = static_cast<png_uint_32>(raster.height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string out(size, '\0');
  if (!png_image_write_to_memory(&image, out.data(), &size, 0, raster.rgb.data(), 0, nullptr))
    image.fail();
  out.resize(size);
  return out;
}

}  // namespace colod::codecs
