// Based on: glTF 2.0 (Khronos), KHR_draco_mesh_compression, EXT_meshopt_compression,
// KHR_mesh_quantization.
// Differs: without fallback data; positions are metres about a local origin, so floats suffice.
// With meshopt they stay floats, since levels of different grids share one node's transform, and
// normals become bytes.
#include "gltf.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <tuple>

#include "core/meshopt.h"

namespace colod {

using OrderedJson = nlohmann::ordered_json;

namespace {

enum ComponentType { kByte = 5120, kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126 };
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr std::uint32_t kMaxShort = 65535;

void pad(std::string& bytes, std::size_t multiple, char with) {
  while (bytes.size() % multiple != 0) bytes += with;
}

void name_extension(OrderedJson& list, const std::string& extension) {
  if (std::find(list.begin(), list.end(), extension) == list.end()) list.push_back(extension);
}

int add_accessor(GltfDocument& document, ComponentType component, const char* type,
                 std::size_t count, int view = -1) {
  OrderedJson accessor;
  if (view >= 0) accessor["bufferView"] = view;
  accessor["componentType"] = static_cast<int>(component);
  accessor["type"] = type;
  accessor["count"] = count;
  document.json["accessors"].push_back(accessor);
  return static_cast<int>(document.json["accessors"].size()) - 1;
}

OrderedJson as_array(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

void set_bounds(GltfDocument& document, int accessor, const Box& box) {
  document.json["accessors"][accessor]["min"] = as_array(box.min);
  document.json["accessors"][accessor]["max"] = as_array(box.max);
}

/// An accessor for what linear_color makes.
int add_colors(GltfDocument& document, std::size_t count, int view) {
  const int accessor = add_accessor(document, kUnsignedShort, "VEC4", count, view);
  document.json["accessors"][accessor]["normalized"] = true;
  return accessor;
}

void put_color(std::string& bytes, const Rgb& rgb) {
  for (const std::uint16_t v : linear_color(rgb)) put(bytes, v);
}

OrderedJson add_draco(GltfDocument& document, const FlatMesh& mesh, const QuantizationGrid& grid,
                      Box& box) {
  const DracoResult draco = encode_draco(mesh, grid);
  box = {draco.min, draco.max};
  OrderedJson extension, attributes;
  extension["bufferView"] = add_buffer_view(document, draco.bytes);
  extension["attributes"]["POSITION"] = draco.position_id;
  attributes["POSITION"] = add_accessor(document, kFloat, "VEC3", draco.vertices);
  set_bounds(document, attributes["POSITION"], box);
  if (draco.normal_id >= 0) {
    extension["attributes"]["NORMAL"] = draco.normal_id;
    attributes["NORMAL"] = add_accessor(document, kFloat, "VEC3", draco.vertices);
  }
  if (draco.uv_id >= 0) {
    extension["attributes"]["TEXCOORD_0"] = draco.uv_id;
    attributes["TEXCOORD_0"] = add_accessor(document, kFloat, "VEC2", draco.vertices);
  }
  if (draco.color_id >= 0) {
    extension["attributes"]["COLOR_0"] = draco.color_id;
    attributes["COLOR_0"] = add_colors(document, draco.vertices, -1);
  }
  if (draco.feature_id >= 0) {
    const auto most = *std::max_element(mesh.feature_ids.begin(), mesh.feature_ids.end());
    extension["attributes"]["_FEATURE_ID_0"] = draco.feature_id;
    attributes["_FEATURE_ID_0"] = add_accessor(document, most > kMaxShort ? kFloat : kUnsignedShort,
                                               "SCALAR", draco.vertices);
  }
  OrderedJson primitive;
  primitive["attributes"] = attributes;
  primitive["indices"] =
      add_accessor(document, draco.vertices > kMaxShort ? kUnsignedInt : kUnsignedShort, "SCALAR",
                   3 * std::size_t{draco.faces});
  primitive["extensions"]["KHR_draco_mesh_compression"] = extension;
  return primitive;
}

void add_plain_look(GltfDocument& document, const FlatMesh& mesh, OrderedJson& attributes) {
  std::string uvs, colors;
  for (const Vec2f& uv : mesh.uvs) put(uvs, uv.x()), put(uvs, uv.y());
  for (const Rgb& rgb : mesh.colors) put_color(colors, rgb);
  const std::size_t n = mesh.positions.size();
  if (!uvs.empty())
    attributes["TEXCOORD_0"] =
        add_accessor(document, kFloat, "VEC2", n, add_buffer_view(document, uvs, kArrayBuffer));
  if (!colors.empty())
    attributes["COLOR_0"] =
        add_colors(document, n, add_buffer_view(document, colors, kArrayBuffer));
}

OrderedJson add_plain(GltfDocument& document, const FlatMesh& mesh, Box& box) {
  std::string indices, positions, normals, ids;
  const bool is_long = mesh.positions.size() > kMaxShort;
  for (const Face& f : mesh.triangles)
    for (const int v : f)
      is_long ? put(indices, static_cast<std::uint32_t>(v))
              : put(indices, static_cast<std::uint16_t>(v));
  for (const Vec3& p : mesh.positions) {
    for (int k = 0; k < 3; ++k) put(positions, static_cast<float>(p[k]));
    box.extend(Vec3(p.cast<float>().cast<double>()));
  }
  for (const Vec3& n : mesh.normals)
    for (int k = 0; k < 3; ++k) put(normals, static_cast<float>(n[k]));
  for (const std::uint32_t id : mesh.feature_ids) put(ids, static_cast<float>(id));
  const std::size_t n = mesh.positions.size();
  OrderedJson primitive, attributes;
  const int index_view = add_buffer_view(document, indices, kElementArrayBuffer);
  attributes["POSITION"] =
      add_accessor(document, kFloat, "VEC3", n, add_buffer_view(document, positions, kArrayBuffer));
  set_bounds(document, attributes["POSITION"], box);
  if (!normals.empty())
    attributes["NORMAL"] =
        add_accessor(document, kFloat, "VEC3", n, add_buffer_view(document, normals, kArrayBuffer));
  add_plain_look(document, mesh, attributes);
  if (!ids.empty())
    attributes["_FEATURE_ID_0"] =
        add_accessor(document, kFloat, "SCALAR", n, add_buffer_view(document, ids, kArrayBuffer));
  primitive["attributes"] = attributes;
  primitive["indices"] = add_accessor(document, is_long ? kUnsignedInt : kUnsignedShort, "SCALAR",
                                      3 * mesh.triangles.size(), index_view);
  return primitive;
}

/// Elements as meshopt packs them, and what a buffer view says of them.
struct Stream {
  std::string bytes;
  std::size_t stride = 0;
  int target = kArrayBuffer;
};

int add_packed_view(GltfDocument& document, const Stream& stream, const std::string& payload,
                    const char* mode) {
  pad(document.binary, 8, '\0');
  document.unpacked_bytes = (document.unpacked_bytes + 7) / 8 * 8;
  OrderedJson view = {
      {"buffer", 1}, {"byteOffset", document.unpacked_bytes}, {"byteLength", stream.bytes.size()}};
  if (stream.target == kArrayBuffer) view["byteStride"] = stream.stride;
  view["target"] = stream.target;
  view["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                   {"byteOffset", document.binary.size()},
                                                   {"byteLength", payload.size()},
                                                   {"byteStride", stream.stride},
                                                   {"count", stream.bytes.size() / stream.stride},
                                                   {"mode", mode}};
  document.unpacked_bytes += stream.bytes.size();
  document.binary += payload;
  document.json["bufferViews"].push_back(view);
  return static_cast<int>(document.json["bufferViews"].size()) - 1;
}

int add_packed(GltfDocument& document, const Stream& stream) {
  return add_packed_view(document, stream, encode_meshopt_vertices(stream.bytes, stream.stride),
                         "ATTRIBUTES");
}

/// Coordinates in steps of 1/65535, a sixteenth of a texel of the largest atlas.
void add_packed_look(GltfDocument& document, const FlatMesh& mesh,
                     const std::vector<std::uint32_t>& order, OrderedJson& attributes) {
  Stream uvs{{}, 4}, colors{{}, 8};
  for (const std::uint32_t v : order) {
    if (!mesh.uvs.empty())
      for (const float c : mesh.uvs[v])
        put(uvs.bytes, static_cast<std::uint16_t>(std::lround(65535 * std::clamp(c, 0.f, 1.f))));
    if (!mesh.colors.empty()) put_color(colors.bytes, mesh.colors[v]);
  }
  if (!mesh.uvs.empty()) {
    attributes["TEXCOORD_0"] =
        add_accessor(document, kUnsignedShort, "VEC2", order.size(), add_packed(document, uvs));
    document.json["accessors"][attributes["TEXCOORD_0"].get<int>()]["normalized"] = true;
  }
  if (!mesh.colors.empty())
    attributes["COLOR_0"] = add_colors(document, order.size(), add_packed(document, colors));
}

void put_normal(std::string& bytes, const Vec3& n) {
  for (int k = 0; k < 3; ++k) put(bytes, static_cast<std::int8_t>(std::lround(127 * n[k])));
  put(bytes, std::int8_t{0});  // elements are a multiple of four bytes
}

OrderedJson add_meshopt(GltfDocument& document, const FlatMesh& mesh, Box& box) {
  std::vector<std::uint32_t> indices, order;
  for (const Face& f : mesh.triangles)
    for (const int v : f) indices.push_back(static_cast<std::uint32_t>(v));
  optimize_order(indices, mesh.positions.size(), order);
  Stream triangles{{}, 4, kElementArrayBuffer}, positions{{}, 12}, normals{{}, 4}, ids{{}, 4};
  for (const std::uint32_t i : indices) put(triangles.bytes, i);
  for (const std::uint32_t v : order) {
    const Eigen::Vector3f p = mesh.positions[v].cast<float>();
    box.extend(Vec3(p.cast<double>()));
    for (int k = 0; k < 3; ++k) put(positions.bytes, p[k]);
    if (!mesh.normals.empty()) put_normal(normals.bytes, mesh.normals[v]);
    if (!mesh.feature_ids.empty()) put(ids.bytes, static_cast<float>(mesh.feature_ids[v]));
  }
  OrderedJson primitive, attributes;
  const int index_view = add_packed_view(
      document, triangles, encode_meshopt_indices(indices, order.size()), "TRIANGLES");
  attributes["POSITION"] =
      add_accessor(document, kFloat, "VEC3", order.size(), add_packed(document, positions));
  set_bounds(document, attributes["POSITION"], box);
  if (!normals.bytes.empty()) {
    attributes["NORMAL"] =
        add_accessor(document, kByte, "VEC3", order.size(), add_packed(document, normals));
    document.json["accessors"][attributes["NORMAL"].get<int>()]["normalized"] = true;
  }
  if (!ids.bytes.empty())
    attributes["_FEATURE_ID_0"] =
        add_accessor(document, kFloat, "SCALAR", order.size(), add_packed(document, ids));
  add_packed_look(document, mesh, order, attributes);
  primitive["attributes"] = attributes;
  primitive["indices"] = add_accessor(document, kUnsignedInt, "SCALAR", indices.size(), index_view);
  return primitive;
}

void require(GltfDocument& document, const char* extension) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"})
    name_extension(document.json[list], extension);
}

/// Position → number, so that equal positions become one.
std::vector<int> weld(const std::vector<Vec3>& positions) {
  std::map<std::tuple<double, double, double>, int> numbers;
  std::vector<int> out;
  for (const Vec3& p : positions)
    out.push_back(
        numbers.emplace(std::make_tuple(p.x(), p.y(), p.z()), numbers.size()).first->second);
  return out;
}

/// The facet's normal in glTF axes; from its triangles where it holds none.
std::vector<Vec3> facet_normals(const PolygonMesh& mesh) {
  std::vector<Vec3> sums(mesh.facets.size(), Vec3::Zero()), normals;
  const Mesh plain = mesh.mesh();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    sums[mesh.facet_of_triangle[t]] += face_cross(plain, mesh.triangles[t]);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    Vec3 n = mesh.facets[f].normal;
    if (!(std::abs(n.norm() - 1) < 1e-3)) n = sums[f].norm() > 0 ? sums[f] : Vec3(Vec3::UnitZ());
    normals.push_back(to_gltf(n.normalized()));
  }
  return normals;
}

}  // namespace

