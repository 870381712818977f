#include "elements/elements.h"

#include <catch2/catch.hpp>

#include "elements_helpers.h"
#include "extraction/extraction.h"
#include "segments/ownership.h"
#include "segments/segments.h"

using namespace colod;
using namespace colod::test;

namespace {

std::vector<Element> elements_of(const Planes& planes) {
  return find_elements(planes, all_planes(planes));
}

std::vector<Element> elements_of(const Mesh& mesh) { return elements_of(planes_of_mesh(mesh)); }

Mesh without(Mesh mesh, const Vec3& a, const Vec3& b) {
  std::erase_if(mesh.faces, [&](const Face& f) {
    const Vec3 x = (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3;
    return (a.array() <= x.array()).all() && (x.array() <= b.array()).all();
  });
  return mesh;
}

PolygonMesh mesh_of(const Mesh& mesh) {
  const Planes planes = planes_of_mesh(mesh);
  Sight sight(planes);
  const Extraction e = extract_layer(planes, all_planes(planes), sight);
  CHECK(e.is_manifold);
  return e.mesh;
}

}  // namespace

TEST_CASE("a plain house has no element, nor has one with a solid box on it") {
  CHECK(elements_of(plain_house()).empty());
  CHECK(elements_of(join(plain_house(), box_mesh({3, -1.2, 2.8}, {6, 0, 4}))).empty());
  CHECK(elements_of(gable_house(10, 8, 5, 4)).empty());
  CHECK(elements_of(join(plain_house(), box_mesh({2, 2, 7}, {3, 2.6, 8.5}))).empty());
}

TEST_CASE("a balcony is found with its four planes and the air in it") {
  const auto found = elements_of(balcony_house());
  REQUIRE(found.size() == 1);
  CHECK(found[0].kind == ElementKind::kBalcony);
  CHECK(found[0].planes.size() == 4);
  CHECK(contains(found[0].air, {4.5, -0.6, 3.5}));
  for (const Vec3& x : {Vec3(4.5, -0.6, 4.5), Vec3(4.5, -0.6, 2.9), Vec3(4.5, -1.15, 3.5),
                        Vec3(4.5, 0.5, 3.5), Vec3(2, -0.6, 3.5)})
    CHECK_FALSE(contains(found[0].air, x));
  CHECK(found[0].sheets.size() == 3);
}

TEST_CASE("what parapets surround on a roof is no balcony") {
  Mesh terrace = balcony_house();
  for (std::size_t v = plain_house().vertices.size(); v < terrace.vertices.size(); ++v)
    terrace.vertices[v] += Vec3(0, 4, 4.2);
  CHECK(elements_of(terrace).empty());
}

TEST_CASE("a balcony needs its floor and a corner of walls, whatever way it looks") {
  CHECK(elements_of(without(balcony_house(), {3, -1.2, 3}, {6, 0, 3})).empty());
  CHECK(elements_of(without(balcony_house(), {6, -2, 2}, {6, 0, 4})).size() == 1);
  Mesh turned = balcony_house();
  for (Vec3& v : turned.vertices) v = Vec3(-v.y(), v.x(), v.z());
  CHECK(elements_of(turned).size() == 1);
}

TEST_CASE("a balcony seen from below only is found, its floor a slab above the underside") {
  Mesh turned = balcony_from_below();
  for (Vec3& v : turned.vertices)
    v = Vec3(0.8 * v.x() - 0.6 * v.y(), 0.6 * v.x() + 0.8 * v.y(), v.z());
  CHECK(elements_of(turned).size() == 1);
  const auto found = elements_of(balcony_from_below());
  REQUIRE(found.size() == 1);
  CHECK(found[0].kind == ElementKind::kBalcony);
  CHECK(found[0].planes.size() == 4);
  CHECK(contains(found[0].air, {4.5, -0.6, 3.5}));
  CHECK(contains(found[0].solid, {4.5, -0.6, 2.9}));
  CHECK_FALSE(contains(found[0].air, {4.5, -0.6, 2.9}));
  CHECK(signed_volume(mesh_of(balcony_from_below()).mesh()) ==
        Approx(560 + 3 * 1.2 * 0.18 + 0.12 * 1.02 * (3 + 2 * 1.08)).margin(0.05));
}

TEST_CASE("an underside is no balcony with a lid, low walls, an open side or a room above") {
  CHECK(elements_of(balcony_from_below(3.4)).empty());  // a canopy's fascia
  CHECK(elements_of(without(balcony_from_below(), {6, -2, 2}, {6, 0, 4})).empty());
  CHECK(elements_of(without(balcony_from_below(), {3, -1.2, 2}, {6, -1.2, 4})).empty());
  Mesh box = balcony_from_below(), sloped = box, bay = box, roof = box;
  add_quad(box, {3, -1.2, 4}, {6, -1.2, 4}, {6, 0, 4}, {3, 0, 4});
  CHECK(elements_of(box).empty());
  add_quad(sloped, {3, -1.2, 4}, {6, -1.2, 4}, {6, 0, 5}, {3, 0, 5});
  CHECK(elements_of(sloped).empty());
  // Panes above the walls, a little behind them.
  add_quad(bay, {3, -1.1, 4}, {6, -1.1, 4}, {6, -1.1, 5.5}, {3, -1.1, 5.5});
  add_quad(bay, {3.1, 0, 4}, {3.1, -1.2, 4}, {3.1, -1.2, 5.5}, {3.1, 0, 5.5});
  add_quad(bay, {5.9, -1.2, 4}, {5.9, 0, 4}, {5.9, 0, 5.5}, {5.9, -1.2, 5.5});
  for (const Element& h : elements_of(bay)) CHECK(h.kind != ElementKind::kBalcony);
  // A roof well above it leaves the balcony open.
  add_quad(roof, {3, -1.2, 5.2}, {6, -1.2, 5.2}, {6, 0, 5.5}, {3, 0, 5.5});
  CHECK(elements_of(roof).size() == 1);
}

TEST_CASE("a floor that is seen goes before the underside") {
  Mesh both = balcony_house();
  add_quad(both, {3, 0, 2.8}, {6, 0, 2.8}, {6, -1.2, 2.8}, {3, -1.2, 2.8});
  const auto found = elements_of(both);
  REQUIRE(found.size() == 1);
  CHECK(contains(found[0].solid, {4.5, -0.6, 2.99}));
}

TEST_CASE("a loggia is found, the space between two bays is none") {
  const auto found = elements_of(loggia_house());
  REQUIRE(found.size() == 1);
  CHECK(found[0].kind == ElementKind::kLoggia);
  CHECK(found[0].planes.size() == 4);
  CHECK(contains(found[0].air, {4.5, 0.7, 4}));
  CHECK_FALSE(contains(found[0].air, {4.5, 0.7, 2.5}));
  const Mesh bays =
      join(join(plain_house(), box_mesh({1, -1, 1}, {3, 0, 4})), box_mesh({6, -1, 1}, {8, 0, 4}));
  for (const Element& h : elements_of(bays)) CHECK(h.kind == ElementKind::kBay);
}

TEST_CASE("a chimney without its top is found") {
  const auto found = elements_of(chimney_house());
  REQUIRE_FALSE(found.empty());
  for (const Element& h : found) CHECK(h.kind == ElementKind::kChimney);
}

TEST_CASE("a chimney may lack one side; a bay or a dormer has a room behind its own") {
  const Vec3 low(2, 2, 7), high(3, 2.6, 8.5);
  const Mesh open = without(join(plain_house(), box_mesh(low, high)), {3, 2, 7}, high);
  const auto found = elements_of(open);
  REQUIRE(found.size() == 1);
  CHECK(found[0].kind == ElementKind::kChimney);
  CHECK(found[0].rims.size() == 2);  // the side and the foot
  CHECK(contains(found[0].solid, {2.9, 2.3, 8}));
  CHECK(signed_volume(mesh_of(open).mesh()) == Approx(560 + 1 * 0.6 * 1.5).margin(0.05));
  const Mesh bay =
      without(join(plain_house(), box_mesh({3, -1, 2}, {5, 0, 5})), {3, 0, 2}, {5, 0, 5});
  for (const Element& h : elements_of(bay)) CHECK(h.kind == ElementKind::kBay);
}

/// Whether the planes above z are a chimney's.
bool is_chimney_above(const Mesh& mesh, double z) {
  const Planes planes = planes_of_mesh(mesh);
  std::vector<int> above;
  for (int p = 0; p < static_cast<int>(planes.planes.size()); ++p)
    if (planes.planes[p].centroid.z() > z) above.push_back(p);
  REQUIRE_FALSE(above.empty());
  return is_whole_chimney(planes, above);
}

TEST_CASE("a whole chimney is told by walls on all sides, whatever its size") {
  for (const double size : {0.6, 0.9, 1.6, 2.2}) {
    CAPTURE(size);
    const Vec3 high(2 + size, 2 + 0.8 * size, 7 + std::max(1.0, 1.2 * size));
    CHECK(is_chimney_above(join(plain_house(), box_mesh({2, 2, 7}, high)), 7.1));
    CHECK(is_chimney_above(
        without(join(plain_house(), box_mesh({2, 2, 7}, high)), {2, 2, high.z()}, high), 7.1));
  }
}

TEST_CASE("a storey, a dormer, a pillar and a low step are no chimney") {
  CHECK_FALSE(is_chimney_above(join(plain_house(), box_mesh({2, 2, 7}, {6, 5, 10})), 7.1));
  CHECK_FALSE(is_chimney_above(join(plain_house(), box_mesh({2, 2, 7}, {4, 4, 7.3})), 7.1));
  CHECK_FALSE(is_chimney_above(dormer_house(), 4.2));
  const Planes pillar = planes_of_mesh(join(plain_house(), box_mesh({2, -4, 0}, {2.6, -3.4, 3})));
  std::vector<int> its;
  for (int p = 0; p < static_cast<int>(pillar.planes.size()); ++p)
    if (pillar.planes[p].centroid.y() < -1) its.push_back(p);
  REQUIRE(its.size() >= 5);
  CHECK_FALSE(is_whole_chimney(pillar, its));
}

TEST_CASE("segments that are chimneys are named, whole ones and such as a scan shows in part") {
  const Mesh whole = join(plain_house(), box_mesh({2, 2, 7}, {3, 2.6, 8.5}));
  for (const Mesh& house : {whole, without(whole, {3, 2, 7}, {3, 2.6, 8.5}), chimney_house()}) {
    const Planes planes = planes_of_mesh(house);
    const Segments s = build_segments(planes, {.visibility = {.ns = 48, .nr = 32}});
    const auto named = std::find_if(s.segments.begin(), s.segments.end(), [](const Segment& g) {
      return g.kind == ElementKind::kChimney;
    });
    REQUIRE(named != s.segments.end());
    for (const int p : named->planes) CHECK(planes.planes[p].centroid.z() > 6.9);
    CHECK(std::count_if(s.segments.begin(), s.segments.end(),
                        [](const Segment& g) { return g.kind == ElementKind::kChimney; }) == 1);
  }
}

TEST_CASE("a window is found by its pane and reveals, two of them at least") {
  const auto found = elements_of(window_house());
  REQUIRE(found.size() == 1);
  CHECK(found[0].kind == ElementKind::kWindow);
  CHECK(found[0].planes.size() == 5);
  CHECK(found[0].bounds.empty());
  CHECK(contains(found[0].air, {3.6, 0.1, 1.7}));
  for (const Vec3& x : {Vec3(3.6, -0.1, 1.7), Vec3(3.6, 0.3, 1.7), Vec3(4.4, 0.1, 1.7)})
    CHECK_FALSE(contains(found[0].air, x));
  const Mesh open = without(window_house(), {3, 0, 1}, {4.2, 0.15, 1.2});  // the sill is not seen
  REQUIRE(elements_of(open).size() == 1);
  CHECK(elements_of(open)[0].planes.size() == 4);
  const Mesh jamb = without(window_house(), {3, 0.01, 1}, {4.19, 0.15, 2.4});
  CHECK(elements_of(jamb).empty());
}

TEST_CASE("a window whose lintel or jamb falls to small planes is as high and wide as its pane") {
  const double opening = 1.2 * 1.4 * 0.2;
  CHECK(signed_volume(mesh_of(window_house()).mesh()) == Approx(560 - opening).margin(0.01));
  const Mesh arched = without(window_house(), {3, 0.01, 2.35}, {4.2, 0.15, 2.5});
  const Mesh left = without(window_house(), {2.9, 0.01, 1}, {3.1, 0.15, 2.4});
  const Mesh right = without(window_house(), {4.1, 0.01, 1}, {4.3, 0.15, 2.4});
  for (const Mesh& house : {arched, left, right}) {
    REQUIRE(elements_of(house).size() == 1);
    CHECK(elements_of(house)[0].rims.size() == 1);
    CHECK(signed_volume(mesh_of(house).mesh()) == Approx(560 - opening).margin(0.01));
  }
}

TEST_CASE("a dormer is told by a small roof that stands out of a steep one") {
  const auto found = elements_of(dormer_house());
  REQUIRE(found.size() == 1);
  CHECK(found[0].kind == ElementKind::kDormer);
  CHECK(found[0].planes.size() == 2);
  CHECK(found[0].rims.size() == 2);  // the cheeks
  CHECK(contains(found[0].solid, {5, 0.4, 5.5}));
  CHECK_FALSE(contains(found[0].solid, {5, 2, 5.5}));
}

TEST_CASE("a dormer's window is found in it, even one larger than the rest of the front") {
  const auto found = elements_of(dormer_window_house());
  REQUIRE(found.size() == 2);
  CHECK(found[0].kind == ElementKind::kDormer);
  CHECK(found[1].kind == ElementKind::kWindow);
  CHECK(signed_volume(mesh_of(dormer_window_house()).mesh()) ==
        Approx(signed_volume(mesh_of(dormer_house()).mesh()) - 1.7 * 1.1 * 0.15).margin(0.01));
}

TEST_CASE("what is larger than any window is none") {
  Mesh house = window_house();  // three and a half times as wide and high: 4.2 × 4.9
  for (Vec3& v : house.vertices) v = {3.5 * v.x(), v.y(), 3.5 * v.z()};
  CHECK(elements_of(house).empty());
}

TEST_CASE("a bay is told by its sides, its front and the facade, square or splayed") {
  for (const double splay : {0.0, 0.5}) {
    const auto found = elements_of(bay_house(splay));
    REQUIRE(found.size() == 1);
    CHECK(found[0].kind == ElementKind::kBay);
    CHECK(found[0].planes.size() == 4);
  }
}

TEST_CASE("a bay as high as a small house is one, though its sides are large beside the facade") {
  Mesh house = bay_house(0.5);  // sides of 1.35 × 5.9 = 8 m², no wall over 60 m²
  for (Vec3& v : house.vertices)
    v = {0.75 * v.x(), v.y() == -0.9 ? -1.3 : v.y(), v.z() == 1 ? 0.5 : v.z() == 4.5 ? 6.4 : v.z()};
  const auto found = elements_of(house);
  REQUIRE(found.size() == 1);
  CHECK(found[0].kind == ElementKind::kBay);
}

TEST_CASE("what a scan misses of them stands in the mesh") {
  const double house = 560;
  CHECK(signed_volume(mesh_of(balcony_house()).mesh()) ==
        Approx(house + 3 * 1.2 * 0.2 + 0.12 * (3 + 2 * 1.08)).margin(0.05));
  CHECK(signed_volume(mesh_of(loggia_house()).mesh()) ==
        Approx(house - 3 * 1.5 * 2.3).margin(0.05));
  CHECK(signed_volume(mesh_of(chimney_house()).mesh()) ==
        Approx(house + 27 + 1 * 0.6 * 1.5).margin(0.05));
}

TEST_CASE("balconies and loggias are segments of their own, whole") {
  for (const bool is_loggia : {false, true}) {
    const Planes planes = planes_of_mesh(is_loggia ? loggia_house() : balcony_house());
    SegmentOptions options;
    options.visibility.ns = 40;
    const Segments s = build_segments(planes, options);
    const ElementKind kind = is_loggia ? ElementKind::kLoggia : ElementKind::kBalcony;
    const auto own = std::find_if(s.segments.begin(), s.segments.end(),
                                  [&](const Segment& g) { return g.kind == kind; });
    REQUIRE(own != s.segments.end());
    CHECK(own->planes == elements_of(planes)[0].planes);
    CHECK(own->is_alcove == is_loggia);
  }
}

TEST_CASE("a window's recess is one segment, although rays give its planes to several") {
  for (const double turn : {0.0, 0.3}) {
    Mesh house = window_house();
    for (Vec3& v : house.vertices)
      v = Vec3(std::cos(turn) * v.x() - std::sin(turn) * v.y(),
               std::sin(turn) * v.x() + std::cos(turn) * v.y(), v.z());
    const Planes planes = planes_of_mesh(house);
    SegmentOptions options;
    options.visibility.ns = 40;
    const Segments s = build_segments(planes, options);
    const auto own = std::find_if(s.segments.begin(), s.segments.end(),
                                  [](const Segment& g) { return g.is_alcove; });
    REQUIRE(own != s.segments.end());
    CHECK(own->planes == elements_of(planes)[0].planes);
    CHECK(own->kind == ElementKind::kWindow);
    CHECK(std::count_if(s.segments.begin(), s.segments.end(),
                        [](const Segment& g) { return g.is_alcove; }) == 1);
  }
}
