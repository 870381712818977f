#include <catch2/catch.hpp>

#include "meshes.h"

using namespace colod;

TEST_CASE("volume and area of a box do not depend on where it stands") {
  const Vec3 far(1e6, -2e6, 300);
  const Mesh m = test::box_mesh(far, far + Vec3(2, 3, 4));
  CHECK(signed_volume(m) == Approx(24));
  CHECK(surface_area(m) == Approx(52));
}

TEST_CASE("the gable house is closed and has the volume of box and prism") {
  CHECK(signed_volume(test::gable_house(10, 8, 6, 3)) == Approx(10 * 8 * 6 + 10 * 8 * 3 / 2.0));
}

TEST_CASE("a plane's basis is right-handed and horizontal in u") {
  for (const Vec3& n :
       {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 2, 3).normalized().eval(), Vec3(0, -1, 0)}) {
    const auto [u, v] = plane_basis(n);
    CHECK((u.cross(v) - n).norm() < 1e-12);
    CHECK(std::abs(u.z()) < 1e-12);
  }
}

TEST_CASE("an empty box has no size") {
  CHECK(Box().is_empty());
  CHECK(Box().size() == Vec3(0, 0, 0));
}
