// Based on: glTF 1.0 (Khronos), KHR_binary_glTF, KHR_materials_common; ContextCapture writes them.
// Differs: of techniques and programs only the texture or the colour of a material is kept.
#include <nlohmann/json.hpp>

#include "formats.h"
#include "gltf.h"

namespace colod::mesh_io {

using Json = nlohmann::json;

namespace {

constexpr const char* kBinary[] = {"binary_glTF", "KHR_binary_glTF"};  // a GLB's own buffer

const Json& object(const Json& json, const char* key) {
  static const Json none = Json::object();
  const auto found = json.is_object() ? json.find(key) : json.end();
  return found != json.end() && found->is_object() ? *found : none;
}

/// What was a dictionary becomes a list, what named an entry its number.
class Upgrade {
 public:
  Upgrade(const std::string& path, const Json& old, std::size_t binary)
      : path_(path), old_(old), binary_(binary) {}

  Json run() {
    for (const char* list : {"buffers", "bufferViews", "accessors", "images", "samplers",
                             "textures", "materials", "meshes", "nodes", "scenes"})
      number_all(list);
    new_["asset"] = {{"version", "2.0"}};
    if (old_.contains("extensions")) new_["extensions"] = old_["extensions"];
    for (const char* list : {"extensionsUsed", "extensionsRequired"})
      for (const Json& name : old_.value(list, Json::array()))
        if (name != "KHR_binary_glTF" && name != "KHR_materials_common") new_[list].push_back(name);
    add_buffers();
    add_accessors();
    add_look();
    add_meshes();
    add_nodes();
    return std::move(new_);
  }

 private:
  using Numbers = std::map<std::string, std::size_t>;

  /// In the order of names, a GLB's own buffer first.
  void number_all(const char* list) {
    Numbers& numbers = numbers_[list];
    for (const char* own : kBinary)
      if (std::string(list) == "buffers" && object(old_, list).contains(own)) numbers[own] = 0;
    for (const auto& [name, value] : object(old_, list).items())
      numbers.emplace(name, numbers.size());
  }

  std::size_t number(const char* list, const Json& name) const {
    const Numbers& numbers = numbers_.at(list);
    const auto found = name.is_string() ? numbers.find(name.get<std::string>()) : numbers.end();
    if (found == numbers.end())
      fail(path_, std::string("glTF 1.0: names ") + name.dump().substr(0, 80) +
                      ", which is not among its " + list);
    return found->second;
  }

  /// An empty list as long as the dictionary, and what stands there under each number.
  template <typename Body>
  void convert(const char* list, Body body) {
    const Json& dictionary = object(old_, list);
    if (dictionary.empty()) return;
    Json entries = Json::array();
    for (std::size_t i = 0; i < dictionary.size(); ++i) entries.push_back(Json::object());
    for (const auto& [name, value] : dictionary.items())
      entries[number(list, name)] = body(name, value);
    new_[list] = std::move(entries);
  }

  static void copy(const Json& from, std::initializer_list<const char*> keys, Json& to) {
    for (const char* key : keys)
      if (from.is_object() && from.contains(key)) to[key] = from[key];
  }

  void add_buffers() {
    convert("buffers", [&](const std::string& name, const Json& b) {
      Json out = Json::object();
      copy(b, {"byteLength"}, out);
      const bool is_own =
          std::find(std::begin(kBinary), std::end(kBinary), name) != std::end(kBinary);
      if (is_own && binary_ > 0)
        out["byteLength"] = binary_;
      else
        copy(b, {"uri"}, out);
      return out;
    });
    convert("bufferViews", [&](const std::string&, const Json& v) {
      Json out = {{"buffer", number("buffers", v.value("buffer", Json()))}};
      copy(v, {"byteOffset", "byteLength"}, out);
      return out;
    });
  }

  /// A stride, which was the accessor's, is a view's.
  void add_accessors() {
    convert("accessors", [&](const std::string&, const Json& a) {
      Json out = Json::object();
      copy(a, {"byteOffset", "componentType", "count", "type"}, out);
      std::size_t view = number("bufferViews", a.value("bufferView", Json()));
      if (a.contains("byteStride") && a["byteStride"] != 0) {
        Json strided = new_["bufferViews"][view];
        strided["byteStride"] = a["byteStride"];
        view = new_["bufferViews"].size();
        new_["bufferViews"].push_back(std::move(strided));
      }
      out["bufferView"] = view;
      return out;
    });
  }

