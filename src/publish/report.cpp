#include "report.h"

#include <sys/resource.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "exporters/exporter.h"
#include "pipeline/losses.h"
#include "pipeline/stand_ins.h"
#include "rules/rules.h"
#include "scene/left_out.h"

namespace colod {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson parameters_json(const Options& options) {
  OrderedJson json;
  json["rules"] = options.rules.is_none() ? "paper" : "robust";
  if (!options.rules.is_none() && !options.rules.is_all()) json["without"] = ids_off(options.rules);
  json["visibility"] = name_of(options.visibility);
  json["layering"] = options.is_size_layering ? "size" : "spectral";
  for (const OptionInfo& info : option_table()) {
    if (info.is_integer)
      json[info.name] = static_cast<std::int64_t>(info.get(options));
    else
      json[info.name] = info.get(options);
  }
  return json;
}

/// A measure that may be unknown, which is negative inside the program and null in the report.
OrderedJson known(double value) { return value < 0 ? OrderedJson() : OrderedJson(value); }

/// As `colod eval` prints them, places in the world's frame.
OrderedJson looks_in_world(Looks looks, const Vec3& origin) {
  for (FaultPlace& worst : looks.worst) worst.place += origin;
  OrderedJson json = OrderedJson::parse(looks_json(looks));
  json["triangles_ratio"] = known(looks.triangles_ratio);
  return json;
}

OrderedJson texture_json(const LayerTexture& texture) {
  const BakeFacts& f = texture.facts;
  return {{"width", f.width},     {"height", f.height},     {"texel", f.texel},
          {"charts", f.charts},   {"bytes", texture.bytes}, {"seen", f.seen},
          {"nearest", f.nearest}, {"filled", f.filled},     {"unseen", f.unseen}};
}

OrderedJson layer_json(const Layer& layer, const Vec3& origin) {
  OrderedJson json{{"layer", layer.layer}, {"segments", layer.segments}};
  if (!layer.failure.empty()) {
    json["failure"] = layer.failure;
    return json;
  }
  json["vertices"] = layer.validity.vertices;
  json["faces"] = layer.validity.faces;
  json["polygons"] = layer.validity.polygons;
  json["watertight"] = layer.validity.is_watertight;
  json["manifold"] = layer.validity.is_manifold;
  json["self_intersections"] = layer.validity.self_intersections;
  json["components"] = layer.validity.components;
  json["enclosed_components"] = layer.validity.enclosed_components;
  json["least_width"] = layer.validity.least_width;
  json["volume"] = layer.validity.volume;
  json["hausdorff"] = layer.distances.a_to_b;
  json["hausdorff_relative"] = layer.distances.relative;
  json["mean_distance"] = layer.distances.mean_a_to_b;
  const Spread& d = layer.distances.taken;
  json["distance"] = {{"mean", d.mean}, {"p95", d.p95}, {"p99", d.p99}, {"max", d.max}};
  json["deviation"] = layer.sight.deviation;
  json["gsd"] = layer.gsd;
  json["own_gsd"] = layer.own_gsd;
  json["invented"] = known(layer.invented);
  json["looks"] = looks_in_world(layer.looks, origin);
  json["like_finer"] = layer.sight.is_like_finer;
  if (layer.stand_in != StandIn::kNone)
    json["stand_in"] = {{"reason", to_string(layer.stand_in)},
                        {"failure", is_failure(layer.stand_in)},
                        {"message", describe(layer.stand_in)}};
  if (layer.bytes > 0) json["bytes"] = layer.bytes;
  if (layer.texture) json["texture"] = texture_json(*layer.texture);
  return json;
}

OrderedJson left_out_json(const LeftOut& l) {
  return {{"reason", to_string(l.reason)},
          {"area", l.area},
          {"share", l.share},
          {"volume", known(l.volume)},
          {"volume_share", known(l.volume_share)},
          {"farthest", l.farthest}};
}

OrderedJson building_json(const Building& b, bool has_prior) {
  OrderedJson json{{"name", b.source.name},
                   {"given_name", b.source.given_name},
                   {"source", b.source.path},
                   {"vertices", b.counts.vertices},
                   {"faces", b.counts.faces},
                   {"planes", b.counts.planes},
                   {"segments", b.segments.segments.size()},
                   {"prior", has_prior},
                   {"diagonal", b.counts.diagonal},
                   {"origin", {b.frame.origin.x(), b.frame.origin.y(), b.frame.origin.z()}}};
  json["solid_volume"] = known(b.solid);
  json["left_out"] = OrderedJson::array();
  for (const LeftOut& l : b.left_out) json["left_out"].push_back(left_out_json(l));
  json["left_out_total"] = left_out_json(total_of(b.left_out));
  json["left_out_total"].erase("reason");
  json["layers"] = OrderedJson::array();
  for (const Layer& layer : b.layers) json["layers"].push_back(layer_json(layer, b.frame.origin));
  json["timings"] = {{"read", b.timings.read},
                     {"planes", b.timings.planes},
                     {"visibility", b.timings.visibility},
                     {"segments", b.timings.segments},
                     {"similarity", b.timings.similarity},
                     {"extraction", b.timings.extraction},
                     {"measure", b.timings.measure},
                     {"pictures", b.timings.pictures},
                     {"export", b.timings.export_}};
  std::vector<std::string> warnings = loss_warnings(b);
  warnings.insert(warnings.end(), b.lost_looks.begin(), b.lost_looks.end());
  json["heavy_warnings"] = warnings.size();
  warnings.insert(warnings.end(), b.warnings.begin(), b.warnings.end());
  json["warnings"] = warnings;
  json["lost"] = b.has_lost();
  json["lost_textures"] = b.lost_looks;
  if (!b.failure.empty()) json["failure"] = b.failure;
  return json;
}

OrderedJson switching_json(const Switching& switching) {
  const SwitchFacts viewport;
  const double view = 2 * std::tan(viewport.fov_y_deg * std::numbers::pi / 360);
  const SwitchOptions& o = switching.options;
  OrderedJson json = {{"measure", to_string(o.measure)},
                      {"scope", to_string(o.scope)},
                      {"visual_error", o.visual_error},
                      {"pixel_error", o.pixel_error},
                      {"share", o.share},
                      {"viewport_height", viewport.viewport_height},
                      {"fov_y_deg", viewport.fov_y_deg},
                      {"from_prior", switching.is_from_prior},
                      {"warnings", switching.warnings},
                      {"layers", OrderedJson::array()}};
  for (std::size_t k = 0; k < switching.layers.size(); ++k) {
    const SceneSwitch& s = switching.layers[k];
    json["layers"].push_back({{"layer", k},
                              {"gsd", s.gsd},
                              {"switch_distance", s.gsd * viewport.viewport_height / view},
                              {"buildings", s.buildings},
                              {"too_coarse", s.too_coarse},
                              {"too_coarse_factor", s.coarse_factor},
                              {"too_fine", s.too_fine},
                              {"too_fine_factor", s.fine_factor}});
  }
  return json;
}

/// How many assignments of segments to layers are whose.
OrderedJson decided_json(const Scene& scene, const Tally& tally) {
  const std::size_t overruled = scene.overruled.size(), segments = tally.segments;
  const std::size_t beyond = tally.beyond_layer0;
  const bool is_by_kind = !scene.clustering.kinds.empty();
  return {{"program", segments - std::min(segments, beyond)},
          {"clustering", is_by_kind ? beyond - std::min(beyond, overruled) : 0},
          {"size", is_by_kind ? 0 : beyond - std::min(beyond, overruled)},
          {"overruled", overruled}};
}

OrderedJson kinds_json(const Clustering& clustering) {
  OrderedJson json = OrderedJson::array();
  for (const KindFacts& k : clustering.kinds)
    json.push_back({{"layer", k.layer}, {"segments", k.segments}, {"extent", k.extent}});
  return json;
}

/// What the program kept on layer 0 and a rule took away.
OrderedJson overruled_json(const Scene& scene) {
  OrderedJson json = OrderedJson::array();
  for (const OverruledSegment& o : scene.overruled)
    json.push_back({{"building", o.building},
                    {"segment", o.segment},
                    {"kind", name_of(o.kind)},
                    {"rule", "selection.whole_kinds"}});
  return json;
}

OrderedJson coanalysis_json(const Scene& scene, const Tally& tally) {
  std::vector<std::string> warnings = scene.selection.warnings;
  warnings.insert(warnings.end(), scene.clustering.warnings.begin(),
                  scene.clustering.warnings.end());
  return {{"segments", tally.segments},
          {"buildings", tally.buildings},
          {"objective", scene.selection.objective},
          {"bound", scene.selection.bound},
          {"gap", scene.selection.gap},
          {"status", to_string(scene.selection.status)},
          {"solver", scene.selection.is_lp_solve ? "lp_solve" : "block ascent"},
          {"decided", decided_json(scene, tally)},
          {"kinds", kinds_json(scene.clustering)},
          {"overruled", overruled_json(scene)},
          {"seconds", scene.coanalysis_seconds},
          {"warnings", warnings}};
}

/// How much is amiss, over all buildings.
void put_losses(const Scene& scene, const Tally& tally, OrderedJson& totals) {
  totals["failed_buildings"] = scene.failures.size() + tally.failed;
  totals["failed_layers"] = tally.failed_layers;
  totals["stand_in_layers"] = tally.stand_in_layers;
  totals["lost_bodies"] = tally.lost_bodies;
  totals["lost_textures"] = tally.lost_textures;
}

std::string dumped(const OrderedJson& json) {
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
}

}  // namespace

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

