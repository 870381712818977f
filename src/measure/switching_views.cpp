// Based on: scan conversion with a depth buffer (Catmull 1974); Crow, "Summed-area tables for
// texture mapping", SIGGRAPH 1984 (any box average in constant time).
// Differs: the same under both rules.
// Notation: a sample is one point of the picture; a pixel n × n of them.
#include "switching_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace colod {
namespace {

constexpr int kSkySamples = 8;                     // samples of sky about the building
constexpr std::uint8_t kSkyLuminance = 230;        // luminance, of 255
constexpr double kAmbient = 0.4, kDiffuse = 0.45;  // of a white that surfaces never reach
constexpr double kMostOfSide = 4096;               // a side: a guard against wild boxes

/// A corner in samples, and its depth in metres.
struct Corner {
  double x, y, depth;
};

struct Samples {
  int width, height;
  std::vector<std::uint8_t> luminance;
  std::vector<float> depth;
};

Corner project(const Vec3& p, const FarView& view) {
  const Vec3 q = p - view.corner;
  return {q.dot(view.right) / view.sample, -q.dot(view.up) / view.sample, q.dot(view.forward)};
}

/// Where an edge crosses row y; the same for both triangles at the edge, whichever way it runs.
double crossing(Corner a, Corner b, double y) {
  if (b.y < a.y || (b.y == a.y && b.x < a.x)) std::swap(a, b);
  return a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
}

/// First whole number not below v, within 0 … most.
int first_at(double v, int most) {
  return static_cast<int>(std::clamp(std::ceil(v), 0.0, static_cast<double>(most)));
}

void fill_row(Samples& out, int y, double from, double to, const Corner& a, double slope_x,
              double slope_y, std::uint8_t luminance) {
  const int begin = first_at(from, out.width), end = first_at(to, out.width);
  const std::size_t row = static_cast<std::size_t>(y) * out.width;
  for (int x = begin; x < end; ++x) {
    const auto depth = static_cast<float>(a.depth + slope_x * (x - a.x) + slope_y * (y - a.y));
    if (!(depth < out.depth[row + x])) continue;
    out.depth[row + x] = depth;
    out.luminance[row + x] = luminance;
  }
}

void fill_triangle(Samples& out, const std::array<Corner, 3>& c, std::uint8_t luminance) {
  const double ux = c[1].x - c[0].x, uy = c[1].y - c[0].y, vx = c[2].x - c[0].x,
               vy = c[2].y - c[0].y;
  const double area = ux * vy - uy * vx;
  if (area == 0) return;
  const double du = c[1].depth - c[0].depth, dv = c[2].depth - c[0].depth;
  const double slope_x = (du * vy - dv * uy) / area, slope_y = (dv * ux - du * vx) / area;
  const auto [low, high] = std::minmax({c[0].y, c[1].y, c[2].y});
  const int end = first_at(high, out.height);
  for (int y = first_at(low, out.height); y < end; ++y) {
    double from = std::numeric_limits<double>::infinity(), to = -from;
    for (int k = 0; k < 3; ++k) {
      const Corner &a = c[k], &b = c[(k + 1) % 3];
      if ((a.y <= y) == (b.y <= y)) continue;
      const double x = crossing(a, b, y);
      from = std::min(from, x), to = std::max(to, x);
    }
    fill_row(out, y, from, to, c[0], slope_x, slope_y, luminance);
  }
}

Samples draw(const Mesh& mesh, const FarView& view) {
  const auto count = static_cast<std::size_t>(view.width) * view.height;
  Samples out{view.width, view.height, std::vector<std::uint8_t>(count, kSkyLuminance),
              std::vector<float>(count, std::numeric_limits<float>::infinity())};
  std::vector<Corner> corners;
  for (const Vec3& p : mesh.vertices) corners.push_back(project(p, view));
  for (const Face& f : mesh.faces) {
    const Vec3 cross = face_cross(mesh, f);
    const double length = cross.norm();
    if (!(length > 0) || cross.dot(view.forward) >= 0) continue;
    const double lit = std::max(0.0, cross.dot(view.light) / length);
    const auto luminance = static_cast<std::uint8_t>(255 * (kAmbient + kDiffuse * lit));
    fill_triangle(out, {corners[f[0]], corners[f[1]], corners[f[2]]}, luminance);
  }
  return out;
}

/// Sums over all samples above and to the left, with a row and a column of zeros before.
template <typename ValueOf>
std::vector<std::uint32_t> summed(int width, int height, const ValueOf& value_of) {
  const std::size_t stride = static_cast<std::size_t>(width) + 1;
  std::vector<std::uint32_t> sums(stride * (height + 1), 0);
  for (int y = 0; y < height; ++y) {
    std::uint32_t row = 0;
    for (int x = 0; x < width; ++x) {
      row += value_of(static_cast<std::size_t>(y) * width + x);
      sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + row;
    }
  }
  return sums;
}

}  // namespace

FarView far_view(const Box& box, const Vec3& direction, double sample) {
  FarView view;
  view.forward = -direction;
  view.right = Vec3::UnitZ().cross(direction).normalized();
  view.up = direction.cross(view.right);
  view.light = (direction * 0.55 - view.right * 0.45 + Vec3::UnitZ() * 0.7).normalized();
  view.sample = sample;
  const Vec3 half = 0.5 * box.size();
  const double across = 2 * half.dot(view.right.cwiseAbs()) / sample;
  const double tall = 2 * half.dot(view.up.cwiseAbs()) / sample;
  view.width = static_cast<int>(std::min(kMostOfSide, std::ceil(across))) + 2 * kSkySamples;
  view.height = static_cast<int>(std::min(kMostOfSide, std::ceil(tall))) + 2 * kSkySamples;
  view.corner =
      box.center() - 0.5 * sample * ((view.width - 1) * view.right - (view.height - 1) * view.up);
  return view;
}

FarPicture::FarPicture(const Mesh& mesh, const FarView& view)
    : width_(view.width), height_(view.height) {
  const Samples samples = draw(mesh, view);
  luminance_ =
      summed(width_, height_, [&](std::size_t i) -> std::uint32_t { return samples.luminance[i]; });
  coverage_ = summed(width_, height_, [&](std::size_t i) -> std::uint32_t {
    return std::isfinite(samples.depth[i]);
  });
}

GreyPicture FarPicture::at(int n) const {
  GreyPicture out{(width_ + n - 1) / n, (height_ + n - 1) / n, {}, {}};
  const std::size_t stride = static_cast<std::size_t>(width_) + 1;
  const float share = 1.0f / static_cast<float>(n * n);
  out.luminance.reserve(static_cast<std::size_t>(out.width) * out.height);
  out.coverage.reserve(static_cast<std::size_t>(out.width) * out.height);
  for (int y = 0; y < height_; y += n)
    for (int x = 0; x < width_; x += n) {
      const int right = std::min(x + n, width_), bottom = std::min(y + n, height_);
      const auto sum = [&](const std::vector<std::uint32_t>& s) {
        return s[bottom * stride + right] - s[y * stride + right] - s[bottom * stride + x] +
               s[y * stride + x];
      };
      const int beyond = n * n - (right - x) * (bottom - y);  // sky
      out.coverage.push_back(share * static_cast<float>(sum(coverage_)));
      out.luminance.push_back(share / 255.0f *
                              static_cast<float>(sum(luminance_) + kSkyLuminance * beyond));
    }
  return out;
}

}  // namespace colod
