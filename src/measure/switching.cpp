// Based on: paper section 1 (levels are for rendering from afar; it leaves open when to switch);
// Simplygon's and Unreal's habit of saying at how many pixels a level looks like the original.
// Differs: the same under both rules.
// Notation: g, gsd: metres a pixel covers; n: samples along a pixel's side.
#include "switching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "deviation.h"
#include "switching_views.h"

namespace colod {
namespace {

constexpr int kViews = 18;
constexpr std::array kElevations_deg{8.0, 30.0, 60.0};  // eye height, a hill, a plane
constexpr int kMayExceed = kViews / 10;                 // views
constexpr double kFinestSample = 0.02;                  // metres
constexpr double kMostSamples = 768;                    // along a building's diagonal
constexpr double kMostPixels = 64;  // nobody wants to know how much worse it gets nearby
// Least factors from layer to layer; what is computed from the first differs by 1.5 after rounding.
constexpr double kVisualStep = 1.501, kDeviationStep = 1.01;
constexpr double kLeastGsd = 1e-4;      // metres a pixel
constexpr double kSameDistance = 0.01;  // metres

bool is_same(const Mesh& a, const Mesh& b) {
  return a.faces == b.faces && a.vertices == b.vertices;
}

/// Samples along a pixel's side: 2, 3, 4, then steps of an eighth to a quarter, as far as a picture
/// has a few pixels.
std::vector<int> pixel_sizes() {
  std::vector<int> sizes;
  for (int n = 2; n < kMostSamples; n += std::max(1, n / 5)) sizes.push_back(n);
  return sizes;
}

/// One mesh in one view at all sizes of pixels, each made when it is first asked for.
class SizedPictures {
 public:
  SizedPictures(const Mesh& mesh, const FarView& view, const std::vector<int>& sizes)
      : far_(mesh, view), sizes_(sizes), made_(sizes.size()) {}
  const GreyPicture& at(std::size_t size) {
    if (!made_[size]) made_[size] = far_.at(sizes_[size]);
    return *made_[size];
  }

 private:
  FarPicture far_;
  const std::vector<int>& sizes_;
  std::vector<std::optional<GreyPicture>> made_;
};

/// Per pixel size the difference of two meshes' pictures, from the coarsest down until it is past
/// caring; kMostPixels for the rest.
std::vector<double> differences(SizedPictures& a, SizedPictures& b, std::size_t sizes) {
  std::vector<double> out(sizes, kMostPixels);
  for (std::size_t i = sizes; i-- > 0;) {
    const double pixels = compare_pictures(a.at(i), b.at(i)).pixels();
    if (pixels >= kMostPixels) break;
    out[i] = pixels;
  }
  return out;
}

/// The steps of one layer from its differences in all views.
VisibleProfile profile_of(const std::vector<std::vector<double>>& views,
                          const std::vector<int>& sizes, double sample) {
  VisibleProfile profile;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    std::vector<double> pixels;
    for (const std::vector<double>& view : views) pixels.push_back(view[i]);
    std::nth_element(pixels.begin(), pixels.end() - 1 - kMayExceed, pixels.end());
    profile.push_back({sizes[i] * sample, pixels[pixels.size() - 1 - kMayExceed]});
  }
  const auto first = std::find_if(profile.begin(), profile.end(),
                                  [](const VisibleStep& s) { return s.pixels < kMostPixels; });
  if (first != profile.begin()) profile.erase(profile.begin(), first - 1);
  return profile;
}

Box box_about(const std::vector<Mesh>& meshes) {
  Box box;
  for (const Mesh& mesh : meshes) box.extend(bounding_box(mesh.vertices));
  return box;
}

/// Sets the profiles of layers that are not the next finer one's like.
void draw_profiles(const std::vector<Mesh>& layers, double sample,
                   std::vector<LayerSight>& sights) {
  const Box box = box_about(layers);
  sample = std::max(sample, box.diagonal() / kMostSamples);
  const std::vector<int> sizes = pixel_sizes();
  const std::vector<Vec3> directions = ring_directions(kViews, kElevations_deg);
  std::vector<std::vector<std::vector<double>>> found(  // per layer and view
      layers.size(), std::vector<std::vector<double>>(directions.size()));
  parallel_for(directions.size(), [&](std::size_t v) {
    const FarView view = far_view(box, directions[v], sample);
    SizedPictures finest(layers.back(), view, sizes);
    for (std::size_t k = 0; k + 1 < layers.size(); ++k) {
      if (sights[k].is_like_finer) continue;
      SizedPictures layer(layers[k], view, sizes);
      found[k][v] = differences(layer, finest, sizes.size());
    }
  });
  for (std::size_t k = 0; k + 1 < layers.size(); ++k)
    if (!sights[k].is_like_finer) sights[k].profile = profile_of(found[k], sizes, sample);
}

/// Sets deviations, and which layers are alike.
void measure_deviations(const std::vector<Mesh>& layers, std::vector<LayerSight>& sights) {
  std::vector<RayScene> scenes;
  for (const Mesh& mesh : layers) scenes.emplace_back(mesh);
  const auto between = [&](std::size_t a, std::size_t b) {
    if (is_same(layers[a], layers[b])) return 0.0;
    return two_sided_deviation(layers[a], scenes[a], layers[b], scenes[b]);
  };
  const std::size_t finest = layers.size() - 1;
  for (std::size_t k = finest; k-- > 0;) {
    const double to_finest = between(k, finest), finer = sights[k + 1].deviation;
    sights[k].deviation = std::max(to_finest, finer);
    // Were k near to k + 1, both would be as far from the finest.
    sights[k].is_like_finer =
        std::abs(to_finest - finer) <= kSameDistance && between(k, k + 1) <= kSameDistance;
  }
}

double own_gsd(const LayerSight& sight, const SwitchOptions& options) {
  const double g = options.measure == SwitchMeasure::kVisual
                       ? visible_gsd(sight.profile, options.visual_error)
                       : sight.deviation / options.pixel_error;
  return std::max({g, options.rounding / options.pixel_error, kLeastGsd});
}

double least_step(const SwitchOptions& options) {
  return options.measure == SwitchMeasure::kVisual ? kVisualStep : kDeviationStep;
}

/// Own gsds of the buildings that count, per layer.
std::vector<std::vector<double>> gsds_by_layer(const std::vector<BuildingSights>& buildings,
                                               int layers, const SwitchOptions& options) {
  std::vector<std::vector<double>> own(static_cast<std::size_t>(layers));
  for (const BuildingSights& b : buildings) {
    const std::vector<double> g = own_gsds(b, options);
    for (std::size_t i = 0; i + 1 < g.size(); ++i)
      if (!b.sights[i].is_like_finer) own[b.layers[i]].push_back(g[i]);
  }
  return own;
}

/// Who is shown too coarse and too fine by g.
SceneSwitch judge(double g, const std::vector<double>& own) {
  SceneSwitch out{.gsd = g, .buildings = static_cast<int>(own.size())};
  const double one = 1 / static_cast<double>(own.size());
  for (const double o : own) {
    if (o > g) out.too_coarse += one, out.coarse_factor = std::max(out.coarse_factor, o / g);
    if (o < g) out.too_fine += one, out.fine_factor = std::max(out.fine_factor, g / o);
  }
  return out;
}

}  // namespace

