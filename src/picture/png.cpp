// Pictures as PNG, whole or small.
//
// Based on: Heckbert: Color image quantization for frame buffer display, SIGGRAPH 1982
// (section 4.1:
//   uniform cells, each shown by the mean of its colours).
// Differs: the same under both rules. Cells grow until few enough are in use.
// Notation: a cell is a cube of the colour space.
#include <png.h>

#include <algorithm>
#include <cassert>
#include <map>

#include "core/error.h"
#include "picture.h"

namespace colod {
namespace {

constexpr int kMostColors = 64;  ///< with the background
constexpr int kLeastSide = 16;   ///< pixels: smaller pictures show nothing

struct Paletted {
  std::vector<std::uint8_t> rgba;     ///< 4 a colour; the first is the background, transparent
  std::vector<std::uint8_t> indices;  ///< one a pixel
};

Color color_at(const Image& image, std::size_t pixel) {
  return {image.rgb[3 * pixel], image.rgb[3 * pixel + 1], image.rgb[3 * pixel + 2]};
}

/// Cells of `cell` steps a side, each shown by the mean of its pixels.
Paletted gather_colors(const Image& image, int cell) {
  struct Sum {
    std::array<std::int64_t, 3> rgb{};
    std::int64_t count = 0;
    std::uint8_t index = 0;
  };
  const std::size_t pixels = image.rgb.size() / 3;
  const auto cell_of = [&](const Color& c) {
    return (c[0] / cell * 256 + c[1] / cell) * 256 + c[2] / cell;
  };
  std::map<int, Sum> sums;
  for (std::size_t i = 0; i < pixels; ++i) {
    const Color c = color_at(image, i);
    if (c == kBackground) continue;
    Sum& sum = sums[cell_of(c)];
    for (int k = 0; k < 3; ++k) sum.rgb[k] += c[k];
    ++sum.count;
  }
  Paletted result;
  if (sums.size() >= kMostColors) return result;
  result.rgba = {kBackground[0], kBackground[1], kBackground[2], 0};
  for (auto& [key, sum] : sums) {
    sum.index = static_cast<std::uint8_t>(result.rgba.size() / 4);
    for (int k = 0; k < 3; ++k)
      result.rgba.push_back(static_cast<std::uint8_t>(sum.rgb[k] / sum.count));
    result.rgba.push_back(255);
  }
  result.indices.resize(pixels, 0);
  for (std::size_t i = 0; i < pixels; ++i) {
    const Color c = color_at(image, i);
    if (c != kBackground) result.indices[i] = sums[cell_of(c)].index;
  }
  return result;
}

std::string encode(const Image& image, png_uint_32 format, const void* pixels, int colors,
                   const void* colormap) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = format;
  header.colormap_entries = static_cast<png_uint_32>(colors);
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, pixels, 0, colormap))
    throw Error(Stage::kOutput, "picture", header.message);
  bytes.resize(size);
  return bytes;
}

/// Three quarters of the pixels a side, each the mean of those that it covers.
Image shrink(const Image& image) {
  Image small{std::max(1, image.width * 3 / 4), std::max(1, image.height * 3 / 4), {}};
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      const int x0 = x * image.width / small.width, y0 = y * image.height / small.height;
      const int x1 = std::max(x0 + 1, (x + 1) * image.width / small.width);
      const int y1 = std::max(y0 + 1, (y + 1) * image.height / small.height);
      for (int k = 0; k < 3; ++k) {
        int sum = 0;
        for (int sy = y0; sy < y1; ++sy)
          for (int sx = x0; sx < x1; ++sx)
            sum += image.rgb[3 * (static_cast<std::size_t>(sy) * image.width + sx) + k];
        small.rgb.push_back(static_cast<std::uint8_t>(sum / ((x1 - x0) * (y1 - y0))));
      }
    }
  return small;
}

}  // namespace

std::string encode_png(const Image& image) {
  assert(image.rgb.size() == static_cast<std::size_t>(image.width) * image.height * 3);
  return encode(image, PNG_FORMAT_RGB, image.rgb.data(), 0, nullptr);
}

std::string encode_small_png(const Image& image, std::size_t most) {
  assert(image.rgb.size() == static_cast<std::size_t>(image.width) * image.height * 3);
  const bool is_least = std::min(image.width, image.height) * 3 / 4 < kLeastSide;
  std::string bytes;
  for (int cell = 8; cell <= 128; cell += cell / 2) {
    const Paletted p = gather_colors(image, cell);
    if (p.rgba.empty()) continue;
    bytes = encode(image, PNG_FORMAT_RGBA_COLORMAP, p.indices.data(),
                   static_cast<int>(p.rgba.size() / 4), p.rgba.data());
    if (bytes.size() <= most) return bytes;
    if (cell > 32 && !is_least) break;  // fewer colours would show less than fewer pixels
  }
  if (is_least) return bytes;
  return encode_small_png(shrink(image), most);
}

}  // namespace colod
