// Inside room `image` only: one pair of functions a format.
#pragma once

#include <stdexcept>

#include "image.h"

namespace colod::codecs {

/// Throws std::runtime_error where so many pixels, with a mip chain, are more than allowed.
void check_size(std::size_t width, std::size_t height, std::size_t most_bytes);

/// Splits 4 bytes a pixel into colours and alpha, which is kept where it means something.
Raster split_alpha(const std::vector<std::uint8_t>& rgba, int width, int height);

DecodedImage decode_jpeg(std::string_view bytes, std::size_t most_bytes);
DecodedImage decode_png(std::string_view bytes, std::size_t most_bytes);
DecodedImage decode_webp(std::string_view bytes, std::size_t most_bytes);

std::string encode_jpeg(const Raster& raster, int quality);
std::string encode_png(const Raster& raster);
std::string encode_webp(const Raster& raster, int quality);
std::string encode_ktx2(const Raster& raster, int quality);

}  // namespace colod::codecs
