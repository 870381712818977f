// Inside room `scene` only: which pieces of their images faces wear, and how these move to another.
#pragma once

#include <array>
#include <vector>

#include "core/geometry.h"
#include "image/image.h"
#include "image/packing.h"

namespace colod {

constexpr int kLargestOwn = 8192;            // pixels a side of an image that is put together
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
  bool is_repeated = false;  // a face reaches beyond the image's border: it has no charts
};

/// By image; faces alone.
std::vector<Worn> worn_by_image(const Source& source);

/// Charts hang together where their faces have a place in the image in common. `width`, `height`:
/// pixels of the image; `margin`: as many around each chart, where the image has them.
void find_charts(const Source& source, int width, int height, int margin, Worn& worn);

/// As large as that and at most three pixels more each way, for packing.
PackedRect rect_of(int width, int height);

/// Copies a chart; what its rectangle has more repeats its last column and row.
void copy_chart(const Raster& from, const Chart& chart, const PackedRect& rect, Raster& to);

}  // namespace colod
