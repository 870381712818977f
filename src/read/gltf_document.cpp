// Based on: glTF 2.0 (Khronos); tinygltf takes container, buffers, URIs and lists apart.
// Differs: no file outside the folder of the one that was named is opened, whatever a URI says.
// The JSON is read once before tinygltf reads it, since tinygltf 2.7 refuses what the format allows
// (buffers without bytes, Draco indices without a view, files longer than their buffer), reads
// images, takes an offset that is no number for 0, and reads beyond a chunk that ends too late.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "formats.h"
#include "gltf.h"

namespace colod::mesh_io {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

constexpr int kDeepestJson = 256;  // no writer nests deeper; lists of lists exhaust stacks
constexpr std::size_t kMostObjects = 4'000'000;  // half a million buildings; some 700 bytes each
constexpr std::size_t kMostValues = 10 * kMostObjects;  // some 150 bytes each
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr const char* kDataUri = "data:application/octet-stream;base64,";

/// The lists that shapes are made of. Others are kept from tinygltf: it would open the files of
/// images, and refuse a file for a fault in a light.
constexpr const char* kShapes[] = {"asset",  "scene",     "scenes",      "nodes",
                                   "meshes", "accessors", "bufferViews", "buffers"};
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

/// What must be known before anything is parsed: parsers recurse, and tinygltf's objects are large.
void check_json(const std::string& path, std::string_view json) {
  int depth = 0;
  std::size_t objects = 0, values = 0;
  bool is_text = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (is_text && c == '\\') ++i;
    if (c == '"') is_text = !is_text;
    if (is_text) continue;
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (depth > kDeepestJson) fail(path, "JSON nested too deeply");
    if (c == '{') ++objects;
    if (c == ',') ++values;
  }
  if (objects > kMostObjects || values > kMostValues)
    fail(path, "JSON of more than " + std::to_string(kMostObjects / 1'000'000) +
                   " million objects: split the file");
}

struct Chunks {
  std::string_view json, binary;  // of binary 0 bytes: there is none
};

/// KHR_binary_glTF of glTF 1.0: a header of 20 bytes, JSON, and the buffer.
Chunks take_old_apart(const std::string& path, std::string_view bytes, std::size_t all,
                      std::size_t json) {
  constexpr std::size_t header = 20;
  if (all > bytes.size() || all < header || json > all - header)
    fail(path, "truncated: the header says " + std::to_string(all) + " bytes, the file has " +
                   std::to_string(bytes.size()));
  return {bytes.substr(header, json), bytes.substr(header + json, all - header - json)};
}

