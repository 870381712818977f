// Scenes of tiles: what 3D Tiles say, which tiles are taken, and what is not allowed to be read.
#include "read/tileset.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "scenes.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;

namespace {

const Mesh kBox = box_mesh({0, 0, 0}, {4, 2, 3});

/// Everything that the finest tiles show, in the root's frame.
Mesh whole(const TileTree& tree, int coarser = 0) {
  Mesh all;
  for (const int n : finest_nodes(tree, coarser))
    for (const std::string& content : tree.nodes[static_cast<std::size_t>(n)].contents) {
      const Source s =
          read_tile(tree.nodes[static_cast<std::size_t>(n)], content, Eigen::Matrix4d::Identity());
      const int base = static_cast<int>(all.vertices.size());
      for (const Vec3& p : s.mesh.vertices) all.vertices.push_back(p);
      for (Face f : s.mesh.faces) {
        for (int& v : f) v += base;
        all.faces.push_back(f);
      }
    }
  return all;
}

void check_box(const Mesh& m, const Vec3& min, const Vec3& max) {
  const Box b = bounding_box(m.vertices);
  CHECK((b.min - min).norm() < 1e-5);
  CHECK((b.max - max).norm() < 1e-5);
}

std::string moved_by(const Vec3& t) {
  return R"(,"transform":[1,0,0,0,0,1,0,0,0,0,1,0,)" + std::to_string(t.x()) + "," +
         std::to_string(t.y()) + "," + std::to_string(t.z()) + ",1]";
}

}  // namespace

TEST_CASE("a b3dm tile is read y up and moved by all transforms above it") {
  const TempFolder folder;
  folder.write("a.b3dm", b3dm_of(glb_of(y_up(kBox)), R"({"BATCH_LENGTH":0,"RTC_CENTER":[0,0,5]})"));
  const std::string path = folder.write(
      "tileset.json", tileset_of(tile_of("", moved_by({10, 0, 0}) + R"(,"children":[)" +
                                                 tile_of("a.b3dm", moved_by({0, 20, 0})) + "]")));
  const TileTree tree = list_tiles(path);
  CHECK(tree.failures.empty());
  check_box(whole(tree), {10, 20, 5}, {14, 22, 8});
}

TEST_CASE("gltfUpAxis says which way a tile's content stands") {
  const TempFolder folder;
  folder.write("z.glb", glb_of(kBox));
  Mesh x_up = kBox;  // gltf x = up, y = y, z = −x of what is meant
  for (Vec3& p : x_up.vertices) p = Vec3(p.z(), p.y(), -p.x());
  folder.write("x.glb", glb_of(x_up));
  for (const auto& [axis, file] : {std::pair{"Z", "z.glb"}, std::pair{"X", "x.glb"}}) {
    const std::string path = folder.write(
        "tileset.json", tileset_of(tile_of(file), R"(,"gltfUpAxis":")" + std::string(axis) + "\""));
    INFO(axis);
    check_box(whole(list_tiles(path)), {0, 0, 0}, {4, 2, 3});
  }
}

TEST_CASE("the finest tiles are those without children, and those that children add to") {
  const TempFolder folder;
  for (int i = 0; i < 4; ++i)
    folder.write(std::to_string(i) + ".glb", glb_of(y_up(moved(kBox, Vec3(100.0 * i, 0, 0)))));
  const std::string children = R"(,"children":[)" + tile_of("1.glb") + "," + tile_of("2.glb") + "]";
  const auto boxes = [&](const std::string& root, int coarser) {
    const TileTree tree = list_tiles(folder.write("tileset.json", tileset_of(root)));
    return surface_area(whole(tree, coarser)) / surface_area(kBox);
  };
  CHECK(boxes(tile_of("0.glb", children), 0) == Approx(2));
  CHECK(boxes(tile_of("0.glb", R"(,"refine":"ADD")" + children), 0) == Approx(3));
  CHECK(boxes(tile_of("0.glb", children), 1) == Approx(1));
  CHECK(boxes(tile_of("", R"(,"content":null)" + children), 1) == Approx(2));
}

TEST_CASE("external tilesets, content.url and contents are followed") {
  const TempFolder folder;
  std::filesystem::create_directories(folder.path / "Data" / "Tile 1");
  folder.write("Data/Tile 1/a.glb", glb_of(y_up(kBox)));
  folder.write("b.glb", glb_of(y_up(moved(kBox, {10, 0, 0}))));
  folder.write("Data/Tile 1/tile.json",
               tileset_of(tile_of("", R"(,"contents":[{"uri":"a.glb"},{"uri":"..\/..\/b.glb"}])")));
  const std::string path =
      folder.write("tileset.json",
                   tileset_of(tile_of("", moved_by({1, 0, 0}) +
                                              R"(,"content":{"url":"Data\/Tile%201/tile.json"})")));
  const TileTree tree = list_tiles(path);
  CHECK(tree.failures.empty());
  check_box(whole(tree), {1, 0, 0}, {15, 2, 3});
}