  void add_look() {
    convert("images", [&](const std::string&, const Json& image) {
      Json out = Json::object();
      const Json& own = object(object(image, "extensions"), "KHR_binary_glTF");
      if (own.contains("bufferView"))
        out["bufferView"] = number("bufferViews", own["bufferView"]);
      else
        copy(image, {"uri"}, out);
      return out;
    });
    convert("samplers", [&](const std::string&, const Json& s) {
      Json out = Json::object();
      copy(s, {"wrapS", "wrapT"}, out);
      return out;
    });
    convert("textures", [&](const std::string&, const Json& t) {
      Json out = {{"source", number("images", t.value("source", Json()))}};
      if (t.contains("sampler")) out["sampler"] = number("samplers", t["sampler"]);
      return out;
    });
    convert("materials", [&](const std::string& name, const Json& m) { return material(name, m); });
  }

  /// The one texture among its values, else the colour that is called diffuse.
  Json material(const std::string& name, const Json& m) const {
    Json out = {{"name", name}, {"pbrMetallicRoughness", Json::object()}};
    const Json& common = object(object(m, "extensions"), "KHR_materials_common");
    const Json& values = object(common.empty() ? m : common, "values");
    for (const auto& [key, value] : values.items()) {
      if (value.is_string() && numbers_.at("textures").contains(value.get<std::string>()))
        out["pbrMetallicRoughness"]["baseColorTexture"]["index"] = number("textures", value);
      if (key == "diffuse" && value.is_array())
        out["pbrMetallicRoughness"]["baseColorFactor"] = value;
    }
    return out;
  }

  void add_meshes() {
    convert("meshes", [&](const std::string&, const Json& mesh) {
      Json out = {{"primitives", Json::array()}};
      for (const Json& p : mesh.value("primitives", Json::array())) {
        Json primitive = {{"attributes", Json::object()}};
        copy(p, {"mode"}, primitive);
        for (const auto& [semantic, accessor] : object(p, "attributes").items())
          if (semantic == "POSITION" || semantic.starts_with("TEXCOORD_"))
            primitive["attributes"][semantic] = number("accessors", accessor);
        if (p.contains("indices")) primitive["indices"] = number("accessors", p["indices"]);
        if (p.contains("material")) primitive["material"] = number("materials", p["material"]);
        out["primitives"].push_back(std::move(primitive));
      }
      return out;
    });
  }

  /// A node of several meshes gets a child for each but the first.
  void add_nodes() {
    std::vector<Json> more;
    const std::size_t count = object(old_, "nodes").size();
    convert("nodes", [&](const std::string& name, const Json& n) {
      Json out = {{"name", name}};
      copy(n, {"matrix", "translation", "rotation", "scale"}, out);
      for (const Json& child : n.value("children", Json::array()))
        out["children"].push_back(number("nodes", child));
      for (const Json& mesh : n.value("meshes", Json::array())) {
        if (!out.contains("mesh")) {
          out["mesh"] = number("meshes", mesh);
          continue;
        }
        out["children"].push_back(count + more.size());
        more.push_back({{"mesh", number("meshes", mesh)}});
      }
      return out;
    });
    for (Json& node : more) new_["nodes"].push_back(std::move(node));
    convert("scenes", [&](const std::string&, const Json& s) {
      Json out = {{"nodes", Json::array()}};
      for (const Json& node : s.value("nodes", Json::array()))
        out["nodes"].push_back(number("nodes", node));
      return out;
    });
    if (old_.contains("scene")) new_["scene"] = number("scenes", old_["scene"]);
  }

  const std::string& path_;
  const Json& old_;
  std::size_t binary_;  // bytes behind the JSON
  std::map<std::string, Numbers> numbers_;
  Json new_;
};

}  // namespace

Json upgrade_gltf1(const std::string& path, const Json& old, std::size_t binary) {
  return Upgrade(path, old, binary).run();
}

}  // namespace colod::mesh_io
