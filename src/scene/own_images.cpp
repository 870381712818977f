// Based on: charts as connected in their image; packing by room `image`.
#include "own_images.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/union_find.h"
#include "image/packing.h"
#include "scratch_file.h"

namespace colod {

namespace {

constexpr double kWorth = 0.5;               // of an image's pixels: of what is more it stays
constexpr int kMargin = 2;                   // pixels around a chart, that filters look at
constexpr int kOwnQuality = 92;              // of JPEG, which was one before
constexpr int kLargest = 8192;               // pixels a side
constexpr std::size_t kMostCharts = 20'000;  // packing takes their square

/// Pixels of one image, from (x, y) on.
struct Chart {
  int x = 0, y = 0, width = 0, height = 0;
};

/// The faces of one image, and which of its charts each wears.
struct Worn {
  std::vector<std::size_t> faces;
  std::vector<int> chart;  // per face
  std::vector<Chart> charts;
};

bool is_inside(const std::array<Vec2f, 3>& uvs) {
  constexpr float kSlack = 1e-4f;
  return std::all_of(uvs.begin(), uvs.end(), [](const Vec2f& uv) {
    return uv.allFinite() && uv.minCoeff() >= -kSlack && uv.maxCoeff() <= 1 + kSlack;
  });
}

/// Faces hang together where they have a place in the image in common.
void find_charts(const Source& source, int width, int height, Worn& worn) {
  UnionFind sets(worn.faces.size());
  std::map<std::array<float, 2>, int> first;
  for (std::size_t i = 0; i < worn.faces.size(); ++i)
    for (const Vec2f& uv : source.look.uvs[worn.faces[i]]) {
      const auto [at, is_new] = first.try_emplace({uv.x(), uv.y()}, static_cast<int>(i));
      if (!is_new) sets.unite(at->second, static_cast<int>(i));
    }
  std::map<int, int> number;
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < worn.faces.size(); ++i) {
    const auto [at, is_new] =
        number.try_emplace(sets.find(static_cast<int>(i)), static_cast<int>(boxes.size()));
    if (is_new) boxes.emplace_back();
    worn.chart.push_back(at->second);
    for (const Vec2f& uv : source.look.uvs[worn.faces[i]])
      boxes[static_cast<std::size_t>(at->second)].extend(
          Vec3(uv.x() * static_cast<float>(width), uv.y() * static_cast<float>(height), 0));
  }
  for (const Box& box : boxes) {
    const auto from = [](double v) { return std::max(0, static_cast<int>(v) - kMargin); };
    const int x = from(box.min.x()), y = from(box.min.y());
    const auto to = [](double v, int most) {
      return std::min(most, static_cast<int>(std::ceil(v)) + kMargin);
    };
    worn.charts.push_back({x, y, to(box.max.x(), width) - x, to(box.max.y(), height) - y});
  }
}

int in_fours(int pixels) { return (pixels + 3) / 4 * 4; }

/// Copies a chart, its last column and row again up to a multiple of four.
void copy(const Raster& from, const Chart& chart, const PackedRect& rect, Raster& to) {
  for (int y = 0; y < rect.height; ++y)
    for (int x = 0; x < rect.width; ++x) {
      const int u = chart.x + std::min(x, chart.width - 1),
                v = chart.y + std::min(y, chart.height - 1);
      std::copy_n(from.at(u, v), 3, to.at(rect.x + x, rect.y + y));
      if (!to.alpha.empty())
        to.alpha[static_cast<std::size_t>(rect.y + y) * to.width + rect.x + x] =
            from.alpha[static_cast<std::size_t>(v) * from.width + u];
    }
}

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
  find_charts(source, facts.width, facts.height, worn);
  std::vector<PackedRect> rects;
  for (const Chart& c : worn.charts) rects.push_back({in_fours(c.width), in_fours(c.height)});
  if (rects.size() > kMostCharts) return;
  const double all = static_cast<double>(facts.width) * facts.height;
  double own = 0;
  for (const PackedRect& r : rects) own += static_cast<double>(r.width) * r.height;
  if (own > kWorth * all) return;
  const auto [width, height] = pack_rects(rects, kLargest);
  if (width == 0 || static_cast<double>(width) * height > kWorth * all) return;
  const ImageCache::Entry entry = images.get(place);
  if (!entry.pyramid) return;
  const Raster& whole = entry.pyramid->levels[0];
  Raster raster(width, height);
  if (!whole.alpha.empty()) raster.alpha.assign(static_cast<std::size_t>(width) * height, 255);
  for (std::size_t c = 0; c < rects.size(); ++c) copy(whole, worn.charts[c], rects[c], raster);
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
  const Appearance& look = source.look;
  if (look.uvs.empty() || look.face_material.empty()) return;
  std::vector<Worn> worn(look.images.size());
  std::vector<char> is_fixed(look.images.size(), 0);
  for (std::size_t f = 0; f < look.face_material.size(); ++f) {
    const int m = look.face_material[f];
    const int image = m < 0 ? -1 : look.materials[static_cast<std::size_t>(m)].image;
    if (image < 0) continue;
    worn[static_cast<std::size_t>(image)].faces.push_back(f);
    is_fixed[static_cast<std::size_t>(image)] |= !is_inside(look.uvs[f]);
  }
  for (std::size_t image = 0; image < worn.size(); ++image)
    if (!worn[image].faces.empty() && !is_fixed[image])
      impl_->shrink(source, image, std::move(worn[image]));
}

}  // namespace colod
