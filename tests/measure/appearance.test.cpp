#include "measure/appearance.h"

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "image/look_sampler.h"
#include "measure/picture_errors.h"
#include "meshes.h"

using namespace colod;

namespace {

ColorPicture plain(const Eigen::Vector3f& linear, float coverage = 1, int side = 40) {
  const auto pixels = static_cast<std::size_t>(side) * side;
  return {side, side, std::vector<Eigen::Vector3f>(pixels, linear),
          std::vector<float>(pixels, coverage)};
}

/// A box whose sides have the colour of its corners.
struct Painted {
  Mesh mesh = test::box_mesh({0, 0, 0}, {6, 4, 3});
  Appearance look;
  ImageCache cache{1 << 20};

  explicit Painted(const Rgb& color) {
    look.colors.assign(mesh.faces.size(), {color, color, color});
  }
  AppearanceDifference beside(const Painted& other, double gsd = 0.1) const {
    return compare_appearance(mesh, LookSampler(mesh, look, cache), other.mesh,
                              LookSampler(other.mesh, other.look, other.cache), gsd);
  }
};

}  // namespace

TEST_CASE("errors of plain pictures are what their formulas say") {
  const ColorPicture black = plain({0, 0, 0}), white = plain({1, 1, 1}),
                     grey = plain({0.5, 0.5, 0.5});
  const PictureErrors e = compare_colors(black, white);
  CHECK(e.pixels == 1600);
  CHECK(e.squares / 1600 == Approx(1).epsilon(1e-5));
  // HyAB 100; greatest difference 203.3, both to the power 0.7; 0.95 at two fifths of it.
  CHECK(e.flip / 1600 == Approx(0.9674).margin(2e-4));
  CHECK(e.ssim / 1600 == Approx(1e-4 / 1.0001).epsilon(0.01));
  const double s = 0.735357;  // sRGB of half the light
  CHECK(compare_colors(white, grey).ssim / 1600 ==
        Approx((2 * s + 1e-4) / (1 + s * s + 1e-4)).epsilon(1e-3));
  CHECK(compare_colors(plain({0, 1, 0}), plain({0, 0, 1})).flip / 1600 == Approx(1).margin(1e-3));
  const PictureErrors none = compare_colors(grey, grey);
  CHECK(none.flip == 0);
  CHECK(none.ssim / 1600 == Approx(1));
}

TEST_CASE("FLIP sees an edge more than its colour, and less of what is too fine") {
  const auto stripes = [](int width) {
    ColorPicture p = plain({0.2f, 0.2f, 0.2f});
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x)
        if (x / width % 2) p.linear[y * 40 + x].setConstant(0.6f);
    return p;
  };
  const ColorPicture mean = plain({0.4f, 0.4f, 0.4f});
  CHECK(compare_colors(stripes(1), mean).flip < compare_colors(stripes(8), mean).flip);
  ColorPicture dot = mean;
  dot.linear[20 * 40 + 20].setConstant(0.5f);
  CHECK(compare_colors(dot, mean).flip > 0);
}

TEST_CASE("only what either covers counts") {
  const ColorPicture black = plain({0, 0, 0}, 0), white = plain({1, 1, 1}, 0);
  CHECK(compare_colors(black, white).pixels == 0);
  ColorPicture some = white;
  some.coverage[7] = 1;
  const PictureErrors e = compare_colors(black, some);
  CHECK((e.pixels == 1 && e.only_a == 0 && e.only_b == 1));
}

TEST_CASE("the same box looks the same, another colour or size does not") {
  const Painted red({200, 40, 30}), redder({210, 40, 30});
  const AppearanceDifference same = red.beside(red);
  CHECK(same.directions == 24);
  CHECK(same.pixels > 24 * 1000);
  CHECK(std::isinf(same.psnr));
  CHECK(same.ssim == Approx(1));
  CHECK(same.flip == 0);
  const AppearanceDifference other = red.beside(redder);
  CHECK(other.psnr == Approx(-10 * std::log10(100.0 / 65025 / 3)).margin(0.3));  // of 10 of 255
  CHECK((other.flip > 0.005 && other.flip < 0.2));
  Painted smaller({200, 40, 30});
  for (Vec3& v : smaller.mesh.vertices) v.z() *= 0.8;
  const AppearanceDifference cut = red.beside(smaller);
  CHECK(cut.only_reference > 0.02);
  CHECK(cut.only_model == 0);
  CHECK(cut.flip > 0.02);
}

TEST_CASE("pictures that would be too large are refused, threads change nothing") {
  const Painted red({200, 40, 30}), blue({20, 40, 230});
  CHECK_THROWS_AS(red.beside(blue, 1e-4), Error);
  const auto flip = [&](int threads) {
    double value = 0;
    in_threads(threads, [&] { value = red.beside(blue).flip; });
    return value;
  };
  CHECK(flip(1) == flip(3));
}
