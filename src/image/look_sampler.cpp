// Based on: Williams, Pyramidal parametrics, SIGGRAPH 1983 (trilinear).
// Differs: one level for both directions, by area; all sums in linear light.
#include "look_sampler.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace colod {

namespace {

int wrapped(int i, int n, Wrap wrap) {
  if (i >= 0 && i < n) return i;
  if (wrap == Wrap::kClamp) return std::clamp(i, 0, n - 1);
  const int period = wrap == Wrap::kMirror ? 2 * n : n;
  i %= period;
  if (i < 0) i += period;
  return i < n ? i : period - 1 - i;
}

/// Coordinates far outside keep their place within a period.
double within_period(double u, Wrap wrap) {
  if (u >= 0 && u < 2) return u;
  if (wrap == Wrap::kClamp) return std::clamp(u, -1.0, 2.0);
  return u - 2 * std::floor(u / 2);
}

/// The same as std::floor, of what an int holds.
int floor_of(double v) {
  const int i = static_cast<int>(v);
  return i - (v < i);
}

/// Also what is no number is none.
bool is_place(const Vec2f& uv) {
  constexpr float kFarthest = 1e6f;  // periods: float has no places between texels beyond it
  return std::abs(uv.x()) < kFarthest && std::abs(uv.y()) < kFarthest;
}

/// What a place shows, and how opaque it is.
struct Shown {
  Light light = Light::Zero();
  float alpha = 0;
};

/// A place between four pixels: the upper left one, and how far on it is.
struct Between {
  int x, y;
  float fx, fy;

  Between(const Raster& raster, const Vec2& uv, const Material& m) {
    const double right = within_period(uv.x(), m.wrap_u) * raster.width - 0.5;
    const double down = within_period(uv.y(), m.wrap_v) * raster.height - 0.5;
    x = floor_of(right), y = floor_of(down);
    fx = static_cast<float>(right - x), fy = static_cast<float>(down - y);
  }
  /// Of the four, column i and row j, 0 or 1.
  float weight(int i, int j) const { return (i ? fx : 1 - fx) * (j ? fy : 1 - fy); }
};

Light light_of(const std::uint8_t* p) {
  return {to_linear(p[0]), to_linear(p[1]), to_linear(p[2])};
}

/// The colour of what is transparent does not count, where the material lets it be seen through.
Shown bilinear_wrapped(const Raster& raster, const Between& at, const Material& m) {
  const std::array px{wrapped(at.x, raster.width, m.wrap_u),
                      wrapped(at.x + 1, raster.width, m.wrap_u)};
  const std::array py{wrapped(at.y, raster.height, m.wrap_v),
                      wrapped(at.y + 1, raster.height, m.wrap_v)};
  const bool is_cut = m.cutoff > 0 && !raster.alpha.empty();
  Light all = Light::Zero(), opaque = Light::Zero();
  float alpha = 0;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const float weight = at.weight(i, j);
      const Light light = light_of(raster.at(px[i], py[j]));
      all += weight * light;
      if (!is_cut) continue;
      const float own = raster.alpha_at(px[i], py[j]);
      opaque += weight * own * light, alpha += weight * own;
    }
  if (!is_cut) return {all, 1};
  return {alpha > 0 ? Light(opaque / alpha) : all, alpha};
}

Light bilinear(const Raster& raster, const Vec2& uv, const Material& m) {
  const Between at(raster, uv, m);
  const bool is_within =
      at.x >= 0 && at.y >= 0 && at.x + 1 < raster.width && at.y + 1 < raster.height;
  if (!is_within || (m.cutoff > 0 && !raster.alpha.empty()))
    return bilinear_wrapped(raster, at, m).light;
  const std::uint8_t *upper = raster.at(at.x, at.y), *lower = raster.at(at.x, at.y + 1);
  return at.weight(0, 0) * light_of(upper) + at.weight(1, 0) * light_of(upper + 3) +
         at.weight(0, 1) * light_of(lower) + at.weight(1, 1) * light_of(lower + 3);
}

}  // namespace

