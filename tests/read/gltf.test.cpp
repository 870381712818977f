// What glTF files say beyond plain meshes under nodes.
#include <meshoptimizer.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/meshopt.h"
#include "exporters/exporters_helpers.h"
#include "exporters/gltf/engine.h"
#include "exporters/gltf/glb.h"
#include "read_helpers.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;

namespace {

using Json = nlohmann::ordered_json;
using Names = std::vector<std::string>;

const Mesh kHouse = gable_house(12, 8, 6, 3);  // 720 m³ once, z up

/// A document and its one buffer.
struct Gltf {
  Json json;
  std::string bin;

  explicit Gltf(const Mesh& m = kHouse) {
    json["asset"]["version"] = "2.0";
    json["scene"] = 0;
    json["scenes"] = {{{"nodes", {0}}}};
    json["nodes"] = {{{"name", "house"}, {"mesh", 0}}};
    std::string positions, indices;
    for (const Vec3& p : m.vertices)
      for (const double v : {p.x(), p.z(), -p.y()}) put(positions, static_cast<float>(v), false);
    for (const Face& f : m.faces)
      for (const int v : f) put(indices, static_cast<std::uint32_t>(v), false);
    add(positions, 5126, "VEC3", m.vertices.size());
    add(indices, 5125, "SCALAR", 3 * m.faces.size());
    json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}};
  }

  int view(const std::string& bytes) {
    bin.resize((bin.size() + 3) / 4 * 4, '\0');
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes.size()}});
    bin += bytes;
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  int add(const std::string& bytes, int type, const std::string& shape, std::size_t count) {
    const int v = view(bytes);
    json["accessors"].push_back(
        {{"bufferView", v}, {"componentType", type}, {"type", shape}, {"count", count}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  int floats(const std::vector<float>& values, const std::string& shape, std::size_t count) {
    std::string bytes;
    for (const float v : values) put(bytes, v, false);
    return add(bytes, 5126, shape, count);
  }

  std::string glb() const {
    Json out = json;
    out["buffers"] = {{{"byteLength", bin.size()}}};
    if (json.contains("buffers")) out["buffers"].push_back(json["buffers"][0]);
    std::string text = out.dump(), rest = bin, all = "glTF";
    text.resize((text.size() + 3) / 4 * 4, ' ');
    rest.resize((rest.size() + 3) / 4 * 4, '\0');
    put(all, std::uint32_t{2}, false);
    put(all, static_cast<std::uint32_t>(28 + text.size() + rest.size()), false);
    put(all, static_cast<std::uint32_t>(text.size()), false);
    all += "JSON" + text;
    put(all, static_cast<std::uint32_t>(rest.size()), false);
    return all + std::string("BIN\0", 4) + rest;
  }

  ReadResult read(const ReadOptions& options = {}) const {
    return read_bytes("a.glb", glb(), options);
  }
  std::string why() const { return failure("a.glb", glb()); }
};

Names names(const ReadResult& result) {
  Names out;
  for (const Source& s : result.sources) out.push_back(s.name);
  return out;
}

double volume(const ReadResult& result) {
  for (const ReadFailure& f : result.failures) UNSCOPED_INFO(f.message);
  double sum = 0;
  for (const Source& s : result.sources) sum += signed_volume(s.mesh);
  return sum;
}

Box box_of(const ReadResult& result) {
  Box box;
  for (const Source& s : result.sources) box.extend(bounding_box(s.mesh.vertices));
  return box;
}

std::string said(const ReadResult& result) {
  std::string all;
  for (const Source& s : result.sources)
    for (const std::string& w : s.warnings) all += w + "\n";
  return all;
}

/// A row of `count` houses 20 m apart by EXT_mesh_gpu_instancing.
Gltf row(std::size_t count) {
  Gltf g;
  std::vector<float> at;
  for (std::size_t i = 0; i < count; ++i)
    at.insert(at.end(), {20.0f * static_cast<float>(i), 0, 0});
  g.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
      g.floats(at, "VEC3", count);
  g.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  return g;
}

/// The house with both views packed, as gltfpack does, under that name of the extension.
Gltf packed(const std::string& name, const std::string& indices_mode, bool is_filtered) {
  Gltf g;
  const std::string positions = g.bin.substr(0, 12 * kHouse.vertices.size());
  std::vector<std::uint32_t> indices;
  for (const Face& f : kHouse.faces)
    for (const int v : f) indices.push_back(static_cast<std::uint32_t>(v));
  std::string raw = positions;
  if (is_filtered)
    meshopt_encodeFilterExp(raw.data(), kHouse.vertices.size(), 12, 20,
                            reinterpret_cast<const float*>(positions.data()));
  std::string sequence(meshopt_encodeIndexSequenceBound(indices.size(), 99), '\0');
  meshopt_encodeIndexVersion(1);
  sequence.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(sequence.data()),
                                              sequence.size(), indices.data(), indices.size()));
  const std::string streams[] = {encode_meshopt_vertices(raw, 12),
                                 indices_mode == "INDICES"
                                     ? sequence
                                     : encode_meshopt_indices(indices, kHouse.vertices.size())};
  g.bin.clear();
  const Json views = g.json["bufferViews"];
  for (int i = 0; i < 2; ++i) {
    g.view(streams[i]);
    const Json stored = g.json["bufferViews"].back();
    g.json["bufferViews"].erase(g.json["bufferViews"].size() - 1);
    Json& view = g.json["bufferViews"][static_cast<std::size_t>(i)];
    view["buffer"] = 1;
    Json& extension = view["extensions"][name];
    extension = stored;
    extension["byteStride"] = i == 0 ? 12 : 4;
    extension["count"] = i == 0 ? kHouse.vertices.size() : indices.size();
    extension["mode"] = i == 0 ? "ATTRIBUTES" : indices_mode;
    if (i == 0 && is_filtered) extension["filter"] = "EXPONENTIAL";
  }
  g.json["buffers"] = {{{"byteLength", 9999}, {"extensions", {{name, {{"fallback", true}}}}}}};
  g.json["extensionsRequired"] = {name};
  return g;
}

}  // namespace