Chunks take_apart(const std::string& path, std::string_view bytes) {
  if (bytes.substr(0, 4) != "glTF") return {bytes, {}};
  const auto number = [&](std::size_t at) {
    std::uint32_t value;
    if (bytes.size() < at + 4) fail(path, "truncated: a GLB header takes 20 bytes");
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  };
  if (number(4) == 1) return take_old_apart(path, bytes, number(8), number(12));
  if (number(4) != 2) fail(path, "GLB version " + std::to_string(number(4)) + ", 1 and 2 are read");
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

/// tinygltf's callbacks for files: what they open lies at or below the folder of `path`. They throw
/// Error{kInput} through tinygltf, which holds nothing then that needs to be given back.
struct Beside {
  const std::string& path;
  double input_memory;               // MiB
  std::size_t bytes;                 // read so far, those of the file itself included
  std::vector<std::size_t> lengths;  // of the buffers in files, in the order of reading
  std::size_t files = 0;             // read so far
};

fs::path folder_of(const std::string& path) { return fs::absolute(path).parent_path(); }

/// `name` is a URI that tinygltf has decoded.
bool check_beside(const std::string& name, void* user) {
  const std::string& path = static_cast<const Beside*>(user)->path;
  const std::string shown = "'" + name.substr(0, 80) + "'";
  const fs::path relative = name;
  const bool is_outside = relative.is_absolute() || name.find(':') != name.npos ||
                          name.find('\\') != name.npos ||
                          std::find(relative.begin(), relative.end(), "..") != relative.end();
  if (is_outside) fail(path, "names " + shown + ", outside of its folder, which is not read");
  std::error_code error;
  const fs::path folder = fs::canonical(folder_of(path), error);
  const fs::path file = fs::canonical(folder / relative, error);
  if (error || !fs::is_regular_file(file, error))
    fail(path, "names " + shown + ", which is no file beside it");
  const auto [end, at] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  if (end != folder.end())
    fail(path, "names " + shown + ", a link out of its folder, which is not read");
  return true;
}

std::string as_named(const std::string& name, void*) { return name; }

/// As many bytes as the buffer has: a file may hold more, which tinygltf would refuse.
bool read_beside(std::vector<unsigned char>* out, std::string*, const std::string& name,
                 void* user) {
  Beside& beside = *static_cast<Beside*>(user);
  const fs::path file = folder_of(beside.path) / name;
  const std::size_t size =
      std::min<std::uintmax_t>(fs::file_size(file), beside.lengths.at(beside.files++));
  beside.bytes += size;
  if (static_cast<double>(beside.bytes) > beside.input_memory * 1048576)
    fail(beside.path, "takes " + std::to_string((beside.bytes >> 20) + 1) +
                          " MiB with the files that it names, more than --input-memory " +
                          std::to_string(std::llround(beside.input_memory)) + " allows one file");
  out->resize(size);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(out->data()), static_cast<std::streamsize>(size));
  if (!in) fail(beside.path, "names '" + name.substr(0, 80) + "', which cannot be read");
  return true;
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

void check_extensions(const std::string& path, const Json& json,
                      std::vector<std::string>& warnings) {
  const std::vector<std::string> required = names(json, "extensionsRequired");
  for (const std::string& extension : required)
    if (!is_read(extension) && !is_shapeless(extension))
      fail(path, "needs the extension " + extension.substr(0, 80) +
                     ", which is not read: write the file without it");
  for (const std::string& extension : names(json, "extensionsUsed"))
    if (!is_read(extension) && !is_shapeless(extension))
      warnings.push_back("uses the extension " + extension.substr(0, 80) +
                         ", which is not read: shapes may differ from what it says");
}

/// What the layers will not show.
void note_losses(const Json& json, std::vector<std::string>& warnings) {
  if (json.contains("skins") && !json["skins"].empty())
    warnings.push_back("has skins, which are not read: shapes are those at rest");
}

/// The parser's callback. tinygltf takes whole numbers that are written as 4.0 for absent: they
/// become 4. Of `extras` only the asset's are kept.
bool keep_value(int depth, Json::parse_event_t event, Json& value) {
  if (event == Json::parse_event_t::key && depth > 2 && value == "extras") return false;
  if (event != Json::parse_event_t::value || !value.is_number_float()) return true;
  const double d = value.get<double>();
  if (std::abs(d) < std::numeric_limits<int>::max() && d == std::floor(d)) {
    if (d < 0) value = static_cast<std::int64_t>(d);
    if (d >= 0) value = static_cast<std::uint64_t>(d);
  }
  return true;
}

/// Sizes and offsets that are no whole numbers, which tinygltf takes for absent.
void check_sizes(const std::string& path, const Json& json) {
  for (const char* list : {"buffers", "bufferViews", "accessors"})
    for (const Json& entry : json.value(list, Json::array()))
      for (const char* key : {"byteOffset", "byteLength", "byteStride", "count", "bufferView"})
        if (entry.contains(key) && !entry[key].is_number_unsigned())
          fail(path, std::string("'") + key + "' is no whole number");
}

/// A `data:` URI as tinygltf takes it: of a media type that it knows, and of just so many bytes.
void settle_data_uri(const std::string& path, std::string uri, Json& buffer) {
  const std::size_t comma = std::min(uri.find(','), uri.size());
  if (!std::string_view(uri).substr(0, comma).ends_with(";base64"))
    fail(path, "a data URI of a buffer is no base64");
  uri.erase(0, comma + 1);
  const std::size_t digits = uri.find_last_not_of('=') + 1, bytes = digits * 3 / 4;
  buffer["byteLength"] = std::max(buffer.value("byteLength", std::size_t{0}), bytes);
  buffer["uri"] = kDataUri + uri;
}

/// Each buffer as tinygltf takes it. One without bytes, which meshopt's fallbacks are, gets one.
void settle_buffers(const std::string& path, bool has_binary, Json& json, Beside& beside) {
  if (!json.contains("buffers")) return;
  bool is_first = true;
  for (Json& buffer : json["buffers"]) {
    const bool is_chunk = std::exchange(is_first, false) && has_binary;
    if (!buffer.contains("uri")) {
      if (!is_chunk) buffer = {{"byteLength", 1}, {"uri", std::string(kDataUri) + "AA=="}};
      continue;
    }
    std::string uri = buffer["uri"];
    if (uri.starts_with("data:")) {
      settle_data_uri(path, std::move(uri), buffer);
      continue;
    }
    if (uri.empty()) uri = ".";  // no file, but no chunk either
    for (std::size_t at = 0; (at = uri.find('+', at)) != uri.npos;) uri.replace(at, 1, "%2B");
    buffer["uri"] = uri;  // a plus stands for itself, for tinygltf it is a blank
    beside.lengths.push_back(buffer.value("byteLength", std::size_t{0}));
  }
}

/// The indices of Draco primitives lie in their streams; tinygltf refuses accessors without a view.
void drop_draco_indices(Json& json) {
  if (!json.contains("meshes")) return;
  for (Json& mesh : json["meshes"]) {
    if (!mesh.contains("primitives")) continue;
    for (Json& primitive : mesh["primitives"])
      if (primitive.value("extensions", Json::object()).contains("KHR_draco_mesh_compression"))
        primitive.erase("indices");
  }
}

Json drop_shapeless(Json all) {
  Json kept;
  for (const char* key : kShapes)
    if (all.contains(key)) kept[key] = std::move(all[key]);
  const Json extensions = all.value("extensions", Json::object());
  if (extensions.contains("CESIUM_RTC"))
    kept["extensions"]["CESIUM_RTC"] = extensions["CESIUM_RTC"];
  return kept;
}

void append_chunk(std::string& glb, std::uint32_t type, std::string_view data, char filler) {
  const auto length = static_cast<std::uint32_t>((data.size() + 3) / 4 * 4);
  for (const std::uint32_t number : {length, type})
    glb.append(reinterpret_cast<const char*>(&number), sizeof number);
  glb.append(data).append(length - data.size(), filler);
}

std::string glb_of(std::string_view json, std::string_view binary) {
  std::string glb("glTF\2\0\0\0\0\0\0\0", 12);
  append_chunk(glb, kJsonChunk, json, ' ');
  if (!binary.empty()) append_chunk(glb, kBinaryChunk, binary, '\0');
  const auto size = static_cast<std::uint32_t>(glb.size());
  std::memcpy(glb.data() + 8, &size, sizeof size);
  return glb;
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text.substr(0, 200);
}

/// tinygltf also writes errors where it went on without an entry.
tinygltf::Model load(const std::string& path, const std::string& text, std::string_view binary,
                     Beside& beside) {
  if (text.size() + binary.size() > std::numeric_limits<std::uint32_t>::max() - 64)
    fail(path, "larger than 4 GiB");
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks({check_beside, as_named, read_beside, nullptr, &beside});
  tinygltf::Model model;
  std::string error, warning;
  if (binary.empty()) {
    loader.LoadASCIIFromString(&model, &error, &warning, text.data(),
                               static_cast<unsigned>(text.size()), "");
  } else {
    const std::string glb = glb_of(text, binary);
    loader.LoadBinaryFromMemory(&model, &error, &warning,
                                reinterpret_cast<const unsigned char*>(glb.data()),
                                static_cast<unsigned>(glb.size()), "");
  }
  if (!error.empty()) fail(path, "glTF: " + one_line(error));
  return model;
}

/// By its container, or, in JSON alone, by its lists, which are dictionaries.
bool is_gltf1(std::string_view bytes, const Json& json) {
  if (bytes.substr(0, 4) == "glTF") return bytes[4] == 1;
  return json.contains("accessors") && json["accessors"].is_object();
}

}  // namespace

