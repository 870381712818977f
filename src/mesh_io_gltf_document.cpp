// Based on: glTF 2.0 (Khronos): GLB container, buffers and their URIs, extensionsRequired.
// Differs: no file outside the folder of the one that was named is opened, whatever a URI says.
#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "mesh_io_formats.h"
#include "mesh_io_gltf.h"

namespace colod::mesh_io {

namespace fs = std::filesystem;

namespace {

constexpr int kDeepestJson = 256;  // no writer nests deeper; lists of lists exhaust stacks
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

/// What the reader understands, and what changes no shape.
constexpr const char* kRead[] = {"KHR_draco_mesh_compression",
                                 "EXT_meshopt_compression",
                                 "KHR_meshopt_compression",
                                 "KHR_mesh_quantization",
                                 "EXT_mesh_gpu_instancing",
                                 "KHR_node_visibility",
                                 "CESIUM_RTC",
                                 "MSFT_lod"};
constexpr const char* kShapeless[] = {"KHR_materials_",
                                      "KHR_texture_",
                                      "EXT_texture_",
                                      "MSFT_texture_",
                                      "KHR_lights_",
                                      "EXT_lights_",
                                      "KHR_xmp",
                                      "KHR_animation",
                                      "KHR_audio",
                                      "KHR_interactivity",
                                      "EXT_mesh_features",
                                      "EXT_structural_metadata",
                                      "EXT_feature_metadata",
                                      "EXT_instance_features",
                                      "EXT_mesh_manifold",
                                      "FB_ngon_encoding",
                                      "CESIUM_primitive_outline",
                                      "KHR_techniques_webgl",
                                      "MSFT_packing_",
                                      "AGI_stk_metadata",
                                      "EXT_mesh_primitive_edge_visibility",
                                      "ADOBE_materials_",
                                      "EXT_property_",
                                      "KHR_physics"};

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

struct Chunks {
  std::string_view json;
  std::optional<std::string_view> binary;
};

Chunks take_apart(const std::string& path, std::string_view bytes) {
  if (bytes.substr(0, 4) != "glTF") return {bytes, {}};
  const auto number = [&](std::size_t at) {
    std::uint32_t value;
    if (bytes.size() < at + 4) fail(path, "truncated: a GLB header takes 20 bytes");
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  };
  if (number(4) != 2) fail(path, "GLB version " + std::to_string(number(4)) + ", only 2 is read");
  const auto chunk = [&](std::size_t at) {
    const std::size_t length = number(at);
    if (length > bytes.size() - at - 8)
      fail(path, "truncated: a chunk of " + std::to_string(length) + " bytes at byte " +
                     std::to_string(at) + " of " + std::to_string(bytes.size()));
    return bytes.substr(at + 8, length);
  };
  if (number(8) > bytes.size() || number(16) != kJsonChunk)
    fail(path, "truncated: the header says " + std::to_string(number(8)) + " bytes, the file has " +
                   std::to_string(bytes.size()));
  Chunks chunks{chunk(12), {}};
  const std::size_t next = 20 + chunks.json.size();
  if (next + 8 <= bytes.size() && number(next + 4) == kBinaryChunk) chunks.binary = chunk(next);
  return chunks;
}

std::string decode_base64(const std::string& path, std::string_view text) {
  std::string out;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    if (c == '=') break;
    const int value = c >= 'A' && c <= 'Z'   ? c - 'A'
                      : c >= 'a' && c <= 'z' ? c - 'a' + 26
                      : c >= '0' && c <= '9' ? c - '0' + 52
                      : c == '+'             ? 62
                      : c == '/'             ? 63
                                             : -1;
    if (value < 0) fail(path, "a data URI holds what is no base64");
    bits = (bits << 6) | static_cast<std::uint32_t>(value), held += 6;
    if (held < 8) continue;
    held -= 8;
    out += static_cast<char>((bits >> held) & 0xff);
  }
  return out;
}

std::string percent_decoded(std::string_view uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto digit = [&](std::size_t at) {
      const std::size_t value = std::string_view("0123456789abcdef0123456789ABCDEF").find(uri[at]);
      return value == std::string_view::npos ? -1 : static_cast<int>(value % 16);
    };
    const bool is_code =
        uri[i] == '%' && i + 2 < uri.size() && digit(i + 1) >= 0 && digit(i + 2) >= 0;
    out += is_code ? static_cast<char>(16 * digit(i + 1) + digit(i + 2)) : uri[i];
    if (is_code) i += 2;
  }
  return out;
}