TEST_CASE("instances are read, each a building where it looks like one") {
  for (const std::size_t count : {1, 5, 60}) {
    INFO(count);
    const ReadResult r = row(count).read();
    CHECK(r.sources.size() == count);
    CHECK(volume(r) == Approx(720 * static_cast<double>(count)));
    CHECK(box_of(r).max.x() == Approx(20 * static_cast<double>(count) - 8));
  }
  CHECK(names(row(2).read()) == Names{"a_house_1", "a_house_2"});
  Gltf turned = row(2);  // a quarter turn about the upright axis, twice as large, below a node
  auto& attributes = turned.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  const float half = std::sqrt(0.5f);
  attributes["ROTATION"] = turned.floats({0, half, 0, half, 0, 0, 0, 1}, "VEC4", 2);
  attributes["SCALE"] = turned.floats({2, 2, 2, 1, 1, 1}, "VEC3", 2);
  turned.json["nodes"].push_back({{"children", {0}}, {"translation", {0, 5, 0}}});
  turned.json["scenes"][0]["nodes"] = {1};
  const ReadResult r = turned.read();
  CHECK(volume(r) == Approx(9 * 720));
  CHECK((box_of(r).min - Vec3(-16, 0, 5)).norm() < 1e-4);
  CHECK(box_of(r).max.y() == Approx(24));
}

