// Based on: what src/measure/switching_views.cpp draws, from near instead of from infinitely far.
// Differs: perspective, and several buildings that hide each other.
#include "streaming_pictures.h"

#include <png.h>

#include <algorithm>
#include <cmath>

#include "core/appearance.h"
#include "core/error.h"
#include "core/parallel.h"

namespace colod::bench {
namespace {

constexpr double kSky = 230.0 / 255, kAmbient = 0.4, kDiffuse = 0.45;
constexpr std::uint8_t kSkyLevel = 16;  // of 255: a screenshot's pure blue is no nearer to others
constexpr int kMargin = 40;             // pixels: outlines are followed for 32
constexpr int kAround = 4;              // pixels: a coarse level stands out of the finest one's box
constexpr double kTooNear = 0.1;        // metres ahead: a box from here on may fill the view

Image read_rgb(const std::string& path) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&header, path.c_str()))
    throw Error(Stage::kInput, path, header.message);
  header.format = PNG_FORMAT_RGB;
  Image image{static_cast<int>(header.width), static_cast<int>(header.height), {}};
  image.rgb.resize(PNG_IMAGE_SIZE(header));
  if (!png_image_finish_read(&header, nullptr, image.rgb.data(), 0, nullptr))
    throw Error(Stage::kInput, path, header.message);
  return image;
}

Mesh soup_of(const Tileset& tileset, const std::vector<int>& tiles) {
  Mesh out;
  for (const int t : tiles) {
    const Mesh& mesh = tileset.tiles[t].mesh;
    const int first = static_cast<int>(out.vertices.size());
    out.vertices.insert(out.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const Face& f : mesh.faces)
      out.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
  }
  return out;
}

Vec3 corner_of(const Box& box, int c) {
  return {c & 1 ? box.max.x() : box.min.x(), c & 2 ? box.max.y() : box.min.y(),
          c & 4 ? box.max.z() : box.min.z()};
}

/// To a picture's coordinates of a point that lies ahead.
Vec2 project(const Vec3& p, const Camera& camera, const PictureOptions& o) {
  const Vec3 q = p - camera.eye;
  const double ahead = q.dot(camera.forward);
  return {0.5 * o.width * (1 + q.dot(camera.right) / (ahead * camera.tan_x)),
          0.5 * o.height * (1 - q.dot(camera.up) / (ahead * camera.tan_y))};
}

/// Empty where no corner is in view; the whole picture where one is beside the eye or behind it.
Window window_about(const std::vector<Vec3>& corners, const Camera& camera, const PictureOptions& o,
                    int margin) {
  Vec2 low(o.width, o.height), high(0, 0);
  for (const Vec3& corner : corners) {
    if ((corner - camera.eye).dot(camera.forward) < kTooNear) return {0, 0, o.width, o.height};
    const Vec2 at = project(corner, camera, o);
    low = low.cwiseMin(at), high = high.cwiseMax(at);
  }
  const auto clipped = [](double v, int most) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(most)));
  };
  return {clipped(std::floor(low.x()) - margin, o.width),
          clipped(std::floor(low.y()) - margin, o.height),
          clipped(std::ceil(high.x()) + margin, o.width),
          clipped(std::ceil(high.y()) + margin, o.height)};
}

std::uint8_t byte_of(double luminance) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(luminance, 0.0, 1.0)));
}

Image grey_image(int width, int height, const std::vector<float>& luminance) {
  Image out{width, height, {}};
  for (const float l : luminance) out.rgb.insert(out.rgb.end(), 3, byte_of(l));
  return out;
}

}  // namespace

Scenery::Scenery(const Tileset& tileset, const std::vector<int>& tiles)
    : mesh_(soup_of(tileset, tiles)), rays_(mesh_) {}

double Scenery::luminance(const Vec3& eye, const Vec3& direction, const Vec3& light) const {
  const RayHit hit = rays_.first_hit(eye, direction);
  if (!hit) return -1;
  const Vec3 normal =
      face_cross(mesh_, mesh_.faces[hit.triangle]).normalized() * (hit.is_inside ? -1 : 1);
  return kAmbient + kDiffuse * std::max(0.0, normal.dot(light));
}

Window window_of_change(const Tileset& tileset, const std::vector<int>& drawn, const Camera& camera,
                        const PictureOptions& o) {
  std::vector<Vec3> corners;
  for (const int t : drawn) {
    const Tile& tile = tileset.tiles[t];
    for (int c = 0; !tile.children.empty() && c < 8; ++c)
      corners.push_back(tileset.frames[tile.frame] * corner_of(tile.box, c));
  }
  return window_about(corners, camera, o, kMargin);
}

