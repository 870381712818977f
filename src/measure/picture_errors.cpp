// Based on: Wang et al., Image quality assessment: from error visibility to structural similarity,
//   IEEE TIP 13(4), 2004; Andersson et al., FLIP: a difference evaluator for alternating images,
//   HPG 2020.
// Differs: means are taken over the pixels of a building alone.
// Notation: as in the second: YCxCz and L*a*b* are colour spaces, a, b the widths and weights of
//   the Gaussians of the eye's contrast sensitivity.
#include "picture_errors.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

namespace colod {
namespace {

using Color = Eigen::Vector3f;
using Channel = std::vector<float>;  // width × height

constexpr float kCoveredPixel = 0.5f;     // of it: inside the building
constexpr double kPixelsADegree = 67.02;  // a screen of 0.7 m with 3840 pixels, 0.7 m away
constexpr double kSsimSigma = 1.5;        // pixels
constexpr int kSsimRadius = 5;            // pixels
constexpr float kC1 = 0.01f * 0.01f, kC2 = 0.03f * 0.03f;
constexpr float kColorPower = 0.7f, kSmallShare = 0.4f, kSmallTop = 0.95f;  // of FLIP's colours
constexpr double kFeatureWidth_deg = 0.082;                                 // of its edges, points

const Color kWhite(0.950428545f, 1.0f, 1.088900371f);  // D65, of XYZ

/// Weights from −radius to radius.
using Kernel = std::vector<float>;

template <typename Weight>
Kernel make_kernel(int radius, const Weight& weight) {
  Kernel kernel;
  for (int x = -radius; x <= radius; ++x) kernel.push_back(static_cast<float>(weight(x)));
  return kernel;
}

/// Positive weights sum to 1, negative ones to −1.
Kernel balanced(Kernel kernel) {
  float positive = 0, negative = 0;
  for (const float w : kernel) (w > 0 ? positive : negative) += w;
  for (float& w : kernel) w /= w > 0 ? positive : -negative;
  return kernel;
}

Kernel gaussian(int radius, double sigma) {
  return balanced(
      make_kernel(radius, [&](int x) { return std::exp(-x * x / (2 * sigma * sigma)); }));
}

/// Along rows, then along columns; what is beyond the border is the border.
Channel convolve(const Channel& in, int width, int height, const Kernel& across,
                 const Kernel& down) {
  Channel rows(in.size()), out(in.size());
  const int rx = static_cast<int>(across.size()) / 2, ry = static_cast<int>(down.size()) / 2;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float sum = 0;
      for (int k = -rx; k <= rx; ++k)
        sum += across[k + rx] * in[y * width + std::clamp(x + k, 0, width - 1)];
      rows[y * width + x] = sum;
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float sum = 0;
      for (int k = -ry; k <= ry; ++k)
        sum += down[k + ry] * rows[std::clamp(y + k, 0, height - 1) * width + x];
      out[y * width + x] = sum;
    }
  return out;
}

float srgb_of(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

Color xyz_of(const Color& linear) {
  static const Eigen::Matrix3f m =
      (Eigen::Matrix3f() << 0.41238656f, 0.35759149f, 0.18045049f, 0.21263682f, 0.71518298f,
       0.07218020f, 0.01933062f, 0.11919716f, 0.95037259f)
          .finished();
  return m * linear;
}

Color linear_of_xyz(const Color& xyz) {
  static const Eigen::Matrix3f m =
      (Eigen::Matrix3f() << 3.24100326f, -1.53739899f, -0.49861587f, -0.96922426f, 1.87592999f,
       0.04155422f, 0.05563942f, -0.20401120f, 1.05714897f)
          .finished();
  return m * xyz;
}

Color opponent_of(const Color& linear) {
  const Color c = xyz_of(linear).cwiseQuotient(kWhite);
  return {116 * c.y() - 16, 500 * (c.x() - c.y()), 200 * (c.y() - c.z())};
}

Color linear_of_opponent(const Color& o) {
  const float y = (o[0] + 16) / 116;
  const Color xyz(y + o[1] / 500, y, y - o[2] / 200);
  return linear_of_xyz(xyz.cwiseProduct(kWhite)).cwiseMax(0).cwiseMin(1);
}

/// L*a*b* after Hunt: colours count less where it is dark.
Color hunt_lab_of(const Color& linear) {
  const auto f = [](float t) {
    constexpr float kStep = 6.0f / 29;
    return t > kStep * kStep * kStep ? std::cbrt(t) : t / (3 * kStep * kStep) + 4.0f / 29;
  };
  const Color c = xyz_of(linear).cwiseQuotient(kWhite);
  const float l = 116 * f(c.y()) - 16;
  const float a = 500 * (f(c.x()) - f(c.y())), b = 200 * (f(c.y()) - f(c.z()));
  return {l, 0.01f * l * a, 0.01f * l * b};
}

float hyab(const Color& a, const Color& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

/// A sum of Gaussians a·√(π/b)·exp(−π²x²/b) over degrees, as FLIP's table has it.
struct Sensitivity {
  double a1, b1, a2, b2;
};

Channel seen_through(const Channel& in, int width, int height, const Sensitivity& s) {
  const double widest = std::max(s.b1, s.b2), pi = std::numbers::pi;
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * kPixelsADegree));
  const auto part = [&](double a, double b, double& weight) {
    Kernel k = make_kernel(radius, [&](int x) {
      const double degrees = x / kPixelsADegree;
      return std::exp(-pi * pi * degrees * degrees / b);
    });
    float sum = 0;
    for (const float w : k) sum += w;
    for (float& w : k) w /= sum;
    weight = a * std::sqrt(pi / b) * sum * sum;
    return convolve(in, width, height, k, k);
  };
  double w1 = 0, w2 = 0;
  Channel out = part(s.a1, s.b1, w1);
  if (s.a2 == 0) return out;
  const Channel second = part(s.a2, s.b2, w2);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<float>((w1 * out[i] + w2 * second[i]) / (w1 + w2));
  return out;
}

/// What FLIP compares of one picture.
struct Seen {
  std::vector<Color> lab;  // as the eye filters it
  Channel edge, point;     // how much of each there is
};

Channel magnitude(const Channel& light, const ColorPicture& p, const Kernel& slope,
                  const Kernel& smooth) {
  Channel x = convolve(light, p.width, p.height, slope, smooth);
  const Channel y = convolve(light, p.width, p.height, smooth, slope);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::hypot(x[i], y[i]);
  return x;
}

Seen look_at(const ColorPicture& p) {
  std::array<Channel, 3> channel;
  Channel light;
  for (const Color& c : p.linear) {
    const Color o = opponent_of(c);
    for (int k = 0; k < 3; ++k) channel[k].push_back(o[k]);
    light.push_back((o[0] + 16) / 116);
  }
  static constexpr std::array<Sensitivity, 3> kEye = {
      {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}}};
  for (int k = 0; k < 3; ++k) channel[k] = seen_through(channel[k], p.width, p.height, kEye[k]);
  Seen seen;
  for (std::size_t i = 0; i < p.linear.size(); ++i)
    seen.lab.push_back(
        hunt_lab_of(linear_of_opponent({channel[0][i], channel[1][i], channel[2][i]})));
  const double sigma = 0.5 * kFeatureWidth_deg * kPixelsADegree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const Kernel smooth = gaussian(radius, sigma);
  const auto bell = [&](int x) { return std::exp(-x * x / (2 * sigma * sigma)); };
  seen.edge = magnitude(light, p,
                        balanced(make_kernel(radius, [&](int x) { return -x * bell(x); })), smooth);
  seen.point = magnitude(
      light, p,
      balanced(make_kernel(radius, [&](int x) { return (x * x / (sigma * sigma) - 1) * bell(x); })),
      smooth);
  return seen;
}