TEST_CASE("what stands in too many places is refused by one line") {
  Gltf crowd = row(20000);
  for (int i = 1; i < 20; ++i)
    crowd.json["meshes"][0]["primitives"].push_back(crowd.json["meshes"][0]["primitives"][0]);
  CHECK_THAT(crowd.why(), Contains("corners") && Contains("--input-memory"));
  Gltf few = row(200);
  for (int i = 1; i < 20; ++i)
    few.json["meshes"][0]["primitives"].push_back(few.json["meshes"][0]["primitives"][0]);
  CHECK(few.read({.input_memory = 1}).failures.size() == 1);
  CHECK(few.read({.input_memory = 40}).failures.empty());
  Gltf bomb;
  for (int i = 0; i < 2000; ++i) {
    bomb.json["nodes"][i] = {{"mesh", 0}};
    bomb.json["scenes"][0]["nodes"][i] = i;
    bomb.json["meshes"][0]["primitives"][i] = bomb.json["meshes"][0]["primitives"][0];
  }
  CHECK_THAT(bomb.why(), Contains("corners"));
  Gltf zeros;
  zeros.json["accessors"][0].erase("bufferView");
  zeros.json["accessors"][0]["count"] = 4000000000;
  CHECK_THAT(zeros.why(), Contains("accessor 0"));
}

TEST_CASE("CESIUM_RTC moves a file to its place") {
  for (const double x : {100.0, 1214904.935}) {
    Gltf g;
    g.json["extensions"]["CESIUM_RTC"]["center"] = {x, -20, 30};
    g.json["extensionsRequired"] = {"CESIUM_RTC"};
    CHECK((box_of(g.read()).min - Vec3(x, -20, 30)).norm() < 1e-9);
    CHECK(said(g.read()).empty());
  }
  Gltf earth;
  earth.json["extensions"]["CESIUM_RTC"]["center"] = {1214904.935, -4736269.81, 4081686.283};
  CHECK_THAT(said(earth.read()), Contains("tilted"));
}

