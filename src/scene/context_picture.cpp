// Based on: own work.
#include "context_picture.h"

#include <algorithm>
#include <cmath>

#include "parameters.h"
#include "survey.h"

namespace colod {

namespace {

using namespace parameters::context;

/// A pixel is the mean of the cells that something covers, in linear light.
Raster averaged(const HeightMap& map, std::vector<char>& is_seen) {
  Raster out(map.width / kCellsAPixel, map.height / kCellsAPixel);
  is_seen.assign(static_cast<std::size_t>(out.width) * out.height, 0);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      std::array<float, 3> sum{};
      int count = 0;
      for (int i = 0; i < kCellsAPixel * kCellsAPixel; ++i) {
        const std::size_t at =
            map.at(kCellsAPixel * x + i % kCellsAPixel, kCellsAPixel * y + i / kCellsAPixel);
        if (std::isnan(map.top[at])) continue;
        for (std::size_t k = 0; k < 3; ++k) sum[k] += to_linear(map.color[at][k]);
        ++count;
      }
      if (count == 0) continue;
      is_seen[static_cast<std::size_t>(y) * out.width + x] = 1;
      for (std::size_t k = 0; k < 3; ++k)
        out.at(x, y)[k] = to_srgb(sum[k] / static_cast<float>(count));
    }
  return out;
}

/// Half as wide and high: means of what is seen.
Raster halved(const Raster& from, const std::vector<char>& is_seen, std::vector<char>& is_known) {
  Raster out((from.width + 1) / 2, (from.height + 1) / 2);
  is_known.assign(static_cast<std::size_t>(out.width) * out.height, 0);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      std::array<int, 3> sum{};
      int count = 0;
      for (int i = 0; i < 4; ++i) {
        const int u = 2 * x + i % 2, v = 2 * y + i / 2;
        if (u >= from.width || v >= from.height) continue;
        if (!is_seen[static_cast<std::size_t>(v) * from.width + u]) continue;
        for (std::size_t k = 0; k < 3; ++k) sum[k] += from.at(u, v)[k];
        ++count;
      }
      if (count == 0) continue;
      is_known[static_cast<std::size_t>(y) * out.width + x] = 1;
      for (std::size_t k = 0; k < 3; ++k)
        out.at(x, y)[k] = static_cast<std::uint8_t>(sum[k] / count);
    }
  return out;
}

/// Between the four nearest pixels of a picture half as wide and high.
void take_between(const Raster& coarse, int x, int y, std::uint8_t* rgb) {
  const int u[2] = {std::clamp(x / 2, 0, coarse.width - 1),
                    std::clamp(x / 2 + (x % 2 ? 1 : -1), 0, coarse.width - 1)};
  const int v[2] = {std::clamp(y / 2, 0, coarse.height - 1),
                    std::clamp(y / 2 + (y % 2 ? 1 : -1), 0, coarse.height - 1)};
  constexpr int kShare[2] = {3, 1};  // quarters
  for (std::size_t k = 0; k < 3; ++k) {
    int sum = 8;
    for (int i = 0; i < 4; ++i)
      sum += kShare[i % 2] * kShare[i / 2] * coarse.at(u[i % 2], v[i / 2])[k];
    rgb[k] = static_cast<std::uint8_t>(sum / 16);
  }
}

/// Pixels that nothing covers look like what is around them: a border has no dark rim, and what was
/// not seen no hole.
void fill(Raster& raster, const std::vector<char>& is_seen) {
  if (std::all_of(is_seen.begin(), is_seen.end(), [](char c) { return c != 0; })) return;
  if (raster.width <= 1 && raster.height <= 1) return;
  std::vector<char> is_known;
  Raster coarse = halved(raster, is_seen, is_known);
  fill(coarse, is_known);
  for (int y = 0; y < raster.height; ++y)
    for (int x = 0; x < raster.width; ++x)
      if (!is_seen[static_cast<std::size_t>(y) * raster.width + x])
        take_between(coarse, x, y, raster.at(x, y));
}

}  // namespace

std::string draw_context(const std::vector<ChainPart>& parts, const Box& box, double texel,
                         const ImageCache& images, PictureFrame& frame) {
  const auto has_look = [](const Source& s) { return !s.look.is_empty(); };
  if (std::none_of(parts.begin(), parts.end(), [&](const ChainPart& p) {
        return has_look(p.source) || std::any_of(p.painted.begin(), p.painted.end(), has_look);
      }))
    return {};
  const auto pixels = [&](double side) { return static_cast<int>(std::ceil(side / texel)) + 2; };
  const Vec3 size = box.size();
  frame = {box.min.head<2>() - Vec2::Constant(texel), texel, pixels(size.x()), pixels(size.y())};
  HeightMap map;
  map.origin = frame.origin, map.cell = texel / kCellsAPixel;
  map.width = kCellsAPixel * frame.width, map.height = kCellsAPixel * frame.height;
  map.top.assign(static_cast<std::size_t>(map.width) * map.height, NAN);
  map.color.assign(map.top.size(), Rgb{});
  for (const ChainPart& part : parts)
    if (part.painted.empty())
      draw_from_above(part.source, images, map);
    else
      for (const Source& source : part.painted) draw_from_above(source, images, map);
  std::vector<char> is_seen;
  Raster raster = averaged(map, is_seen);
  fill(raster, is_seen);
  return encode_image(raster, ImageFormat::kJpeg, kQuality);
}

void wear(const PictureFrame& frame, const ImagePlace& picture, Source& source) {
  Material material;
  material.image = 0;
  material.wrap_u = material.wrap_v = Wrap::kClamp;
  source.look.images = {picture};
  source.look.materials = {material};
  source.look.face_material.assign(source.mesh.faces.size(), 0);
  for (const Face& f : source.mesh.faces) {
    std::array<Vec2f, 3> uvs;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 at =
          (source.mesh.vertices[static_cast<std::size_t>(f[k])].head<2>() - frame.origin) /
          frame.texel;
      uvs[k] = Vec2(at.x() / frame.width, at.y() / frame.height).cast<float>();
    }
    source.look.uvs.push_back(uvs);
  }
}

}  // namespace colod
