#include "image/image.h"

#include <jpeglib.h>
#include <png.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <random>
#include <stdexcept>

#include "image/cache.h"
#include "image/packing.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;

namespace {

constexpr std::size_t kRoom = std::size_t{64} << 20;

Raster slopes(int width, int height) {
  Raster raster(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      raster.at(x, y)[0] = static_cast<std::uint8_t>(40 + 2 * x);
      raster.at(x, y)[1] = static_cast<std::uint8_t>(200 - 2 * y);
      raster.at(x, y)[2] = 90;
    }
  return raster;
}

/// Largest difference of a component.
int difference(const Raster& a, const Raster& b) {
  REQUIRE(a.rgb.size() == b.rgb.size());
  int most = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    most = std::max(most, std::abs(int{a.rgb[i]} - int{b.rgb[i]}));
  return most;
}

/// A JPEG of any kind: `components` of `space` a pixel.
std::string jpeg(int width, int height, int components, J_COLOR_SPACE space, bool is_progressive,
                 const std::vector<std::uint8_t>& samples) {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors;
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = width, info.image_height = height;
  info.input_components = components, info.in_color_space = space;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, 95, TRUE);
  if (is_progressive) jpeg_simple_progression(&info);
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    JSAMPROW row = const_cast<std::uint8_t*>(&samples[info.next_scanline * width * components]);
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  std::string out(reinterpret_cast<char*>(bytes), size);
  free(bytes);
  return out;
}

/// A PNG of any format that libpng's simplified API writes.
std::string png(int width, int height, int format, const void* samples, const void* palette,
                int colors) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width, image.height = height, image.format = format;
  image.colormap_entries = colors;
  png_alloc_size_t size = 0;
  REQUIRE(png_image_write_to_memory(&image, nullptr, &size, 0, samples, 0, palette));
  std::string out(size, '\0');
  REQUIRE(png_image_write_to_memory(&image, out.data(), &size, 0, samples, 0, palette));
  out.resize(size);
  return out;
}

std::string cause_of(const std::string& bytes, std::size_t room = kRoom) {
  try {
    decode_image(bytes, room);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return {};
}

}  // namespace

TEST_CASE("images come back from each format, equal bytes for equal pixels") {
  const Raster raster = slopes(61, 45);
  for (const auto& [format, most] :
       {std::pair(ImageFormat::kPng, 0), {ImageFormat::kJpeg, 12}, {ImageFormat::kWebp, 14}}) {
    const std::string bytes = encode_image(raster, format, 90);
    INFO(mime_of(format));
    CHECK(encode_image(raster, format, 90) == bytes);
    const DecodedImage back = decode_image(bytes, kRoom);
    CHECK(back.remark.empty());
    CHECK((back.raster.width == 61 && back.raster.height == 45));
    CHECK(difference(back.raster, raster) <= most);
  }
}

TEST_CASE("grey, progressive and CMYK JPEGs, and grey, palette and 16 bit PNGs are read") {
  const std::vector<std::uint8_t> grey(32 * 32, 120);
  CHECK(decode_image(jpeg(32, 32, 1, JCS_GRAYSCALE, false, grey), kRoom).raster.at(5, 5)[2] == 120);
  const Raster raster = slopes(32, 32);
  const DecodedImage progressive = decode_image(jpeg(32, 32, 3, JCS_RGB, true, raster.rgb), kRoom);
  CHECK(progressive.remark.empty());
  CHECK(difference(progressive.raster, raster) <= 12);
  std::vector<std::uint8_t> ink;  // inverted, as Adobe's: 200 of red let through, all of black
  for (int i = 0; i < 32 * 32; ++i) ink.insert(ink.end(), {200, 100, 50, 255});
  const DecodedImage cmyk = decode_image(jpeg(32, 32, 4, JCS_CMYK, false, ink), kRoom);
  CHECK_THAT(cmyk.remark, Contains("CMYK"));
  CHECK(std::abs(cmyk.raster.at(9, 9)[0] - 200) <= 2);
  CHECK(std::abs(cmyk.raster.at(9, 9)[2] - 50) <= 2);
  CHECK(decode_image(png(32, 32, PNG_FORMAT_GRAY, grey.data(), nullptr, 0), kRoom)
            .raster.at(3, 4)[1] == 120);
  const std::vector<std::uint16_t> deep(3 * 16 * 16, 65535 / 2);  // linear in libpng's API
  const DecodedImage deeper =
      decode_image(png(16, 16, PNG_FORMAT_LINEAR_RGB, deep.data(), nullptr, 0), kRoom);
  CHECK(std::abs(deeper.raster.at(3, 4)[1] - 188) <= 3);  // libpng looks gamma up in tables
  const std::vector<std::uint8_t> indices(16 * 16, 1), palette = {1, 2, 3, 70, 80, 90};
  const DecodedImage few =
      decode_image(png(16, 16, PNG_FORMAT_RGB_COLORMAP, indices.data(), palette.data(), 2), kRoom);
  CHECK(few.raster.at(7, 7)[2] == 90);
}

