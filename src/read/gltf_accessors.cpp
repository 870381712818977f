// Based on: glTF 2.0 (accessors, sparse ones too), KHR_draco_mesh_compression,
// EXT_meshopt_compression and KHR_meshopt_compression, KHR_mesh_quantization.
// Differs: every index, offset and count is checked before it is used. Of a Draco or meshopt stream
// only what the shape needs is decoded.
#include <draco/compression/decode.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/meshopt.h"
#include "formats.h"
#include "gltf.h"

namespace colod::mesh_io {

namespace {

constexpr double kFreeCorners = 6000;        // a MiB: all rooms take some 100 bytes a corner
constexpr std::size_t kCornersPerByte = 16;  // Draco's best is about 10
constexpr std::size_t kMeshoptGain = 64;     // 16 bytes may take 2 bits: no stream unpacks to more
constexpr double kMostExact = 9007199254740992;  // 2^53

using tinygltf::Value;

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

/// Bytes; 0: no type of the format. tinygltf knows two more, int and double.
std::size_t size_of_component(int type) {
  if (type == TINYGLTF_COMPONENT_TYPE_INT || type == TINYGLTF_COMPONENT_TYPE_DOUBLE) return 0;
  const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type));
  return static_cast<std::size_t>(std::max(size, 0));
}

/// Numbers that lie `stride` bytes apart in `bytes`; false: not that many are there.
bool take_numbers(std::string_view bytes, std::size_t offset, std::size_t stride, std::size_t count,
                  int components, int type, bool is_normalized, std::vector<double>& values) {
  const std::size_t size = size_of_component(type);
  const std::size_t element = size * static_cast<std::size_t>(components);
  if (stride == 0) stride = element;
  if (count == 0) return true;
  if (offset > bytes.size() || bytes.size() - offset < element ||
      count - 1 > (bytes.size() - offset - element) / stride)
    return false;
  values.reserve(count * static_cast<std::size_t>(components));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < static_cast<std::size_t>(components); ++c)
      values.push_back(
          component(bytes.data() + offset + i * stride + c * size, type, is_normalized));
  return true;
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

/// A member that is a whole number, or `none` where it is absent.
std::size_t size_of(const GltfReader& reader, const Value& object, const char* key,
                    std::size_t none = 0) {
  if (!object.Has(key)) return none;
  const Value& member = object.Get(key);
  const double value = member.IsNumber() ? member.GetNumberAsDouble() : -1;
  if (!(value >= 0) || value > kMostExact || value != std::floor(value))
    reader.fail(std::string("'") + key + "' is no whole number");
  return static_cast<std::size_t>(value);
}

std::string text_of(const Value& object, const char* key, const char* none) {
  return object.Has(key) && object.Get(key).IsString() ? object.Get(key).Get<std::string>() : none;
}

}  // namespace

const Value* extension_of(const tinygltf::ExtensionMap& extensions, const char* name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? nullptr : &found->second;
}

GltfReader::GltfReader(const std::string& path, const tinygltf::Model& model, double input_memory)
    : path_(path),
      model_(model),
      free_corners_(static_cast<std::size_t>(kFreeCorners * input_memory)),
      budget_(free_corners_) {
  for (const tinygltf::Buffer& buffer : model.buffers)
    budget_ += kCornersPerByte * buffer.data.size();
}

void GltfReader::fail(const std::string& cause) const { mesh_io::fail(path_, cause); }

