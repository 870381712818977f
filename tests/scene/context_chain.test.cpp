// Coarser tiles of what is no building: fewer faces, the same joints, what it looks like from
// above.
#include "scene/context_chain.h"

#include <catch2/catch.hpp>
#include <set>

#include "core/error.h"
#include "core/meshopt.h"
#include "image/cache.h"
#include "image/image.h"
#include "meshes.h"

using namespace colod;

namespace {

constexpr int kCells = 24;  // along a tile's side

double height(double x, double y) { return 2 * std::sin(x / 9) + std::cos(y / 7); }

/// A square of a hilly place, with one colour left and another one right of x = 30 m.
Source hills(int column, int row) {
  Source s;
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i) {
      const double x = column * kCells + i, y = row * kCells + j;
      s.mesh.vertices.emplace_back(x, y, height(x, y));
    }
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i) {
      const int a = j * (kCells + 1) + i, b = a + 1, d = a + kCells + 1, c = d + 1;
      s.mesh.faces.push_back({a, b, c}), s.mesh.faces.push_back({a, c, d});
      const bool is_left = column * kCells + i < 30;
      const Rgb rgb = is_left ? Rgb{200, 40, 40} : Rgb{40, 40, 200};
      for (int k = 0; k < 2; ++k) s.look.colors.push_back({rgb, rgb, rgb});
    }
  return s;
}

std::vector<ChainLeaf> tiles(int side) {
  std::vector<ChainLeaf> leaves;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      leaves.push_back({bounding_box(hills(column, row).mesh.vertices), [column, row] {
                          ChainPart part{hills(column, row), {}, {}};
                          part.is_joint = on_border(part.source.mesh);
                          return part;
                        }});
  return leaves;
}

using Places = std::set<std::array<double, 3>>;

Places places(const Mesh& mesh) {
  Places out;
  for (const Vec3& p : mesh.vertices) out.insert({p.x(), p.y(), p.z()});
  return out;
}

}  // namespace

TEST_CASE("a chain holds each leaf once, and coarser tiles have fewer faces over the same place") {
  const int side = GENERATE(1, 2, 3, 5);
  const std::vector<ChainLeaf> leaves = tiles(side);
  const ContextChain chain(leaves, 16 << 20);
  const std::vector<ChainNode>& nodes = chain.nodes();
  std::set<int> seen;
  std::vector<std::size_t> below(nodes.size(), 0);  // faces
  for (std::size_t i = nodes.size(); i-- > 0;) {
    INFO("node " << i << " of " << nodes.size());
    CHECK(nodes[i].parent < static_cast<int>(i));
    std::size_t faces = 2 * kCells * kCells;
    if (nodes[i].leaf >= 0) {
      CHECK(seen.insert(nodes[i].leaf).second);
    } else {
      const Source s = chain.read(i);
      faces = s.mesh.faces.size();
      CHECK(faces > 0);
      CHECK(faces < below[i]);
      CHECK(nodes[i].texel > 0);
      CHECK(nodes[i].deviation < 4 * nodes[i].texel);
      REQUIRE(s.look.images.size() == 1);
      CHECK(s.look.uvs.size() == faces);
    }
    if (nodes[i].parent >= 0) below[static_cast<std::size_t>(nodes[i].parent)] += faces;
  }
  CHECK(seen.size() == leaves.size());
  const Box all = bounding_box(chain.read(0).mesh.vertices);
  CHECK(all.size().x() == Approx(side * kCells));
  CHECK(all.size().y() == Approx(side * kCells));
}

TEST_CASE("where tiles meet, all levels have the same vertices") {
  const ContextChain chain(tiles(4), 16 << 20);
  const std::vector<ChainNode>& nodes = chain.nodes();
  std::size_t compared = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    if (nodes[i].leaf >= 0 || nodes[i].parent != 0) continue;
    for (const auto& [x, y, z] : places(chain.read(i).mesh)) {
      if (x != 2 * kCells) continue;
      CHECK(z == height(x, y));
      ++compared;
    }
  }
  CHECK(compared >= 2 * (4 * kCells + 1));  // from either side, none left out
}