TEST_CASE("what is damaged, huge or foreign is told of") {
  const Raster raster = slopes(200, 200);
  const std::string jpg = encode_image(raster, ImageFormat::kJpeg, 90);
  const DecodedImage half = decode_image(jpg.substr(0, jpg.size() / 2), kRoom);
  CHECK_THAT(half.remark, Contains("damaged"));
  CHECK(difference(half.raster, half.raster) == 0);
  for (const ImageFormat format : {ImageFormat::kPng, ImageFormat::kWebp}) {
    const std::string bytes = encode_image(raster, format, 90);
    CHECK(!cause_of(bytes.substr(0, bytes.size() / 2)).empty());
  }
  for (const std::size_t n : {0, 3, 12, 30}) CHECK(!cause_of(jpg.substr(0, n)).empty());
  CHECK_THAT(cause_of("\xABKTX 20\xBB\r\n\x1A\n"), Contains("KTX2"));
  CHECK_THAT(cause_of("BM123456"), Contains("no JPEG, PNG or WebP"));
  std::string huge = jpg;  // the frame header's height and width
  const std::size_t frame = huge.find("\xFF\xC0");
  REQUIRE(frame != huge.npos);
  huge.replace(frame + 5, 4, "\xFF\xDC\xFF\xDC");
  CHECK_THAT(cause_of(huge), Contains("65500 x 65500") && Contains("--texture-memory"));
  CHECK_THAT(cause_of(jpg, 1000), Contains("--texture-memory"));
}

TEST_CASE("the cache gives the same image again, within its budget") {
  const TemporaryFolder folder;
  std::vector<ImagePlace> places;
  for (int i = 0; i < 4; ++i) {
    places.push_back({.path = (folder / (std::to_string(i) + ".png")).string()});
    std::ofstream(places.back().path, std::ios::binary)
        << encode_image(slopes(80 + i, 80), ImageFormat::kPng, 0);
  }
  const ImageCache small(100'000), large(kRoom);
  for (int round = 0; round < 2; ++round)
    for (const ImagePlace& place : places) {
      const ImageCache::Entry a = small.get(place), b = large.get(place);
      REQUIRE((a.pyramid && b.pyramid));
      CHECK(a.pyramid->levels.front().rgb == b.pyramid->levels.front().rgb);
      CHECK(a.pyramid->levels.back().rgb == b.pyramid->levels.back().rgb);
    }
  CHECK(large.get(places[0]).pyramid == large.get(places[0]).pyramid);
  const std::shared_ptr<const Pyramid> first = small.get(places[0]).pyramid;
  small.get(places[1]), small.get(places[2]), small.get(places[3]);
  CHECK(small.get(places[0]).pyramid != first);  // it was let go of
  CHECK_THAT(large.get({.path = (folder / "none.png").string()}).problem, Contains("missing"));
  CHECK((large.facts(places[2]).width == 82 && large.facts(places[2]).height == 80));
}

TEST_CASE("half of the light is not half of the number") {
  CHECK(to_srgb(0.5f) == 188);
  for (int i = 0; i < 256; ++i) CHECK(to_srgb(to_linear(static_cast<std::uint8_t>(i))) == i);
  for (int i = 0; i < 255; ++i) {  // the border between two components, in linear light
    const double coded = (i + 0.5) / 255;
    const double linear = coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4);
    CHECK(to_srgb(static_cast<float>(linear * (1 - 1e-5))) == i);
    CHECK(to_srgb(static_cast<float>(linear * (1 + 1e-5))) == i + 1);
  }
  CHECK((to_srgb(-1) == 0 && to_srgb(7) == 255 && to_srgb(NAN) <= 255));
}