const char* to_string(SwitchMeasure measure) {
  return measure == SwitchMeasure::kVisual ? "visual" : "deviation";
}

const char* to_string(SwitchScope scope) {
  return scope == SwitchScope::kScene ? "scene" : "building";
}

std::vector<LayerSight> measure_sights(const std::vector<Mesh>& layers) {
  std::vector<LayerSight> sights(layers.size());
  if (layers.empty()) return sights;
  measure_deviations(layers, sights);
  const bool is_any = std::any_of(sights.begin(), sights.end() - 1,
                                  [](const LayerSight& s) { return !s.is_like_finer; });
  if (is_any) draw_profiles(layers, kFinestSample, sights);
  return sights;
}

VisibleProfile measure_profile(const Mesh& mesh, const Mesh& finest, double sample) {
  std::vector<LayerSight> sights(2);
  draw_profiles({mesh, finest}, sample, sights);
  return std::move(sights[0].profile);
}

double value_at_share(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double place = std::ceil(share * static_cast<double>(values.size()) - 1e-9) - 1;
  return values[static_cast<std::size_t>(
      std::clamp(place, 0.0, static_cast<double>(values.size() - 1)))];
}

double visible_gsd(const VisibleProfile& profile, double pixels) {
  for (std::size_t i = profile.size(); i-- > 0;) {
    const VisibleStep& over = profile[i];
    if (over.pixels <= pixels) continue;
    if (i + 1 == profile.size()) return over.gsd * over.pixels / pixels;
    const VisibleStep& within = profile[i + 1];
    const double share = (over.pixels - pixels) / (over.pixels - within.pixels);
    return over.gsd * std::pow(within.gsd / over.gsd, share);
  }
  return profile.empty() ? 0 : profile.front().gsd;
}

std::vector<double> own_gsds(const BuildingSights& building, const SwitchOptions& options) {
  std::vector<double> g(building.sights.size(), 0);
  for (std::size_t i = g.size(); i-- > 1;) {
    const LayerSight& sight = building.sights[i - 1];
    g[i - 1] =
        sight.is_like_finer ? g[i] : std::max(own_gsd(sight, options), least_step(options) * g[i]);
  }
  return g;
}

std::vector<SceneSwitch> plan_scene_switches(const std::vector<BuildingSights>& buildings,
                                             int layers, const SwitchOptions& options,
                                             const std::vector<BuildingSights>& others) {
  std::vector<std::vector<double>> own = gsds_by_layer(buildings, layers, options);
  const std::vector<std::vector<double>> spare = gsds_by_layer(others, layers, options);
  for (std::size_t k = 0; k < own.size(); ++k)
    if (own[k].empty()) own[k] = spare[k];
  std::vector<SceneSwitch> plan(own.size());
  for (std::size_t k = own.size(); k-- > 0;) {
    const double finer = k + 1 < own.size() ? plan[k + 1].gsd : 0;
    if (own[k].empty())
      plan[k].gsd = finer;
    else
      plan[k] = judge(std::max(value_at_share(own[k], options.share), least_step(options) * finer),
                      own[k]);
  }
  return plan;
}

}  // namespace colod