GltfDocument start_gltf() {
  GltfDocument document;
  document.json["asset"] = {{"version", "2.0"}, {"generator", "colod"}};
  document.json["scene"] = 0;
  document.json["scenes"] = OrderedJson::array({{{"nodes", {0}}}});
  for (const char* key : {"nodes", "meshes", "accessors", "bufferViews"})
    document.json[key] = OrderedJson::array();
  document.json["materials"] = OrderedJson::array({{{"name", "plain"},
                                                    {"pbrMetallicRoughness",
                                                     {{"baseColorFactor", {0.8, 0.8, 0.8, 1.0}},
                                                      {"metallicFactor", 0},
                                                      {"roughnessFactor", 1}}}}});
  return document;
}

int add_buffer_view(GltfDocument& document, const std::string& bytes, int target) {
  pad(document.binary, 8, '\0');
  OrderedJson view = {
      {"buffer", 0}, {"byteOffset", document.binary.size()}, {"byteLength", bytes.size()}};
  if (target != 0) view["target"] = target;
  document.binary += bytes;
  document.json["bufferViews"].push_back(view);
  return static_cast<int>(document.json["bufferViews"].size()) - 1;
}

OrderedJson add_primitive(GltfDocument& document, const FlatMesh& mesh,
                          const QuantizationGrid& grid, Compression compression, Box* box) {
  Box seen;
  OrderedJson primitive;
  switch (compression) {
    case Compression::kNone:
      primitive = add_plain(document, mesh, seen);
      break;
    case Compression::kDraco:
      primitive = add_draco(document, mesh, grid, seen);
      require(document, "KHR_draco_mesh_compression");
      break;
    case Compression::kMeshopt:
      primitive = add_meshopt(document, mesh, seen);
      require(document, "EXT_meshopt_compression");
      require(document, "KHR_mesh_quantization");
      break;
  }
  primitive["material"] = 0;
  if (box) *box = seen;
  return primitive;
}