TEST_CASE("meshopt's streams are read under both names, in all modes, and damage is told") {
  for (const std::string name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    for (const std::string mode : {"TRIANGLES", "INDICES"})
      for (const bool is_filtered : {false, true}) {
        INFO(name << " " << mode << " " << is_filtered);
        CHECK(volume(packed(name, mode, is_filtered).read()) == Approx(720));
      }
  Gltf bad = packed("EXT_meshopt_compression", "TRIANGLES", false);
  bad.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["count"] = 100000000;
  CHECK_THAT(bad.why(), Contains("buffer view 0"));
  bad = packed("EXT_meshopt_compression", "TRIANGLES", false);
  bad.bin[3] = '\x7f', bad.bin[5] = '\x7f', bad.bin.resize(bad.bin.size() - 8);
  CHECK(!bad.why().empty());
  bad = packed("EXT_meshopt_compression", "TRIANGLES", false);
  bad.bin[0] = '\xa1';
  CHECK_THAT(bad.why(), Contains("version 1"));
}

TEST_CASE("our own buildings come back as one, the finest, whatever packs them") {
  const Vec3 origin(691234.5, 5334567.25, 512.125);
  const ExportBuilding b = three_layers("house", origin);
  const double finest = signed_volume(b.levels.back().mesh.mesh());
  for (const Compression how : {Compression::kNone, Compression::kDraco, Compression::kMeshopt}) {
    GlbOptions options;
    options.compression = how;
    const std::string glb = encode_building_glb(b, options).bytes;
    const ReadResult r = read_bytes("house.glb", glb);
    CHECK(names(r) == Names{"house"});
    CHECK(volume(r) == Approx(finest).epsilon(0.01));
    CHECK((box_of(r).min - origin).norm() < 0.02);
    CHECK(said(r).empty());
    const double coarsest = volume(read_bytes("house.glb", glb, {.coarser = 2}));
    CHECK(coarsest == Approx(signed_volume(b.levels.front().mesh.mesh())).epsilon(0.01));
  }
}

TEST_CASE("levels of MSFT_lod count once, where they stand in the scene, too") {
  Gltf g;
  g.json["nodes"] = {
      {{"name", "fine"}, {"mesh", 0}, {"extensions", {{"MSFT_lod", {{"ids", {1}}}}}}},
      {{"name", "coarse"}, {"mesh", 0}}};
  g.json["scenes"][0]["nodes"] = {0, 1};
  CHECK(names(g.read()) == Names{"a"});
  CHECK(volume(g.read()) == Approx(720));
}

TEST_CASE("levels of detail below the node of a house are one building") {
  Gltf g;
  g.json["nodes"] = Json::array();
  for (int i = 0; i < 2; ++i) {
    g.json["nodes"].push_back({{"name", "no " + std::to_string(i)},
                               {"translation", {30 * i, 0, 0}},
                               {"children", {3 * i + 1, 3 * i + 2}}});
    for (const char* level : {"LOD0", "LOD1"})
      g.json["nodes"].push_back({{"name", level}, {"mesh", 0}});
  }
  g.json["scenes"][0]["nodes"] = {0, 3};
  CHECK(names(g.read()) == Names{"a_no_0", "a_no_1"});
  CHECK(volume(g.read()) == Approx(2 * 720));
  CHECK(volume(g.read({.split = Split::kObject})) == Approx(4 * 720));
}

TEST_CASE("hidden nodes are left out with all below them") {
  Gltf g;
  g.json["nodes"].push_back(
      {{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  g.json["scenes"][0]["nodes"] = {0, 1};
  CHECK(names(g.read()) == Names{"a"});
}

TEST_CASE("sparse accessors replace what they name") {
  for (const bool has_base : {true, false}) {
    Gltf g;
    std::string indices, values;
    for (std::size_t v = 0; v < kHouse.vertices.size(); ++v) {
      if (has_base && v < 8) continue;
      const Vec3& p = kHouse.vertices[v];  // the ridge rises by 2 m
      put(indices, static_cast<std::uint16_t>(v), false);
      for (const double x : {p.x(), p.z() + (v < 8 ? 0 : 2), -p.y()})
        put(values, static_cast<float>(x), false);
    }
    Json& sparse = g.json["accessors"][0]["sparse"];
    sparse["count"] = has_base ? 2 : 10;
    sparse["indices"] = {{"bufferView", g.view(indices)}, {"componentType", 5123}};
    sparse["values"]["bufferView"] = g.view(values);
    if (!has_base) g.json["accessors"][0].erase("bufferView");
    CHECK(volume(g.read()) == Approx(816));
    g.json["accessors"][0]["sparse"]["count"] = 11;
    CHECK_THAT(g.why(), Contains("sparse part"));
    g.json["accessors"][0]["count"] = 9;
    g.json["accessors"][0]["sparse"]["count"] = has_base ? 2 : 10;
    CHECK_THAT(g.why(), Contains("element 9 of 9"));
  }
}

TEST_CASE("an extension that is needed and not read is named, what is lost is said once") {
  Gltf g;
  g.json["extensionsRequired"] = {"EXT_voxels"};
  CHECK_THAT(g.why(), Contains("needs the extension EXT_voxels"));
  g.json["extensionsRequired"] = {"KHR_materials_unlit", "KHR_texture_transform"};
  CHECK(said(g.read()).empty());
  g.json["extensionsUsed"] = {"EXT_voxels"};
  CHECK_THAT(said(g.read()), Contains("uses the extension EXT_voxels"));
  Gltf painted;
  painted.json["materials"] = {{{"name", "red"}}};
  CHECK(said(painted.read()).empty());
  painted.json["materials"].push_back({{"name", "blue"}});
  painted.json["images"] = {{{"uri", "../../secret.png"}}};
  CHECK(said(painted.read()).empty());  // nothing wears them
  painted.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}};
  CHECK_THAT(said(painted.read()), Contains("morph targets"));
}

TEST_CASE("a glTF never leaves its folder") {
  const TempFolder outside, folder;
  Gltf g;
  Json json = g.json;
  const auto read = [&](const std::string& uri) {
    json["buffers"] = {{{"byteLength", g.bin.size()}, {"uri", uri}}};
    return read_sources({folder.write("a.gltf", json.dump())});
  };
  const auto why = [&](const std::string& uri) {
    const ReadResult r = read(uri);
    return r.failures.empty() ? "" : r.failures[0].message;
  };
  const std::string secret = outside.write("secret.bin", g.bin);
  folder.write("a b.bin", g.bin);
  std::filesystem::create_directories(folder.path / "sub");
  folder.write("sub/c.bin", g.bin);
  std::filesystem::create_symlink(secret, folder.path / "link.bin");
  CHECK(volume(read("a%20b.bin")) == Approx(720));
  CHECK(volume(read("./sub/c.bin")) == Approx(720));
  const std::string up = "../" + outside.path.filename().string() + "/secret.bin";
  for (const std::string& uri :
       {up, "%2e%2e" + up.substr(2), "sub/../" + up, secret, "file://" + secret,
        std::string("http://localhost/a.bin"), std::string("..\\secret.bin")})
    CHECK_THAT(why(uri), Contains("outside of its folder"));
  CHECK_THAT(why("link.bin"), Contains("a link out of its folder"));
  for (const char* uri : {".", "sub", "none.bin", ""}) CHECK_THAT(why(uri), Contains("no file"));
  REQUIRE(mkfifo((folder.path / "pipe.bin").c_str(), 0600) == 0);
  CHECK_THAT(why("pipe.bin"), Contains("no file"));
}

TEST_CASE("files beside a glTF count against the memory of one input") {
  const TempFolder folder;
  Gltf g;
  g.json["buffers"] = {{{"byteLength", 3 << 20}, {"uri", "a.bin"}}};
  folder.write("a.bin", g.bin + std::string((3 << 20) - g.bin.size(), ' '));
  const std::string path = folder.write("a.gltf", g.json.dump());
  CHECK(volume(read_sources({path}, {.input_memory = 4})) == Approx(720));
  const ReadResult r = read_sources({path}, {.input_memory = 2});
  REQUIRE(r.failures.size() == 1);
  CHECK_THAT(r.failures[0].message, Contains("--input-memory 2"));
}

TEST_CASE("our own levels for engines are not read again as buildings, wherever they were copied") {
  const TempFolder folder;
  const ExportBuilding b = three_layers("house", Vec3::Zero());
  for (const char* name : {"engine", "assets"}) {
    std::filesystem::create_directories(folder.path / name);
    std::vector<Encoded> files = encode_engine_levels(b);
    files.push_back(encode_lods_json({b}));
    for (const Encoded& file : files)
      folder.write((name / std::filesystem::path(file.path).filename()).string(), file.bytes);
    CHECK_THROWS_WITH(take_inventory({(folder.path / name).string()}),
                      Contains("colod itself wrote"));
  }
  folder.write("other.glb", Gltf().glb());
  const Inventory all = take_inventory({folder.path.string()}, {.is_recursive = true});
  CHECK(all.building_count() == 1);
}

TEST_CASE("nodes on one place that show the same thing are levels of detail under any names") {
  Gltf g;
  std::string positions, indices;  // the same house, each triangle in four
  int next = 0;
  for (const Face& f : kHouse.faces) {
    std::array<Vec3, 6> p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = kHouse.vertices[f[k]];
      p[3 + k] = 0.5 * (kHouse.vertices[f[k]] + kHouse.vertices[f[(k + 1) % 3]]);
    }
    for (const Vec3& v : p)
      for (const double x : {v.x(), v.z(), -v.y()}) put(positions, static_cast<float>(x), false);
    for (const int i : {0, 3, 5, 3, 1, 4, 5, 4, 2, 3, 4, 5})
      put(indices, static_cast<std::uint32_t>(next + i), false);
    next += 6;
  }
  const int at = g.add(positions, 5126, "VEC3", 6 * kHouse.faces.size());
  const int corners = g.add(indices, 5125, "SCALAR", 12 * kHouse.faces.size());
  g.json["meshes"].push_back(
      {{"primitives", {{{"attributes", {{"POSITION", at}}}, {"indices", corners}}}}});
  g.json["nodes"] = {{{"name", "far"}, {"mesh", 0}}, {{"name", "near"}, {"mesh", 1}}};
  g.json["scenes"][0]["nodes"] = {0, 1};
  CHECK(volume(g.read()) == Approx(720));
  CHECK(g.read().sources.at(0).mesh.faces.size() == 4 * kHouse.faces.size());
  CHECK_THAT(said(g.read()), Contains("finer ones") && Contains("near"));
  CHECK(volume(g.read({.split = Split::kNone})) == Approx(1440));
}

TEST_CASE("data URIs are read") {
  static constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  Gltf g;
  std::string text;
  for (std::size_t i = 0; i < g.bin.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < g.bin.size() ? static_cast<unsigned char>(g.bin[i + k]) : 0);
    for (int shift = 18; shift >= 0; shift -= 6) text += kDigits[bits >> shift & 63];
  }
  const std::string start = "data:application/octet-stream;base64,";
  g.json["buffers"] = {{{"byteLength", g.bin.size()}, {"uri", start + text}}};
  CHECK(volume(read_bytes("a.gltf", g.json.dump())) == Approx(720));
  g.json["buffers"][0]["uri"] = start + "!!!!";
  CHECK_THAT(failure("a.gltf", g.json.dump()), Contains("base64"));
  g.json["buffers"][0]["uri"] = 7;
  CHECK_THAT(failure("a.gltf", g.json.dump()), Contains("glTF: "));
}

