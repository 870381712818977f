// Based on: glTF 2.0 (accessors, sparse ones too), KHR_draco_mesh_compression,
// EXT_meshopt_compression and KHR_meshopt_compression, KHR_mesh_quantization.
// Differs: every index, offset and count is checked before it is used. Of a Draco or meshopt stream
// only what the shape needs is decoded.
#include <draco/compression/decode.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "../exporters/meshopt.h"
#include "mesh_io_formats.h"
#include "mesh_io_gltf.h"

namespace colod::mesh_io {

namespace {

constexpr std::size_t kFreeCorners = 12'000'000;  // 4 million triangles, some 1 GiB in all rooms
constexpr std::size_t kCornersPerByte = 16;       // Draco's best is about 10
constexpr std::size_t kMeshoptGain = 64;  // 16 bytes may take 2 bits: no stream unpacks to more
constexpr double kMostExact = 9007199254740992;  // 2^53

enum ComponentType {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126
};
enum Mode { kPoints = 0, kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6 };

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
    case kByte:
      return as_double<std::int8_t>(bytes, is_normalized);
    case kUnsignedByte:
      return as_double<std::uint8_t>(bytes, is_normalized);
    case kShort:
      return as_double<std::int16_t>(bytes, is_normalized);
    case kUnsignedShort:
      return as_double<std::uint16_t>(bytes, is_normalized);
    case kUnsignedInt:
      return as_double<std::uint32_t>(bytes, is_normalized);
    default:
      return as_double<float>(bytes, false);
  }
}

