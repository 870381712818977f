// Based on: own work.
#include "context_picture.h"

#include <algorithm>
#include <cmath>

#include "filling.h"
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
  fill_unseen(raster, is_seen);
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