namespace {

OrderedJson dull(const std::string& name) {
  return {{"name", name},
          {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}};
}

/// A material of baked light.
OrderedJson unlit(GltfDocument& document, const std::string& name) {
  name_extension(document.json["extensionsUsed"], "KHR_materials_unlit");
  OrderedJson material = dull(name);
  material["extensions"]["KHR_materials_unlit"] = OrderedJson::object();
  return material;
}

/// Its number.
int add_material(GltfDocument& document, OrderedJson material) {
  OrderedJson& all = document.json["materials"];
  if (all.size() == 1 && all[0]["name"] == "plain") all = OrderedJson::array();
  if (!all.empty() && all.back() == material) return static_cast<int>(all.size()) - 1;
  all.push_back(std::move(material));
  return static_cast<int>(all.size()) - 1;
}

/// The extension that a texture needs for a format; null: none.
const char* extension_for(ImageFormat format) {
  switch (format) {
    case ImageFormat::kWebp:
      return "EXT_texture_webp";
    case ImageFormat::kKtx2:
      return "KHR_texture_basisu";
    default:
      return nullptr;
  }
}

/// Its number.
std::size_t add_image(GltfDocument& document, const std::string& bytes, ImageFormat format) {
  OrderedJson& images = document.json["images"];
  images.push_back(
      {{"bufferView", add_buffer_view(document, bytes)}, {"mimeType", mime_of(format)}});
  return images.size() - 1;
}

int add_texture(GltfDocument& document, const std::string& name, const LevelLook& look) {
  constexpr int kLinear = 9729, kTrilinear = 9987, kClamp = 33071;
  OrderedJson& json = document.json;
  // Clients may raise an image's sides to powers of two for its mip levels: CesiumJS does.
  const int min_filter = look.has_mip_levels ? kTrilinear : kLinear;
  json["samplers"] = OrderedJson::array(
      {{{"magFilter", kLinear}, {"minFilter", min_filter}, {"wrapS", kClamp}, {"wrapT", kClamp}}});
  OrderedJson texture = {{"sampler", 0}};
  const std::size_t image = add_image(document, look.image, look.format);
  if (const char* extension = extension_for(look.format)) {
    texture["extensions"][extension]["source"] = image;
    if (look.fallback.empty())
      require(document, extension);
    else
      name_extension(json["extensionsUsed"], extension);
    if (!look.fallback.empty())
      texture["source"] = add_image(document, look.fallback, ImageFormat::kJpeg);
  } else {
    texture["source"] = image;
  }
  json["textures"].push_back(texture);
  const std::size_t number = json["textures"].size() - 1;
  OrderedJson material = look.normals.empty() ? unlit(document, name) : dull(name);
  material["pbrMetallicRoughness"]["baseColorTexture"]["index"] = number;
  if (!look.normals.empty()) {
    json["textures"].push_back(
        {{"sampler", 0}, {"source", add_image(document, look.normals, ImageFormat::kPng)}});
    material["normalTexture"]["index"] = json["textures"].size() - 1;
  }
  return add_material(document, std::move(material));
}

}  // namespace