TEST_CASE("what leaves the scene's folder, leads back or is missing costs itself only") {
  const TempFolder folder;
  std::filesystem::create_directories(folder.path / "scene");
  folder.write("secret.glb", glb_of(kBox));
  folder.write("scene/good.glb", glb_of(y_up(kBox)));
  std::filesystem::create_symlink(folder.path / "secret.glb", folder.path / "scene" / "link.glb");
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"../secret.glb", "outside of the scene's folder"},
      {"%2e%2e/secret.glb", "outside of the scene's folder"},
      {(folder.path / "secret.glb").string(), "not a file of the scene"},
      {"https://example.org/a.glb", "not a file of the scene"},
      {"file:///etc/passwd", "not a file of the scene"},
      {"link.glb", "outside of the scene's folder"},
      {"gone.b3dm", "is missing"},
      {"tileset.json", "leads back"}};
  for (const auto& [uri, message] : faults) {
    INFO(uri);
    const std::string path = folder.write(
        "scene/tileset.json", tileset_of(tile_of("", R"(,"children":[)" + tile_of(uri) + "," +
                                                         tile_of("good.glb") + "]")));
    const TileTree tree = list_tiles(path);
    REQUIRE(tree.failures.size() == 1);
    CHECK_THAT(tree.failures[0].message, Contains(message));
    check_box(whole(tree), {0, 0, 0}, {4, 2, 3});
  }
}

