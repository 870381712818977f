// Based on: glTF 2.0, EXT_meshopt_compression.
// Differs: reads what colod writes; other layouts are faults.
#include "accessors.h"

#include <cstring>
#include <stdexcept>

#include "core/meshopt.h"
#include "files.h"

namespace colod {

using Json = nlohmann::json;

namespace {

constexpr std::size_t kMostWork = 20'000'000;  // some seconds, and below 1 GiB of numbers
constexpr std::size_t kBestMeshopt = 64;       // of meshopt's codecs of version 0, slack for heads

struct View {
  std::string bytes;
  std::size_t stride = 0;  // 0: tight
};

View read_packed(CheckedGlb& glb, const Json& packed) {
  const std::string payload = slice(glb, packed);
  const std::size_t count = whole_number(packed.at("count"));
  const std::size_t stride = whole_number(packed.at("byteStride"));
  const bool is_index = packed.at("mode") == "TRIANGLES";
  const std::size_t most = kBestMeshopt * payload.size() + 1024;
  const bool is_possible =
      is_index ? count % 3 == 0 : stride > 0 && stride <= 256 && stride % 4 == 0;
  if (!is_possible || count > most || count * (is_index ? 4 : stride) > most)
    throw std::out_of_range("a meshopt stream cannot hold what it states");
  glb.spend(count);
  View out{{}, is_index ? 4 : stride};
  if (is_index) {
    for (const std::uint32_t i : decode_meshopt_indices(payload, count))
      out.bytes.append(reinterpret_cast<const char*>(&i), 4);
  } else {
    out.bytes = decode_meshopt_vertices(payload, count, stride);
  }
  if (out.bytes.empty()) throw std::out_of_range("a meshopt stream does not decode");
  return out;
}

View read_view(CheckedGlb& glb, const Json& index) {
  const Json& view = glb.json.at("bufferViews").at(whole_number(index));
  const auto extensions = view.find("extensions");
  if (extensions != view.end() && extensions->contains("EXT_meshopt_compression"))
    return read_packed(glb, extensions->at("EXT_meshopt_compression"));
  return {slice(glb, view), whole_number_of(view, "byteStride")};
}

/// Throws std::out_of_range for what is no component type.
std::size_t size_of(std::size_t type) {
  if (type < 5120 || type > 5126 || type == 5124)
    throw std::out_of_range("an accessor's component type is none of glTF's");
  return type <= 5121 ? 1 : type <= 5123 ? 2 : 4;
}

}  // namespace

void CheckedGlb::spend(std::size_t steps) {
  work += steps;
  if (work > kMostWork || steps > kMostWork)
    throw std::length_error("asks for more than a client could show; the rest is not checked");
}

std::uint32_t u32_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

bool open_container(CheckedGlb& glb, const std::string& bytes) {
  const auto fail = [&](const char* cause) {
    glb.report("glb-container", "", cause);
    return false;
  };
  if (bytes.size() < 20 || bytes.compare(0, 4, "glTF") != 0 || u32_at(bytes, 4) != 2)
    return fail("not a binary glTF 2.0");
  if (u32_at(bytes, 8) != bytes.size()) return fail("the header's length is not the file's");
  const std::size_t length = u32_at(bytes, 12);
  if (bytes.compare(16, 4, "JSON") != 0 || length > bytes.size() - 20)
    return fail("the first chunk is not JSON, or longer than the file");
  glb.json = parse_json(bytes.substr(20, length));
  if (!glb.json.is_object()) return fail("the JSON chunk does not parse");
  const std::size_t bin = 20 + length;
  if (bin + 8 > bytes.size()) return true;
  if (bytes.compare(bin + 4, 4, std::string("BIN\0", 4)) != 0 ||
      u32_at(bytes, bin) > bytes.size() - bin - 8)
    return fail("the second chunk is not BIN, or longer than the file");
  glb.binary = bytes.substr(bin + 8, u32_at(bytes, bin));
  return true;
}

std::size_t whole_number(const Json& json) {
  if (!json.is_number_unsigned())
    throw std::out_of_range("an index, offset, stride or count is no whole number from 0 on");
  return json.get<std::size_t>();
}

std::size_t whole_number_of(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() ? 0 : whole_number(*found);
}

std::string slice(const CheckedGlb& glb, const Json& range) {
  const std::size_t offset = whole_number_of(range, "byteOffset");
  const std::size_t length = whole_number(range.at("byteLength"));
  if (whole_number_of(range, "buffer") != 0 || offset > glb.binary.size() ||
      length > glb.binary.size() - offset)
    throw std::out_of_range("a buffer view lies outside the BIN chunk");
  return glb.binary.substr(offset, length);
}

double element_at(const std::string& bytes, std::size_t at, int type) {
  const auto get = [&](auto value) {
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return static_cast<double>(value);
  };
  switch (type) {
    case 5120:
      return get(std::int8_t{});
    case 5121:
      return get(std::uint8_t{});
    case 5122:
      return get(std::int16_t{});
    case 5123:
      return get(std::uint16_t{});
    case 5125:
      return get(std::uint32_t{});
    default:
      return get(float{});
  }
}

std::vector<double> read_accessor(CheckedGlb& glb, const Json& accessor, std::size_t components) {
  const std::size_t count = whole_number(accessor.at("count"));
  glb.spend(count);
  const View view = read_view(glb, accessor.at("bufferView"));
  const std::size_t stated = whole_number(accessor.at("componentType"));
  const std::size_t size = size_of(stated), tight = size * components;
  const int type = static_cast<int>(stated);
  const std::size_t stride = view.stride ? view.stride : tight, room = view.bytes.size();
  const std::size_t offset = whole_number_of(accessor, "byteOffset");
  if (count == 0 || stride < tight || tight > room || offset > room - tight ||
      count - 1 > (room - tight - offset) / stride)
    throw std::out_of_range("an accessor reaches beyond its buffer view");
  const double scale = !accessor.value("normalized", false) ? 1 : type == 5120 ? 127 : 255;
  std::vector<double> out;
  out.reserve(count * components);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < components; ++k)
      out.push_back(element_at(view.bytes, offset + i * stride + k * size, type) / scale);
  return out;
}

}  // namespace colod
