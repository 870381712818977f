#include "picture/picture.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "image/look_sampler.h"
#include "meshes.h"

using namespace colod;

namespace {

Color pixel(const Image& i, int x, int y) {
  const std::uint8_t* p = &i.rgb[3 * (static_cast<std::size_t>(y) * i.width + x)];
  return {p[0], p[1], p[2]};
}
Color middle(const Image& i) { return pixel(i, i.width / 2, i.height / 2); }
bool is_reddish(const Color& c) { return c[0] > 2 * c[1] && c[0] > 2 * c[2]; }

/// Share of pixels that are not background.
double coverage(const Image& i) {
  int count = 0;
  for (int y = 0; y < i.height; ++y)
    for (int x = 0; x < i.width; ++x) count += pixel(i, x, y) != pixel(i, 0, 0);
  return count / static_cast<double>(i.width * i.height);
}

int dark_pixels(const Image& i) {
  int count = 0;
  for (std::size_t k = 0; k < i.rgb.size(); k += 3) count += i.rgb[k] < 95 && i.rgb[k + 1] < 95;
  return count;
}

Mesh flipped(Mesh m) {
  for (Face& f : m.faces) std::swap(f[1], f[2]);
  return m;
}

const PreviewOptions kSouth{
    .width = 100, .height = 100, .azimuth_deg = 0, .elevation_deg = 0, .box = {}};

}  // namespace

TEST_CASE("a cube seen from the front fills the frame but for the margin") {
  const Image i = render_preview(test::box_mesh({5, 5, 5}, {7, 7, 7}), kSouth);
  CHECK(i.rgb.size() == 30000);
  CHECK(coverage(i) == Approx(1 / (1.06 * 1.06)).margin(0.03));
}

TEST_CASE("a look is drawn in its own colours, without light, and backs stay red") {
  const Mesh box = test::box_mesh({0, 0, 0}, {2, 2, 2});
  Appearance look;
  look.colors.assign(12, {Rgb{10, 20, 30}, Rgb{10, 20, 30}, Rgb{10, 20, 30}});
  look.colors[4] = look.colors[5] = {Rgb{90, 180, 40}, Rgb{90, 180, 40}, Rgb{90, 180, 40}};  // −y
  const ImageCache images(1 << 20);
  CHECK(middle(render_preview(box, LookSampler(box, look, images), kSouth)) == Color{90, 180, 40});
  PreviewOptions east = kSouth;
  east.azimuth_deg = 90;
  CHECK(middle(render_preview(box, LookSampler(box, look, images), east)) == Color{10, 20, 30});
  const Mesh inside = flipped(box);
  CHECK(middle(render_preview(inside, LookSampler(inside, look, images), kSouth))[0] == 150);
}

TEST_CASE("azimuth 0 looks from the south, 90 from the east, elevation 90 from above") {
  const Mesh box = test::box_mesh({0, 0, 0}, {2, 2, 2});
  std::vector<Color> colors(12, {200, 200, 200});
  colors[2] = colors[3] = {0, 0, 255};      // top
  colors[4] = colors[5] = {0, 255, 0};      // −y
  colors[10] = colors[11] = {255, 255, 0};  // +x
  PreviewOptions o = kSouth;
  const Color south = middle(render_preview(box, o, {}, colors));
  o.azimuth_deg = 90;
  const Color east = middle(render_preview(box, o, {}, colors));
  o.elevation_deg = 90;
  const Color top = middle(render_preview(box, o, {}, colors));
  CHECK((south[0] == 0 && south[1] > 100 && south[2] == 0));
  CHECK((east[0] > 100 && east[1] > 100 && east[2] == 0));
  CHECK((top[0] == 0 && top[1] == 0 && top[2] > 100));
}

TEST_CASE("what is right in the scene is right in the picture, what is high is high") {
  const Mesh m =
      test::join(test::box_mesh({0, 0, 0}, {1, 1, 1}), test::box_mesh({9, 0, 9}, {10, 1, 10}));
  const Image i = render_preview(m, kSouth);
  CHECK(pixel(i, 8, 91) != pixel(i, 8, 8));
  CHECK(pixel(i, 91, 8) != pixel(i, 91, 91));
}

TEST_CASE("flipped faces are dark red, right ones are not") {
  const Mesh box = test::box_mesh({0, 0, 0}, {2, 2, 2});
  CHECK(is_reddish(middle(render_preview(flipped(box), kSouth))));
  CHECK_FALSE(is_reddish(middle(render_preview(box, kSouth))));
}

