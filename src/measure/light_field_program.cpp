// Based on: the program that Chen et al. published with their paper (light_field.h), version 1.8,
// from which most published light field distances are: the angular radial transform of MPEG-7
// (Bober, "MPEG-7 visual shape descriptors", IEEE Trans. CSVT 11(6), 2001), Fourier coefficients of
// the distance from the centre, circularity and eccentricity.
// Differs: the ten orientations of the dodecahedron are ours; of a silhouette in several parts the
// largest is traced, where the program thickens it until it is one; a border pixel has an uncovered
// one beside, above or below it.
// Notation: p angular, r radial order; ρ distance from the centre over the light field's radius.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <numbers>

#include "core/parallel.h"
#include "light_field.h"
#include "light_field_views.h"

namespace colod {
namespace {

using namespace light_fields;

constexpr int kAngular = 12, kRadial = 3;

/// A silhouette's pixels about the centre of their box.
struct Shape {
  std::vector<Pixel> pixels;
  std::complex<double> center;
  double radius = 0;  ///< to the farthest

  explicit Shape(const Silhouette& silhouette) : pixels(covered_pixels(silhouette)) {
    if (pixels.empty()) return;
    Pixel low = pixels[0], high = pixels[0];
    for (const Pixel p : pixels) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    center = {0.5 * (low.x + high.x), 0.5 * (low.y + high.y)};
    for (const Pixel p : pixels) radius = std::max(radius, std::abs(about_center(p)));
  }
  std::complex<double> about_center(Pixel p) const {
    return std::complex<double>(p.x, p.y) - center;
  }
};

/// |F(p, r)| over |F(0, 0)|, which is 1: by p, then r, without (0, 0).
std::vector<double> radial_transform(const Shape& shape, double radius) {
  std::array<std::array<std::complex<double>, kRadial>, kAngular> sums{};
  for (const Pixel pixel : shape.pixels) {
    const std::complex<double> z = shape.about_center(pixel);
    const double rho = std::abs(z) / radius;
    const std::complex<double> turn = std::abs(z) > 0 ? std::conj(z) / std::abs(z) : 1;
    std::complex<double> angular = 1;
    for (int p = 0; p < kAngular; ++p, angular *= turn)
      for (int r = 0; r < kRadial; ++r)
        sums[p][r] += std::cos(std::numbers::pi * r * rho) * angular;
  }
  std::vector<double> magnitudes;
  for (int p = 0; p < kAngular; ++p)
    for (int r = p == 0 ? 1 : 0; r < kRadial; ++r)
      magnitudes.push_back(std::abs(sums[p][r]) / static_cast<double>(shape.pixels.size()));
  return magnitudes;
}

/// |F_k| / |F_0|, k = 1..10, of the distance from the centre, pixel by pixel round the contour.
std::array<double, kFourierCount> contour_spectrum(const Shape& shape,
                                                   const std::vector<Pixel>& contour) {
  constexpr std::size_t kLeastPixels = 8;  // the program's
  std::array<double, kFourierCount> magnitudes{};
  if (contour.size() < kLeastPixels) return magnitudes;
  std::array<std::complex<double>, kFourierCount + 1> sums{};
  const double n = static_cast<double>(contour.size());
  for (std::size_t i = 0; i < contour.size(); ++i)
    for (int k = 0; k <= kFourierCount; ++k)
      sums[k] += std::polar(std::abs(shape.about_center(contour[i])),
                            -2 * std::numbers::pi * k * static_cast<double>(i) / n);
  for (int k = 1; k <= kFourierCount; ++k)
    if (2 * k <= static_cast<int>(contour.size()))
      magnitudes[k - 1] = std::abs(sums[k]) / std::abs(sums[0]);
  return magnitudes;
}

/// 4π area / perimeter², both in pixels: 1 of a disc and of what is rounder than pixels tell.
double circularity(const Silhouette& s, const Shape& shape) {
  const auto is_covered = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < kSilhouetteSize && y < kSilhouetteSize &&
           s[y * kSilhouetteSize + x];
  };
  const auto border =
      static_cast<double>(std::count_if(shape.pixels.begin(), shape.pixels.end(), [&](Pixel p) {
        return !is_covered(p.x - 1, p.y) || !is_covered(p.x + 1, p.y) ||
               !is_covered(p.x, p.y - 1) || !is_covered(p.x, p.y + 1);
      }));
  const auto area = static_cast<double>(shape.pixels.size());
  return std::min(1.0, 4 * std::numbers::pi * area / (border * border));
}

/// ((I20 − I02)² + 4 I11²) / (I20 + I02)²: 0 of a disc, 1 of a line.
double eccentricity(const Shape& shape) {
  double xx = 0, xy = 0, yy = 0;
  for (const Pixel p : shape.pixels) {
    const std::complex<double> z = shape.about_center(p);
    xx += z.real() * z.real(), xy += z.real() * z.imag(), yy += z.imag() * z.imag();
  }
  if (!(xx + yy > 0)) return 0;
  return std::min(1.0, ((xx - yy) * (xx - yy) + 4 * xy * xy) / ((xx + yy) * (xx + yy)));
}

ProgramDescriptor describe_by_program(const Silhouette& silhouette, const Shape& shape,
                                      double radius) {
  ProgramDescriptor descriptor{};
  if (shape.pixels.empty()) return descriptor;
  auto next = descriptor.begin();
  for (const double a : radial_transform(shape, radius)) *next++ = quantized(a);
  for (const double f : contour_spectrum(shape, outer_contour(silhouette)))
    *next++ = quantized(2 * f);
  *next++ = quantized(circularity(silhouette, shape));
  *next = quantized(eccentricity(shape));
  return descriptor;
}

/// Fourier coefficients and circularity count twice.
int weighted_difference(const ProgramDescriptor& a, const ProgramDescriptor& b) {
  int sum = 0;
  for (int i = 0; i < kProgramCount; ++i) {
    const bool is_twice = i >= kRadialTransformCount && i <= kRadialTransformCount + kFourierCount;
    sum += (is_twice ? 2 : 1) * std::abs(int{a[i]} - int{b[i]});
  }
  return sum;
}

}  // namespace

ProgramLightFields describe_as_program(const Mesh& mesh) {
  const std::vector<Silhouette> silhouettes = cast_silhouettes(mesh);
  ProgramLightFields result;
  parallel_for(kLightFieldCount, [&](std::size_t field) {
    std::vector<Shape> shapes;
    double radius = 1;  // of a single pixel
    for (int view = 0; view < kViewCount; ++view) {
      shapes.emplace_back(silhouettes[field * kViewCount + view]);
      radius = std::max(radius, shapes.back().radius);
    }
    for (int view = 0; view < kViewCount; ++view)
      result.views[field][view] =
          describe_by_program(silhouettes[field * kViewCount + view], shapes[view], radius);
  });
  return result;
}

int light_field_distance(const ProgramLightFields& a, const ProgramLightFields& b) {
  return least_distance(a, b, weighted_difference);
}

}  // namespace colod