void set_look(GltfDocument& document, const LevelLook& look, const std::string& name,
              OrderedJson& primitive) {
  if (look.has_texture())
    primitive["material"] = add_texture(document, name, look);
  else if (!look.facet_colors.empty())
    primitive["material"] = add_material(document, unlit(document, "colors"));
}

std::string finish_glb(GltfDocument document) {
  pad(document.binary, 4, '\0');
  document.json["buffers"] = OrderedJson::array({{{"byteLength", document.binary.size()}}});
  if (document.unpacked_bytes > 0) {
    OrderedJson stand_in = {{"byteLength", document.unpacked_bytes}};
    stand_in["extensions"]["EXT_meshopt_compression"]["fallback"] = true;
    document.json["buffers"].push_back(stand_in);
  }
  std::string json = document.json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
  pad(json, 4, ' ');
  std::string glb = "glTF";
  put(glb, std::uint32_t{2});
  put(glb, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + document.binary.size()));
  put(glb, static_cast<std::uint32_t>(json.size()));
  glb += "JSON" + json;
  put(glb, static_cast<std::uint32_t>(document.binary.size()));
  glb.append("BIN\0", 4);
  return glb + document.binary;
}

FlatMesh flatten(const PolygonMesh& mesh, const Vec3& offset, const QuantizationGrid& grid,
                 int feature, const LevelLook& look) {
  FlatMesh out;
  const bool has_texture = look.has_texture();
  const bool has_colors = !has_texture && !look.facet_colors.empty();
  if (has_texture) out.texture_side = std::max(look.width, look.height);
  const std::vector<Vec3> normals = facet_normals(mesh);
  std::vector<Vec3> rounded;
  for (const Vec3& p : mesh.vertices) rounded.push_back(grid.round(to_gltf(p + offset)));
  std::map<std::pair<int, int>, int> numbers;  // facet and vertex → flat vertex
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Face& f = mesh.triangles[t];
    if (rounded[f[0]] == rounded[f[1]] || rounded[f[1]] == rounded[f[2]] ||
        rounded[f[2]] == rounded[f[0]])
      continue;
    const int facet = mesh.facet_of_triangle[t];
    Face flat;
    for (int c = 0; c < 3; ++c) {
      const auto [it, is_new] =
          numbers.emplace(std::make_pair(facet, f[c]), static_cast<int>(out.positions.size()));
      flat[c] = it->second;
      if (!is_new) continue;
      out.positions.push_back(rounded[f[c]]);
      out.normals.push_back(normals[facet]);
      out.feature_ids.push_back(static_cast<std::uint32_t>(feature));
      if (has_texture) out.uvs.push_back(look.uvs[t][static_cast<std::size_t>(c)]);
      if (has_colors) out.colors.push_back(look.facet_colors[static_cast<std::size_t>(facet)]);
    }
    out.triangles.push_back(flat);
  }
  return out;
}

