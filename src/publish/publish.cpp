// Based on: own work.
// Differs: the same under both rules.
// Notation: none.
#include "publish.h"

#include <filesystem>

namespace colod {

ExportBuilding export_building(const Building& b) {
  ExportBuilding result{.name = b.source.name,
                        .source = std::filesystem::path(b.source.path).filename().string(),
                        .origin = b.frame.origin,
                        .levels = {},
                        .given_name = b.source.given_name};
  bool is_like_last = false;
  for (const Layer& layer : b.layers) {
    if (!layer.failure.empty()) continue;
    if (!is_like_last) result.levels.emplace_back();
    ExportLevel& level = result.levels.back();
    level.layers.push_back(layer.layer);
    level.mesh = layer.mesh;
    level.gsd = layer.gsd;
    level.deviation = layer.sight.deviation;
    is_like_last = layer.sight.is_like_finer;
  }
  return result;
}

SwitchFacts switch_facts(const Switching& switching) {
  const SwitchOptions& o = switching.options;
  SwitchFacts facts{.measure = to_string(o.measure),
                    .scope = to_string(o.scope),
                    .visual_error = o.visual_error,
                    .pixel_error = o.pixel_error,
                    .share = o.share,
                    .layer_gsd = {}};
  if (o.scope == SwitchScope::kScene)
    for (const SceneSwitch& layer : switching.layers) facts.layer_gsd.push_back(layer.gsd);
  return facts;
}

}  // namespace colod
