#include "kept_switching.h"

#include <nlohmann/json.hpp>

#include "core/hash.h"

namespace colod {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson options_json(const SwitchOptions& o) {
  return {{"measure", to_string(o.measure)},
          {"scope", to_string(o.scope)},
          {"visual_error", o.visual_error},
          {"pixel_error", o.pixel_error},
          {"share", o.share},
          {"rounding", o.rounding}};
}

std::string indented(const OrderedJson& json) {
  return json.dump(1, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

}  // namespace

std::string switching_text(const Switching& switching) {
  OrderedJson json = {{"options", options_json(switching.options)},
                      {"from_prior", switching.is_from_prior},
                      {"warnings", switching.warnings},
                      {"layers", OrderedJson::array()}};
  for (const SceneSwitch& s : switching.layers)
    json["layers"].push_back(
        {s.gsd, s.buildings, s.too_coarse, s.coarse_factor, s.too_fine, s.fine_factor});
  json["hash"] = hash_of(indented(json));
  return indented(json);
}

std::optional<Switching> switching_of(const std::string& text, const SwitchOptions& options) {
  try {
    OrderedJson json = OrderedJson::parse(text);
    const std::string hash = json.at("hash");
    json.erase("hash");
    if (hash != hash_of(indented(json))) return std::nullopt;
    if (json.at("options") != options_json(options)) return std::nullopt;
    Switching switching;
    switching.options = options;
    switching.is_from_prior = json.at("from_prior");
    switching.warnings = json.at("warnings").get<std::vector<std::string>>();
    for (const OrderedJson& s : json.at("layers"))
      switching.layers.push_back({s.at(0), s.at(1), s.at(2), s.at(3), s.at(4), s.at(5)});
    return switching;
  } catch (const OrderedJson::exception&) {
    return std::nullopt;
  }
}

}  // namespace colod