Window window_of(const Box& box, const Camera& camera, const PictureOptions& o,
                 const Window& outer) {
  std::vector<Vec3> corners;
  for (int c = 0; c < 8; ++c) corners.push_back(corner_of(box, c));
  const Window w = window_about(corners, camera, o, kAround);
  return {std::max(w.x0, outer.x0), std::max(w.y0, outer.y0), std::min(w.x1, outer.x1),
          std::min(w.y1, outer.y1)};
}

GreyPicture cropped(const GreyPicture& picture, const Window& outer, const Window& inner) {
  GreyPicture out{inner.x1 - inner.x0, inner.y1 - inner.y0, {}, {}};
  for (int y = inner.y0; y < inner.y1; ++y)
    for (int x = inner.x0; x < inner.x1; ++x) {
      const int at = (y - outer.y0) * picture.width + x - outer.x0;
      out.luminance.push_back(picture.luminance[at]);
      out.coverage.push_back(picture.coverage[at]);
    }
  return out;
}

GreyPicture draw(const Scenery& scenery, const Camera& camera, const Window& w,
                 const PictureOptions& o) {
  GreyPicture out{w.x1 - w.x0, w.y1 - w.y0, {}, {}};
  const std::size_t count = static_cast<std::size_t>(out.width) * out.height;
  out.luminance.resize(count);
  out.coverage.resize(count);
  const Vec3 light =
      (-camera.forward * 0.55 - camera.right * 0.45 + Vec3::UnitZ() * 0.7).normalized();
  const int all = o.samples * o.samples;
  parallel_for(static_cast<std::size_t>(out.height), [&](std::size_t row) {
    for (int column = 0; column < out.width; ++column) {
      double sum = 0;
      int covered = 0;
      for (int s = 0; s < all; ++s) {
        const int across = s % o.samples, down = s / o.samples;
        const double x = w.x0 + column + (across + 0.5) / o.samples;
        const double y = w.y0 + static_cast<double>(row) + (down + 0.5) / o.samples;
        const Vec3 direction = camera.forward +
                               camera.right * (camera.tan_x * (2 * x / o.width - 1)) +
                               camera.up * (camera.tan_y * (1 - 2 * y / o.height));
        const double luminance = scenery.luminance(camera.eye, direction.normalized(), light);
        sum += luminance < 0 ? kSky : luminance;
        covered += luminance >= 0;
      }
      const std::size_t at = row * out.width + column;
      out.luminance[at] = static_cast<float>(sum / all);
      out.coverage[at] = static_cast<float>(covered) / static_cast<float>(all);
    }
  });
  return out;
}

GreyPicture read_screenshot(const std::string& path) {
  const Image image = read_rgb(path);
  GreyPicture out{image.width, image.height, {}, {}};
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    // Buildings are grey, so that red is theirs alone and what blue has more of is the sky's.
    const float red = static_cast<float>(image.rgb[i]) / 255;
    const float blue = static_cast<float>(image.rgb[i + 2]) / 255;
    const float sky = std::clamp(blue - red, 0.0f, 1.0f);
    out.coverage.push_back(1 - sky);
    out.luminance.push_back(red + sky * static_cast<float>(kSky));
  }
  return out;
}

ColorPicture read_colors(const std::string& path) {
  const Image image = read_rgb(path);
  ColorPicture out{image.width, image.height, {}, {}};
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    const std::uint8_t* rgb = &image.rgb[i];
    const bool is_sky = rgb[0] < kSkyLevel && rgb[1] < kSkyLevel && rgb[2] > 255 - kSkyLevel;
    out.coverage.push_back(is_sky ? 0.0f : 1.0f);
    out.linear.emplace_back(to_linear(rgb[0]), to_linear(rgb[1]), to_linear(rgb[2]));
  }
  return out;
}

Image side_by_side(const GreyPicture& a, const GreyPicture& b) {
  std::vector<float> difference;
  for (std::size_t i = 0; i < a.luminance.size(); ++i)
    difference.push_back(1 - std::min(1.0f, 2 * std::abs(a.luminance[i] - b.luminance[i])));
  return contact_sheet(
      {grey_image(a.width, a.height, a.luminance), grey_image(b.width, b.height, b.luminance),
       grey_image(a.width, a.height, difference)},
      {}, 3);
}

}  // namespace colod::bench
