#include "options_text.h"

#include <nlohmann/json.hpp>

#include "parts.h"
#include "rules/rules.h"

namespace colod {
namespace {

using Json = nlohmann::json;

RuleSet rules_of(const Json& json, const std::string& path) {
  if (json.value("rules", "robust") == "paper") return RuleSet::none();
  RuleSet rules = RuleSet::all();
  for (const std::string& id : json.value("without", std::vector<std::string>{}))
    rules = rules.without(rule_named(id, path));
  return rules;
}

}  // namespace

std::string options_text(const Options& o) {
  Json json{{"rules", o.rules.is_none() ? "paper" : "robust"},
            {"visibility", name_of(o.visibility)},
            {"layering", o.is_size_layering ? "size" : "spectral"}};
  if (!o.rules.is_none() && !o.rules.is_all()) json["without"] = ids_off(o.rules);
  for (const OptionInfo& info : option_table()) json[info.name] = info.get(o);
  return json.dump();
}

Options options_of(const std::string& text, const std::string& where) {
  Options options;
  read_json(text, where, "options", [&](const Json& json) {
    options.rules = rules_of(json, where);
    options.visibility = visibility_of(json.value("visibility", "embree"));
    options.is_size_layering = json.value("layering", "spectral") == "size";
    for (const OptionInfo& info : option_table()) {
      const double value = json.value(info.name, info.get(options));
      if (!(value >= info.min && value <= info.max))
        throw Error(Stage::kInput, where, "damaged: its option " + info.name + " is wild");
      info.set(options, value);
    }
  });
  return options;
}

}  // namespace colod
