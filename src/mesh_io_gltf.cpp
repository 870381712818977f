// Based on: glTF 2.0, KHR_draco_mesh_compression, KHR_mesh_quantization; container and JSON through
// tinygltf.
// Differs: tinygltf hands out indices and offsets unchecked, so every one is checked here; Draco is
// decoded here, since Debian's tinygltf is built without it. The coarser levels of MSFT_lod are in
// no scene and therefore not read.
#include <draco/compression/decode.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "mesh_io_formats.h"

namespace colod::mesh_io {

namespace {

using Matrix = Eigen::Matrix4d;
constexpr int kDeepestJson = 256;
constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// A primitive's own points and corners, before its node places them.
struct Primitive {
  std::vector<Vec3> points;
  std::vector<int> corners;  // three a triangle; empty: points only
};

/// One file while it is read; all methods throw Error{kInput} naming the mesh or accessor.
class Reader {
 public:
  Reader(const std::string& path, const tinygltf::Model& model) : path_(path), model_(model) {}

  RawFile read(int coarser);

 private:
  [[noreturn]] void fail(const std::string& cause) const { mesh_io::fail(path_, cause); }
  template <typename T>
  const T& at(const std::vector<T>& list, int i, const char* what) const {
    if (i < 0 || i >= static_cast<int>(list.size()))
      fail(std::string(what) + " " + std::to_string(i) + " of " + std::to_string(list.size()) +
           " is named but missing");
    return list[i];
  }
  std::string_view view_bytes(int view) const;
  std::vector<double> accessor_values(int accessor, int components) const;
  Primitive read_draco(const tinygltf::Primitive& primitive,
                       const tinygltf::Value& extension) const;
  Primitive read_plain(const tinygltf::Primitive& primitive) const;
  std::vector<int> top_nodes() const;
  int coarser_node(int node, int levels) const;
  void add_node(RawFile& raw, int node, const Matrix& parent, int part);
  void add_mesh(RawFile& raw, const tinygltf::Mesh& mesh, const Matrix& matrix, int part) const;

  const std::string& path_;
  const tinygltf::Model& model_;
  std::vector<char> is_visited_;
};

std::string_view Reader::view_bytes(int view) const {
  const tinygltf::BufferView& v = at(model_.bufferViews, view, "buffer view");
  const std::vector<unsigned char>& data = at(model_.buffers, v.buffer, "buffer").data;
  if (v.byteOffset > data.size() || v.byteLength > data.size() - v.byteOffset)
    fail("buffer view " + std::to_string(view) + " reaches beyond its buffer");
  return {reinterpret_cast<const char*>(data.data()) + v.byteOffset, v.byteLength};
}

template <typename T>
double as_double(const char* bytes, bool is_normalized) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  const double d = static_cast<double>(value);
  if constexpr (std::is_integral_v<T>)
    return is_normalized ? std::max(-1.0, d / static_cast<double>(std::numeric_limits<T>::max()))
                         : d;
  return d;
}

double component(const char* bytes, int type, bool is_normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return as_double<std::int8_t>(bytes, is_normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return as_double<std::uint8_t>(bytes, is_normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return as_double<std::int16_t>(bytes, is_normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return as_double<std::uint16_t>(bytes, is_normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return as_double<std::uint32_t>(bytes, is_normalized);
    default:
      return as_double<float>(bytes, false);
  }
}

std::vector<double> Reader::accessor_values(int accessor, int components) const {
  const tinygltf::Accessor& a = at(model_.accessors, accessor, "accessor");
  const std::string place = "accessor " + std::to_string(accessor);
  const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(a.componentType));
  if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a.type)) != components ||
      size <= 0 || a.componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE ||
      a.componentType == TINYGLTF_COMPONENT_TYPE_INT)
    fail(place + " has a type that does not belong there");
  if (a.sparse.isSparse || a.bufferView < 0) fail(place + ": no or sparse data are not read");
  const std::string_view bytes = view_bytes(a.bufferView);
  const std::size_t element = static_cast<std::size_t>(size * components);
  const std::size_t given = model_.bufferViews[a.bufferView].byteStride;
  const std::size_t stride = given > 0 ? given : element;
  const bool fits =
      a.count == 0 || (a.byteOffset <= bytes.size() && bytes.size() - a.byteOffset >= element &&
                       a.count - 1 <= (bytes.size() - a.byteOffset - element) / stride);
  if (!fits) fail(place + " reaches beyond its buffer view (truncated)");
  std::vector<double> values;
  for (std::size_t i = 0; i < a.count; ++i)
    for (int c = 0; c < components; ++c)
      values.push_back(
          component(bytes.data() + a.byteOffset + i * stride + static_cast<std::size_t>(c * size),
                    a.componentType, a.normalized));
  return values;
}

