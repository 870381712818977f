#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "image/cache.h"
#include "read/frame.h"
#include "read_helpers.h"
#include "scene/hidden.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;

namespace {

const std::string kPng = [] {
  Raster raster(8, 4);
  std::fill(raster.rgb.begin(), raster.rgb.end(), 77);
  return encode_image(raster, ImageFormat::kPng, 0);
}();

constexpr const char* kQuads =
    "mtllib my materials.mtl\n"
    "v 0 0 0\nv 4 0 0\nv 4 0 3\nv 0 0 3\nv 4 4 0\nv 4 4 3\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt nan 0.5\nvt 7.25 -2\n"
    "usemtl brick wall\nf 1/1 2/2 3/3 4/4\nusemtl red\nf 2/1 5/2 6/6\nusemtl brick wall\n"
    "f 2/5 6/2 3/-3\nf 1 3 2\n";

Source read_quads(const TempFolder& folder, const std::string& mtl) {
  folder.write("my materials.mtl", mtl);
  const ReadResult result = read_sources({folder.write("quads.obj", kQuads)});
  REQUIRE(result.sources.size() == 1);
  return result.sources[0];
}

bool warns(const Source& s, const std::string& of) {
  return std::any_of(s.warnings.begin(), s.warnings.end(),
                     [&](const std::string& w) { return w.find(of) != w.npos; });
}

}  // namespace

TEST_CASE("an OBJ has its materials, images and coordinates") {
  const TempFolder folder;
  folder.write("wall 1.png", kPng);
  const Source s = read_quads(folder,
                              "newmtl brick wall\nKd 0.2 0.2 0.2\n"
                              "map_Kd -s 2 3 -o 0.5 0 -clamp on C:\\scan\\wall 1.png\n"
                              "newmtl red\r\nKd 1 0 0.5\n");
  const Appearance& look = s.look;
  REQUIRE(look.materials.size() == 2);
  CHECK(look.materials[0].image == 0);
  CHECK(look.materials[0].color == std::array<float, 3>{1, 1, 1});  // the image alone counts
  CHECK(look.materials[0].wrap_u == Wrap::kClamp);
  CHECK(look.materials[0].cutoff == 0.5f);
  CHECK(look.materials[1].color[0] == 1);
  CHECK(look.materials[1].color[2] == Approx(0.214).epsilon(0.01));
  REQUIRE(look.images.size() == 1);
  CHECK(std::filesystem::path(look.images[0].path).filename() == "wall 1.png");
  CHECK(look.face_material == std::vector<int>{0, 0, 1, 0, 0});
  REQUIRE(look.uvs.size() == 5);
  CHECK(look.uvs[0][0] == Vec2f(0.5f, 1));
  CHECK(look.uvs[0][2] == Vec2f(2.5f, -2));
  CHECK(look.uvs[2][2] == Vec2f(7.25f, 3));
  CHECK(std::isnan(look.uvs[3][0].x()));
  CHECK(std::isnan(look.uvs[4][1].x()));
  CHECK(!warns(s, "texture"));
}

TEST_CASE("what of an OBJ's looks is missing is told of, and its shape is the same") {
  const TempFolder folder;
  const Source s = read_quads(folder, "newmtl brick wall\nmap_Kd ../secret.png\n");
  REQUIRE(s.look.images.size() == 1);
  CHECK(is_missing(s.look.images[0]));  // also where such a file lies outside of the folder
  CHECK(s.look.images[0].path == "../secret.png");
  CHECK_THROWS_WITH(read_image(s.look.images[0], 1 << 20), "is missing");
  const Source bare = read_bytes("quads.obj", kQuads).sources.at(0);
  CHECK(warns(bare, "my materials.mtl"));
  CHECK((bare.mesh.vertices == s.mesh.vertices && bare.mesh.faces == s.mesh.faces));
  const Source broken = read_quads(folder, "Kd 1 1 1\nnewmtl\nmap_Kd -s\nnewmtl red\nKd x\nmap_Kd");
  CHECK(broken.mesh.faces == s.mesh.faces);
}

TEST_CASE("a texture that no face wears is told of, and one that some wear is not") {
  const TempFolder folder;
  folder.write("wall.png", kPng);
  folder.write("m.mtl", "newmtl plain\nKd 1 0 0\nnewmtl wall\nmap_Kd wall.png\n");
  const std::string triangle =
      "v 0 0 0\nv 4 0 0\nv 4 0 3\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n";
  const auto read = [&](const std::string& text) {
    return read_sources({folder.write("a.obj", text)}).sources.at(0);
  };
  const Source unworn = read("mtllib m.mtl\nusemtl plain\n" + triangle);
  CHECK(warns(unworn, "its texture 'wall.png' is on no face"));
  CHECK(unworn.look.images.empty());
  const Source worn =
      read("mtllib m.mtl\nusemtl plain\n" + triangle + "usemtl wall\nf 1/1 2/2 4/3\n");
  CHECK(!warns(worn, "no face"));
  CHECK(worn.look.images.size() == 1);
}

