#include "measure/light_field.h"

#include <catch2/catch.hpp>
#include <functional>

#include "core/error.h"
#include "core/parallel.h"
#include "meshes.h"

using namespace colod;

namespace {

/// What `covers` says of each pixel's centre, in −1..1 both ways.
Silhouette draw(const std::function<bool(double, double)>& covers) {
  Silhouette s;
  for (int y = 0; y < kSilhouetteSize; ++y)
    for (int x = 0; x < kSilhouetteSize; ++x)
      s.push_back(covers((x + 0.5) / kSilhouetteSize * 2 - 1, (y + 0.5) / kSilhouetteSize * 2 - 1));
  return s;
}

Silhouette square(double half, double turn = 0, double x0 = 0, double y0 = 0) {
  return draw([=](double x, double y) {
    const double u = std::cos(turn) * (x - x0) + std::sin(turn) * (y - y0);
    const double v = std::cos(turn) * (y - y0) - std::sin(turn) * (x - x0);
    return std::abs(u) < half && std::abs(v) < half;
  });
}

double zernike(const Silhouette& s, int n, int m) {
  int index = 0;
  for (int k = 1; k < n; ++k) index += k / 2 + 1;
  return zernike_magnitudes(s)[index + m / 2];
}

Mesh transformed(Mesh m, const Eigen::Matrix3d& r, double scale = 1, Vec3 shift = Vec3::Zero()) {
  for (Vec3& v : m.vertices) v = scale * (r * v) + shift;
  return m;
}

int apart(const Mesh& a, const Mesh& b) {
  return light_field_distance(describe_light_fields(a), describe_light_fields(b));
}

Mesh house() { return test::gable_house(10, 7, 5, 3); }

}  // namespace

TEST_CASE("a disc has no moment besides the zeroth and a contour of one harmonic") {
  const Silhouette disc = draw([](double x, double y) { return std::hypot(x, y) < 0.8; });
  for (const double z : zernike_magnitudes(disc)) CHECK(z < 0.02);
  for (const double f : fourier_magnitudes(disc)) CHECK(f < 0.01);
}

TEST_CASE("the moments of a square are the integrals") {
  // Corners on the unit circle, side √2: the mean of 2r² − 1 is −1/3, of z⁴ −4/15, of 4r⁴ z … 0.
  const Silhouette s = square(0.7);
  CHECK(zernike(s, 2, 0) == Approx(1.0 / 3).margin(0.01));
  CHECK(zernike(s, 4, 4) == Approx(4.0 / 60).margin(0.01));
  for (const auto& [n, m] : {std::pair{1, 1}, {2, 2}, {3, 1}, {3, 3}, {5, 5}, {6, 2}, {10, 6}})
    CHECK(zernike(s, n, m) < 0.01);
  CHECK(fourier_magnitudes(s)[3] > 0.05);  // four corners
  CHECK(fourier_magnitudes(s)[2] < 0.01);
}

TEST_CASE("turned, moved and scaled silhouettes have the same description") {
  const Silhouette a = square(0.6), b = square(0.45, 0.4, 0.1, -0.05);
  const auto za = zernike_magnitudes(a), zb = zernike_magnitudes(b);
  const auto fa = fourier_magnitudes(a), fb = fourier_magnitudes(b);
  for (int i = 0; i < kZernikeCount; ++i) CHECK(za[i] == Approx(zb[i]).margin(0.015));
  for (int i = 0; i < kFourierCount; ++i) CHECK(fa[i] == Approx(fb[i]).margin(0.015));
}

TEST_CASE("the contour is the outer one of the largest part") {
  const auto covers = [](double x, double y) { return std::hypot(x, y) < 0.6; };
  const auto disc = fourier_magnitudes(draw(covers));
  const Silhouette ring = draw([&](double x, double y) {
    return (covers(x, y) && std::hypot(x, y) > 0.3) || (x > 0.9 && y > 0.9);
  });
  const auto magnitudes = fourier_magnitudes(ring);
  for (int i = 0; i < kFourierCount; ++i) CHECK(magnitudes[i] == Approx(disc[i]).margin(1e-9));
}

TEST_CASE("nothing, one pixel and a line are described without a number that is none") {
  Silhouette s(std::size_t{kSilhouetteSize} * kSilhouetteSize, 0);
  for (int covered = 0; covered < 4; ++covered) {
    for (const double z : zernike_magnitudes(s)) CHECK((z >= 0 && z <= 1));
    for (const double f : fourier_magnitudes(s)) CHECK((f >= 0 && f <= 1));
    s[covered] = 1;
  }
}