Primitive Reader::read_draco(const tinygltf::Primitive&, const tinygltf::Value& extension) const {
  if (!extension.Get("bufferView").IsInt() || !extension.Get("attributes").IsObject())
    fail("a Draco primitive without buffer view or attributes");
  const std::string_view bytes = view_bytes(extension.Get("bufferView").GetNumberAsInt());
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  const auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) fail("Draco: " + decoded.status().error_msg_string());
  const draco::Mesh& mesh = *decoded.value();
  const int id = extension.Get("attributes").Get("POSITION").GetNumberAsInt();
  const draco::PointAttribute* position =
      mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
  if (!position || position->num_components() != 3) fail("Draco: no positions under the given id");
  Primitive out;
  for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
    double v[3] = {NAN, NAN, NAN};
    const draco::AttributeValueIndex value = position->mapped_index(p);
    if (value.value() >= position->size() || !position->ConvertValue<double, 3>(value, v))
      fail("Draco: point " + std::to_string(p.value()) + " has no position");
    out.points.emplace_back(v[0], v[1], v[2]);
  }
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
    for (int c = 0; c < 3; ++c) out.corners.push_back(static_cast<int>(mesh.face(f)[c].value()));
  return out;
}

/// Triangles of a list, strip or fan.
std::vector<int> unroll(const std::vector<int>& indices, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return indices;
  std::vector<int> out;
  for (std::size_t i = 2; i < indices.size(); ++i) {
    const bool is_odd = i % 2 == 1, is_fan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
    const int a = is_fan ? indices[0] : indices[is_odd ? i - 1 : i - 2];
    const int b = is_fan ? indices[i - 1] : indices[is_odd ? i - 2 : i - 1];
    out.insert(out.end(), {a, b, indices[i]});
  }
  return out;
}

Primitive Reader::read_plain(const tinygltf::Primitive& primitive) const {
  Primitive out;
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) return out;
  const std::vector<double> xyz = accessor_values(position->second, 3);
  for (std::size_t i = 0; i < xyz.size(); i += 3)
    out.points.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
  if (primitive.mode == TINYGLTF_MODE_POINTS) return out;
  std::vector<int> indices;
  if (primitive.indices >= 0)
    for (const double v : accessor_values(primitive.indices, 1))
      indices.push_back(v < static_cast<double>(out.points.size()) ? static_cast<int>(v)
                                                                   : static_cast<int>(-1));
  else
    for (std::size_t i = 0; i < out.points.size(); ++i) indices.push_back(static_cast<int>(i));
  const auto bad = std::find(indices.begin(), indices.end(), -1);
  if (bad != indices.end())
    fail("index " + std::to_string(bad - indices.begin()) + " names a vertex beyond " +
         std::to_string(out.points.size()));
  out.corners = unroll(indices, primitive.mode);
  out.corners.resize(out.corners.size() / 3 * 3);
  return out;
}

Matrix local_matrix(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return Eigen::Map<const Matrix>(node.matrix.data());
  Eigen::Affine3d t = Eigen::Affine3d::Identity();
  if (node.translation.size() == 3) t.translate(Vec3(node.translation.data()));
  if (node.rotation.size() == 4)
    t.rotate(
        Eigen::Quaterniond(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2])
            .normalized());
  if (node.scale.size() == 3) t.scale(Vec3(node.scale.data()));
  return t.matrix();
}