TEST_CASE("a face keeps its coordinates in its own frame and where it is cut") {
  const TempFolder folder;
  folder.write("wall.png", kPng);
  const Source s =
      read_quads(folder, "newmtl brick wall\nmap_Kd wall.png\nnewmtl red\nmap_Kd wall.png\n");
  const Source local = localize(s, main_frame(s));
  REQUIRE(local.look.uvs.size() == local.mesh.faces.size());
  const Frame frame = main_frame(s);
  int compared = 0;
  for (std::size_t f = 0; f < local.mesh.faces.size(); ++f)
    for (std::size_t g = 0; g < s.mesh.faces.size(); ++g)
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t d = 0; d < 3; ++d) {
          const Vec3 a = local.mesh.vertices[local.mesh.faces[f][c]];
          const Vec3 b = frame.to_local(s.mesh.vertices[s.mesh.faces[g][d]]);
          if (local.look.face_material[f] != 0 || s.look.face_material[g] != 0 || g > 1) continue;
          if ((a - b).norm() > 1e-3 || std::isnan(local.look.uvs[f][0].x())) continue;
          if (std::isnan(local.look.uvs[f][c].x())) continue;
          CHECK((local.look.uvs[f][c] - s.look.uvs[g][d]).norm() < 1e-6f);
          ++compared;
        }
  CHECK(compared >= 6);
}

TEST_CASE("faces that are cut where others hide them keep their picture in place") {
  // Two boxes of a house that overlap: faces are cut; u and v are the place itself.
  Source two = as_source(join(box_mesh({0, 0, 0}, {10, 8, 6}), box_mesh({6, 3, 0}, {16, 12, 5})));
  two.look.materials.resize(1);
  two.look.images.resize(1);
  two.look.materials[0].image = 0;
  const auto place = [](const Vec3& p) {
    return Vec2f(static_cast<float>(p.x() + 0.25 * p.z()), static_cast<float>(p.y() - 0.5 * p.z()));
  };
  for (const Face& f : two.mesh.faces) {
    two.look.face_material.push_back(0);
    two.look.uvs.push_back({place(two.mesh.vertices[f[0]]), place(two.mesh.vertices[f[1]]),
                            place(two.mesh.vertices[f[2]])});
  }
  const std::size_t before = two.mesh.faces.size();
  const Source shell = remove_hidden(two);
  REQUIRE(shell.mesh.faces.size() != before);
  REQUIRE(shell.look.uvs.size() == shell.mesh.faces.size());
  REQUIRE(shell.look.face_material.size() == shell.mesh.faces.size());
  for (std::size_t f = 0; f < shell.mesh.faces.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c)
      CHECK((shell.look.uvs[f][c] - place(shell.mesh.vertices[shell.mesh.faces[f][c]])).norm() <
            1e-3f);
}

TEST_CASE("a PLY has colours of its points, and images of its faces") {
  const std::string head = "ply\nformat ascii 1.0\ncomment TextureFile wall.png\n";
  const std::string points =
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const TempFolder folder;
  folder.write("wall.png", kPng);
  const ReadResult faces = read_sources({folder.write(
      "a.ply",
      head + points +
          "element face 2\nproperty list uchar int vertex_indices\n"
          "property list uchar float texcoord\nproperty int texnumber\nend_header\n"
          "0 0 0\n4 0 0\n4 0 3\n0 0 3\n3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 6 0 0 1 1 0 1 0\n")});
  REQUIRE(faces.sources.size() == 1);
  const Appearance& look = faces.sources[0].look;
  CHECK(look.face_material == std::vector<int>{0, 0});
  CHECK(look.materials.at(0).image == 0);
  CHECK(look.uvs.at(0)[2] == Vec2f(1, 0));
  CHECK(look.uvs.at(1)[2] == Vec2f(0, 0));
  const Source colored =
      read_bytes("b.ply", "ply\nformat ascii 1.0\n" + points +
                              "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                              "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                              "0 0 0 255 0 0\n4 0 0 0 255 0\n4 0 3 0 0 255\n0 0 3 9 9 9\n3 0 1 2\n")
          .sources.at(0);
  REQUIRE(colored.look.colors.size() == 1);
  CHECK(colored.look.colors[0][1] == Rgb{0, 255, 0});
  CHECK(!colored.look.is_empty());
}