TEST_CASE("a coarser tile looks as the finer ones do from above") {
  const ContextChain chain(tiles(3), 16 << 20);
  const Source s = chain.read(0);
  const ImageCache images(16 << 20);
  const ImageCache::Entry entry = images.get(s.look.images[0]);
  REQUIRE(entry.pyramid);
  const Raster& raster = entry.pyramid->levels[0];
  for (const double x : {10.0, 60.0}) {
    const double u = (x + chain.nodes()[0].texel) / (chain.nodes()[0].texel * raster.width);
    const std::uint8_t* rgb = raster.at(static_cast<int>(u * raster.width), raster.height / 2);
    CHECK(rgb[x < 30 ? 0 : 2] == Approx(200).margin(12));
    CHECK(rgb[x < 30 ? 2 : 0] == Approx(40).margin(12));
  }
}

TEST_CASE("a tile that cannot be read is left out of what is above it") {
  std::vector<ChainLeaf> leaves = tiles(2);
  leaves[3].read = []() -> ChainPart { throw Error(Stage::kInput, "tile", "is gone"); };
  const ContextChain chain(leaves, 16 << 20);
  const Box box = bounding_box(chain.read(0).mesh.vertices);
  CHECK(box.size().x() == Approx(2 * kCells));
  for (const Vec3& p : chain.read(0).mesh.vertices) CHECK_FALSE((p.x() > kCells && p.y() > kCells));
}

TEST_CASE("locked vertices stay, all others of a plane go") {
  const int cells = GENERATE(4, 17, 40);
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;
  std::vector<char> is_locked;
  const auto n = static_cast<std::uint32_t>(cells + 1);
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      positions.insert(positions.end(), {static_cast<float>(i), static_cast<float>(j), 0.0f});
      is_locked.push_back(i == 0);  // one side only
    }
  for (std::uint32_t j = 0; j + 1 < n; ++j)
    for (std::uint32_t i = 0; i + 1 < n; ++i)
      for (const std::uint32_t v : {j * n + i, j * n + i + 1, (j + 1) * n + i + 1, j * n + i,
                                    (j + 1) * n + i + 1, (j + 1) * n + i})
        indices.push_back(v);
  const std::vector<std::uint32_t> kept = simplify_within(positions, indices, is_locked, 0.05f);
  const std::set<std::uint32_t> used(kept.begin(), kept.end());
  for (std::uint32_t j = 0; j < n; ++j) CHECK(used.contains(j * n));
  CHECK(used.size() < n + n);
  double area = 0;
  for (std::size_t i = 0; i < kept.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return Vec3(positions[3 * kept[i + k]], positions[3 * kept[i + k] + 1], 0);
    };
    area += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).z();
  }
  CHECK(area == Approx(cells * cells));
}

TEST_CASE("small pieces high above the ground are no deviation, tall tips stay") {
  const double size = GENERATE(1.0, 10.0);  // all of the place is so many times as large
  const double texel = size * kCells / 2048;
  Source whole = hills(0, 0);
  for (Vec3& p : whole.mesh.vertices) p *= size;
  const auto triangle = [&](const Vec3& at, const Vec3& side, const Vec3& up) {
    const int n = static_cast<int>(whole.mesh.vertices.size());
    for (const Vec3& p : {at, Vec3(at + side), Vec3(at + up)}) whole.mesh.vertices.push_back(p);
    whole.mesh.faces.push_back({n, n + 1, n + 2});
    whole.look.colors.push_back(whole.look.colors.back());
  };
  const Vec3 stray = size * Vec3(5, 5, 50), foot = size * Vec3(12, 12, 0);
  triangle(stray, texel * Vec3(0.5, 0, 0), texel * Vec3(0, 0.5, 0));
  triangle(foot, texel * Vec3(0.2, 0, 0), size * Vec3(0, 0, 9));
  const auto read = [&] { return ChainPart{whole, {}, {}}; };
  const ContextChain chain({{bounding_box(whole.mesh.vertices), read, texel}}, 16 << 20);
  bool is_lower = false;
  for (std::size_t i = 0; i < chain.nodes().size(); ++i) {
    const ChainNode& node = chain.nodes()[i];
    if (node.leaf >= 0) continue;
    INFO("node " << i << ", texel " << node.texel);
    const Box box = bounding_box(chain.read(i).mesh.vertices);
    CHECK(box.max.z() == Approx(9 * size).margin(2 * node.deviation));
    is_lower = is_lower || box.max.z() < 49 * size;
    CHECK(node.deviation < 8 * node.texel);
  }
  CHECK(is_lower);
}