/// Bytes; 0: no such type.
std::size_t size_of_component(int type) {
  switch (type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

int components_of(const std::string& type) {
  return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
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
  if (mode == kTriangles) return indices;
  std::vector<int> out;
  for (std::size_t i = 2; i < indices.size(); ++i) {
    const bool is_odd = i % 2 == 1, is_fan = mode == kTriangleFan;
    const int a = is_fan ? indices[0] : indices[is_odd ? i - 1 : i - 2];
    const int b = is_fan ? indices[i - 1] : indices[is_odd ? i - 2 : i - 1];
    out.insert(out.end(), {a, b, indices[i]});
  }
  return out;
}

const Json* extension_of(const Json& object, const char* name) {
  const auto list = object.find("extensions");
  if (list == object.end() || !list->is_object()) return nullptr;
  const auto found = list->find(name);
  return found == list->end() ? nullptr : &*found;
}

}  // namespace

GltfReader::GltfReader(const std::string& path, const GltfDocument& document)
    : path_(path), document_(document), budget_(kFreeCorners) {
  for (const std::string& buffer : document.buffers) budget_ += kCornersPerByte * buffer.size();
}

void GltfReader::fail(const std::string& cause) const { mesh_io::fail(path_, cause); }

std::size_t GltfReader::count(const char* list) const {
  const auto found = json().find(list);
  return found != json().end() && found->is_array() ? found->size() : 0;
}

const Json& GltfReader::at(const char* list, int i, const char* what) const {
  if (i < 0 || static_cast<std::size_t>(i) >= count(list))
    fail(std::string(what) + " " + std::to_string(i) + " of " + std::to_string(count(list)) +
         " is named but missing");
  return json()[list][static_cast<std::size_t>(i)];
}

std::size_t GltfReader::size_of(const Json& object, const char* key, std::size_t none) const {
  const auto found = object.find(key);
  if (found == object.end()) return none;
  const double value = found->is_number() ? found->get<double>() : -1;
  if (!(value >= 0) || value > kMostExact || value != std::floor(value))
    fail(std::string("'") + key + "' is no whole number");
  return static_cast<std::size_t>(value);
}

int GltfReader::integer(const Json& object, const char* key, int none) const {
  if (!object.contains(key)) return none;
  const std::size_t value = size_of(object, key, 0);
  if (value > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    fail(std::string("'") + key + "' is too large");
  return static_cast<int>(value);
}

void GltfReader::spend(std::size_t points_and_corners) {
  if (points_and_corners > budget_)
    fail("its meshes stand in so many places that they come to over " +
         std::to_string(kFreeCorners / 1'000'000) +
         " million corners: place fewer, or split the file");
  budget_ -= points_and_corners;
}

/// The bytes that `buffer`, `byteOffset` and `byteLength` of a view or an extension name.
std::string_view GltfReader::slice(const Json& holder, const std::string& place) const {
  const int buffer = integer(holder, "buffer");
  at("buffers", buffer, "buffer");
  const std::string& data = document_.buffers[buffer];
  const std::size_t offset = size_of(holder, "byteOffset", 0);
  const std::size_t length = size_of(holder, "byteLength", 0);
  if (offset > data.size() || length > data.size() - offset)
    fail(place + " reaches beyond its buffer");
  return std::string_view(data).substr(offset, length);
}

GltfReader::View GltfReader::unpack(int index, const Json& extension) const {
  const std::string place = "buffer view " + std::to_string(index);
  const std::string_view payload = slice(extension, place);
  const std::size_t count = size_of(extension, "count", 0);
  const std::size_t stride = size_of(extension, "byteStride", 0);
  const std::string mode = extension.value("mode", ""), filter = extension.value("filter", "NONE");
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
  const Json& v = at("bufferViews", index, "buffer view");
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    if (const Json* extension = extension_of(v, name)) return unpack(index, *extension);
  return {slice(v, "buffer view " + std::to_string(index)), {}, size_of(v, "byteStride", 0)};
}

/// Puts the values of a sparse accessor at their places.
void GltfReader::replace_sparse(const Json& sparse, int component_type, int components,
                                bool is_normalized, const std::string& place,
                                std::vector<double>& values) const {
  const std::size_t count = size_of(sparse, "count", 0);
  const Json &at = sparse.at("indices"), &from = sparse.at("values");
  const int index_type = integer(at, "componentType");
  std::vector<double> indices, replaced;
  const bool is_index = size_of_component(index_type) > 0 && index_type != kFloat;
  if (!is_index ||
      !take_numbers(view(integer(at, "bufferView")).bytes(), size_of(at, "byteOffset", 0), 0, count,
                    1, index_type, false, indices) ||
      !take_numbers(view(integer(from, "bufferView")).bytes(), size_of(from, "byteOffset", 0), 0,
                    count, components, component_type, is_normalized, replaced))
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
  const Json& a = at("accessors", accessor, "accessor");
  const std::string place = "accessor " + std::to_string(accessor);
  const int type = integer(a, "componentType");
  const std::size_t count = size_of(a, "count", 0);
  const bool is_normalized = a.value("normalized", false);
  if (components_of(a.value("type", "")) != components || size_of_component(type) == 0)
    fail(place + " has a type that does not belong there");
  std::vector<double> values;
  if (a.contains("bufferView")) {
    const View seen = view(integer(a, "bufferView"));
    if (!take_numbers(seen.bytes(), size_of(a, "byteOffset", 0), seen.stride, count, components,
                      type, is_normalized, values))
      fail(place + " reaches beyond its buffer view (truncated)");
  } else {
    if (count > budget_) fail(place + " has more elements than the file could hold");
    values.assign(count * static_cast<std::size_t>(components), 0.0);
  }
  if (a.contains("sparse"))
    replace_sparse(a["sparse"], type, components, is_normalized, place, values);
  return values;
}

GltfPrimitive GltfReader::draco(const Json& extension) const {
  const View seen = view(integer(extension, "bufferView"));
  draco::DecoderBuffer buffer;
  buffer.Init(seen.bytes().data(), seen.bytes().size());
  draco::Decoder decoder;
  const auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) fail("Draco: " + decoded.status().error_msg_string());
  const draco::Mesh& mesh = *decoded.value();
  const int id = integer(extension.value("attributes", Json::object()), "POSITION");
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
  return out;
}

GltfPrimitive GltfReader::primitive(const Json& primitive) const {
  GltfPrimitive out;
  const int mode = integer(primitive, "mode", kTriangles);
  if (mode != kPoints && mode < kTriangles) return out;  // lines
  if (const Json* extension = extension_of(primitive, "KHR_draco_mesh_compression"))
    return draco(*extension);
  const int position = integer(primitive.value("attributes", Json::object()), "POSITION");
  if (position < 0) return out;
  const std::vector<double> xyz = values(position, 3);
  for (std::size_t i = 0; i < xyz.size(); i += 3)
    out.points.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
  if (mode == kPoints) return out;
  std::vector<int> indices(out.points.size());
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<int>(i);
  if (const int accessor = integer(primitive, "indices"); accessor >= 0) {
    indices.clear();
    for (const double v : values(accessor, 1)) {
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
