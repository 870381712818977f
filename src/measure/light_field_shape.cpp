// Based on: Teague, "Image analysis via the general theory of moments", J. Opt. Soc. Am. 70(8),
// 1980 (Zernike moments); Zhang & Lu, "A comparative study of Fourier descriptors for shape
// representation and retrieval", ACCV 2002 (centroid distance).
// Differs: no --rules here. Magnitudes are means over the silhouette, without the factor (n + 1)/π
// of an expansion, so that each lies in 0..1.
// Notation: n order, m repetition; z = x + iy about the centroid, |z| ≤ 1; R(n, m) the radial
// polynomial. The outer contour is traced by 8-neighbours, steps of length 1 or √2.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>

#include "light_field.h"
#include "light_field_views.h"

namespace colod {
namespace {

using namespace light_fields;

constexpr int kSize = kSilhouetteSize;
constexpr int kOrder = 10;

bool is_covered(const Silhouette& s, Pixel p) {
  return p.x >= 0 && p.y >= 0 && p.x < kSize && p.y < kSize && s[p.y * kSize + p.x];
}

/// Coefficient of r^(n − 2s) in R(n, m).
double radial_coefficient(int n, int m, int s) {
  const auto factorial = [](int k) { return std::tgamma(k + 1.0); };
  return (s % 2 ? -1 : 1) * factorial(n - s) /
         (factorial(s) * factorial((n + m) / 2 - s) * factorial((n - m) / 2 - s));
}

/// Clockwise on the screen, from east.
constexpr std::array<Pixel, 8> kEightAround = {
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

/// Only the largest 8-connected part; of equal ones the first.
Silhouette largest_part(const Silhouette& s) {
  std::vector<int> part(s.size(), -1);
  std::vector<Pixel> stack;
  int parts = 0, best = -1;
  std::size_t most = 0;
  for (const Pixel seed : covered_pixels(s)) {
    if (part[seed.y * kSize + seed.x] >= 0) continue;
    std::size_t count = 0;
    part[seed.y * kSize + seed.x] = parts;
    stack.push_back(seed);
    while (!stack.empty()) {
      const Pixel p = stack.back();
      stack.pop_back();
      ++count;
      for (const Pixel step : kEightAround) {
        const Pixel q = {p.x + step.x, p.y + step.y};
        if (!is_covered(s, q) || part[q.y * kSize + q.x] >= 0) continue;
        part[q.y * kSize + q.x] = parts;
        stack.push_back(q);
      }
    }
    if (count > most) most = count, best = parts;
    ++parts;
  }
  Silhouette largest(s.size(), 0);
  for (std::size_t i = 0; i < s.size(); ++i) largest[i] = best >= 0 && part[i] == best;
  return largest;
}

/// The border pixels of the part that holds the first covered pixel, in order round it; the first
/// is not repeated at the end.
std::vector<Pixel> trace_contour(const Silhouette& s) {
  const auto first = std::find(s.begin(), s.end(), 1);
  if (first == s.end()) return {};
  const int index = static_cast<int>(first - s.begin());
  std::vector<Pixel> contour = {{index % kSize, index / kSize}};
  int direction = 0;  // of the last step; nothing is covered above the first pixel or left of it
  for (int steps = 0; steps < 4 * kSize * kSize; ++steps) {
    const Pixel p = contour.back();
    int turn = 0;
    // From the outside: the neighbour after the one that the last step left uncovered.
    const int from = (direction + 7 - direction % 2) % 8;
    while (turn < 8) {
      const Pixel step = kEightAround[(from + turn) % 8];
      if (is_covered(s, {p.x + step.x, p.y + step.y})) break;
      ++turn;
    }
    if (turn == 8) return contour;  // a single pixel
    direction = (from + turn) % 8;
    contour.push_back({p.x + kEightAround[direction].x, p.y + kEightAround[direction].y});
    const std::size_t n = contour.size();
    if (n > 3 && contour[n - 1] == contour[1] && contour[n - 2] == contour[0]) {
      contour.resize(n - 2);
      break;
    }
  }
  return contour;
}

}  // namespace

namespace light_fields {

std::vector<Pixel> covered_pixels(const Silhouette& s) {
  std::vector<Pixel> pixels;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      if (s[y * kSize + x]) pixels.push_back({x, y});
  return pixels;
}

std::vector<Pixel> outer_contour(const Silhouette& silhouette) {
  return trace_contour(largest_part(silhouette));
}

}  // namespace light_fields

std::array<double, kZernikeCount> zernike_magnitudes(const Silhouette& silhouette) {
  assert(silhouette.size() == std::size_t{kSize} * kSize);
  std::array<double, kZernikeCount> magnitudes{};
  const std::vector<Pixel> pixels = covered_pixels(silhouette);
  if (pixels.empty()) return magnitudes;
  std::complex<double> sum = 0;
  for (const Pixel p : pixels) sum += std::complex<double>(p.x, p.y);
  const std::complex<double> center = sum / static_cast<double>(pixels.size());
  double radius = 0;
  for (const Pixel p : pixels)
    radius = std::max(radius, std::abs(std::complex<double>(p.x, p.y) - center));
  radius += 0.5;  // to the pixel's far side

  // power[m][j]: the sum of conj(z)^m |z|^(2j)
  std::array<std::array<std::complex<double>, kOrder / 2 + 1>, kOrder + 1> power{};
  for (const Pixel p : pixels) {
    const std::complex<double> z = (std::complex<double>(p.x, p.y) - center) / radius;
    std::complex<double> angular = 1;
    for (int m = 0; m <= kOrder; ++m, angular *= std::conj(z)) {
      double radial = 1;
      for (int j = 0; 2 * j <= kOrder - m; ++j, radial *= std::norm(z))
        power[m][j] += angular * radial;
    }
  }
  int next = 0;
  for (int n = 1; n <= kOrder; ++n)
    for (int m = n % 2; m <= n; m += 2) {
      std::complex<double> moment = 0;
      for (int s = 0; 2 * s <= n - m; ++s)
        moment += radial_coefficient(n, m, s) * power[m][(n - m) / 2 - s];
      magnitudes[next++] = std::min(1.0, std::abs(moment) / static_cast<double>(pixels.size()));
    }
  return magnitudes;
}

std::array<double, kFourierCount> fourier_magnitudes(const Silhouette& silhouette) {
  assert(silhouette.size() == std::size_t{kSize} * kSize);
  std::array<double, kFourierCount> magnitudes{};
  const std::vector<Pixel> contour = outer_contour(silhouette);
  const std::size_t n = contour.size();
  if (n < 3) return magnitudes;
  // Per pixel half of the steps to its two neighbours, and its middle along the contour.
  std::vector<double> length(n), at(n);
  const auto step = [&](std::size_t i, std::size_t j) {
    return std::hypot(contour[i].x - contour[j].x, contour[i].y - contour[j].y);
  };
  double total = 0;
  Vec2 center = Vec2::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    length[i] = 0.5 * (step(i, (i + 1) % n) + step(i, (i + n - 1) % n));
    at[i] = total;
    total += i + 1 < n ? step(i, i + 1) : step(i, 0);
    center += length[i] * Vec2(contour[i].x, contour[i].y);
  }
  center /= total;
  std::array<std::complex<double>, kFourierCount + 1> sums{};
  for (std::size_t i = 0; i < n; ++i) {
    const double distance = (Vec2(contour[i].x, contour[i].y) - center).norm();
    for (int k = 0; k <= kFourierCount; ++k)
      sums[k] += std::polar(distance * length[i], -2 * std::numbers::pi * k * at[i] / total);
  }
  for (int k = 1; k <= kFourierCount; ++k)
    magnitudes[k - 1] = std::min(1.0, std::abs(sums[k]) / std::abs(sums[0]));
  return magnitudes;
}

}  // namespace colod
