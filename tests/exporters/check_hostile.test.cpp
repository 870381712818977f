// `info --check` on files that anybody may have made: it ends, and says what is wrong.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>

#include "check_helpers.h"
#include "core/error.h"
#include "exporters/check/check.h"
#include "exporters/check/files.h"
#include "exporters/gltf/glb.h"
#include "exporters_helpers.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

constexpr Compression kAll[] = {Compression::kNone, Compression::kDraco, Compression::kMeshopt};

Mesh turned(Mesh mesh, double yaw, double roll) {
  const Eigen::Matrix3d rotation =
      (Eigen::AngleAxisd(yaw, Vec3::UnitZ()) * Eigen::AngleAxisd(roll, Vec3(0.6, 0.8, 0)))
          .toRotationMatrix();
  for (Vec3& p : mesh.vertices) p = rotation * p;
  return mesh;
}

/// A house with plates beside it that are `thickness` thick and turned anyhow.
ExportBuilding with_plates(double thickness) {
  Mesh mesh = gable_house(12.3, 8.1, 5.7, 3.3);
  for (int i = 0; i < 30; ++i) {
    const Vec3 corner(20 + 3 * i, 0.37 * i, 0.21 * i);
    mesh =
        join(mesh, turned(box_mesh(corner, corner + Vec3(1.7, 0.9, thickness)), 0.1 * i, 0.07 * i));
  }
  return {"plates", "plates.obj", Vec3::Zero(), {{{0}, as_polygons(mesh), 0, 0}}, "plates"};
}

/// Faces whose corners, rounded as they are, tell another direction than the normals.
int turned_faces(const std::string& glb) {
  const Decoded decoded = decode_mesh(parse_glb(glb), 0);
  int found = 0;
  for (const Face& f : decoded.mesh.faces)
    found += face_cross(decoded.mesh, f).normalized().dot(decoded.normals[f[0]]) < 0.5;
  return found;
}

const std::string kBox = R"("boundingVolume":{"box":[0,0,0,10,0,0,0,10,0,0,0,10]})";

std::string tile(const std::string& more) {
  return "{" + kBox + R"(,"geometricError":1,"refine":"REPLACE")" + more + "}";
}

std::string tileset(const std::string& root) {
  return R"({"asset":{"version":"1.1"},"geometricError":100,"root":)" + root + "}";
}

std::string content(const std::string& uri) { return R"(,"content":{"uri":")" + uri + R"("})"; }

/// A folder with a tileset of one root tile.
class Hostile {
 public:
  explicit Hostile(const std::string& root) { write("out/tileset.json", tileset(root)); }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  fs::path operator/(const std::string& name) const { return folder_ / name; }
  Codes codes() const { return codes_of(check_output((folder_ / "out").string())); }

 private:
  TemporaryFolder folder_;
};

}  // namespace

TEST_CASE("what rounding turned is thinner than the grid and no fault; what is thicker is one") {
  int turned = 0;
  for (const double bound : {0.001, 0.01, 0.1})
    for (const double share : {0.1, 0.4, 1.0, 3.0}) {
      const std::string glb =
          encode_building_glb(with_plates(share * bound), {.quantization = bound}).bytes;
      INFO(bound << " " << share);
      CHECK(check(glb) == Codes{});
      turned += turned_faces(glb);
    }
  CHECK(turned > 0);  // else the test shows nothing
  ExportBuilding one_against = with_plates(0.3);
  std::swap(one_against.levels[0].mesh.triangles[7][0], one_against.levels[0].mesh.triangles[7][1]);
  for (const Compression c : kAll)
    CHECK(check(encode_building_glb(one_against, {.compression = c}).bytes) == Codes{"normals"});
}

TEST_CASE("any number of a GLB's JSON may be anything") {
  const std::vector<Json> values = {-1,
                                    0,
                                    1,
                                    3,
                                    1000,
                                    1e300,
                                    -0.5,
                                    4294967295u,
                                    1ull << 62,
                                    (1ull << 63) + 4,
                                    ~0ull,
                                    nullptr,
                                    "x",
                                    Json::array(),
                                    Json::object(),
                                    ~0ull - 3};
  for (const Compression c : kAll) {
    const Glb glb = parse_glb(encode_building_glb(street(1)[0], {.compression = c}).bytes);
    const Json flat = glb.json.flatten();
    int found = 0;
    for (const auto& [pointer, old] : flat.items())
      for (const Json& value : values) {
        Json json = glb.json;
        json[Json::json_pointer(pointer)] = value;
        found += !check(packed(json.dump(), glb.binary)).empty();
      }
    CHECK(found > 1000);
  }
}