void Reader::add_mesh(RawFile& raw, const tinygltf::Mesh& mesh, const Matrix& matrix,
                      int part) const {
  const bool is_mirrored = matrix.topLeftCorner<3, 3>().determinant() < 0;
  for (const tinygltf::Primitive& p : mesh.primitives) {
    const int mode = p.mode < 0 ? TINYGLTF_MODE_TRIANGLES : p.mode;
    if (mode != TINYGLTF_MODE_POINTS && mode < TINYGLTF_MODE_TRIANGLES) continue;  // lines
    const auto draco = p.extensions.find(kDraco);
    const Primitive own =
        draco != p.extensions.end() ? read_draco(p, draco->second) : read_plain(p);
    const int base = static_cast<int>(raw.points.size());
    for (const Vec3& v : own.points) {
      const Vec3 w = (matrix * v.homogeneous()).head<3>();
      raw.points.emplace_back(w.x(), -w.z(), w.y());
    }
    for (std::size_t c = 0; c < own.corners.size(); c += 3) {
      raw.face_begin.push_back(static_cast<int>(raw.corners.size()));
      raw.face_part.push_back(part);
      for (int k = 0; k < 3; ++k)
        raw.corners.push_back(base +
                              own.corners[c + static_cast<std::size_t>(is_mirrored ? 2 - k : k)]);
    }
  }
}

void Reader::add_node(RawFile& raw, int index, const Matrix& parent, int part) {
  std::vector<std::pair<int, Matrix>> stack = {{index, parent}};
  while (!stack.empty()) {
    const auto [at_node, above] = stack.back();
    stack.pop_back();
    const tinygltf::Node& node = at(model_.nodes, at_node, "node");
    if (is_visited_[at_node]) fail("node " + std::to_string(at_node) + " hangs in two places");
    is_visited_[at_node] = 1;
    const Matrix matrix = above * local_matrix(node);
    if (node.mesh >= 0) add_mesh(raw, at(model_.meshes, node.mesh, "mesh"), matrix, part);
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
      stack.emplace_back(*child, matrix);
  }
}

/// The nodes of the scene that is shown; all of them when the file names no scene.
std::vector<int> Reader::top_nodes() const {
  if (!model_.scenes.empty())
    return at(model_.scenes, std::max(model_.defaultScene, 0), "scene").nodes;
  std::vector<char> is_child(model_.nodes.size(), 0);
  for (const tinygltf::Node& node : model_.nodes)
    for (const int child : node.children)
      if (child >= 0 && child < static_cast<int>(is_child.size())) is_child[child] = 1;
  std::vector<int> tops;
  for (std::size_t i = 0; i < is_child.size(); ++i)
    if (!is_child[i]) tops.push_back(static_cast<int>(i));
  return tops;
}

/// The node that MSFT_lod names for a node, that many levels down.
int Reader::coarser_node(int node, int levels) const {
  if (levels == 0) return node;
  const auto& extensions = at(model_.nodes, node, "node").extensions;
  const auto lod = extensions.find("MSFT_lod");
  if (lod == extensions.end() || !lod->second.Has("ids") ||
      static_cast<int>(lod->second.Get("ids").ArrayLen()) < levels)
    fail("has fewer levels of detail");
  return lod->second.Get("ids").Get(levels - 1).GetNumberAsInt();
}

RawFile Reader::read(int coarser) {
  RawFile raw;
  raw.is_soup = raw.is_turned = true;
  is_visited_.assign(model_.nodes.size(), 0);
  std::vector<int> tops = top_nodes();
  Matrix above = Matrix::Identity();
  for (std::size_t depth = 0; tops.size() == 1 && depth < model_.nodes.size(); ++depth) {
    const tinygltf::Node& node = at(model_.nodes, tops[0], "node");
    if (node.mesh >= 0 || node.children.empty()) break;
    above = above * local_matrix(node);  // a wrapper around the buildings
    tops = node.children;
  }
  for (int& top : tops) top = coarser_node(top, coarser);
  for (const int top : tops) {
    const std::string& name = at(model_.nodes, top, "node").name;
    raw.parts.push_back(name.empty() ? "node" + std::to_string(top) : name);
    add_node(raw, top, above, static_cast<int>(raw.parts.size()) - 1);
  }
  const tinygltf::Value& extras = model_.asset.extras;
  if (model_.asset.generator == "colod" && extras.Has("origin"))
    for (int k = 0; k < 3 && extras.Get("origin").ArrayLen() == 3; ++k)
      raw.origin[k] = extras.Get("origin").Get(k).GetNumberAsDouble();
  return raw;
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text.substr(0, 200);
}