ReportFrame report_frame(const Scene& scene, const Options& options, const RunTotals& totals,
                         const Tally& tally) {
  OrderedJson json;
  json["colod"] = COLOD_VERSION;
  json["parameters"] = parameters_json(options);
  json["totals"] = {
      {"seconds", totals.seconds},
      {"export_seconds", scene.export_seconds},
      {"peak_memory_bytes", totals.peak_memory_bytes},
      {"rays", tally.rays},
      {"rays_per_second",
       tally.ray_seconds > 0 ? static_cast<double>(tally.rays) / tally.ray_seconds : 0.0}};
  put_losses(scene, tally, json["totals"]);
  json["coanalysis"] = coanalysis_json(scene, tally);
  json["switching"] = switching_json(scene.switching);
  if (!scene.consistency.empty())
    json["consistency"] = OrderedJson::parse(consistency_json(scene.consistency));
  json["warnings"] = scene.warnings;
  for (const ClassArea& c : scene.classes)
    json["classes"].push_back({{"name", c.name}, {"area", c.area}});
  std::string before = dumped(json);
  before.resize(before.size() - 2);  // "\n}": the object goes on
  OrderedJson rest;
  rest["failures"] = OrderedJson::array();
  for (const ReadFailure& f : scene.failures)
    rest["failures"].push_back({{"source", f.path}, {"message", f.message}});
  if (!scene.tileset_failure.empty())
    rest["failures"].push_back({{"source", "tileset.json"}, {"message", scene.tileset_failure}});
  return {before + ",\n  \"buildings\": [", "]," + dumped(rest).substr(1) + "\n"};
}

std::string report_row(const Scene& scene, const Building& b) {
  OrderedJson json =
      building_json(b, scene.has_prior || scene.placed_later.contains(b.source.name));
  if (const auto own = scene.attributes.find(b.source.name); own != scene.attributes.end())
    for (const auto& [name, value] : own->second) json["attributes"][name] = value;
  std::string row = "\n";
  for (const char c : dumped(json)) c == '\n' ? row += "\n    " : row += c;
  return row.insert(1, "    ");
}

std::string report_json(const Scene& scene, const Options& options, const RunTotals& totals) {
  const ReportFrame frame = report_frame(scene, options, totals, tally_of(scene));
  std::string text = frame.before;
  for (std::size_t i = 0; i < scene.buildings.size(); ++i)
    text += (i > 0 ? "," : "") + report_row(scene, scene.buildings[i]);
  return text + (scene.buildings.empty() ? "" : "\n  ") + frame.after;
}

}  // namespace colod