TEST_CASE("numbers that are none, and JSON that never ends, are refused") {
  for (const Json& wild : {Json(-1), Json(1e300), Json(0.5), Json("0"), Json::array()}) {
    Gltf g;
    g.json["accessors"][0]["count"] = wild;
    CHECK_THAT(g.why(), Contains("'count'"));
  }
  CHECK_THAT(failure("a.gltf", std::string(100000, '[')), Contains("nested too deeply"));
  CHECK_THAT(failure("a.gltf", "[]"), Contains("not JSON"));
  CHECK_THAT(failure("a.gltf", R"({"asset":{"version":"1.0"}})"), Contains("version 1.0"));
}

TEST_CASE("files are read however long they are, under any name, with numbers in any spelling") {
  const TempFolder folder;
  Gltf g;
  folder.write("a+b c.bin", g.bin + "more");
  g.json["buffers"] = {{{"byteLength", g.bin.size()}, {"uri", "a+b%20c.bin"}}};
  g.json["accessors"][0]["count"] = static_cast<double>(kHouse.vertices.size());  // 10.0
  CHECK(volume(read_sources({folder.write("a.gltf", g.json.dump())})) == Approx(720));
  g.json["buffers"][0]["byteLength"] = g.bin.size() + 100;
  CHECK_THAT(read_sources({folder.write("a.gltf", g.json.dump())}).failures.at(0).message,
             Contains("File size mismatch"));
}

TEST_CASE(
    "a container that is cut or says too much is refused, what it may leave out is not missed") {
  const std::string glb = Gltf().glb();
  for (std::size_t size = 4; size < glb.size(); size += 7)
    CHECK(!failure("a.glb", glb.substr(0, size)).empty());
  std::string bad = glb;
  const std::size_t chunk = glb.find(std::string("BIN\0", 4)) - 4;
  bad[chunk] = static_cast<char>(bad[chunk] + 8);
  CHECK_THAT(failure("a.glb", bad), Contains("truncated"));
  Gltf offset;
  offset.json["bufferViews"][0]["byteOffset"] = -4;
  CHECK_THAT(offset.why(), Contains("'byteOffset'"));
  Gltf crowd;  // buffers without bytes, and extras of any shape
  for (int i = 0; i < 3; ++i) crowd.json["nodes"][0]["extras"][i] = Json::object();
  crowd.json["buffers"] = {{{"byteLength", 4000000000}}};
  CHECK(volume(crowd.read()) == Approx(720));
  crowd.json["bufferViews"][0]["buffer"] = 1;
  CHECK_THAT(crowd.why(), Contains("beyond its buffer"));
}