/// The bytes of a file at or below the folder of `path`.
std::string read_beside(const std::string& path, const std::string& uri) {
  const std::string shown = "'" + uri.substr(0, 80) + "'";
  const fs::path relative = percent_decoded(uri);
  const bool is_outside = relative.is_absolute() || uri.find(':') != uri.npos ||
                          uri.find('\\') != uri.npos ||
                          std::find(relative.begin(), relative.end(), "..") != relative.end();
  if (is_outside) fail(path, "names " + shown + ", outside of its folder, which is not read");
  std::error_code error;
  const fs::path folder = fs::canonical(fs::absolute(path).parent_path(), error);
  const fs::path file = fs::canonical(folder / relative, error);
  if (error || !fs::is_regular_file(file, error))
    fail(path, "names " + shown + ", which is no file beside it");
  const auto [end, at] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  if (end != folder.end())
    fail(path, "names " + shown + ", a link out of its folder, which is not read");
  if (fs::file_size(file, error) > (std::uintmax_t{1} << 31) || error)
    fail(path, "names " + shown + ", larger than 2 GiB");
  std::ifstream in(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (!in) fail(path, "names " + shown + ", which cannot be read");
  return bytes;
}

std::string buffer_bytes(const std::string& path, const Json& buffer, std::size_t index,
                         const Chunks& chunks) {
  if (!buffer.contains("uri"))
    return index == 0 && chunks.binary ? std::string(*chunks.binary) : std::string();
  const std::string uri = buffer["uri"];
  if (!uri.starts_with("data:")) return read_beside(path, uri);
  const std::size_t comma = uri.find(',');
  if (comma == uri.npos || !std::string_view(uri).substr(0, comma).ends_with(";base64"))
    fail(path, "buffer " + std::to_string(index) + " is a data URI that is no base64");
  return decode_base64(path, std::string_view(uri).substr(comma + 1));
}

bool is_read(const std::string& extension) {
  return std::find(std::begin(kRead), std::end(kRead), extension) != std::end(kRead);
}

bool is_shapeless(const std::string& extension) {
  return std::any_of(std::begin(kShapeless), std::end(kShapeless),
                     [&](const char* start) { return extension.starts_with(start); });
}

std::vector<std::string> names(const Json& json, const char* key) {
  return json.contains(key) ? json[key].get<std::vector<std::string>>()
                            : std::vector<std::string>();
}

void check_extensions(const std::string& path, GltfDocument& document) {
  const std::vector<std::string> required = names(document.json, "extensionsRequired");
  for (const std::string& extension : required)
    if (!is_read(extension) && !is_shapeless(extension))
      fail(path, "needs the extension " + extension.substr(0, 80) +
                     ", which is not read: write the file without it");
  for (const std::string& extension : names(document.json, "extensionsUsed"))
    if (!is_read(extension) && !is_shapeless(extension))
      document.warnings.push_back("uses the extension " + extension.substr(0, 80) +
                                  ", which is not read: shapes may differ from what it says");
}

/// What the layers will not show.
void note_losses(GltfDocument& document) {
  const auto has = [&](const char* key) {
    return document.json.contains(key) && !document.json[key].empty();
  };
  const std::size_t materials = has("materials") ? document.json["materials"].size() : 0;
  if (has("textures") || has("images"))
    document.warnings.push_back(
        "its textures and materials are left out: layers are of one plain colour");
  else if (materials > 1)
    document.warnings.push_back("its " + std::to_string(materials) +
                                " materials are left out: layers are of one plain colour");
  if (has("skins"))
    document.warnings.push_back("has skins, which are not read: shapes are those at rest");
}

}  // namespace

GltfDocument open_gltf(const std::string& path, std::string_view bytes) {
  const Chunks chunks = take_apart(path, bytes);
  if (is_too_deep(chunks.json)) fail(path, "JSON nested too deeply");
  GltfDocument document;
  document.json = Json::parse(chunks.json, nullptr, false);
  if (!document.json.is_object()) fail(path, "glTF: not JSON");
  const Json asset = document.json.value("asset", Json::object());
  if (const std::string version = asset.value("version", "2.0"); !version.starts_with("2"))
    fail(path, "glTF version " + version.substr(0, 20) + ", only 2 is read");
  check_extensions(path, document);
  note_losses(document);
  if (!document.json.contains("buffers")) return document;
  std::size_t index = 0;
  for (const Json& buffer : document.json["buffers"])
    document.buffers.push_back(buffer_bytes(path, buffer, index++, chunks));
  return document;
}

}  // namespace colod::mesh_io
