// Based on: own work.
#include "context.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "image/look_sampler.h"

namespace colod {

namespace {

constexpr Rgb kGrey = {160, 160, 160};

/// By how the bytes begin; nothing for what clients do not read.
std::optional<ImageFormat> format_of(const std::string& bytes) {
  if (bytes.starts_with("\xFF\xD8")) return ImageFormat::kJpeg;
  if (bytes.starts_with("\x89PNG")) return ImageFormat::kPng;
  if (bytes.starts_with("RIFF") && bytes.size() > 12 && bytes.compare(8, 4, "WEBP") == 0)
    return ImageFormat::kWebp;
  return {};
}

using CornerColors = std::array<Rgb, 3>;

/// The colours of a face that wears no image.
CornerColors plain_colors(const Appearance& look, std::size_t f) {
  const int m = look.face_material.empty() ? -1 : look.face_material[f];
  if (m < 0 && look.colors.empty()) return {kGrey, kGrey, kGrey};
  std::array<float, 3> light = {1, 1, 1};
  if (m >= 0) light = look.materials[static_cast<std::size_t>(m)].color;
  CornerColors out;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t k = 0; k < 3; ++k)
      out[c][k] =
          to_srgb(look.colors.empty() ? light[k] : light[k] * to_linear(look.colors[f][c][k]));
  return out;
}

/// What faces look like on the whole, their images included.
class FaceColors {
 public:
  FaceColors(const Source& source, const ImageCache& images)
      : mesh_(source.mesh), sampler_(source.mesh, source.look, images), lens_(images) {}

  /// The mean over as many places as halving a face's sides twice makes parts: one alone would be
  /// a stain of what lies in its middle.
  CornerColors colors(std::size_t f) {
    const Face& face = mesh_.faces[f];
    const double spacing = std::sqrt(face_area(mesh_, face) / kParts);
    Light sum = Light::Zero();
    for (const Vec3& w : kMiddles) {
      Vec3 p = Vec3::Zero();
      for (int k = 0; k < 3; ++k)
        p += w[k] * mesh_.vertices[static_cast<std::size_t>(face[static_cast<std::size_t>(k)])];
      sum += sampler_.sample(static_cast<int>(f), p, spacing, lens_);
    }
    sum /= kParts;
    const Rgb rgb = {to_srgb(sum[0]), to_srgb(sum[1]), to_srgb(sum[2])};
    return {rgb, rgb, rgb};
  }

 private:
  static constexpr int kParts = 16;
  static const std::vector<Vec3> kMiddles;

  const Mesh& mesh_;
  LookSampler sampler_;
  Lens lens_;
};

/// Weights of the middles of a face's parts.
const std::vector<Vec3> FaceColors::kMiddles = [] {
  std::vector<Vec3> out;
  constexpr int kSides = 4;
  for (int i = 0; i < kSides; ++i)
    for (int j = 0; i + j < kSides; ++j) {
      out.emplace_back(Vec3(i + 1 / 3., j + 1 / 3., kSides - i - j - 2 / 3.) / kSides);
      if (i + j + 1 < kSides)
        out.emplace_back(Vec3(i + 2 / 3., j + 2 / 3., kSides - i - j - 4 / 3.) / kSides);
    }
  return out;
}();

class Dresser {
 public:
  Dresser(Source source, const TextureOptions& options, const ImageCache& images)
      : source_(std::move(source)), options_(options), images_(images) {
    if (options.mode == Texture::kColors && !source_.look.images.empty())
      colors_.emplace(source_, images_);
  }

  /// Images that cannot be worn join `failures`.
  ContextMesh dress(std::vector<ReadFailure>& failures) {
    failures_ = &failures;
    const Appearance& look = source_.look;
    for (std::size_t f = 0; f < source_.mesh.faces.size(); ++f) {
      const int m = look.face_material.empty() ? -1 : look.face_material[f];
      const int image = m < 0 ? -1 : look.materials[static_cast<std::size_t>(m)].image;
      const bool has_place = image >= 0 && !look.uvs.empty() && look.uvs[f][0].allFinite() &&
                             look.uvs[f][1].allFinite() && look.uvs[f][2].allFinite();
      const int number = has_place && options_.mode == Texture::kAuto ? number_of(image) : -1;
      if (image >= 0 && colors_) tell_loss(image);
      out_.face_image.push_back(number);
      out_.colors.push_back(number >= 0             ? CornerColors{}
                            : image >= 0 && colors_ ? colors_->colors(f)
                                                    : plain_colors(look, f));
      out_.uvs.push_back(number < 0 ? std::array<Vec2f, 3>{} : look.uvs[f]);
    }
    out_.mesh = std::move(source_.mesh);
    return std::move(out_);
  }

