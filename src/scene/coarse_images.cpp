// Based on: packing by room `image`.
#include "coarse_images.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "filling.h"
#include "image_charts.h"
#include "parameters.h"
#include "scratch_file.h"

namespace colod {

namespace {

constexpr double kWorth = 0.9;  // of the texels: of what is more they stay …
constexpr double kMostlyBare =
    0.75;                // … but for images of which less is worn: the rest costs no byte
constexpr int kRim = 1;  // texels around a chart
constexpr double kMoreTexels =
    1.1;                            // times what an image has, where its sides become powers of two
constexpr double kTouching = 0.45;  // pixels between a triangle and the middle of one that it wears
constexpr double kLeastPixels = 1e-6;

/// An image that moves: its charts, and as how many texels.
struct Moving {
  ImagePlace place;
  int width = 0, height = 0;  ///< pixels
  Worn worn;
  std::vector<Chart> sizes;  ///< of each chart, without the rim; at (0, 0)
};

/// Where the charts of all images go, image by image.
struct Packing {
  std::vector<PackedRect> rects;
  std::array<int, 2> size = {0, 0};  ///< pixels; 0: nothing moves
};

std::array<Vec2f, 3> in_pixels(const std::array<Vec2f, 3>& uvs, int width, int height) {
  std::array<Vec2f, 3> out;
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = uvs[k].cwiseProduct(Vec2f(static_cast<float>(width), static_cast<float>(height)));
  return out;
}

double cross_of(const Vec2f& a, const Vec2f& b) {
  return static_cast<double>(a.x()) * b.y() - static_cast<double>(a.y()) * b.x();
}

/// Per chart, in metres.
std::vector<double> own_texels(const Source& source, const Moving& m) {
  std::vector<double> area(m.worn.charts.size(), 0), pixels(area);
  for (std::size_t i = 0; i < m.worn.faces.size(); ++i) {
    const std::size_t f = m.worn.faces[i], c = static_cast<std::size_t>(m.worn.chart[i]);
    const auto p = in_pixels(source.look.uvs[f], m.width, m.height);
    pixels[c] += std::abs(cross_of(p[1] - p[0], p[2] - p[0])) / 2;
    area[c] += face_area(source.mesh, source.mesh.faces[f]);
  }
  for (std::size_t c = 0; c < area.size(); ++c)
    area[c] = std::sqrt(area[c] / std::max(kLeastPixels, pixels[c]));
  return area;
}

/// Marks the pixels whose middle is in a triangle, or nearly so.
void mark(std::array<Vec2f, 3> p, int width, int height, std::vector<char>& is_worn) {
  if (cross_of(p[1] - p[0], p[2] - p[0]) < 0) std::swap(p[1], p[2]);
  const auto place = [](float v, int most) { return std::clamp(static_cast<int>(v), 0, most); };
  const Vec2f low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
  const int x1 = place(high.x() + 1, width - 1), y1 = place(high.y() + 1, height - 1);
  for (int y = place(low.y() - 1, y1); y <= y1; ++y)
    for (int x = place(low.x() - 1, x1); x <= x1; ++x) {
      const Vec2f at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const auto is_near = [&](std::size_t k) {
        const Vec2f along = p[(k + 1) % 3] - p[k];
        return cross_of(along, at - p[k]) >= -kTouching * static_cast<double>(along.norm());
      };
      if (is_near(0) && is_near(1) && is_near(2))
        is_worn[static_cast<std::size_t>(y) * width + x] = 1;
    }
}

std::vector<char> worn_pixels(const Source& source, const Moving& m) {
  std::vector<char> is_worn(static_cast<std::size_t>(m.width) * m.height, 0);
  for (const std::size_t f : m.worn.faces)
    mark(in_pixels(source.look.uvs[f], m.width, m.height), m.width, m.height, is_worn);
  return is_worn;
}

/// Images that are seen through stay, so that what is wholly transparent lies beside the charts.
std::vector<char> without_clear(std::vector<char> is_worn, const Raster& raster) {
  for (std::size_t i = 0; i < raster.alpha.size(); ++i)
    if (raster.alpha[i] == 0) is_worn[i] = 0;
  return is_worn;
}

/// What of a row of pixels a texel covers.
struct Cover {
  double begin, end;
  int first() const { return static_cast<int>(std::floor(begin)); }
  double share(int pixel) const {
    return std::min<double>(end, pixel + 1) - std::max<double>(begin, pixel);
  }
};

/// The mean of the worn pixels that a texel covers, in linear light; false: there are none.
bool mean_of(const Raster& from, const std::vector<char>& is_worn, const Cover& across,
             const Cover& down, std::uint8_t* rgb) {
  std::array<double, 3> sum{};
  double all = 0;
  for (int y = std::max(0, down.first()); y < std::min<double>(down.end, from.height); ++y)
    for (int x = std::max(0, across.first()); x < std::min<double>(across.end, from.width); ++x) {
      const double share = across.share(x) * down.share(y);
      if (share <= 0 || !is_worn[static_cast<std::size_t>(y) * from.width + x]) continue;
      for (std::size_t k = 0; k < 3; ++k) sum[k] += share * to_linear(from.at(x, y)[k]);
      all += share;
    }
  for (std::size_t k = 0; k < 3 && all > 0; ++k) rgb[k] = to_srgb(static_cast<float>(sum[k] / all));
  return all > 0;
}

/// Draws a chart at its size, with its rim; returns which texels cover a pixel that is worn.
std::vector<char> draw(const Raster& from, const std::vector<char>& is_worn, const Chart& chart,
                       const Chart& size, Raster& to) {
  std::vector<char> is_seen(static_cast<std::size_t>(to.width) * to.height, 0);
  const auto cover = [](int texel, int first, int pixels, int texels) {
    const double step = static_cast<double>(pixels) / texels;
    return Cover{first + step * (texel - kRim), first + step * (texel - kRim + 1)};
  };
  for (int y = 0; y < to.height; ++y)
    for (int x = 0; x < to.width; ++x)
      is_seen[static_cast<std::size_t>(y) * to.width + x] =
          mean_of(from, is_worn, cover(x, chart.x, chart.width, size.width),
                  cover(y, chart.y, chart.height, size.height), to.at(x, y));
  return is_seen;
}

/// What nobody wears looks like what is around. Faces may be too small to wear any pixel.
Raster resampled(const Raster& from, const std::vector<char>& is_worn, const Chart& chart,
                 const Chart& size) {
  Raster out(size.width + 2 * kRim, size.height + 2 * kRim);
  std::vector<char> is_seen = draw(from, is_worn, chart, size, out);
  if (std::none_of(is_seen.begin(), is_seen.end(), [](char c) { return c != 0; }))
    is_seen = draw(from, std::vector<char>(is_worn.size(), 1), chart, size, out);
  fill_unseen(out, is_seen);
  return out;
}

/// Powers of two, each no more than a factor of two off, with as many texels together as there
/// were or somewhat fewer: half as many at least.
std::array<int, 2> powers_of_two(int width, int height) {
  const auto below = [](int n) {
    return static_cast<int>(std::bit_floor(static_cast<unsigned>(n)));
  };
  const int w = below(width), h = below(height);
  const bool is_wider = static_cast<double>(width) / w > static_cast<double>(height) / h;
  if (2.0 * w * h > kMoreTexels * width * height) return {w, h};
  return is_wider ? std::array{2 * w, h} : std::array{w, 2 * h};
}

Raster on_powers_of_two(const Raster& from) {
  const auto [width, height] = powers_of_two(from.width, from.height);
  Raster out(width, height);
  const std::vector<char> all(static_cast<std::size_t>(from.width) * from.height, 1);
  const double across = static_cast<double>(from.width) / out.width;
  const double down = static_cast<double>(from.height) / out.height;
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      mean_of(from, all, {x * across, (x + 1) * across}, {y * down, (y + 1) * down}, out.at(x, y));
  return out;
}

Chart size_of(const Chart& chart, double scale) {
  const auto texels = [&](int pixels) {
    return std::max(1, static_cast<int>(std::ceil(pixels * scale)));
  };
  return {0, 0, texels(chart.width), texels(chart.height)};
}

/// By image.
std::vector<char> plain_images(const Appearance& look) {
  std::vector<char> is_plain(look.images.size(), 1);
  for (const Material& m : look.materials)
    if (m.image >= 0 && (m.cutoff > 0 || m.color != std::array<float, 3>{1, 1, 1}))
      is_plain[static_cast<std::size_t>(m.image)] = 0;
  return is_plain;
}

/// None where it would take more than so many texels.
Packing pack(const std::vector<Moving>& moving, double most) {
  Packing out;
  double own = 0;
  for (const Moving& m : moving)
    for (const Chart& c : m.sizes) {
      out.rects.push_back(rect_of(c.width + 2 * kRim, c.height + 2 * kRim));
      own += static_cast<double>(out.rects.back().width) * out.rects.back().height;
    }
  if (out.rects.size() > kMostCharts || own > most) return {};
  out.size = pack_rects(out.rects, kLargestOwn);
  if (static_cast<double>(out.size[0]) * out.size[1] > most) return {};
  return out;
}

/// The faces wear their charts where these have moved to, by a material that is still to come.
void wear(const Moving& m, const PackedRect* rects, const std::array<int, 2>& all, Source& source) {
  const Vec2f whole(static_cast<float>(all[0]), static_cast<float>(all[1]));
  for (std::size_t i = 0; i < m.worn.faces.size(); ++i) {
    const std::size_t f = m.worn.faces[i], c = static_cast<std::size_t>(m.worn.chart[i]);
    const Chart &chart = m.worn.charts[c], &size = m.sizes[c];
    const Vec2f from(static_cast<float>(chart.x), static_cast<float>(chart.y));
    const Vec2f to(static_cast<float>(rects[c].x + kRim), static_cast<float>(rects[c].y + kRim));
    const Vec2f scale(static_cast<float>(size.width) / static_cast<float>(chart.width),
                      static_cast<float>(size.height) / static_cast<float>(chart.height));
    const auto p = in_pixels(source.look.uvs[f], m.width, m.height);
    for (std::size_t k = 0; k < 3; ++k)
      source.look.uvs[f][k] = (Vec2f((p[k] - from).cwiseProduct(scale)) + to).cwiseQuotient(whole);
    source.look.face_material[f] = static_cast<int>(source.look.materials.size());
  }
}

/// All of each image as one chart, where its charts would take more room than that.
void join_charts(const Source& source, double texel, std::vector<Moving>& moving) {
  for (Moving& m : moving) {
    m.worn.charts = {{0, 0, m.width, m.height}};
    std::fill(m.worn.chart.begin(), m.worn.chart.end(), 0);
    m.sizes = {size_of(m.worn.charts[0], std::min(1.0, own_texels(source, m)[0] / texel))};
  }
}

double worn_texels(const Source& source, const std::vector<Moving>& moving) {
  double sum = 0;
  for (const Moving& m : moving) {
    const std::vector<char> is_worn = worn_pixels(source, m);
    sum += static_cast<double>(std::count(is_worn.begin(), is_worn.end(), 1));
  }
  return sum;
}

}  // namespace

struct CoarseImages::Impl {
  ImageCache images;
  ScratchFile file;

