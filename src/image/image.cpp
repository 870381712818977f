#include "image.h"

#include <algorithm>

#include "codecs.h"

namespace colod {

namespace codecs {

void check_size(std::size_t width, std::size_t height, std::size_t most_bytes) {
  if (width == 0 || height == 0) throw std::runtime_error("has no pixels");
  if (width > most_bytes / 4 / height)
    throw std::runtime_error("is " + std::to_string(width) + " x " + std::to_string(height) +
                             " pixels, more than --texture-memory allows");
}

Raster split_alpha(const std::vector<std::uint8_t>& rgba, int width, int height) {
  Raster out(width, height);
  std::uint8_t least = 255, most = 0;
  for (std::size_t i = 0; i < rgba.size() / 4; ++i) {
    std::copy_n(&rgba[4 * i], 3, &out.rgb[3 * i]);
    least = std::min(least, rgba[4 * i + 3]), most = std::max(most, rgba[4 * i + 3]);
  }
  if (least == 255 || most < 128) return out;
  for (std::size_t i = 0; i < rgba.size() / 4; ++i) out.alpha.push_back(rgba[4 * i + 3]);
  return out;
}

}  // namespace codecs

const char* mime_of(ImageFormat format) {
  switch (format) {
    case ImageFormat::kJpeg:
      return "image/jpeg";
    case ImageFormat::kWebp:
      return "image/webp";
    case ImageFormat::kPng:
      return "image/png";
    case ImageFormat::kKtx2:
      return "image/ktx2";
  }
  return "";
}

const char* extension_of(ImageFormat format) {
  switch (format) {
    case ImageFormat::kJpeg:
      return "jpg";
    case ImageFormat::kWebp:
      return "webp";
    case ImageFormat::kPng:
      return "png";
    case ImageFormat::kKtx2:
      return "ktx2";
  }
  return "";
}

DecodedImage decode_image(std::string_view bytes, std::size_t most_bytes) {
  if (bytes.empty()) throw std::runtime_error("is empty");
  if (bytes.starts_with("\xFF\xD8")) return codecs::decode_jpeg(bytes, most_bytes);
  if (bytes.starts_with("\x89PNG")) return codecs::decode_png(bytes, most_bytes);
  if (bytes.starts_with("RIFF") && bytes.substr(8).starts_with("WEBP"))
    return codecs::decode_webp(bytes, most_bytes);
  if (bytes.starts_with("\xABKTX 20"))
    throw std::runtime_error("is KTX2, which is not read: write it as JPEG, PNG or WebP");
  throw std::runtime_error("is no JPEG, PNG or WebP");
}

std::string encode_image(const Raster& raster, ImageFormat format, int quality) {
  switch (format) {
    case ImageFormat::kJpeg:
      return codecs::encode_jpeg(raster, quality);
    case ImageFormat::kWebp:
      return codecs::encode_webp(raster, quality);
    case ImageFormat::kKtx2:
      return codecs::encode_ktx2(raster, quality);
    case ImageFormat::kPng:
      break;
  }
  return codecs::encode_png(raster);
}

}  // namespace colod
