// Based on: libwebp's simple API.
#include <webp/decode.h>
#include <webp/encode.h>

#include "codecs.h"

namespace colod::codecs {

DecodedImage decode_webp(std::string_view bytes, std::size_t most_bytes) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  int width = 0, height = 0;
  if (!WebPGetInfo(data, bytes.size(), &width, &height))
    throw std::runtime_error("is damaged: no WebP header");
  check_size(static_cast<std::size_t>(width), static_cast<std::size_t>(height), most_bytes);
  std::vector<std::uint8_t> rgba(4 * static_cast<std::size_t>(width) *
                                 static_cast<std::size_t>(height));
  if (!WebPDecodeRGBAInto(data, bytes.size(), rgba.data(), rgba.size(), 4 * width))
    throw std::runtime_error("is damaged or truncated");
  return {split_alpha(rgba, width, height), {}};
}

std::string encode_webp(const Raster& raster, int quality) {
  std::uint8_t* bytes = nullptr;
  const std::size_t size = WebPEncodeRGB(raster.rgb.data(), raster.width, raster.height,
                                         3 * raster.width, static_cast<float>(quality), &bytes);
  const std::string out(reinterpret_cast<const char*>(bytes), size);
  WebPFree(bytes);
  if (size == 0) throw std::runtime_error("WebP: cannot be encoded");
  return out;
}

}  // namespace colod::codecs