 private:
  /// −1: it cannot be read, or in no format that clients know: the face has a plain colour then.
  int number_of(int image) {
    const auto [known, is_new] = numbers_.try_emplace(image, -1);
    if (!is_new) return known->second;
    const ImagePlace& place = source_.look.images[static_cast<std::size_t>(image)];
    try {
      const std::size_t most = static_cast<std::size_t>(options_.memory * (1 << 20));
      std::string bytes = read_image(place, most);
      const auto format = format_of(bytes);
      if (!format) throw std::runtime_error("neither JPEG nor PNG nor WebP");
      known->second = static_cast<int>(out_.images.size());
      out_.images.push_back({std::move(bytes), *format});
    } catch (const std::exception& e) {
      add_loss(place, e.what());
    }
    return known->second;
  }

  /// Of an image whose mean is worn, once.
  void tell_loss(int image) {
    if (!numbers_.try_emplace(image, -1).second) return;
    const ImagePlace& place = source_.look.images[static_cast<std::size_t>(image)];
    if (const ImageCache::Facts facts = images_.facts(place); facts.is_lost)
      add_loss(place, facts.problem);
  }

  void add_loss(const ImagePlace& place, const std::string& cause) {
    const std::string within =
        place.length > 0 ? ", image at byte " + std::to_string(place.offset) : "";
    failures_->push_back({place.path, "its look is lost beside the buildings" + within + ": " +
                                          cause + ": --texture none wants none"});
  }

  Source source_;
  const TextureOptions& options_;
  const ImageCache& images_;
  std::optional<FaceColors> colors_;  // where faces wear the mean of their images
  ContextMesh out_;
  std::map<int, int> numbers_;
  std::vector<ReadFailure>* failures_ = nullptr;
};

}  // namespace

std::optional<ContextTiles> context_tiles(const Scene& scene, const TextureOptions& options,
                                          ContextFailures& failures) {
  if (!scene.context) return {};
  ContextTiles tiles;
  for (const Context::Node& n : scene.context->nodes)
    tiles.nodes.push_back({n.parent, n.geometric_error, n.is_added, n.rounding, n.is_farthest});
  failures.assign(tiles.nodes.size(), {});
  const auto images =
      std::make_shared<const ImageCache>(static_cast<std::size_t>(options.memory * (1 << 20)));
  tiles.mesh = [context = scene.context, options, images, &failures](std::size_t node) {
    Source source = context->read(node);
    for (const std::string& line : source.warnings) {
      const std::size_t end = std::min(line.find(": "), line.size());
      failures[node].push_back({line.substr(0, end), line.substr(std::min(end + 2, line.size()))});
    }
    return Dresser(std::move(source), options, *images).dress(failures[node]);
  };
  return tiles;
}

void tell_failures(const ContextFailures& failures, Scene& scene) {
  if (!scene.context) return;
  std::vector<char> is_finest(failures.size(), 1);
  for (const Context::Node& node : scene.context->nodes)
    if (node.parent >= 0) is_finest[static_cast<std::size_t>(node.parent)] = 0;
  std::set<std::pair<std::string, std::string>> told;
  for (const ReadFailure& f : scene.failures) told.insert({f.path, f.message});
  for (std::size_t i = 0; i < failures.size(); ++i)
    for (ReadFailure f : failures[i]) {
      if (const auto& shown = scene.context->shown) f = {shown(f.path), shown(f.message)};
      if (!told.insert({f.path, f.message}).second) continue;
      if (is_finest[i] || scene.context->nodes[i].is_added)
        scene.failures.push_back(f);
      else
        scene.warnings.push_back(f.path + ": " + f.message + "; finer tiles stand for it");
    }
}

}  // namespace colod
