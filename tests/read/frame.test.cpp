#include "read/frame.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>
#include <random>

#include "meshes.h"

using namespace colod;

namespace {

/// An L-shaped group of two boxes: no symmetry that would leave the frame a choice.
Source asymmetric() {
  return test::as_source(
      test::join(test::box_mesh({0, 0, 0}, {12, 7, 6}), test::box_mesh({1, 7.5, 0}, {4, 10, 3})));
}

Source moved(Source s, double yaw_deg, const Vec3& by) {
  const Eigen::AngleAxisd turn(yaw_deg * std::numbers::pi / 180, Vec3::UnitZ());
  for (Vec3& p : s.mesh.vertices) p = turn * p + by;
  return s;
}

Source local(const Source& s) { return localize(s, main_frame(s)); }

double largest_difference(const Source& a, const Source& b) {
  REQUIRE(a.mesh.vertices.size() == b.mesh.vertices.size());
  double d = 0;  // nearest vertex, since rounding may change the order
  for (const Vec3& p : a.mesh.vertices) {
    double nearest = 1e9;
    for (const Vec3& q : b.mesh.vertices) nearest = std::min(nearest, (p - q).norm());
    d = std::max(d, nearest);
  }
  return d;
}

}  // namespace

TEST_CASE("the local frame undoes translation, quarter turns and any turn about z") {
  const Source reference = local(asymmetric());
  for (const double yaw : {0.0, 90.0, 180.0, 270.0, 17.0, 133.5})
    CHECK(largest_difference(reference, local(moved(asymmetric(), yaw, {1e6, -2e6, 40}))) < 1e-4);
}

TEST_CASE("world and local coordinates are inverse") {
  const Frame frame = main_frame(moved(asymmetric(), 33, {5e5, 5e6, 100}));
  const Vec3 p(3.25, -4.5, 2);
  CHECK((frame.to_local(frame.to_world(p)) - p).norm() < 1e-8);
}

TEST_CASE("a permuted mesh is the same mesh in its frame") {
  Source s = asymmetric();
  const Source reference = local(s);
  std::mt19937 random(7);
  std::shuffle(s.mesh.faces.begin(), s.mesh.faces.end(), random);
  for (Face& f : s.mesh.faces) std::rotate(f.begin(), f.begin() + 1, f.end());
  const Source permuted = local(s);
  CHECK(permuted.mesh.faces == reference.mesh.faces);
  CHECK(permuted.mesh.vertices == reference.mesh.vertices);
}

TEST_CASE("duplicate and degenerate faces are dropped with a warning, objects follow") {
  Source s = asymmetric();
  s.face_object.resize(s.mesh.faces.size());
  for (std::size_t i = 0; i < s.face_object.size(); ++i) s.face_object[i] = i < 12 ? 1 : 2;
  s.mesh.faces.push_back(s.mesh.faces[3]), s.face_object.push_back(1);
  s.mesh.faces.push_back({0, 0, 1}), s.face_object.push_back(2);
  const Source clean = local(s);
  CHECK(clean.mesh.faces.size() == 24);
  CHECK(clean.warnings.size() == 2);
  CHECK(std::count(clean.face_object.begin(), clean.face_object.end(), 1) == 12);
}

TEST_CASE("a cloud's normals turn with its points, and no wall at all is no error") {
  Source s;
  s.cloud.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  s.cloud.normals.assign(4, Vec3::UnitZ());
  const Source flat = local(s);
  CHECK(flat.cloud.points.size() == 3);
  CHECK(flat.cloud.normals.size() == 3);
  CHECK(main_frame(Source{}).yaw == 0);
}