int GltfReader::integer(const Value& object, const char* key, int none) const {
  if (!object.Has(key)) return none;
  const std::size_t value = size_of(*this, object, key);
  if (value > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    fail(std::string("'") + key + "' is too large");
  return static_cast<int>(value);
}

std::vector<double> GltfReader::numbers(const Value& object, const char* key) const {
  std::vector<double> out;
  if (!object.Has(key)) return out;
  const Value& list = object.Get(key);
  for (std::size_t i = 0; i < list.ArrayLen(); ++i) {
    const Value& number = list.Get(static_cast<int>(i));
    if (!number.IsNumber()) fail(std::string("'") + key + "' lists what is no number");
    out.push_back(number.GetNumberAsDouble());
  }
  return out;
}

void GltfReader::spend(std::size_t points_and_corners) {
  if (points_and_corners > budget_)
    fail("its meshes stand in so many places that they come to over " +
         std::to_string(free_corners_) +
         " corners, more than --input-memory allows: place fewer, or split the file");
  budget_ -= points_and_corners;
}

std::string_view GltfReader::slice(int buffer, std::size_t offset, std::size_t length,
                                   const std::string& place) const {
  const std::vector<unsigned char>& data = at(model_.buffers, buffer, "buffer").data;
  if (offset > data.size() || length > data.size() - offset)
    fail(place + " reaches beyond its buffer");
  return {reinterpret_cast<const char*>(data.data()) + offset, length};
}

GltfReader::View GltfReader::unpack(int index, const Value& extension) const {
  const std::string place = "buffer view " + std::to_string(index);
  const std::string_view payload =
      slice(integer(extension, "buffer"), size_of(*this, extension, "byteOffset"),
            size_of(*this, extension, "byteLength"), place);
  const std::size_t count = size_of(*this, extension, "count");
  const std::size_t stride = size_of(*this, extension, "byteStride");
  const std::string mode = text_of(extension, "mode", "");
  const std::string filter = text_of(extension, "filter", "NONE");
  if (stride == 0 || stride > 256 || count > kMeshoptGain * (payload.size() + 64) / stride)
    fail(place + ": meshopt data that cannot be as long as they say");
  if (!payload.empty() && (payload[0] & 0x0f) > (mode == "ATTRIBUTES" ? 0 : 1))
    fail(place + ": meshopt data of version " + std::to_string(payload[0] & 0x0f) +
         ", which is not read: write them for EXT_meshopt_compression");
  View view{{}, decode_meshopt(payload, count, stride, mode, filter), stride};
  if (view.unpacked.size() != count * stride)
    fail(place + ": meshopt data are damaged, or of mode '" + mode.substr(0, 20) +
         "' and filter '" + filter.substr(0, 20) + "'");
  return view;
}

GltfReader::View GltfReader::view(int index) const {
  const tinygltf::BufferView& v = at(model_.bufferViews, index, "buffer view");
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    if (const Value* extension = extension_of(v.extensions, name)) return unpack(index, *extension);
  const std::string place = "buffer view " + std::to_string(index);
  return {slice(v.buffer, v.byteOffset, v.byteLength, place), {}, v.byteStride};
}

/// Puts the values of a sparse accessor at their places.
void GltfReader::replace_sparse(const tinygltf::Accessor& a, int components,
                                const std::string& place, std::vector<double>& values) const {
  const auto unsigned_size = [](int n) {  // what is negative lies beyond every view
    return n < 0 ? std::numeric_limits<std::size_t>::max() : static_cast<std::size_t>(n);
  };
  const std::size_t count = unsigned_size(a.sparse.count);
  const int index_type = a.sparse.indices.componentType;
  std::vector<double> indices, replaced;
  const bool is_index =
      size_of_component(index_type) > 0 && index_type != TINYGLTF_COMPONENT_TYPE_FLOAT;
  if (!is_index ||
      !take_numbers(view(a.sparse.indices.bufferView).bytes(),
                    unsigned_size(a.sparse.indices.byteOffset), 0, count, 1, index_type, false,
                    indices) ||
      !take_numbers(view(a.sparse.values.bufferView).bytes(),
                    unsigned_size(a.sparse.values.byteOffset), 0, count, components,
                    a.componentType, a.normalized, replaced))
    fail(place + ": its sparse part reaches beyond its buffer view");
  const auto width = static_cast<std::size_t>(components);
  for (std::size_t i = 0; i < count; ++i) {
    if (!(indices[i] >= 0) || indices[i] >= static_cast<double>(values.size() / width))
      fail(place + ": its sparse part names element " + std::to_string(std::lround(indices[i])) +
           " of " + std::to_string(values.size() / width));
    std::copy_n(replaced.begin() + static_cast<std::ptrdiff_t>(i * width), width,
                values.begin() + static_cast<std::ptrdiff_t>(indices[i]) * components);
  }
}

std::vector<double> GltfReader::values(int accessor, int components) const {
  const tinygltf::Accessor& a = at(model_.accessors, accessor, "accessor");
  const std::string place = "accessor " + std::to_string(accessor);
  if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a.type)) != components ||
      size_of_component(a.componentType) == 0)
    fail(place + " has a type that does not belong there");
  std::vector<double> values;
  if (a.bufferView >= 0) {
    const View seen = view(a.bufferView);
    if (!take_numbers(seen.bytes(), a.byteOffset, seen.stride, a.count, components, a.componentType,
                      a.normalized, values))
      fail(place + " reaches beyond its buffer view (truncated)");
  } else {
    if (a.count > budget_) fail(place + " has more elements than the file could hold");
    values.assign(a.count * static_cast<std::size_t>(components), 0.0);
  }
  if (a.sparse.isSparse) replace_sparse(a, components, place, values);
  return values;
}

namespace {

Rgb rgb_of_linear(const double* rgb) {
  Rgb out;
  for (int k = 0; k < 3; ++k) out[k] = to_srgb(static_cast<float>(std::clamp(rgb[k], 0.0, 1.0)));
  return out;
}

/// All values of an attribute of a decoded stream, `components` each; empty: it has none of the id.
std::vector<double> draco_values(const draco::Mesh& mesh, int id, int components) {
  std::vector<double> values;
  const draco::PointAttribute* attribute =
      id < 0 ? nullptr : mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
  if (!attribute) return values;
  // Whole numbers stand for 0 … 1, which accessors of colours and coordinates call normalized.
  const double most = attribute->data_type() == draco::DT_UINT8    ? 255
                      : attribute->data_type() == draco::DT_UINT16 ? 65535
                                                                   : 1;
  for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
    std::array<double, 4> v{};
    const draco::AttributeValueIndex value = attribute->mapped_index(p);
    if (value.value() >= attribute->size() ||
        !attribute->ConvertValue<double>(value, static_cast<std::int8_t>(components), v.data()))
      return {};
    for (int c = 0; c < components; ++c) values.push_back(v[static_cast<std::size_t>(c)] / most);
  }
  return values;
}

