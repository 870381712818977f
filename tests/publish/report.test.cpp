// report.html: what it holds, whatever the names, the failures and the size of the scene.
#include "publish/report.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <regex>

#include "core/parallel.h"
#include "exporters/html_report/html_report.h"
#include "meshes.h"
#include "publish/report_parts.h"
#include "publish/report_pictures.h"

using namespace colod;
using Json = nlohmann::json;

namespace {

PolygonMesh polygons(const Mesh& mesh) {
  PolygonMesh p;
  p.vertices = mesh.vertices;
  p.triangles = mesh.faces;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    p.facets.push_back({face_cross(mesh, mesh.faces[i]).normalized(), static_cast<int>(i), {}});
    p.facet_of_triangle.push_back(static_cast<int>(i));
  }
  return p;
}

/// A house with two layers and as many segments as layers; `extent` of the second.
Building house(const std::string& name, double extent = 1) {
  Building b;
  b.source = test::as_source(test::gable_house(12, 9, 6, 4), name);
  b.counts = count(b);
  b.segments.segments.resize(2);
  b.segments.segment_of_plane = std::vector<int>(16, 1);
  for (const double e : {4.0, extent}) {
    Descriptor d;
    d.d2[static_cast<std::size_t>(10 * e) % 64] = 1;
    d.extent = e;
    d.area = 10 * e;
    d.eigenvalues = {e * e, e, 1};
    b.descriptors.push_back(d);
  }
  b.layer_of_segment = {0, 1};
  for (int k = 0; k < 2; ++k) {
    Layer layer;
    layer.layer = k;
    layer.mesh = polygons(k == 0 ? test::box_mesh({0, 0, 0}, {12, 9, 8}) : b.source.mesh);
    layer.validity.faces = static_cast<int>(layer.mesh.triangles.size());
    layer.validity.is_watertight = true;
    b.layers.push_back(std::move(layer));
  }
  return b;
}

Options two_layers() {
  Options o;
  o.layers = 2;
  return o;
}

std::string page_of(const Scene& scene, std::vector<std::vector<std::string>> pictures = {}) {
  const Options o = two_layers();
  return encode_html_report({report_json(scene, o, {}),
                             parts_json(scene, o),
                             std::move(pictures),
                             {"#abcdef", "#123456"}})
      .bytes;
}

/// The JSON of one of the page's data blocks, up to the first thing that ends a script.
Json block(const std::string& page, const std::string& id) {
  const std::string start = "<script type=\"application/json\" id=\"" + id + "-data\">";
  const std::size_t begin = page.find(start);
  REQUIRE(begin != page.npos);
  const std::size_t end = page.find("</", begin);
  return Json::parse(page.substr(begin + start.size(), end - begin - start.size()));
}

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t n = 0;
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++n;
  return n;
}

/// Tags that are not closed in the order in which they were opened; scripts and styles are text.
std::vector<std::string> unbalanced(const std::string& page) {
  static const std::regex kTag("<(/?)([a-z][a-z0-9]*)([^>]*)>");
  static const std::vector<std::string> kVoid{"meta", "link", "br", "img", "input"};
  std::vector<std::string> open, wrong;
  std::string text;
  for (std::size_t at = 0; at < page.size();) {  // std::regex runs out of stack on long scripts
    const std::size_t tag = std::min(page.find("<script", at), page.find("<style", at));
    text += page.substr(at, tag - at);
    if (tag == page.npos) break;
    at = page.find('>', page.find("</", tag)) + 1;
  }
  for (std::sregex_iterator it(text.begin(), text.end(), kTag), end; it != end; ++it) {
    const std::string name = (*it)[2];
    if (std::find(kVoid.begin(), kVoid.end(), name) != kVoid.end()) continue;
    if ((*it)[1].length() == 0)
      open.push_back(name);
    else if (!open.empty() && open.back() == name)
      open.pop_back();
    else
      wrong.push_back(name);
  }
  wrong.insert(wrong.end(), open.begin(), open.end());
  return wrong;
}