GltfDocument open_gltf(const std::string& path, std::string_view bytes, std::size_t begin,
                       double input_memory) {
  const Chunks chunks = take_apart(path, bytes);
  check_json(path, chunks.json);
  Json json = Json::parse(chunks.json, keep_value, false);
  if (!json.is_object()) fail(path, "glTF: not JSON");
  const Json asset = json.value("asset", Json::object());
  if (is_gltf1(bytes, json))
    json = upgrade_gltf1(path, json, chunks.binary.size());
  else if (const std::string version = asset.value("version", "2.0"); !version.starts_with("2"))
    fail(path, "glTF version " + version.substr(0, 20) + ", 1 and 2 are read");
  GltfDocument document;
  check_extensions(path, json, document.warnings);
  note_losses(json, document.warnings);
  const std::size_t binary =
      chunks.binary.empty() ? 0 : begin + (chunks.binary.data() - bytes.data());
  document.look = read_gltf_look(path, bytes, binary, json);
  json = drop_shapeless(std::move(json));
  check_sizes(path, json);
  drop_draco_indices(json);
  Beside beside{path, input_memory, bytes.size(), {}};
  settle_buffers(path, !chunks.binary.empty(), json, beside);
  document.model = load(path, json.dump(), chunks.binary, beside);
  return document;
}

}  // namespace colod::mesh_io