TEST_CASE("broken and foreign tiles say what they are") {
  const TempFolder folder;
  const auto message = [&](const std::string& bytes) {
    TileNode node;
    try {
      read_tile(node, folder.write("t.b3dm", bytes), Eigen::Matrix4d::Identity());
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const std::string good = b3dm_of(glb_of(kBox));
  CHECK(message(good).empty());
  CHECK_THAT(message(good.substr(0, 20)), Contains("truncated"));
  CHECK_THAT(message(good.substr(0, good.size() / 2)), Contains("truncated"));
  CHECK_THAT(message("i3dm" + good.substr(4)), Contains("i3dm"));
  CHECK_THAT(message("pnts" + good.substr(4)), Contains("pnts"));
  CHECK_THAT(message(b3dm_of(glb_of(kBox), R"({"RTC_CENTER":[1,"x",2]})")), Contains("RTC_CENTER"));
}

TEST_CASE("a tileset that is none, or deep beyond measure, is refused") {
  const TempFolder folder;
  CHECK_THROWS_WITH(list_tiles(folder.write("a.json", "[1]")), Contains("no tileset"));
  CHECK_THROWS_WITH(list_tiles(folder.write("a.json", tileset_of(tile_of("")))),
                    Contains("names no tile"));
  CHECK_THROWS_WITH(
      list_tiles(folder.write("a.json", tileset_of(tile_of("a.glb", R"(,"transform":[1,2])")))),
      Contains("16 numbers"));
  const std::string deep = std::string(5000, '[') + std::string(5000, ']');
  CHECK_THROWS_WITH(list_tiles(folder.write("a.json", R"({"root":{"x":)" + deep + "}}")),
                    Contains("deeply"));
}

TEST_CASE("glTF 1.0 in a binary container is read with its texture") {
  const TempFolder folder;
  std::string bin;
  for (const Vec3& p : y_up(kBox).vertices)
    for (int k = 0; k < 3; ++k) put(bin, static_cast<float>(p[k]), false);
  const std::size_t uvs = bin.size();
  for (std::size_t i = 0; i < kBox.vertices.size(); ++i)
    put(bin, 0.25f, false), put(bin, static_cast<float>(i), false);
  const std::size_t indices = bin.size();
  for (const Face& f : kBox.faces)
    for (const int v : f) put(bin, static_cast<std::uint16_t>(v), false);
  const std::size_t image = bin.size();
  bin += "picture!";
  nlohmann::json j;
  const auto view = [&](const char* name, std::size_t at, std::size_t length) {
    j["bufferViews"][name] = {
        {"buffer", "binary_glTF"}, {"byteOffset", at}, {"byteLength", length}};
  };
  const auto accessor = [&](const char* name, const char* of, int type, std::size_t count,
                            const char* shape) {
    j["accessors"][name] = {{"bufferView", of},
                            {"byteOffset", 0},
                            {"componentType", type},
                            {"count", count},
                            {"type", shape}};
  };
  view("p", 0, uvs), view("t", uvs, indices - uvs), view("i", indices, image - indices);
  view("img", image, 8);
  accessor("pos", "p", 5126, kBox.vertices.size(), "VEC3");
  accessor("tex", "t", 5126, kBox.vertices.size(), "VEC2");
  accessor("ind", "i", 5123, 3 * kBox.faces.size(), "SCALAR");
  j["extensionsUsed"] = {"KHR_binary_glTF", "CESIUM_RTC"};
  j["extensions"]["CESIUM_RTC"]["center"] = {100.0, 200.0, 300.0};
  j["buffers"]["binary_glTF"] = {{"byteLength", bin.size()}};
  j["images"]["im"]["extensions"]["KHR_binary_glTF"] = {{"bufferView", "img"},
                                                        {"mimeType", "image/jpeg"}};
  j["textures"]["tx"] = {{"source", "im"}};
  j["materials"]["m"] = {{"technique", "q"}, {"values", {{"u_tex", "tx"}}}};
  j["meshes"]["mesh"]["primitives"] = {
      {{"attributes", {{"POSITION", "pos"}, {"TEXCOORD_0", "tex"}}},
       {"indices", "ind"},
       {"material", "m"},
       {"mode", 4}}};
  j["nodes"]["n"]["meshes"] = {"mesh"};
  j["scenes"]["s"]["nodes"] = {"n"};
  j["scene"] = "s";
  const std::string text = j.dump();
  std::string glb = "glTF";
  put(glb, std::uint32_t{1}, false);
  put(glb, static_cast<std::uint32_t>(20 + text.size() + bin.size()), false);
  put(glb, static_cast<std::uint32_t>(text.size()), false);
  put(glb, std::uint32_t{0}, false);
  const std::string bytes = b3dm_of(glb + text + bin);
  const Source s = read_tile({}, folder.write("t.b3dm", bytes), Eigen::Matrix4d::Identity());
  check_box(s.mesh, {100, 200, 300}, {104, 202, 303});
  REQUIRE(s.look.images.size() == 1);
  CHECK(bytes.substr(s.look.images[0].offset, s.look.images[0].length) == "picture!");
  CHECK(s.look.uvs.at(0)[0].x() == 0.25f);
}

TEST_CASE("a scene is told by its tileset or by its folders, and colod's own result is none") {
  const TempFolder folder;
  std::string why;
  CHECK_FALSE(is_tiled_scene(folder.path.string(), why));
  std::filesystem::create_directories(folder.path / "Data" / "Tile_1");
  CHECK(is_tiled_scene(folder.path.string(), why));
  folder.write("tileset.json", tileset_of(tile_of("a.glb"), R"(,"generator": "colod")"));
  CHECK_FALSE(is_tiled_scene(folder.path.string(), why));
  folder.write("tileset.json", tileset_of(tile_of("a.glb")));
  CHECK(is_tiled_scene((folder.path / "tileset.json").string(), why));
}

TEST_CASE("a folder of OBJ tiles is a tree of them") {
  const TempFolder folder;
  std::filesystem::create_directories(folder.path / "Data" / "Tile_1");
  std::filesystem::create_directories(folder.path / "Data" / "Tile_2");
  folder.write("Data/Tile_1/Tile_1.obj", obj_text(kBox));
  folder.write("Data/Tile_2/Tile_2.obj", obj_text(moved(kBox, {4, 0, 0})));
  const TileTree tree = list_tiles(folder.path.string());
  CHECK(finest_nodes(tree).size() == 2);
  check_box(whole(tree), {0, 0, 0}, {8, 2, 3});
}

namespace {

std::string binary_subtree(std::string json, std::string bits) {
  while (json.size() % 8 != 0) json += ' ';
  while (bits.size() % 8 != 0) bits += '\0';
  std::string out = "subt";
  put(out, std::uint32_t{1}, false);
  put(out, std::uint64_t{json.size()}, false);
  put(out, std::uint64_t{bits.size()}, false);
  return out + json + bits;
}

/// A tree of `levels` over one place where all tiles have contents but those at the upper right,
/// with subtrees of `subtree_levels`; tile x, y of a level is a box moved by 10 x, 10 y.
std::string write_implicit(const TempFolder& folder, int branches, int subtree_levels, int levels,
                           bool is_binary) {
  std::filesystem::create_directories(folder.path / "s");
  std::filesystem::create_directories(folder.path / "c");
  const bool is_octree = branches == 8;
  for (int level = 0; level < levels; ++level)
    for (int x = 0; x < 1 << level; ++x)
      for (int y = 0; y < 1 << level; ++y)
        for (int z = 0; z < (is_octree ? 1 << level : 1); ++z) {
          const std::string name = std::to_string(level) + "_" + std::to_string(x) + "_" +
                                   std::to_string(y) + "_" + std::to_string(z);
          folder.write("c/" + name + ".b3dm",
                       b3dm_of(glb_of(y_up(moved(kBox, Vec3(10 * x, 10 * y, 10 * z))))));
          if (level % subtree_levels != 0) continue;
          const bool has_more = level + subtree_levels < levels;
          const std::string more = has_more ? "1" : "0";
          // 64 bytes of ones are more than the tiles of any subtree here.
          const std::string json =
              is_binary
                  ? R"({"buffers":[{"byteLength":64}],"bufferViews":[{"buffer":0,"byteLength":64}],)"
                    R"("tileAvailability":{"bitstream":0},"contentAvailability":[{"bitstream":0}],)"
                    R"("childSubtreeAvailability":{"constant":)" +
                        more + "}}"
                  : R"({"tileAvailability":{"constant":1},"contentAvailability":[{"constant":1}],)"
                    R"("childSubtreeAvailability":{"constant":)" +
                        more + "}}";
          folder.write("s/" + name + ".subtree",
                       is_binary ? binary_subtree(json, std::string(64, '\xFF')) : json);
        }
  const std::string z = is_octree ? "{z}" : "0";
  return folder.write(
      "tileset.json",
      tileset_of(tile_of("c/{level}_{x}_{y}_" + z + ".b3dm",
                         R"(,"refine":"REPLACE","implicitTiling":{"subdivisionScheme":")" +
                             std::string(is_octree ? "OCTREE" : "QUADTREE") +
                             R"(","subtreeLevels":)" + std::to_string(subtree_levels) +
                             R"(,"availableLevels":)" + std::to_string(levels) +
                             R"(,"subtrees":{"uri":"s/{level}_{x}_{y}_)" + z + R"(.subtree"}})",
                         16)));
}

}  // namespace