TEST_CASE("any byte of a GLB may be anything") {
  std::mt19937 random(7);
  for (const Compression c : kAll) {
    const std::string good = encode_building_glb(street(1)[0], {.compression = c}).bytes;
    for (int i = 0; i < 1500; ++i) {
      std::string bytes = good;
      for (unsigned k = 0; k < 1 + random() % 4; ++k)
        bytes[random() % bytes.size()] = static_cast<char>(random());
      if (i % 9 == 0) bytes.resize(random() % bytes.size());
      check(bytes);
    }
  }
}

TEST_CASE("indices that are no indices, and streams that state what they cannot hold") {
  const auto plain = [](int type, double index) {
    std::string bytes(36, '\0');
    const auto value = static_cast<float>(index);
    for (int i = 0; i < 3; ++i) bytes.append(reinterpret_cast<const char*>(&value), 4);
    Json json = Json::parse(
        R"({"accessors":[{"bufferView":0,"componentType":5126,"count":3,"min":[0,0,0],"max":[0,0,0]},
            {"bufferView":1,"componentType":5126,"count":3}],"bufferViews":[{"byteLength":36},
            {"byteOffset":36,"byteLength":12}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,
            "NORMAL":0},"indices":1}]}]})");
    json["accessors"][1]["componentType"] = type;
    return check(packed(json.dump(), bytes));
  };
  for (const double index : {std::nan(""), -1.0, -HUGE_VAL, HUGE_VAL, 0.5, 3.0, 1e30})
    CHECK(plain(5126, index).contains("accessor"));
  CHECK(plain(5120, -1).contains("accessor"));
  for (const int type : {0, 7, 5119, 5124, 5127}) CHECK(plain(type, 0).contains("accessor"));

  Glb glb =
      parse_glb(encode_building_glb(street(1)[0], {.compression = Compression::kMeshopt}).bytes);
  for (const std::size_t count : {std::size_t{1'000'000}, std::size_t{1} << 40, ~std::size_t{0}})
    for (Json& view : glb.json["bufferViews"]) {
      if (!view.contains("extensions")) continue;
      view["extensions"]["EXT_meshopt_compression"]["count"] = count;
      CHECK(check(packed(glb.json.dump(), glb.binary)).contains("accessor"));
    }
}

TEST_CASE("feature ids that are fewer than the vertices are told, and none beyond them is read") {
  for (const int count : {1, 3, 20}) {
    Glb glb =
        parse_glb(encode_building_glb(street(1)[0], {.compression = Compression::kNone}).bytes);
    const Json& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
    REQUIRE(attributes.contains("_FEATURE_ID_0"));
    glb.json["accessors"][attributes["_FEATURE_ID_0"].get<std::size_t>()]["count"] = count;
    CHECK(check(packed(glb.json.dump(), glb.binary)).contains("features"));
  }
}

