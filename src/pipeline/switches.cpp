#include "switches.h"

namespace colod {
namespace {

/// One warning for each layer that most buildings have nothing for.
std::vector<std::string> idle_layers(const std::vector<BuildingSights>& buildings, int layers) {
  std::vector<std::size_t> shown(static_cast<std::size_t>(layers), 0), alike = shown;
  for (const BuildingSights& b : buildings)
    for (std::size_t i = 0; i + 1 < b.layers.size(); ++i)
      ++shown[b.layers[i]], alike[b.layers[i]] += b.sights[i].is_like_finer;
  std::vector<std::string> warnings;
  for (std::size_t k = 0; k < shown.size(); ++k)
    if (2 * alike[k] > shown[k])
      warnings.push_back("layers " + std::to_string(k) + " and " + std::to_string(k + 1) +
                         " are alike in " + std::to_string(alike[k]) + " of " +
                         std::to_string(shown[k]) +
                         " buildings, which have one level for both; --layers " +
                         std::to_string(std::max(1, layers - 1)) +
                         " asks for fewer, --layering size and --beta part them elsewhere");
  return warnings;
}

BuildingSights sights_of(const Building& b) {
  BuildingSights out;
  for (const Layer& layer : b.layers)
    if (layer.failure.empty()) out.layers.push_back(layer.layer), out.sights.push_back(layer.sight);
  return out;
}

}  // namespace

void decide_switches(Scene& scene, int layers, const SwitchOptions& options,
                     const std::vector<BuildingSights>& prior) {
  std::vector<BuildingSights> own;
  for (const Building& b : scene.buildings) own.push_back(sights_of(b));
  scene.switching = plan_switches(own, layers, options, prior);
  for (Building& b : scene.buildings) apply_switches(scene.switching, b);
}

Switching plan_switches(const std::vector<BuildingSights>& own, int layers,
                        const SwitchOptions& options, const std::vector<BuildingSights>& prior) {
  Switching switching;
  switching.options = options;
  switching.is_from_prior = !prior.empty();
  switching.layers = prior.empty() ? plan_scene_switches(own, layers, options)
                                   : plan_scene_switches(prior, layers, options, own);
  switching.warnings = idle_layers(own, layers);
  return switching;
}

void apply_switches(const Switching& switching, Building& b) {
  const std::vector<double> gsds = own_gsds(sights_of(b), switching.options);
  std::size_t next = 0;
  for (Layer& layer : b.layers) {
    if (!layer.failure.empty()) continue;
    layer.own_gsd = layer.gsd = gsds[next++];
    if (switching.options.scope == SwitchScope::kScene && next < gsds.size())
      layer.gsd = switching.layers[layer.layer].gsd;
  }
}

}  // namespace colod