TEST_CASE("implicit tiles are those of their subtrees, JSON or binary") {
  const int branches = GENERATE(4, 8);
  const int subtree_levels = GENERATE(1, 2), levels = GENERATE(1, 2, 3);
  const bool is_binary = GENERATE(true, false);
  const TempFolder folder;
  const TileTree tree =
      list_tiles(write_implicit(folder, branches, subtree_levels, levels, is_binary));
  CHECK(tree.failures.empty());
  std::size_t expected = 0, finest = 1;
  for (int l = 0; l < levels; ++l) expected += finest, finest *= static_cast<std::size_t>(branches);
  CHECK(tree.nodes.size() == expected);
  CHECK(finest_nodes(tree).size() == finest / static_cast<std::size_t>(branches));
  CHECK(tree.nodes.back().geometric_error == Approx(16.0 / (1 << (levels - 1))));
  const double far = 10.0 * ((1 << (levels - 1)) - 1);
  check_box(whole(tree), {0, 0, 0}, {far + 4, far + 2, (branches == 8 ? far : 0) + 3});
}

TEST_CASE("a subtree that is missing, cut off or out of the folder costs itself only") {
  const TempFolder folder;
  const std::string path = write_implicit(folder, 4, 1, 2, true);
  const std::string fault = GENERATE("missing", "cut", "short", "no JSON");
  const std::string name = "s/1_1_0_0.subtree";
  std::filesystem::remove(folder.path / name);
  if (fault == "cut") folder.write(name, "subt\1\0\0\0");
  if (fault == "no JSON") folder.write(name, "nothing");
  if (fault == "short")
    folder.write(name, binary_subtree(R"({"buffers":[{"byteLength":8}],"bufferViews":[{"buffer":0,)"
                                      R"("byteLength":99}],"tileAvailability":{"bitstream":0}})",
                                      "12345678"));
  const TileTree tree = list_tiles(path);
  INFO(fault);
  CHECK(tree.failures.size() == 1);
  CHECK(finest_nodes(tree).size() == 3);
}

TEST_CASE("implicit tiling without sense is said") {
  const TempFolder folder;
  const std::string levels = GENERATE("0", "-1", "40", "\"a\"", "20");
  folder.write("a.b3dm", b3dm_of(glb_of(y_up(kBox))));
  const TileTree tree = list_tiles(folder.write(
      "tileset.json",
      tileset_of(tile_of(
          "", R"(,"refine":"ADD","children":[)" + tile_of("a.b3dm") + "," +
                  tile_of("x", R"(,"implicitTiling":{"subdivisionScheme":"QUADTREE",)"
                               R"("subtreeLevels":)" +
                                   levels + R"(,"availableLevels":30,"subtrees":{"uri":"s"}})") +
                  "]"))));
  REQUIRE(tree.failures.size() == 1);
  CHECK_THAT(tree.failures[0].message, Contains("implicit tiling"));
}