  explicit Impl(std::size_t memory) : images(memory) {}
  std::vector<Moving> moving(const Source& source, double texel) const;
  Raster draw_all(const Source& source, const std::vector<Moving>& moving,
                  const Packing& packing) const;
};

CoarseImages::CoarseImages(std::size_t memory) : impl_(std::make_unique<Impl>(memory)) {}
CoarseImages::~CoarseImages() = default;

std::vector<Moving> CoarseImages::Impl::moving(const Source& source, double texel) const {
  std::vector<Moving> out;
  std::vector<Worn> worn = worn_by_image(source);
  const std::vector<char> is_plain = plain_images(source.look);
  for (std::size_t i = 0; i < worn.size(); ++i) {
    if (worn[i].faces.empty() || worn[i].is_repeated || !is_plain[i]) continue;
    const ImageCache::Facts facts = images.facts(source.look.images[i]);
    if (facts.width == 0 || facts.is_lost) continue;
    Moving m{source.look.images[i], facts.width, facts.height, std::move(worn[i]), {}};
    find_charts(source, m.width, m.height, 0, m.worn);  // they get a rim of their own
    const std::vector<double> own = own_texels(source, m);
    for (std::size_t c = 0; c < own.size(); ++c)
      m.sizes.push_back(size_of(m.worn.charts[c], std::min(1.0, own[c] / texel)));
    out.push_back(std::move(m));
  }
  return out;
}

/// Images are decoded one after the other: a tile may have many.
Raster CoarseImages::Impl::draw_all(const Source& source, const std::vector<Moving>& moving,
                                    const Packing& packing) const {
  Raster out(packing.size[0], packing.size[1]);
  std::size_t first = 0;  // of an image's charts
  for (const Moving& m : moving) {
    const ImageCache::Entry entry = images.get(m.place);
    if (!entry.pyramid) return {};  // it was there a moment ago
    const Raster& raster = entry.pyramid->levels[0];
    const std::vector<char> is_worn = without_clear(worn_pixels(source, m), raster);
    for (std::size_t c = 0; c < m.sizes.size(); ++c) {
      const Raster chart = resampled(raster, is_worn, m.worn.charts[c], m.sizes[c]);
      copy_chart(chart, {0, 0, chart.width, chart.height}, packing.rects[first + c], out);
    }
    first += m.sizes.size();
  }
  return out;
}

void CoarseImages::give(Source& source, double texel, bool has_mip_levels) const {
  std::vector<Moving> moving = impl_->moving(source, texel);
  double texels = 0;
  for (const Moving& m : moving) texels += static_cast<double>(m.width) * m.height;
  Packing packing = pack(moving, kWorth * texels);
  if (packing.size[0] == 0) {
    join_charts(source, texel, moving);
    packing =
        pack(moving, (worn_texels(source, moving) < kMostlyBare * texels ? 1 : kWorth) * texels);
  }
  if (packing.size[0] == 0) return;
  Raster raster = impl_->draw_all(source, moving, packing);
  if (raster.width == 0) return;
  if (has_mip_levels) raster = on_powers_of_two(raster);
  std::size_t first = 0;
  for (const Moving& m : moving) {
    wear(m, &packing.rects[first], packing.size, source);
    first += m.sizes.size();
  }
  Appearance& look = source.look;
  Material material;
  material.image = static_cast<int>(look.images.size());
  material.wrap_u = material.wrap_v = Wrap::kClamp;
  look.materials.push_back(material);
  const std::string bytes =
      encode_image(raster, ImageFormat::kJpeg, parameters::context::kCoarseQuality);
  look.images.push_back({impl_->file.path(), impl_->file.append(bytes), bytes.size(), false, 0, 0});
}

}  // namespace colod