TEST_CASE("a glTF has its base colour, turned coordinates and colours, whatever holds its image") {
  using Json = nlohmann::json;
  const TempFolder folder;
  folder.write("a b.png", kPng);
  const auto base64 = [](const std::string& bytes) {
    static constexpr char kDigits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      unsigned bits = 0;
      for (std::size_t k = 0; k < 3; ++k)
        bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
      for (int k = 3; k >= 0; --k) out += kDigits[bits >> 6 * k & 63];
    }
    return out;
  };
  std::string data;
  for (const float v : {0.f, 0.f, 0.f, 4.f, 0.f, 0.f, 0.f, 3.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f})
    data.append(reinterpret_cast<const char*>(&v), 4);
  const std::size_t shapes = data.size();
  data += kPng;
  const std::vector<std::pair<Json, std::string>> images = {
      {{{"uri", "a%20b.png"}}, "file"},
      {{{"uri", "data:image/png;base64," + base64(kPng)}}, "data URI"},
      {{{"bufferView", 2}, {"mimeType", "image/png"}}, "buffer"},
      {{{"uri", "no.png"}}, "nothing"}};
  for (const auto& [image, what] : images) {
    INFO(what);
    Json j;
    j["asset"]["version"] = "2.0";
    j["buffers"] = {{{"byteLength", data.size()},
                     {"uri", "data:application/octet-stream;base64," + base64(data)}}};
    j["bufferViews"] = {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 36}},
                        {{"buffer", 0}, {"byteOffset", 36}, {"byteLength", 24}},
                        {{"buffer", 0}, {"byteOffset", shapes}, {"byteLength", kPng.size()}}};
    j["accessors"] = {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
                      {{"bufferView", 1}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}}};
    j["meshes"] = {{{"primitives",
                     {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}, {"material", 0}}}}}};
    j["nodes"] = {{{"mesh", 0}}};
    j["images"] = Json::array({image});
    j["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
    j["textures"] = {{{"source", 0}, {"sampler", 0}}};
    j["materials"] = {
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {0.5, 1, 1, 1}},
           {"baseColorTexture",
            {{"index", 0},
             {"extensions",
              {{"KHR_texture_transform",
                what == "file"  // the specification's example: the image's lower left quarter
                    ? Json{{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}}
                    : Json{{"offset", {0.25, 0}}, {"scale", {2, 3}}}}}}}}}}}};
    if (what == "file")
      j["materials"][0]["alphaMode"] = "MASK", j["materials"][0]["alphaCutoff"] = 0.25;
    if (what == "buffer") j["materials"][0]["alphaMode"] = "BLEND";
    const ReadResult result = read_sources({folder.write("a.gltf", j.dump())});
    REQUIRE(result.sources.size() == 1);
    const Source& s = result.sources[0];
    REQUIRE(s.look.materials.size() == 1);
    CHECK(s.look.materials[0].color[0] == 0.5f);
    CHECK(s.look.face_material == std::vector<int>{0});
    if (what == "nothing") {
      REQUIRE(s.look.images.size() == 1);
      CHECK(is_missing(s.look.images[0]));
      CHECK(s.look.images[0].path == "no.png");
      continue;
    }
    CHECK(s.look.materials[0].wrap_u == Wrap::kClamp);
    CHECK(s.look.materials[0].wrap_v == Wrap::kMirror);
    CHECK(s.look.materials[0].cutoff == (what == "file" ? 0.25f : what == "buffer" ? 0.1f : 0.f));
    REQUIRE(s.look.uvs.size() == 1);
    const std::array<Vec2f, 3> wanted =
        what == "file" ? std::array{Vec2f(0, 1), Vec2f(0, 0.5f), Vec2f(0.5f, 1)}
                       : std::array{Vec2f(0.25f, 0), Vec2f(2.25f, 0), Vec2f(0.25f, 3)};
    for (std::size_t c = 0; c < 3; ++c) CHECK((s.look.uvs[0][c] - wanted[c]).norm() < 1e-6f);
    REQUIRE(s.look.images.size() == 1);
    const ImageCache::Entry image_read = ImageCache(1 << 20).get(s.look.images[0]);
    INFO(image_read.problem);
    REQUIRE(image_read.pyramid);
    CHECK(image_read.pyramid->levels[0].width == 8);
  }
}