const Pyramid* Lens::look(const ImagePlace& place, int number) {
  if (held_[0].number == number) return held_[0].pyramid.get();
  std::swap(held_[0], held_[1]);
  if (held_[0].number != number) held_[0] = {number, cache_.get(place).pyramid}, ++changes_;
  return held_[0].pyramid.get();
}

Vec3 Lens::weights(const Mesh& mesh, int face, const Vec3& point) {
  if (mesh_ != &mesh || face_ != face) {
    mesh_ = &mesh, face_ = face;
    weights_ = CornerWeights(mesh, mesh.faces[static_cast<std::size_t>(face)]);
  }
  return weights_.at(point);
}

LookSampler::LookSampler(const Mesh& mesh, const Appearance& look, const ImageCache& cache)
    : mesh_(mesh), look_(look), cache_(cache), texel_of_face_(mesh.faces.size(), 0) {
  std::vector<ImageCache::Facts> facts;
  for (const ImagePlace& place : look.images) facts.push_back(cache.facts(place));
  measure_texels(facts);
  has_images_ = std::ranges::any_of(facts, [](const auto& image) { return image.width > 0; });
  has_holes_ = std::ranges::any_of(look.materials, [&](const Material& m) {
    return m.image >= 0 && m.cutoff > 0 &&
           cache.has_alpha(look.images[static_cast<std::size_t>(m.image)]);
  });
  const std::vector<Wear> wear = find_wear();
  for (std::size_t i = 0; i < look.images.size(); ++i) {
    if (wear[i].faces == 0) continue;
    const std::string named =
        "texture '" + std::filesystem::path(look.images[i].path).filename().string() + "' ";
    const bool is_there = facts[i].width > 0;
    if (facts[i].is_lost)
      losses_.push_back(named + facts[i].problem +
                        (is_there ? ": what could be read of it is shown"
                                  : ": the colour of material '" + wear[i].material.substr(0, 80) +
                                        "' stands for it") +
                        "; --texture none builds without textures");
    else if (!facts[i].problem.empty())
      warnings_.push_back(named + facts[i].problem);
    if (wear[i].without > 0 && is_there)
      warnings_.push_back(named + "is on " + std::to_string(wear[i].without) +
                          " faces without texture coordinates: its mean colour stands for it");
  }
}

bool LookSampler::has_place(std::size_t face) const {
  return !look_.uvs.empty() &&
         std::all_of(look_.uvs[face].begin(), look_.uvs[face].end(), is_place);
}

std::vector<LookSampler::Wear> LookSampler::find_wear() const {
  std::vector<Wear> wear(look_.images.size());
  for (std::size_t f = 0; f < look_.face_material.size(); ++f) {
    if (look_.face_material[f] < 0) continue;
    const Material& m = look_.materials[static_cast<std::size_t>(look_.face_material[f])];
    if (m.image < 0) continue;
    Wear& w = wear[static_cast<std::size_t>(m.image)];
    if (w.faces++ == 0) w.material = m.name;
    w.without += !has_place(f);
  }
  return wear;
}

void LookSampler::measure_texels(const std::vector<ImageCache::Facts>& facts) {
  double area = 0, texels = 0, plain_area = 0;
  for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
    const double own = face_area(mesh_, mesh_.faces[f]);
    plain_area += own;
    const int material = look_.face_material.empty() ? -1 : look_.face_material[f];
    const int image = material < 0 ? -1 : look_.materials[static_cast<std::size_t>(material)].image;
    if (image < 0 || !has_place(f)) continue;
    const ImageCache::Facts& size = facts[static_cast<std::size_t>(image)];
    const auto& uv = look_.uvs[f];
    const Eigen::Vector2d a = (uv[1] - uv[0]).cast<double>(), b = (uv[2] - uv[0]).cast<double>();
    const double covered = 0.5 * std::abs(a.x() * b.y() - a.y() * b.x()) * size.width * size.height;
    if (!(covered > 0) || !(own > 0)) continue;
    texel_of_face_[f] = static_cast<float>(std::sqrt(own / covered));
    area += own, texels += covered;
  }
  if (texels > 0)
    texel_ = std::sqrt(area / texels);
  else if (!mesh_.faces.empty())
    texel_ = std::sqrt(plain_area / static_cast<double>(mesh_.faces.size()));
}

