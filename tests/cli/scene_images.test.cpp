// A textured tileset through the program: what its context wears on each level.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "image/image.h"
#include "program.h"
#include "scenes.h"

using namespace colod;
using namespace colod::test;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

constexpr double kSide = 40;  // metres of the place

struct Glb {
  Json json;
  std::string bin;
};

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t out = 0;
  for (std::size_t k = 4; k-- > 0;) out = out << 8 | static_cast<unsigned char>(bytes[at + k]);
  return out;
}

Glb parse(const std::string& bytes) {
  const std::size_t length = word(bytes, 12);
  return {Json::parse(bytes.substr(20, length)), bytes.substr(28 + length)};
}

std::string dump(const Glb& glb) {
  std::string json = glb.json.dump(), out = "glTF";
  while (json.size() % 4 != 0) json += ' ';
  put(out, std::uint32_t{2}, false);
  put(out, static_cast<std::uint32_t>(28 + json.size() + glb.bin.size()), false);
  put(out, static_cast<std::uint32_t>(json.size()), false);
  out += "JSON" + json;
  put(out, static_cast<std::uint32_t>(glb.bin.size()), false);
  return out + std::string("BIN\0", 4) + glb.bin;
}

/// A tile that wears a picture of `pixels` a side, from above.
std::string tile_with_image(const Mesh& m, int pixels) {
  Glb glb = parse(glb_of(y_up(m)));
  const auto add_view = [&](const std::string& bytes) {
    glb.json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", glb.bin.size()}, {"byteLength", bytes.size()}});
    glb.bin += bytes;
    while (glb.bin.size() % 4 != 0) glb.bin += '\0';
    return glb.json["bufferViews"].size() - 1;
  };
  std::string uvs;
  for (const Vec3& p : m.vertices)
    for (const double c : {p.x(), p.y()}) put(uvs, static_cast<float>(c / kSide), false);
  glb.json["accessors"].push_back({{"bufferView", add_view(uvs)},
                                   {"componentType", 5126},
                                   {"type", "VEC2"},
                                   {"count", m.vertices.size()}});
  Raster raster(pixels, pixels);
  for (std::size_t i = 0; i < raster.rgb.size(); ++i) raster.rgb[i] = i % 3 == 0 ? 200 : 60;
  glb.json["images"] = {{{"bufferView", add_view(encode_image(raster, ImageFormat::kJpeg, 90))},
                         {"mimeType", "image/jpeg"}}};
  glb.json["textures"] = {{{"source", 0}}};
  glb.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  Json& primitive = glb.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_0"] = glb.json["accessors"].size() - 1;
  primitive["material"] = 0;
  glb.json["buffers"][0]["byteLength"] = glb.bin.size();
  return b3dm_of(dump(glb));
}

/// Pixels a side of the images of a context tile that lies in the source.
std::vector<int> sides_of(const fs::path& file) {
  const Glb glb = parse(slurp(file));
  std::vector<int> out;
  for (const Json& image : glb.json.value("images", Json::array())) {
    const Json& view = glb.json["bufferViews"][image["bufferView"].get<std::size_t>()];
    const std::string bytes = glb.bin.substr(view.value("byteOffset", std::size_t{0}),
                                             view["byteLength"].get<std::size_t>());
    out.push_back(decode_image(bytes, std::size_t{1} << 26).raster.width);
  }
  return out;
}

}  // namespace

TEST_CASE("a source's coarse tiles wear texels of a pixel, its finest its images as they are") {
  const TempFolder folder;
  const double error = GENERATE(4.0, 16.0, 32.0);  // texels of 0.25, 1 and 2 m
  constexpr int kPixels = 512;                     // of 0.08 m
  const std::vector<Box> house = {Box{{12, 14, 0}, {20, 24, 6}}};
  folder.write("coarse.b3dm", tile_with_image(terrain_with_boxes(kSide, 4, house), kPixels));
  folder.write("fine.b3dm", tile_with_image(terrain_with_boxes(kSide, 1, house), kPixels));
  folder.write("tileset.json",
               tileset_of(tile_of(
                   "coarse.b3dm",
                   R"(,"refine":"REPLACE","children":[)" + tile_of("fine.b3dm") + "]", error)));
  const std::string plan = folder.write(
      "plan.geojson",
      R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":)"
      R"({"type":"Polygon","coordinates":[[[12,14],[20,14],[20,24],[12,24],[12,14]]]}}]})");
  const Ended run =
      run_colod(folder.path, "build " + (folder.path / "tileset.json").string() + " --footprints " +
                                 plan + " -o " + (folder.path / "out").string() +
                                 " --ns 24 --nr 24 --no-report-html --target-sse 16");
  INFO(run.err);
  CHECK(run.exit_code == 0);
  const fs::path context = folder.path / "out" / "tiles" / "context";
  const std::vector<int> coarse = sides_of(context / "0.glb"), fine = sides_of(context / "1.glb");
  REQUIRE(coarse.size() == 1);
  const double pixels = kSide / (error / 16);
  CHECK(coarse[0] <= 1.5 * (pixels + 16));
  CHECK(coarse[0] >= pixels / 2);
  CHECK((coarse[0] & (coarse[0] - 1)) == 0);  // nothing coarser is shown: it has mip levels
  CHECK(fine == std::vector<int>{kPixels});
}
