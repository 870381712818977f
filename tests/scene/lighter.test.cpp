// Textured meshes with fewer faces: where they lie, what they wear, and what stays.
#include "scene/lighter.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "core/rays.h"
#include "scene/context_chain.h"

using namespace colod;

namespace {

/// A hilly square of so many metres, a vertex a metre; its halves wear charts of two images that
/// meet on a seam. Where a face lies tells what it wears.
struct Hills {
  double side;

  static double height(double x, double y) { return 1.5 * std::sin(x / 8) + std::cos(y / 6); }
  Vec2f uv(const Vec3& p, int material) const {
    const double x = p.x() / side, y = p.y() / side;
    return material == 0 ? Vec2f(static_cast<float>(x), static_cast<float>(y))
                         : Vec2f(static_cast<float>(1 - y), static_cast<float>(x - 0.5));
  }

  Source source() const {
    Source s;
    const int n = static_cast<int>(side);
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) s.mesh.vertices.emplace_back(i, j, height(i, j));
    s.look.images.resize(2);
    s.look.materials.resize(2);
    for (int m = 0; m < 2; ++m) s.look.materials[static_cast<std::size_t>(m)].image = m;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int a = j * (n + 1) + i, b = a + 1, d = a + n + 1, c = d + 1;
        add({a, b, c}, i < n / 2 ? 0 : 1, s);
        add({a, c, d}, i < n / 2 ? 0 : 1, s);
      }
    return s;
  }

  void add(const Face& face, int material, Source& s) const {
    s.mesh.faces.push_back(face);
    s.look.face_material.push_back(material);
    std::array<Vec2f, 3> uvs;
    for (std::size_t k = 0; k < 3; ++k)
      uvs[k] = uv(s.mesh.vertices[static_cast<std::size_t>(face[k])], material);
    s.look.uvs.push_back(uvs);
  }
};

double farthest(const Mesh& from, const Mesh& to) {
  const RayScene scene(to);
  double most = 0;
  for (const Vec3& p : from.vertices) most = std::max(most, scene.nearest(p).distance);
  return most;
}

}  // namespace

TEST_CASE("a lighter mesh lies where it lay and wears what it wore") {
  const double side = GENERATE(24.0, 40.0, 96.0);
  const double error = GENERATE(0.05, 0.2, 0.6);
  const Hills hills{side};
  const Source whole = hills.source();
  const Source light = lighter(whole, on_border(whole.mesh), error);
  CAPTURE(side, error, whole.mesh.faces.size(), light.mesh.faces.size());
  CHECK(light.mesh.faces.size() < (error < 0.1 ? 0.7 : 0.35) * whole.mesh.faces.size());
  CHECK(farthest(whole.mesh, light.mesh) <= 2 * error);
  CHECK(farthest(light.mesh, whole.mesh) < 1e-6);  // vertices are the source's
  std::set<int> materials;
  for (std::size_t f = 0; f < light.mesh.faces.size(); ++f) {
    const int m = light.look.face_material[f];
    materials.insert(m);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = light.mesh.vertices[static_cast<std::size_t>(light.mesh.faces[f][k])];
      CHECK((light.look.uvs[f][k] - hills.uv(p, m)).norm() < 1e-6f);
      CHECK((m == 0 ? p.x() <= side / 2 : p.x() >= side / 2));
    }
  }
  CHECK(materials.size() == 2);
}

TEST_CASE("joints of a lighter mesh stay, and it has no crack where looks part") {
  const Source whole = Hills{40}.source();
  const std::vector<char> is_joint = on_border(whole.mesh);
  const Source light = lighter(whole, is_joint, 0.5);
  const std::vector<char> all(light.mesh.vertices.size(), 1);
  const std::vector<char> is_there = marked_as(whole.mesh, light.mesh, all);
  for (std::size_t v = 0; v < is_joint.size(); ++v) CHECK((!is_joint[v] || is_there[v]));
  const std::vector<char> is_open = on_border(light.mesh);
  for (std::size_t v = 0; v < is_open.size(); ++v) {
    const Vec3& p = light.mesh.vertices[v];
    const double rim = std::min({p.x(), p.y(), 40 - p.x(), 40 - p.y()});
    CHECK((!is_open[v] || rim == 0));
  }
}

TEST_CASE("pieces that nobody would see go, and those that are charted apart do not") {
  Source s = Hills{24}.source();
  const auto add_scrap = [&](double at, double size) {
    const int v = static_cast<int>(s.mesh.vertices.size());
    for (const Vec3& p : {Vec3(at, at, 9), Vec3(at + size, at, 9), Vec3(at, at + size, 9)})
      s.mesh.vertices.push_back(p);
    Hills{24}.add({v, v + 1, v + 2}, 0, s);
  };
  add_scrap(3, 0.2);
  add_scrap(15, 4);
  // Each face of a strip has an island of its own: they hang together all the same.
  for (std::size_t f = 0; f < 40; ++f)
    for (Vec2f& uv : s.look.uvs[f]) uv += Vec2f(static_cast<float>(f) * 2, 0);
  const Source light = lighter(s, std::vector<char>(s.mesh.vertices.size(), 0), 0.5);
  const auto has = [&](double z, double x) {
    return std::any_of(light.mesh.vertices.begin(), light.mesh.vertices.end(),
                       [&](const Vec3& p) { return p.z() == z && std::abs(p.x() - x) < 1; });
  };
  CHECK_FALSE(has(9, 3));
  CHECK(has(9, 15));
  CHECK(farthest(Hills{24}.source().mesh, light.mesh) < 1);
}

TEST_CASE("what has no place in an image keeps its colours when it becomes lighter") {
  Source s = Hills{24}.source();
  for (std::size_t f = 0; f < s.mesh.faces.size(); ++f) {
    s.look.colors.push_back({Rgb{9, 9, 9}, Rgb{9, 9, 9}, Rgb{9, 9, 9}});
    if (s.look.face_material[f] != 1) continue;
    s.look.face_material[f] = -1;
    s.look.uvs[f].fill(Vec2f(NAN, NAN));
    s.look.colors[f].fill(Rgb{200, 0, 0});
  }
  const Source light = lighter(s, on_border(s.mesh), 0.3);
  CHECK(light.mesh.faces.size() < s.mesh.faces.size() / 2);
  int colored = 0;
  for (std::size_t f = 0; f < light.mesh.faces.size(); ++f) {
    const bool is_textured = light.look.face_material[f] == 0;
    CHECK(light.look.colors[f][0] == (is_textured ? Rgb{9, 9, 9} : Rgb{200, 0, 0}));
    CHECK(std::isfinite(light.look.uvs[f][0].x()) == is_textured);
    colored += !is_textured;
  }
  CHECK(colored > 0);
  CHECK(lighter({}, {}, 1).mesh.faces.empty());
}