Vec2 LookSampler::place_of(std::size_t f, const Vec3& weight) const {
  if (look_.uvs.empty()) return {NAN, NAN};
  return weight[0] * look_.uvs[f][0].cast<double>() + weight[1] * look_.uvs[f][1].cast<double>() +
         weight[2] * look_.uvs[f][2].cast<double>();
}

bool LookSampler::is_hole(int face, const Vec3& point, Lens& lens) const {
  const auto f = static_cast<std::size_t>(face);
  const int number = look_.face_material.empty() ? -1 : look_.face_material[f];
  if (number < 0) return false;
  const Material& m = look_.materials[static_cast<std::size_t>(number)];
  if (m.image < 0 || !(m.cutoff > 0)) return false;
  const Pyramid* pyramid = lens.look(look_.images[static_cast<std::size_t>(m.image)], m.image);
  if (!pyramid || pyramid->levels[0].alpha.empty()) return false;
  const Vec2 uv = place_of(f, lens.weights(mesh_, face, point));
  return is_place(uv.cast<float>()) &&
         bilinear_wrapped(pyramid->levels[0], Between(pyramid->levels[0], uv, m), m).alpha <
             m.cutoff;
}

Light FaceLook::at(const Vec3& weight) const {
  Light light = Light::Ones();
  if (colors_) {
    light.setZero();
    for (int c = 0; c < 3; ++c)
      light += static_cast<float>(std::clamp(weight[c], 0.0, 1.0)) *
               light_of((*colors_)[static_cast<std::size_t>(c)].data());
  }
  light = light.cwiseProduct(tint_);
  if (!fine_) return light;
  const Vec2 uv = weight[0] * (*uvs_)[0].cast<double>() + weight[1] * (*uvs_)[1].cast<double>() +
                  weight[2] * (*uvs_)[2].cast<double>();
  Light shown = bilinear(*fine_, uv, *material_);
  if (coarse_) shown = (1 - share_) * shown + share_ * bilinear(*coarse_, uv, *material_);
  return light.cwiseProduct(shown);
}

FaceLook LookSampler::look_at(int face, double spacing, Lens& lens) const {
  constexpr double kLeastShare = 1e-3;
  const auto f = static_cast<std::size_t>(face);
  FaceLook look;
  if (!look_.colors.empty()) look.colors_ = &look_.colors[f];
  const int number = look_.face_material.empty() ? -1 : look_.face_material[f];
  if (number < 0) return look;
  const Material& m = look_.materials[static_cast<std::size_t>(number)];
  look.tint_ = Light(m.color[0], m.color[1], m.color[2]);
  const Pyramid* pyramid =
      m.image < 0 ? nullptr : lens.look(look_.images[static_cast<std::size_t>(m.image)], m.image);
  if (!pyramid) return look;
  const std::vector<Raster>& levels = pyramid->levels;
  if (!has_place(f)) {
    look.tint_ = look.tint_.cwiseProduct(light_of(levels.back().at(0, 0)));
    return look;
  }
  const double own = texel_of_face_[f];
  double level = own > 0 && spacing > 0 ? std::log2(spacing / own) : 0;
  level = std::clamp(std::min(level, std::log2(kMostTexels)), 0.0,
                     static_cast<double>(levels.size()) - 1);
  const auto fine = static_cast<std::size_t>(level);
  look.share_ = static_cast<float>(level - static_cast<double>(fine));
  look.fine_ = &levels[fine];
  if (look.share_ >= kLeastShare) look.coarse_ = &levels[fine + 1];
  look.material_ = &m, look.uvs_ = &look_.uvs[f];
  return look;
}

Light LookSampler::sample(int face, const Vec3& point, double spacing, Lens& lens) const {
  const Vec3 weight = lens.weights(mesh_, face, point);
  return look_at(face, spacing, lens).at(weight);
}

}  // namespace colod