std::vector<Vec2f> as_uvs(const std::vector<double>& values) {
  std::vector<Vec2f> out;
  for (std::size_t i = 0; i + 1 < values.size(); i += 2)
    out.push_back(Vec2(values[i], values[i + 1]).cast<float>());
  return out;
}

std::vector<Rgb> as_colors(const std::vector<double>& values, std::size_t components) {
  std::vector<Rgb> out;
  for (std::size_t i = 0; i + 2 < values.size(); i += components)
    out.push_back(rgb_of_linear(&values[i]));
  return out;
}

}  // namespace

GltfPrimitive GltfReader::draco(const Value& extension, int uv_set) const {
  const View seen = view(integer(extension, "bufferView"));
  draco::DecoderBuffer buffer;
  buffer.Init(seen.bytes().data(), seen.bytes().size());
  draco::Decoder decoder;
  const auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) fail("Draco: " + decoded.status().error_msg_string());
  const draco::Mesh& mesh = *decoded.value();
  const int id =
      extension.Has("attributes") ? integer(extension.Get("attributes"), "POSITION") : -1;
  const draco::PointAttribute* position =
      mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
  if (!position || position->num_components() != 3) fail("Draco: no positions under the given id");
  GltfPrimitive out;
  for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
    double v[3] = {NAN, NAN, NAN};
    const draco::AttributeValueIndex value = position->mapped_index(p);
    if (value.value() >= position->size() || !position->ConvertValue<double, 3>(value, v))
      fail("Draco: point " + std::to_string(p.value()) + " has no position");
    out.points.emplace_back(v[0], v[1], v[2]);
  }
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
    for (int c = 0; c < 3; ++c) out.corners.push_back(static_cast<int>(mesh.face(f)[c].value()));
  const Value& attributes = extension.Get("attributes");
  const std::string uvs = "TEXCOORD_" + std::to_string(uv_set);
  out.uvs = as_uvs(draco_values(mesh, integer(attributes, uvs.c_str()), 2));
  out.colors = as_colors(draco_values(mesh, integer(attributes, "COLOR_0"), 3), 3);
  return out;
}

/// Texture coordinates and colours; what is wrong with them leaves shapes as they are.
void GltfReader::add_look(const tinygltf::Primitive& primitive, int uv_set,
                          GltfPrimitive& out) const {
  try {
    const auto uvs = primitive.attributes.find("TEXCOORD_" + std::to_string(uv_set));
    if (uvs != primitive.attributes.end()) out.uvs = as_uvs(values(uvs->second, 2));
    const auto colors = primitive.attributes.find("COLOR_0");
    if (colors != primitive.attributes.end()) {
      const bool has_alpha =
          at(model_.accessors, colors->second, "accessor").type == TINYGLTF_TYPE_VEC4;
      out.colors = as_colors(values(colors->second, has_alpha ? 4 : 3), has_alpha ? 4 : 3);
    }
  } catch (const Error&) {
    out.uvs.clear(), out.colors.clear();
  }
}

GltfPrimitive GltfReader::primitive(const tinygltf::Primitive& primitive, int uv_set) const {
  GltfPrimitive out;
  const int mode = primitive.mode;
  if (mode != TINYGLTF_MODE_POINTS && mode < TINYGLTF_MODE_TRIANGLES) return out;  // lines
  if (const Value* extension = extension_of(primitive.extensions, "KHR_draco_mesh_compression"))
    return draco(*extension, uv_set);
  const auto named = primitive.attributes.find("POSITION");
  const int position = named == primitive.attributes.end() ? -1 : named->second;
  if (position < 0) return out;
  const std::vector<double> xyz = values(position, 3);
  for (std::size_t i = 0; i < xyz.size(); i += 3)
    out.points.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
  if (mode == TINYGLTF_MODE_POINTS) return out;
  add_look(primitive, uv_set, out);
  std::vector<int> indices(out.points.size());
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<int>(i);
  if (primitive.indices >= 0) {
    indices.clear();
    for (const double v : values(primitive.indices, 1)) {
      if (!(v >= 0) || v >= static_cast<double>(out.points.size()))
        fail("index " + std::to_string(indices.size()) + " names a vertex beyond " +
             std::to_string(out.points.size()));
      indices.push_back(static_cast<int>(v));
    }
  }
  out.corners = unroll(indices, mode);
  out.corners.resize(out.corners.size() / 3 * 3);
  return out;
}

}  // namespace colod::mesh_io