TEST_CASE("lines follow facets, not triangles") {
  PreviewOptions o{.width = 200, .height = 200, .box = {}};
  const Mesh box = test::box_mesh({0, 0, 0}, {2, 2, 2});
  const std::vector<int> triangles{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  const std::vector<int> sides{0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5};
  const int by_triangle = dark_pixels(render_preview(box, o, triangles));
  const int by_side = dark_pixels(render_preview(box, o, sides));
  const int by_normal = dark_pixels(render_preview(box, o));
  CHECK(by_side > 100);
  CHECK(by_triangle > by_side + 50);
  CHECK(by_normal == by_side);
  o.has_edges = false;
  CHECK(dark_pixels(render_preview(box, o)) < by_side / 4);
}

TEST_CASE("the same box gives the same camera") {
  const Mesh box = test::box_mesh({0, 0, 0}, {2, 2, 2});
  PreviewOptions o = kSouth;
  o.box.extend(Vec3(0, 0, 0));
  o.box.extend(Vec3(4, 2, 4));
  CHECK(coverage(render_preview(box, o)) == Approx(0.25 / (1.06 * 1.06)).margin(0.03));
  o.box = Box();
  o.box.extend(Vec3(0.9, 0.9, 0.9));  // smaller than the mesh: it fills the picture
  o.box.extend(Vec3(1.1, 1.1, 1.1));
  CHECK(middle(render_preview(box, o)) == pixel(render_preview(box, o), 0, 0));
}

TEST_CASE("points of a plane cover what the plane covers") {
  PointCloud cloud;
  for (int i = 0; i < 100; ++i)
    for (int j = 0; j < 100; ++j) cloud.points.emplace_back(i * 0.1, 0.0, j * 0.1);
  CHECK(coverage(render_preview(cloud, kSouth)) == Approx(0.9).margin(0.06));
  cloud.normals.assign(cloud.points.size(), Vec3(0, 1, 0));  // away from the viewer
  CHECK(is_reddish(middle(render_preview(cloud, kSouth))));
}

TEST_CASE("nothing, degenerate and non-finite input give a picture all the same") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(coverage(render_preview(Mesh(), kSouth)) == 0);
  CHECK(coverage(render_preview(PointCloud(), kSouth)) == 0);
  CHECK(coverage(render_preview(PointCloud{{{1, 2, 3}, {nan, 0, 0}}, {}}, kSouth)) > 0);
  Mesh box = test::box_mesh({0, 0, 0}, {2, 2, 2});
  box.vertices.emplace_back(nan, nan, nan);
  box.faces.push_back({0, 1, 8});
  box.faces.push_back({0, 0, 0});
  CHECK(coverage(render_preview(box, kSouth)) > 0.8);
}

TEST_CASE("a contact sheet holds every picture and a caption under it") {
  const Image i = render_preview(test::box_mesh({0, 0, 0}, {2, 2, 2}), kSouth);
  const Image sheet = contact_sheet({i, i, i}, {"a", "", "a name much longer than its picture"}, 2);
  CHECK(sheet.width == 2 * 108 + 8);
  CHECK(sheet.height == 2 * 120 + 8);
  CHECK(pixel(sheet, 8 + 50, 8 + 50) == middle(i));
  CHECK(pixel(sheet, 8 + 50, 128 + 50) == middle(i));
  const auto ink = [&](int x0, int y0) {
    int count = 0;
    for (int y = y0; y < y0 + 12; ++y)
      for (int x = x0; x < x0 + 100; ++x) count += pixel(sheet, x, y) == Color{20, 20, 20};
    return count;
  };
  CHECK(ink(8, 108) > 5);
  CHECK(ink(116, 108) == 0);
  CHECK(ink(8, 228) > 100);
  CHECK(contact_sheet({}, {}, 3).rgb.size() > 0);
}

TEST_CASE("a PNG says its size and is the same every time") {
  const Image i = render_preview(test::gable_house(10, 8, 5, 3));
  const std::string png = encode_png(i);
  REQUIRE(png.size() > 100);
  CHECK(png.substr(1, 3) == "PNG");
  CHECK((static_cast<unsigned char>(png[18]) * 256 + static_cast<unsigned char>(png[19])) == 480);
  CHECK(png == encode_png(render_preview(test::gable_house(10, 8, 5, 3))));
}

TEST_CASE("neighbouring colours differ, and so do the first two dozen") {
  std::set<Color> seen;
  for (int id = 0; id < 24; ++id) seen.insert(palette(id));
  CHECK(seen.size() == 24);
  for (int id = 0; id < 100; ++id) {
    const Color a = palette(id), b = palette(id + 1);
    CHECK(std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) > 80);
  }
}

TEST_CASE("a small PNG keeps to its size and its background is transparent") {
  const Image image =
      render_preview(test::sphere_mesh(4), {.width = 200, .height = 150, .box = {}});
  const std::string whole = encode_png(image), small = encode_small_png(image, 100000);
  CHECK(small.size() < whole.size());
  CHECK(small.find("PLTE") != small.npos);
  CHECK(small.find("tRNS") != small.npos);
  for (const std::size_t most : {6000, 2000, 700}) {
    const std::string bytes = encode_small_png(image, most);
    CHECK(bytes.size() <= most);
    CHECK(bytes.starts_with("\x89PNG"));
  }
  CHECK(encode_small_png(Image{1, 1, {1, 2, 3}}, 1).starts_with("\x89PNG"));
}

TEST_CASE("faces finer than the samples leave no pinhole") {
  PreviewOptions o = kSouth;
  o.samples = 1;
  const Image i = render_preview(test::sphere_mesh(6), o);
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x)
      if (std::hypot(x - 49.5, y - 49.5) < 44) REQUIRE(pixel(i, x, y) != kBackground);
}