/// Large differences of colour are pressed together, and all brought to 0..1.
float color_error(const Color& a, const Color& b) {
  static const float most =
      std::pow(hyab(hunt_lab_of({0, 1, 0}), hunt_lab_of({0, 0, 1})), kColorPower);
  const float error = std::pow(hyab(a, b), kColorPower), small = kSmallShare * most;
  return error < small ? error * kSmallTop / small
                       : kSmallTop + (error - small) / (most - small) * (1 - kSmallTop);
}

Channel flip(const ColorPicture& a, const ColorPicture& b) {
  const Seen s = look_at(a), t = look_at(b);
  Channel out;
  for (std::size_t i = 0; i < s.lab.size(); ++i) {
    const float feature =
        std::max(std::abs(s.edge[i] - t.edge[i]), std::abs(s.point[i] - t.point[i]));
    const float shown = std::sqrt(feature / std::numbers::sqrt2_v<float>);
    out.push_back(std::pow(color_error(s.lab[i], t.lab[i]), 1 - std::min(1.0f, shown)));
  }
  return out;
}

Channel luma(const ColorPicture& p) {
  Channel out;
  for (const Color& c : p.linear)
    out.push_back(0.299f * srgb_of(c[0]) + 0.587f * srgb_of(c[1]) + 0.114f * srgb_of(c[2]));
  return out;
}

Channel ssim(const ColorPicture& a, const ColorPicture& b) {
  const Kernel bell = gaussian(kSsimRadius, kSsimSigma);
  const Channel u = luma(a), v = luma(b);
  const auto mean = [&](const Channel& p, const Channel& q) {
    Channel product(p.size());
    for (std::size_t i = 0; i < p.size(); ++i) product[i] = p[i] * q[i];
    return convolve(product, a.width, a.height, bell, bell);
  };
  const Channel one(u.size(), 1), mu = mean(u, one), mv = mean(v, one), uu = mean(u, u),
                                  vv = mean(v, v), uv = mean(u, v);
  Channel out(u.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const float su = uu[i] - mu[i] * mu[i], sv = vv[i] - mv[i] * mv[i];
    out[i] = (2 * mu[i] * mv[i] + kC1) * (2 * (uv[i] - mu[i] * mv[i]) + kC2) /
             ((mu[i] * mu[i] + mv[i] * mv[i] + kC1) * (su + sv + kC2));
  }
  return out;
}

}  // namespace

void PictureErrors::add(const PictureErrors& e) {
  pixels += e.pixels, only_a += e.only_a, only_b += e.only_b;
  squares += e.squares, ssim += e.ssim, flip += e.flip;
}

PictureErrors compare_colors(const ColorPicture& a, const ColorPicture& b) {
  assert(a.width == b.width && a.height == b.height);
  const Channel structure = ssim(a, b), difference = flip(a, b);
  PictureErrors e;
  for (std::size_t i = 0; i < a.linear.size(); ++i) {
    const bool in_a = a.coverage[i] >= kCoveredPixel, in_b = b.coverage[i] >= kCoveredPixel;
    if (!in_a && !in_b) continue;
    ++e.pixels, e.only_a += !in_b, e.only_b += !in_a;
    e.ssim += structure[i], e.flip += difference[i];
    for (int k = 0; k < 3; ++k) {
      const double d = srgb_of(a.linear[i][k]) - srgb_of(b.linear[i][k]);
      e.squares += d * d / 3;
    }
  }
  return e;
}

}  // namespace colod