/// tinygltf walks JSON recursively: what is nested absurdly deep would overflow its stack.
bool is_too_deep(std::string_view json) {
  int depth = 0;
  bool is_text = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (is_text && c == '\\') ++i;
    if (c == '"') is_text = !is_text;
    if (is_text) continue;
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (depth > kDeepestJson) return true;
  }
  return false;
}

/// The JSON of a file; checks a GLB's container.
std::string_view json_of(const std::string& path, std::string_view bytes, bool is_binary) {
  if (!is_binary) return bytes;
  std::uint32_t header[5];
  if (bytes.size() < sizeof header) fail(path, "truncated: a GLB header takes 20 bytes");
  std::memcpy(header, bytes.data(), sizeof header);
  if (header[1] != 2) fail(path, "GLB version " + std::to_string(header[1]) + ", only 2 is read");
  if (header[2] > bytes.size() || header[3] > bytes.size() - sizeof header)
    fail(path, "truncated: the header says " + std::to_string(header[2]) + " bytes, the file has " +
                   std::to_string(bytes.size()));
  return bytes.substr(sizeof header, header[3]);
}

/// The file as tinygltf can take it: without the index accessors of Draco primitives. They need no
/// buffer view, since the Draco stream holds the indices, but tinygltf 2.7 refuses such a file.
std::string without_draco_indices(const std::string& path, const std::string& bytes,
                                  std::string_view json, bool is_binary) {
  nlohmann::json document = nlohmann::json::parse(json, nullptr, false);
  if (document.is_discarded()) fail(path, "glTF: not JSON");
  bool is_changed = false;
  if (document.is_object() && document.contains("meshes") && document["meshes"].is_array())
    for (auto& mesh : document["meshes"]) {
      if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array())
        continue;
      for (auto& p : mesh["primitives"])
        if (p.is_object() && p.contains("extensions") && p["extensions"].is_object() &&
            p["extensions"].contains(kDraco))
          is_changed |= p.erase("indices") > 0;
    }
  if (!is_changed) return bytes;
  std::string text = document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (!is_binary) return text;
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t rest = std::min(bytes.size(), 20 + json.size());
  std::string result = bytes.substr(0, 20) + text + bytes.substr(rest);
  const auto put = [&result](std::size_t at, std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    std::memcpy(result.data() + at, &number, sizeof number);
  };
  put(8, result.size());
  put(12, text.size());
  return result;
}

bool keep_no_image(tinygltf::Image*, const int, std::string*, std::string*, int, int,
                   const unsigned char*, int, void*) {
  return true;
}

}  // namespace

RawFile read_gltf(const std::string& path, const std::string& file, int coarser) {
  const bool is_binary = file.compare(0, 4, "glTF") == 0;
  const std::string_view json = json_of(path, file, is_binary);
  if (is_too_deep(json)) fail(path, "JSON nested too deeply");
  const std::string bytes = without_draco_indices(path, file, json, is_binary);
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_no_image, nullptr);
  tinygltf::Model model;
  std::string error, warning;
  bool is_read = false;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const auto size = static_cast<unsigned>(bytes.size());
  try {
    is_read =
        is_binary
            ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(bytes.data()),
                                          size, folder)
            : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, folder);
  } catch (const std::exception& e) {
    error = e.what();
  }
  if (!is_read) fail(path, "glTF: " + (error.empty() ? "cannot be read" : one_line(error)));
  for (const std::string& extension : model.extensionsRequired)
    if (extension.find("meshopt") != extension.npos || extension == "EXT_mesh_gpu_instancing")
      fail(path, "needs " + extension + ", which is not read");
  return Reader(path, model).read(coarser);
}

}  // namespace colod::mesh_io
