// Based on: glTF 2.0 (materials, textures, samplers, images), KHR_texture_transform,
// EXT_texture_webp, KHR_texture_basisu, KHR_materials_pbrSpecularGlossiness.
// Differs: of a material its base colour alone is read.
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "formats.h"
#include "gltf.h"
#include "image/cache.h"
#include "look.h"

namespace colod::mesh_io {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string percent_decoded(const std::string& uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto digit = [&](std::size_t at) {
      const char c = at < uri.size() ? uri[at] : 'x';
      return c >= '0' && c <= '9'   ? c - '0'
             : c >= 'a' && c <= 'f' ? c - 'a' + 10
             : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                    : -1;
    };
    if (uri[i] == '%' && digit(i + 1) >= 0 && digit(i + 2) >= 0) {
      out += static_cast<char>(16 * digit(i + 1) + digit(i + 2));
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

namespace {

/// A member where it is there and of the right kind, else an empty object or list.
const Json& member(const Json& json, const char* key, Json::value_t kind = Json::value_t::object) {
  static const Json none_object = Json::object(), none_list = Json::array();
  if (json.is_object() && json.contains(key) && json[key].type() == kind) return json[key];
  return kind == Json::value_t::array ? none_list : none_object;
}

int index(const Json& json, const char* key, int none = -1) {
  if (!json.is_object() || !json.contains(key) || !json[key].is_number()) return none;
  const double value = json[key].get<double>();
  return value >= 0 && value < 1e9 ? static_cast<int>(value) : none;
}

double number(const Json& list, std::size_t i, double none) {
  return list.is_array() && i < list.size() && list[i].is_number() ? list[i].get<double>() : none;
}

class LookReader {
 public:
  LookReader(const std::string& path, std::string_view bytes, std::size_t binary, const Json& json)
      : path_(path), bytes_(bytes), binary_(binary), json_(json) {}

  GltfLook read() {
    for (const Json& m : member(json_, "materials", Json::value_t::array)) add_material(m);
    return std::move(look_);
  }

 private:
  void add_material(const Json& json) {
    look_.materials.emplace_back();
    GltfMaterial& m = look_.materials.back();
    if (json.is_object() && json.contains("name") && json["name"].is_string())
      m.material.name = json["name"].get<std::string>();
    const Json& old = member(member(json, "extensions"), "KHR_materials_pbrSpecularGlossiness");
    const Json& base = old.empty() ? member(json, "pbrMetallicRoughness") : old;
    const Json& factor =
        member(base, old.empty() ? "baseColorFactor" : "diffuseFactor", Json::value_t::array);
    for (std::size_t k = 0; k < 3; ++k)
      m.material.color[k] = static_cast<float>(std::clamp(number(factor, k, 1), 0.0, 1.0));
    const Json& texture = member(base, old.empty() ? "baseColorTexture" : "diffuseTexture");
    if (!texture.empty()) set_texture(texture, m);
    set_cutoff(json, number(factor, 3, 1), m.material);
  }

  /// What is blended counts as there, however faint, so that panes are seen rather than what is
  /// behind them; what hardly shows at all does not.
  void set_cutoff(const Json& json, double factor, Material& m) const {
    constexpr double kFaint = 0.1;
    const std::string mode =
        json.is_object() && json.contains("alphaMode") && json["alphaMode"].is_string()
            ? json["alphaMode"].get<std::string>()
            : "OPAQUE";
    if (mode == "BLEND") m.cutoff = static_cast<float>(kFaint);
    if (mode != "MASK") return;
    const bool is_told = json.contains("alphaCutoff") && json["alphaCutoff"].is_number();
    const double cutoff = is_told ? json["alphaCutoff"].get<double>() : 0.5;
    m.cutoff = static_cast<float>(std::clamp(cutoff / std::max(factor, 1e-3), 0.0, 1.0));
  }

  void set_texture(const Json& info, GltfMaterial& m) {
    m.uv_set = index(info, "texCoord", 0);
    const Json& transform = member(member(info, "extensions"), "KHR_texture_transform");
    if (!transform.empty()) {
      m.uv_set = index(transform, "texCoord", m.uv_set);
      const Json& offset = member(transform, "offset", Json::value_t::array);
      const Json& scale = member(transform, "scale", Json::value_t::array);
      const double turn = transform.contains("rotation") && transform["rotation"].is_number()
                              ? transform["rotation"].get<double>()
                              : 0;
      const double c = std::cos(turn), s = std::sin(turn);
      const double sx = number(scale, 0, 1), sy = number(scale, 1, 1);
      m.place << c * sx, s * sy, number(offset, 0, 0), -s * sx, c * sy, number(offset, 1, 0);
    }
    const Json& textures = member(json_, "textures", Json::value_t::array);
    const int i = index(info, "index");
    if (i < 0 || i >= static_cast<int>(textures.size())) {
      m.material.image = lost("texture " + std::to_string(i));
      return;
    }
    const Json& texture = textures[static_cast<std::size_t>(i)];
    set_sampler(index(texture, "sampler"), m.material);
    set_image(texture, m.material);
  }

  void set_sampler(int i, Material& m) const {
    const Json& samplers = member(json_, "samplers", Json::value_t::array);
    if (i < 0 || i >= static_cast<int>(samplers.size())) return;
    const auto wrap = [&](const char* key) {
      const int mode = index(samplers[static_cast<std::size_t>(i)], key);
      return mode == 33071 ? Wrap::kClamp : mode == 33648 ? Wrap::kMirror : Wrap::kRepeat;
    };
    m.wrap_u = wrap("wrapS"), m.wrap_v = wrap("wrapT");
  }

  void set_image(const Json& texture, Material& m) {
    const Json& extensions = member(texture, "extensions");
    int source = index(member(extensions, "EXT_texture_webp"), "source");
    if (source < 0) source = index(texture, "source");
    if (source < 0) source = index(member(extensions, "KHR_texture_basisu"), "source");
    const Json& images = member(json_, "images", Json::value_t::array);
    m.image = source < 0 || source >= static_cast<int>(images.size())
                  ? lost("image " + std::to_string(source))
                  : image_number(look_.images,
                                 find_image(images[static_cast<std::size_t>(source)], source));
  }

  /// Number of an image that the file names and does not hold.
  int lost(const std::string& what) { return image_number(look_.images, missing_in_file(what)); }

  ImagePlace missing_in_file(const std::string& what) const {
    return missing_image(what + " of " + fs::path(path_).filename().string());
  }

  ImagePlace find_image(const Json& image, int number) {
    if (image.is_object() && image.contains("uri") && image["uri"].is_string())
      return place_of_uri(image["uri"].get<std::string>());
    const Json& views = member(json_, "bufferViews", Json::value_t::array);
    const int v = index(image, "bufferView");
    if (v >= 0 && v < static_cast<int>(views.size()))
      return place_of_view(views[static_cast<std::size_t>(v)], number);
    return missing_in_file("image " + std::to_string(number));
  }

  ImagePlace place_of_view(const Json& view, int number) const {
    const Json& buffers = member(json_, "buffers", Json::value_t::array);
    const int b = index(view, "buffer");
    const auto offset = static_cast<std::size_t>(index(view, "byteOffset", 0));
    const auto length = static_cast<std::size_t>(index(view, "byteLength", 0));
    if (b < 0 || b >= static_cast<int>(buffers.size()) || length == 0)
      return missing_in_file("image " + std::to_string(number));
    const Json& buffer = buffers[static_cast<std::size_t>(b)];
    ImagePlace place{.path = path_};
    if (!buffer.is_object() || !buffer.contains("uri")) {
      place.offset = binary_ + offset, place.length = length;
      return place;
    }
    place = place_of_uri(buffer["uri"].is_string() ? buffer["uri"].get<std::string>() : "");
    if (is_missing(place)) return place;
    if (place.is_base64)
      place.skip = offset, place.take = length;
    else
      place.offset = offset, place.length = length;
    return place;
  }

  ImagePlace place_of_uri(const std::string& uri) const {
    return uri.starts_with("data:") ? place_of_data(uri)
                                    : image_beside(path_, percent_decoded(uri));
  }

  /// Where a data URI stands in the file.
  ImagePlace place_of_data(const std::string& uri) const {
    const std::size_t comma = uri.find(',');
    const std::size_t digits = uri.size() - std::min(comma + 1, uri.size());
    for (std::size_t at = 0;
         comma != uri.npos && (at = bytes_.find(";base64,", at)) != bytes_.npos;) {
      at += 8;
      std::size_t read = 0, end = at;
      for (; read < digits && end < bytes_.size(); ++end) {
        if (bytes_[end] == '\\') continue;
        if (bytes_[end] != uri[comma + 1 + read]) break;
        ++read;
      }
      if (read < digits) continue;
      std::error_code error;
      const std::uintmax_t size = fs::file_size(path_, error);  // a byte order mark was taken off
      const std::size_t before = error || size < bytes_.size() ? 0 : size - bytes_.size();
      return {.path = path_, .offset = before + at, .length = end - at, .is_base64 = true};
    }
    return missing_in_file("base64 of an image");
  }

  const std::string& path_;
  std::string_view bytes_;
  std::size_t binary_;
  const Json& json_;
  GltfLook look_;
};

}  // namespace

GltfLook read_gltf_look(const std::string& path, std::string_view bytes, std::size_t binary,
                        const Json& json) {
  return LookReader(path, bytes, binary, json).read();
}

}  // namespace colod::mesh_io