/// A picture that no encoder makes small.
Image noise(int width, int height) {
  Image image{width, height, {}};
  std::uint32_t state = 1;
  for (int i = 0; i < 3 * width * height; ++i)
    image.rgb.push_back(static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24));
  return image;
}

Scene scene_of(std::vector<Building> buildings) {
  Scene scene;
  scene.buildings = std::move(buildings);
  return scene;
}

}  // namespace

TEST_CASE("names and messages of any kind stay text") {
  const std::string evil = "</script><script>alert(1)</script><!--<b>&\"x'\\\xFF";
  Building b = house(evil);
  b.warnings = {evil, "<img src=x onerror=alert(1)>"};
  Scene scene = scene_of({b});
  scene.failures.push_back({evil, evil});
  const std::string plain = page_of(scene_of({house("a")})), page = page_of(scene);
  for (const char* mark : {"<script", "</script>", "<!--", "<b>", "<img"})
    CHECK(count_of(page, mark) == count_of(plain, mark));
  const Json report = block(page, "report");
  const std::string name = report["buildings"][0]["name"];
  CHECK(name.substr(0, evil.size() - 1) == evil.substr(0, evil.size() - 1));
  CHECK(report["buildings"][0]["warnings"][1] == "<img src=x onerror=alert(1)>");
  CHECK(report["failures"][0]["source"] == name);
}

TEST_CASE("failures stand in the page with their reason") {
  Building lost = house("lost"), half = house("half");
  lost.failure = "lost: has no planes";
  lost.layers.clear();
  half.layers[1].mesh = {};
  half.layers[1].failure = "half: no plane has an outline";
  Scene scene = scene_of({house("good"), lost, half});
  scene.failures.push_back({"bad.obj", "face names a vertex that is not there"});
  const Json report = block(page_of(scene), "report");
  CHECK(report["buildings"][1]["failure"] == "lost: has no planes");
  CHECK(report["buildings"][1]["layers"].empty());
  CHECK(report["buildings"][2]["layers"][1]["failure"] == "half: no plane has an outline");
  CHECK(report["failures"][0]["message"] == "face names a vertex that is not there");
}

TEST_CASE("the page is well-formed and points nowhere outside") {
  const std::string page = page_of(scene_of({house("a"), house("b")}), {{"png", "", "png"}, {}});
  CHECK(page.starts_with("<!doctype html>"));
  CHECK(unbalanced(page).empty());
  CHECK(count_of(page, "http") - count_of(page, "http-equiv") ==
        count_of(page, "http://www.w3.org/2000/svg"));
  for (const char* word : {"@import", "url(", "src=\"", "fetch(", "XMLHttpRequest", "innerHTML"})
    CHECK(count_of(page, word) == 0);
  CHECK(count_of(page, "default-src 'none'") == 1);
  CHECK(unbalanced(page_of({})).empty());
}

TEST_CASE("pictures of 500 buildings stay under 7 MB, and of any number") {
  for (const std::size_t n : {1, 15, 500, 3000, 100000}) {
    const PictureOptions o = picture_options(n, 3);
    const std::string worst = encode_small_png(noise(o.width, o.height), o.most_bytes);
    CHECK(worst.size() <= o.most_bytes);
    CHECK(n / o.every * 4 * worst.size() * 4 / 3 <= 7'200'000);
    CHECK(o.width >= 48);
  }
  CHECK(picture_options(15, 3).width > 2 * picture_options(500, 3).width);
}

TEST_CASE("500 buildings with pictures and warnings make a page under 10 MB") {
  const PictureOptions o = picture_options(500, 2);
  const std::string picture(o.most_bytes, 'x');
  std::vector<Building> buildings(500, house("a building with a long name"));
  for (Building& b : buildings) b.warnings.assign(30, std::string(150, 'w'));
  for (Layer& layer : buildings[0].layers) layer.mesh = {};
  const std::string page = page_of(scene_of(std::move(buildings)),
                                   std::vector<std::vector<std::string>>(500, {3, picture}));
  CHECK(page.size() < 10'000'000);
  CHECK(block(page, "report")["buildings"][499]["warnings"].size() == 21);
  CHECK(block(page, "pictures").size() == 500);
}