TEST_CASE("images of even sides are halved as those that may have borders or holes") {
  std::mt19937 random(3);
  Raster plain(64, 38);
  for (std::uint8_t& c : plain.rgb) c = static_cast<std::uint8_t>(random() % 256);
  Raster opaque = plain;
  opaque.alpha.assign(plain.rgb.size() / 3, 255);
  CHECK(halve(plain).rgb == halve(opaque).rgb);
}

TEST_CASE("light becomes the component of sRGB that is nearest to it") {
  for (int i = 0; i <= 1'000'000; ++i) {
    const double light = i * 1e-6;
    const double exact =
        255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055);
    const double found = to_srgb(static_cast<float>(light));
    if (std::abs(found - exact) > 0.5 + 1e-3) FAIL(light << " " << found << " " << exact);
  }
  for (int i = 0; i < 256; ++i) CHECK(to_srgb(to_linear(static_cast<std::uint8_t>(i))) == i);
}

TEST_CASE("rectangles are packed without overlap") {
  std::vector<PackedRect> rects;
  double area = 0;
  for (int i = 0; i < 300; ++i) {
    rects.push_back({4 * (1 + i * 7 % 23), 4 * (1 + i * 5 % 11)});
    area += rects.back().width * rects.back().height;
  }
  const auto [width, height] = pack_rects(rects, 4096);
  std::vector<char> taken(static_cast<std::size_t>(width) * height, 0);
  bool overlaps = false;
  for (const PackedRect& r : rects) {
    REQUIRE((r.x >= 0 && r.y >= 0 && r.x + r.width <= width && r.y + r.height <= height));
    CHECK((r.x % 4 == 0 && r.y % 4 == 0));
    for (int y = r.y; y < r.y + r.height; ++y)
      for (int x = r.x; x < r.x + r.width; ++x)
        overlaps |= taken[static_cast<std::size_t>(y) * width + x]++ > 0;
  }
  CHECK(!overlaps);
  CHECK(area > 0.85 * width * height);
  CHECK(pack_rects(rects, 64)[0] == 0);
}

TEST_CASE("an image keeps its alpha, unless it has none or no pixel is opaque by half") {
  for (const int high : {255, 128, 100})
    for (const int low : {0, 60, 255}) {
      INFO(low << " " << high);
      std::vector<std::uint8_t> rgba;
      for (int i = 0; i < 16; ++i)
        rgba.insert(rgba.end(), {7, 8, static_cast<std::uint8_t>(i),
                                 static_cast<std::uint8_t>(i % 2 ? high : std::min(low, high))});
      const Raster raster =
          decode_image(png(4, 4, PNG_FORMAT_RGBA, rgba.data(), nullptr, 0), kRoom).raster;
      CHECK(raster.at(3, 1)[2] == 7);
      const bool is_kept = high >= 128 && !(low == 255 && high == 255);
      REQUIRE(raster.alpha.empty() == !is_kept);
      if (is_kept) CHECK((raster.alpha[6] == std::min(low, high) && raster.alpha[7] == high));
    }
}

TEST_CASE("what is transparent has no part in coarser levels") {
  Raster half(8, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      half.at(x, y)[0] = x % 2 ? 200 : 0;
      half.alpha.push_back(x % 2 ? 255 : 0);
    }
  ImageCache cache(1 << 20);
  const ImagePlace place{.path = "half"};
  cache.put(place, half);
  const auto pyramid = cache.get(place).pyramid;
  REQUIRE(pyramid);
  for (std::size_t k = 1; k < pyramid->levels.size(); ++k) {
    CHECK(pyramid->levels[k].at(0, 0)[0] == 200);
    CHECK(pyramid->levels[k].alpha_at(0, 0) == Approx(0.5).margin(0.01));
  }
}
