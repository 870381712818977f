// Based on: Ricco's law (a small spot is seen by its contrast times its area); Karis,
// "High-quality temporal supersampling", SIGGRAPH 2014 (a pixel is compared with the range of its
// neighbours, so that a line which moves by less than a pixel is no change).
// Differs: the same under both rules. A share of changed pixels is no measure: a dormer covers the
// same share of a house at every distance, what counts is how many pixels that is.
// Notation: none.
#include "picture_difference.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace colod {
namespace {

constexpr float kJustSeen = 0.05f;  // contrast below which pixels do not differ
constexpr float kCovered = 0.5f;    // share of a pixel from which on it is inside an outline …
constexpr float kHardlyCovered = 0.25f;  // … and from which on one is near enough
constexpr int kMostOutline = 32;         // pixels

using Channel = std::vector<float>;

/// Least or largest of each pixel and its eight neighbours; `pick` chooses of two.
template <typename Pick>
Channel over_neighbours(const Channel& in, int width, int height, const Pick& pick) {
  Channel rows(in.size()), out(in.size());
  for (int y = 0; y < height; ++y) {
    const float* row = &in[static_cast<std::size_t>(y) * width];
    float* to = &rows[static_cast<std::size_t>(y) * width];
    for (int x = 1; x + 1 < width; ++x) to[x] = pick(row[x], pick(row[x - 1], row[x + 1]));
    const int last = width - 1;
    to[0] = pick(row[0], row[std::min(1, last)]);
    to[last] = pick(row[last], row[std::max(0, last - 1)]);
  }
  for (int y = 0; y < height; ++y) {
    const auto row = [&](int v) {
      return &rows[static_cast<std::size_t>(std::clamp(v, 0, height - 1)) * width];
    };
    const float *above = row(y - 1), *here = row(y), *below = row(y + 1);
    float* to = &out[static_cast<std::size_t>(y) * width];
    for (int x = 0; x < width; ++x) to[x] = pick(here[x], pick(above[x], below[x]));
  }
  return out;
}

/// How far each pixel of `a` is out of the range of b's pixels around it.
void add_out_of_range(const GreyPicture& a, const GreyPicture& b, Channel& difference) {
  const auto least = [](float u, float v) { return std::min(u, v); };
  const auto most = [](float u, float v) { return std::max(u, v); };
  const Channel low = over_neighbours(b.luminance, b.width, b.height, least);
  const Channel high = over_neighbours(b.luminance, b.width, b.height, most);
  for (std::size_t i = 0; i < difference.size(); ++i)
    difference[i] = std::max({difference[i], low[i] - a.luminance[i], a.luminance[i] - high[i]});
}

/// The largest sum over a connected set of pixels that differ; the map is used up.
double largest_piece(Channel& difference, int width, int height) {
  double largest = 0;
  std::vector<int> stack;
  const auto visit = [&](int i) {
    if (difference[i] < kJustSeen) return 0.0f;
    const float value = difference[i];
    difference[i] = 0;
    stack.push_back(i);
    return value;
  };
  for (int seed = 0; seed < width * height; ++seed) {
    double sum = visit(seed);
    while (!stack.empty()) {
      const int x = stack.back() % width, y = stack.back() / width;
      stack.pop_back();
      for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u)
          sum += visit(v * width + u);
    }
    largest = std::max(largest, sum);
  }
  return largest;
}

/// Pixels from the farthest covered one of `a` to what `b` covers: by steps along the axes and,
/// every other one, the diagonals too, which make an octagon of what a circle should be.
int farthest(const GreyPicture& a, const GreyPicture& b) {
  const int width = a.width, height = a.height;
  std::vector<char> is_reached(a.coverage.size());
  std::vector<int> front, open;
  for (std::size_t i = 0; i < is_reached.size(); ++i) {
    is_reached[i] = b.coverage[i] >= kHardlyCovered;
    if (!is_reached[i] && a.coverage[i] >= kCovered) open.push_back(static_cast<int>(i));
  }
  if (open.empty()) return 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const char* const at = &is_reached[static_cast<std::size_t>(y) * width + x];
      const bool is_inside = (x == 0 || at[-1]) && (x + 1 == width || at[1]) &&
                             (y == 0 || at[-width]) && (y + 1 == height || at[width]);
      if (*at && !is_inside) front.push_back(y * width + x);
    }
  for (int step = 0; step < kMostOutline; ++step) {
    std::erase_if(open, [&](int i) { return is_reached[i]; });
    if (open.empty()) return step;
    std::vector<int> next;
    for (const int i : front)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const int x = i % width + dx, y = i / width + dy;
          if (x < 0 || x >= width || y < 0 || y >= height) continue;
          if (step % 2 == 0 && dx != 0 && dy != 0) continue;
          char& reached = is_reached[y * width + x];
          if (!reached) reached = 1, next.push_back(y * width + x);
        }
    front = std::move(next);
  }
  return kMostOutline;
}

}  // namespace

PictureDifference compare_pictures(const GreyPicture& a, const GreyPicture& b) {
  assert(a.width == b.width && a.height == b.height);
  Channel difference(a.luminance.size(), 0);
  add_out_of_range(a, b, difference);
  add_out_of_range(b, a, difference);
  PictureDifference result;
  result.piece = std::sqrt(largest_piece(difference, a.width, a.height) / kReferenceContrast);
  result.outline = std::max(farthest(a, b), farthest(b, a));
  return result;
}

}  // namespace colod