void append(FlatMesh& a, const FlatMesh& b) {
  const int base = static_cast<int>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  a.normals.insert(a.normals.end(), b.normals.begin(), b.normals.end());
  a.feature_ids.insert(a.feature_ids.end(), b.feature_ids.begin(), b.feature_ids.end());
  a.uvs.insert(a.uvs.end(), b.uvs.begin(), b.uvs.end());
  a.colors.insert(a.colors.end(), b.colors.begin(), b.colors.end());
  a.texture_side = std::max(a.texture_side, b.texture_side);
  for (const Face& f : b.triangles) a.triangles.push_back({f[0] + base, f[1] + base, f[2] + base});
}

bool is_closed(const FlatMesh& mesh) {
  const std::vector<int> number = weld(mesh.positions);
  std::vector<std::pair<int, int>> edges;
  for (const Face& f : mesh.triangles)
    for (int c = 0; c < 3; ++c) edges.emplace_back(number[f[c]], number[f[(c + 1) % 3]]);
  std::sort(edges.begin(), edges.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  return std::all_of(edges.begin(), edges.end(), [&](const std::pair<int, int>& e) {
    return std::binary_search(edges.begin(), edges.end(), std::make_pair(e.second, e.first));
  });
}

QuantizationGrid fit_closed_grid(const PolygonMesh& mesh, const Vec3& offset, const Box& gltf_box,
                                 double bound) {
  const QuantizationGrid first = fit_grid(gltf_box, bound);
  if (is_closed(flatten(mesh, offset, first))) return first;
  const QuantizationGrid exact = fit_grid(gltf_box, bound / 256);
  if (!is_closed(flatten(mesh, offset, exact))) return first;  // it is open in any case
  for (double b = bound / 2; b > bound / 256; b /= 2) {
    const QuantizationGrid grid = fit_grid(gltf_box, b);
    if (is_closed(flatten(mesh, offset, grid))) return grid;
  }
  return exact;
}

}  // namespace colod
