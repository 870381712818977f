// Based on: packing by room `image`.
#include "own_images.h"

#include "image_charts.h"
#include "scratch_file.h"

namespace colod {

namespace {

constexpr double kWorth = 0.5;   // of an image's pixels: of what is more it stays
constexpr int kOwnQuality = 92;  // of JPEG, which was one before
constexpr int kMargin = 2;       // pixels around a chart, that filters look at

}  // namespace

struct OwnImages::Impl {
  ImageCache images;
  ScratchFile file;

  explicit Impl(std::size_t memory) : images(memory) {}
  void shrink(Source& source, std::size_t image, Worn worn);
};

OwnImages::OwnImages(std::size_t memory) : impl_(std::make_unique<Impl>(memory)) {}
OwnImages::~OwnImages() = default;

void OwnImages::Impl::shrink(Source& source, std::size_t image, Worn worn) {
  ImagePlace& place = source.look.images[image];
  const ImageCache::Facts facts = images.facts(place);
  if (facts.width == 0 || facts.is_lost) return;
  find_charts(source, facts.width, facts.height, kMargin, worn);
  std::vector<PackedRect> rects;
  for (const Chart& c : worn.charts) rects.push_back(rect_of(c.width, c.height));
  if (rects.size() > kMostCharts) return;
  const double all = static_cast<double>(facts.width) * facts.height;
  double own = 0;
  for (const PackedRect& r : rects) own += static_cast<double>(r.width) * r.height;
  if (own > kWorth * all) return;
  const auto [width, height] = pack_rects(rects, kLargestOwn);
  if (width == 0 || static_cast<double>(width) * height > kWorth * all) return;
  const ImageCache::Entry entry = images.get(place);
  if (!entry.pyramid) return;
  const Raster& whole = entry.pyramid->levels[0];
  Raster raster(width, height);
  if (!whole.alpha.empty()) raster.alpha.assign(static_cast<std::size_t>(width) * height, 255);
  for (std::size_t c = 0; c < rects.size(); ++c)
    copy_chart(whole, worn.charts[c], rects[c], raster);
  const bool is_clear = !whole.alpha.empty();
  const std::string bytes =
      encode_image(raster, is_clear ? ImageFormat::kPng : ImageFormat::kJpeg, kOwnQuality);
  place = {file.path(), file.append(bytes), bytes.size(), false, 0, 0};
  for (std::size_t i = 0; i < worn.faces.size(); ++i) {
    const auto c = static_cast<std::size_t>(worn.chart[i]);
    const Vec2f size(static_cast<float>(facts.width), static_cast<float>(facts.height));
    const Vec2f by(static_cast<float>(rects[c].x - worn.charts[c].x),
                   static_cast<float>(rects[c].y - worn.charts[c].y));
    for (Vec2f& uv : source.look.uvs[worn.faces[i]])
      uv = (uv.cwiseProduct(size) + by)
               .cwiseQuotient(Vec2f(static_cast<float>(width), static_cast<float>(height)));
  }
}

void OwnImages::give(Source& source) const {
  std::vector<Worn> worn = worn_by_image(source);
  for (std::size_t image = 0; image < worn.size(); ++image)
    if (!worn[image].faces.empty() && !worn[image].is_repeated)
      impl_->shrink(source, image, std::move(worn[image]));
}

}  // namespace colod