TEST_CASE("a building is drawn with its source and its layers, as far as they are there") {
  const PictureOptions o = picture_options(1, 2);
  Building b = house("a");
  const std::vector<std::string> all = draw_building(b, o);
  REQUIRE(all.size() == 3);
  for (const std::string& png : all) CHECK(png.starts_with("\x89PNG"));
  CHECK(all[1] != all[2]);
  b.layers[0].mesh = {};
  b.layers[0].failure = "why";
  CHECK(draw_building(b, o)[1].empty());
  CHECK(draw_building(b, o)[2] == all[2]);  // the same camera
  b.source.mesh = {};
  CHECK(draw_building(b, o)[0].empty());
  CHECK(draw_building(Building{}, o).empty());
}

TEST_CASE("turning a building turns no picture") {
  const PictureOptions o = picture_options(1, 2);
  Building b = house("a");
  const std::vector<std::string> reference = draw_building(b, o);
  b.frame.yaw = 1.5;
  const Frame turn{Vec3::Zero(), b.frame.yaw};
  for (Layer& layer : b.layers)
    for (Vec3& v : layer.mesh.vertices) v = turn.to_world(v);
  CHECK(draw_building(b, o)[0] == reference[0]);
  CHECK(draw_building(b, o)[2].size() == Approx(reference[2].size()).epsilon(0.05));
}

TEST_CASE("1 and 2 threads make the same page") {
  std::string pages[2];
  for (const int threads : {1, 2}) {
    limit_threads(threads);
    Scene scene = scene_of({house("a"), house("b", 2), house("c", 0.5)});
    Gallery gallery(3, 2);
    parallel_for(3, [&](std::size_t i) { gallery.draw(scene.buildings[i]); });
    for (Building& b : scene.buildings) b.timings = {};
    pages[threads - 1] = page_of(scene, gallery.take(scene));
  }
  limit_threads(0);
  CHECK(pages[0] == pages[1]);
  CHECK(block(pages[0], "pictures")[2].size() == 3);
}

TEST_CASE("parts: clusters, members and similarities are those of the segments") {
  Building failed;
  failed.source.name = "failed";
  const Scene scene = scene_of({house("a", 2), failed, house("b", 1)});
  const Json parts = Json::parse(parts_json(scene, two_layers()));
  CHECK(parts["clusters"][1]["segments"] == 2);
  CHECK(parts["clusters"][1]["buildings"] == 2);
  CHECK(parts["clusters"][0]["area"] == Approx(80));
  CHECK(parts["members"] == Json::parse("[[1,1],[0,0],[1,1]]"));
  CHECK(parts["similarity"]["layer"] == Json::parse("[0,0,1,1]"));
  CHECK(parts["similarity"]["building"] == Json::parse("[0,2,0,2]"));
  CHECK(parts["between"][0][0] == Approx(1));  // both large segments are the same
  const double s = segment_similarity(scene.buildings[0].descriptors[1],
                                      scene.buildings[2].descriptors[1], two_layers().eta);
  CHECK(parts["between"][1][1] == Approx(s));
  std::string values(10, '\xFF');  // rows from the diagonal on: the last is alike itself
  CHECK(parts["similarity"]["values"].get<std::string>().size() == base64(values).size());
}

TEST_CASE("many segments are thinned out, layers keep their shares") {
  std::vector<Building> buildings;
  for (int i = 0; i < 600; ++i) buildings.push_back(house("h" + std::to_string(i), 1 + i % 7));
  const Json parts = Json::parse(parts_json(scene_of(std::move(buildings)), two_layers()));
  const std::vector<int> layer = parts["similarity"]["layer"];
  CHECK(layer.size() == 320);
  CHECK(std::count(layer.begin(), layer.end(), 0) == 160);
  CHECK(std::is_sorted(layer.begin(), layer.end()));
}

TEST_CASE("layers that the options have not are no crash") {
  Building b = house("a");
  b.layer_of_segment = {5, -1};
  const Json parts = Json::parse(parts_json(scene_of({b}), two_layers()));
  CHECK(!parts.contains("similarity"));
}

TEST_CASE("base64 is RFC 4648's") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64("\xFF\xFE") == "//4=");
}