TEST_CASE(
    "as the authors' program: nothing from itself, turned or scaled, and grows with the roof") {
  const Mesh m = house();
  const ProgramLightFields own = describe_as_program(m);
  CHECK(light_field_distance(own, own) == 0);
  const Mesh placed = transformed(m, Eigen::Matrix3d::Identity(), 3, {1e5, -2e5, 40});
  CHECK(light_field_distance(own, describe_as_program(placed)) < 200);
  const Mesh slab = test::box_mesh({0, 0, 0}, {10, 7, 0.2});
  const int apart_from_slab = light_field_distance(own, describe_as_program(slab));
  const Mesh turned = transformed(m, dodecahedron_rotations()[17]);
  CHECK(4 * light_field_distance(own, describe_as_program(turned)) < apart_from_slab);  // pixels
  int last = 0;
  for (const double roof : {3.5, 4.5, 6.5, 10.0}) {
    const int d = light_field_distance(own, describe_as_program(test::gable_house(10, 7, 5, roof)));
    CHECK(d > last);
    last = d;
  }
}

TEST_CASE("as the authors' program: a ball is round from all sides, a needle is a line") {
  const auto last_two = [](const Mesh& mesh) {
    const ProgramDescriptor view = describe_as_program(mesh).views[0][0];
    return std::pair<int, int>(view[kProgramCount - 2], view[kProgramCount - 1]);
  };
  const auto [ball_circularity, ball_eccentricity] = last_two(test::sphere_mesh(4));
  CHECK(ball_circularity > 230);
  CHECK(ball_eccentricity < 3);
  const auto [needle_circularity, needle_eccentricity] =
      last_two(test::box_mesh({0, 0, 0}, {100, 1, 1}));
  CHECK(needle_circularity < 30);
  CHECK(needle_eccentricity > 250);
}

TEST_CASE("sixty rotations, all different, all rotations") {
  const auto rotations = dodecahedron_rotations();
  REQUIRE(rotations.size() == 60);
  for (std::size_t i = 0; i < 60; ++i) {
    CHECK(rotations[i].determinant() == Approx(1));
    CHECK((rotations[i] * rotations[i].transpose()).isIdentity(1e-12));
    for (std::size_t j = 0; j < i; ++j) CHECK((rotations[i] - rotations[j]).norm() > 0.1);
  }
}

TEST_CASE("a model is no distance from itself, moved, scaled or turned by one of the rotations") {
  const Mesh m = house();
  const LightFields own = describe_light_fields(m);
  CHECK(light_field_distance(own, own) == 0);
  const Mesh placed = transformed(m, Eigen::Matrix3d::Identity(), 3, {1e5, -2e5, 40});
  CHECK(light_field_distance(own, describe_light_fields(placed)) < 60);
  for (const int i : {1, 17, 42}) {
    const Mesh turned = transformed(m, dodecahedron_rotations()[i]);
    CHECK(light_field_distance(own, describe_light_fields(turned)) < 350);  // pixels only
  }
}

TEST_CASE("the distance grows with the deformation, different shapes are far apart") {
  const LightFields own = describe_light_fields(house());
  int last = 0;
  for (const double roof : {3.5, 4.5, 6.5, 10.0}) {
    const int d =
        light_field_distance(own, describe_light_fields(test::gable_house(10, 7, 5, roof)));
    CHECK(d > last);
    last = d;
  }
  const Mesh slab = test::box_mesh({0, 0, 0}, {10, 7, 0.2});
  CHECK(apart(house(), slab) > 3000);
  CHECK(apart(test::sphere_mesh(4), slab) > 5000);
}

TEST_CASE("the distance has two sides that are equal, and bounds") {
  const LightFields a = describe_light_fields(house()),
                    b = describe_light_fields(test::sphere_mesh(3));
  CHECK(light_field_distance(a, b) == light_field_distance(b, a));
  CHECK(light_field_distance(a, b) <= 10 * 45 * 255);
}

TEST_CASE("any number of threads sees the same") {
  limit_threads(1);
  const LightFields one = describe_light_fields(house());
  limit_threads(2);
  const LightFields two = describe_light_fields(house());
  limit_threads(0);
  CHECK(one.views == two.views);
}

TEST_CASE("broken faces are not seen; nothing to see is an error") {
  Mesh m = house();
  m.vertices.push_back(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  m.faces.push_back({0, 1, static_cast<int>(m.vertices.size()) - 1});
  m.faces.push_back({0, 0, 1});
  CHECK(apart(house(), m) == 0);
  CHECK_THROWS_AS(describe_light_fields({}), Error);
}
