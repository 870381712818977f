#include "coanalysis/similarity.h"

#include <catch2/catch.hpp>

#include "similarity_helpers.h"

using namespace colod;
using namespace colod::test;

namespace {

Descriptor describe_mesh(const Mesh& m, const DescriptorOptions& options = {},
                         const std::string& building = "b") {
  Planes planes;
  Segments segments;
  add_segment(m, planes, segments);
  return describe_segments(planes, segments, building, options).front();
}

// Mean distance in whitened units, from the bins' middles.
double mean_distance(const Descriptor& d) {
  double mean = 0;
  for (int i = 0; i < 64; ++i) mean += d.d2[i] * (i + 0.5) * 6 / 64;
  return mean;
}

double sum(const Descriptor& d) {
  double s = 0;
  for (const double x : d.d2) s += x;
  return s;
}

const Mesh kCube = box_mesh({0, 0, 0}, {2, 2, 2});

}  // namespace

TEST_CASE("a sphere's mean distance is 4/3 r and its covariance r²/3") {
  const Descriptor d = describe_mesh(sphere_mesh(4));
  CHECK(d.eigenvalues[0] == Approx(1.0 / 3).epsilon(0.01));
  CHECK(d.eigenvalues[2] == Approx(1.0 / 3).epsilon(0.01));
  CHECK(mean_distance(d) == Approx(4.0 / 3 * std::sqrt(3)).epsilon(0.005));
  CHECK(sum(d) == Approx(1));
  CHECK_FALSE(d.is_flat);
}

TEST_CASE("a cube's surface has covariance 5/36 of its side squared in each direction") {
  // Two faces at ±1/2 and four with 1/12 in x: (2·1/4 + 4/12) / 6 = 5/36.
  const Descriptor d = describe_mesh(kCube);
  for (int i = 0; i < 3; ++i) CHECK(d.eigenvalues[i] == Approx(4 * 5.0 / 36));
  CHECK(d.extent == Approx(std::sqrt(5.0 / 9)));
  CHECK(d.area == Approx(24));
}

TEST_CASE("a square's mean distance is 0.5214 of its side, before whitening by √12") {
  const Mesh square{{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Descriptor d = describe_mesh(square);
  CHECK(d.is_flat);
  CHECK(mean_distance(d) == Approx(0.521405 * std::sqrt(12)).epsilon(0.005));
}

TEST_CASE("a thin strip's mean distance is a third of its length") {
  const Mesh strip{{{0, 0, 0}, {90, 0, 0}, {90, 1e-3, 0}, {0, 1e-3, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  CHECK(mean_distance(describe_mesh(strip)) == Approx(std::sqrt(12) / 3).epsilon(0.01));
}

TEST_CASE("rigid motion changes nothing but the sampling's rounding") {
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  const Mesh house = gable_house(10, 6, 5, 3);
  const Mesh moved =
      mapped(house, [&](const Vec3& v) { return Vec3(turn * v + Vec3(900, -800, 70)); });
  const Descriptor a = describe_mesh(house), b = describe_mesh(moved);
  CHECK(shape_distance(a, b) < 3.3e-3);
  CHECK(segment_distance(a, b, 4) < 0.016);
}

TEST_CASE("anisotropic scaling changes the scale and not the shape of an equally sampled body") {
  // Not exactly: faces of different direction grow by different factors.
  const auto stretched = mapped(kCube, [](const Vec3& v) { return Vec3(3 * v.x(), v.y(), v.z()); });
  const Descriptor a = describe_mesh(kCube), b = describe_mesh(stretched);
  const Descriptor scaled = describe_mesh(mapped(kCube, [](const Vec3& v) { return Vec3(5 * v); }));
  CHECK(shape_distance(a, scaled) < 1e-12);
  CHECK(shape_distance(a, b) < 0.16);
  CHECK(b.eigenvalues[0] > 5 * a.eigenvalues[0]);
  for (int i = 0; i < 64; ++i) CHECK(b.d2[i] >= 0);
}

TEST_CASE("scale_d is the L1 difference of the eigenvalues over their sum") {
  Descriptor a, b;
  a.eigenvalues = Vec3(4, 2, 1), b.eigenvalues = Vec3(1, 1, 1);
  CHECK(segment_distance(a, b, 4) == Approx(0.4));
  CHECK(segment_distance(b, a, 4) == segment_distance(a, b, 4));
  a.d2[3] = 1, b.d2[7] = 1;
  CHECK(segment_distance(a, b, 2) == Approx(0.4 + 2 * kDensity * std::sqrt(2)));
  CHECK(segment_distance(a, a, 4) == 0);
  CHECK(segment_similarity(a, a, 4) == 1);
}

TEST_CASE("another seed moves the histogram by far less than another shape") {
  const Mesh house = gable_house(10, 6, 5, 3);
  const Descriptor a = describe_mesh(house, {.seed = 1}), b = describe_mesh(house, {.seed = 2});
  CHECK(shape_distance(a, b) > 0);
  CHECK(shape_distance(a, b) < 0.023);
  CHECK(shape_distance(a, describe_mesh(sphere_mesh(3))) > 3 * shape_distance(a, b));
  CHECK(describe_mesh(house).d2 == describe_mesh(house).d2);
  CHECK(describe_mesh(house, {}, "x").d2 != describe_mesh(house, {}, "y").d2);
}

TEST_CASE("flat: one plane, or thinner than 5 cm") {
  Planes planes;
  Segments segments;
  add_segment(box_mesh({0, 0, 0}, {2, 2, 0.04}), planes, segments);
  add_segment(box_mesh({0, 0, 0}, {2, 2, 0.4}), planes, segments);
  add_segment(kCube, planes, segments, 1, 12);
  const auto d = describe_segments(planes, segments, "b");
  CHECK(d[0].is_flat);
  CHECK_FALSE(d[1].is_flat);
  CHECK(d[2].is_flat);
}

TEST_CASE("no area, NaN and missing outlines are described, never NaN") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Planes planes;
  Segments segments;
  add_segment({{{1, 1, 1}, {2, 2, 2}, {3, 3, 3}}, {{0, 1, 2}}}, planes, segments);
  add_segment({{{1, 1, nan}, {2, 0, 2}, {3, 3, 3}}, {{0, 1, 2}}}, planes, segments, nan);
  segments.segments.push_back({});
  for (const Descriptor& d : describe_segments(planes, segments, "b")) {
    CHECK(sum(d) == 1);
    CHECK(d.eigenvalues.isZero());
    CHECK(std::isfinite(d.area + d.volume + d.extent));
    CHECK(d.is_flat);
    CHECK(segment_distance(d, describe_mesh(kCube), 4) < 20);
  }
}