TEST_CASE("many meshes on one accessor do not take all memory") {
  const std::string good =
      encode_building_glb(street(1)[0], {.compression = Compression::kNone}).bytes;
  for (const int copies : {1000, 100'000}) {
    Glb glb = parse_glb(good);
    const Json finest = glb.json["meshes"].back();
    for (int i = 0; i < copies; ++i) glb.json["meshes"].push_back(finest);
    const Codes codes = check(packed(glb.json.dump(), glb.binary));
    CHECK(codes.contains("too-large") == (copies > 1000));
  }
}

TEST_CASE("tilesets that lead back to themselves end") {
  const Hostile self(tile(content("tileset.json")));
  CHECK(self.codes() == Codes{"repeated"});
  const Hostile pair(tile(content("b.json")));
  pair.write("out/b.json", tileset(tile(content("./x/../tileset.json"))));
  fs::create_directories(pair / "out/x");
  CHECK(pair.codes().contains("repeated"));
  const std::string twice = tile(content("tileset.json"));
  const Hostile children(tile(content("a.glb") + ",\"children\":[" + twice + "," + twice + "]"));
  CHECK(children.codes().contains("repeated"));
}

TEST_CASE("tilesets and JSON may be as deep as anybody likes") {
  for (const int depth : {100, 1000, 20'000, 200'000}) {
    std::string head, tail;
    for (int i = 0; i < depth; ++i)
      head += "{" + kBox + ",\"geometricError\":1,\"children\":[", tail += "]}";
    const Hostile hostile(head + tile("") + tail);
    CHECK(hostile.codes().contains(depth < 300 ? "error-not-falling" : "json"));
    CHECK(parse_json(std::string(depth, '[') + std::string(depth, ']')).is_discarded() ==
          (depth > kDeepestJson));
  }
  CHECK_FALSE(parse_json("\"" + std::string(5000, '[') + "\\\"" + std::string(50, '{') + "\"")
                  .is_discarded());
  // One tileset below the other: no JSON is deep, all of them together are.
  const Hostile chain(tile(content("t1.json")));
  for (int i = 1; i < 1000; ++i)
    chain.write("out/t" + std::to_string(i) + ".json",
                tileset(tile(content("t" + std::to_string(i + 1) + ".json"))));
  CHECK(chain.codes().contains("too-deep"));
}

TEST_CASE("nothing outside the folder is read, by whatever way it is named") {
  const std::string glb = encode_building_glb(street(1)[0]).bytes;
  for (const std::string uri :
       {"../secret.glb", "x/../../secret.glb", "%2e%2e/secret.glb", "..%2Fsecret.glb",
        "/etc/passwd", "/dev/zero", "//host/a.glb", "http://127.0.0.1:9/a.glb",
        "file:///etc/passwd", "link.glb", "linked/secret.glb", "a%00.glb"}) {
    const Hostile hostile(tile(content(uri)));
    hostile.write("secret.glb", glb);
    hostile.write("out/x/y", "");
    fs::create_symlink(hostile / "secret.glb", hostile / "out/link.glb");
    fs::create_symlink(hostile / "", hostile / "out/linked");
    INFO(uri);
    const Codes codes = hostile.codes();
    CHECK(codes.contains("outside"));
    CHECK_FALSE(codes.contains("content-box"));  // its content would lie outside the box
  }
  const Hostile linked(tile(""));
  fs::rename(linked / "out/tileset.json", linked / "tileset.json");
  fs::create_symlink(linked / "tileset.json", linked / "out/tileset.json");
  CHECK(linked.codes() == Codes{"outside"});
}

TEST_CASE("links that lead to themselves are findings, or no input, and end nothing") {
  const Hostile own(tile(""));
  fs::remove(own / "out/tileset.json");
  fs::create_symlink("tileset.json", own / "out/tileset.json");
  CHECK(own.codes() == Codes{"outside"});
  const Hostile lods(tile(""));
  fs::create_directories(lods / "out/engine");
  fs::create_symlink("lods.json", lods / "out/engine/lods.json");
  CHECK(lods.codes().contains("outside"));
  fs::create_symlink("self", lods / "self");
  CHECK_THROWS_AS(check_output((lods / "self").string()), Error);
}

TEST_CASE("what is no file is not waited for, and names may be anything") {
  for (const std::string uri : {"fifo.glb", "folder.glb", "none.glb", "%zz.glb", "%", "a%2"}) {
    const Hostile hostile(tile(content(uri)));
    REQUIRE(mkfifo((hostile / "out/fifo.glb").c_str(), 0600) == 0);
    fs::create_directory(hostile / "out/folder.glb");
    INFO(uri);
    CHECK(hostile.codes().contains("content"));
  }
}

TEST_CASE("any part of a tileset may be of another type") {
  const Json good =
      Json::parse(tileset(tile(content("a.glb") + ",\"children\":[" + tile("") + "]")));
  const Json flat = good.flatten();
  for (const auto& [pointer, old] : flat.items())
    for (Json::json_pointer at(pointer); !at.empty(); at.pop_back())
      for (const Json& value :
           {Json(5), Json("x"), Json(1e308), Json(), Json::array({1}), Json::object({{"a", 1}})}) {
        Json json = good;
        json[at] = value;
        const Hostile hostile("{}");
        hostile.write("out/tileset.json", json.dump());
        hostile.write("out/a.glb", "glTF");
        CHECK_FALSE(hostile.codes().empty());
      }
}
