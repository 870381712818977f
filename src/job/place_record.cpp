// Based on: own work.
#include "place_record.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "place/cloud_place.h"

namespace colod {

namespace {

using Json = nlohmann::json;

std::string absolute(const std::string& path) {
  return path.empty() ? path : std::filesystem::absolute(path).lexically_normal().string();
}

}  // namespace

std::string to_json(const PlaceRecord& record) {
  const SceneChoice& choice = record.choice;
  Json json = {
      {"input", absolute(record.input)},           {"up", static_cast<int>(record.read.up)},
      {"input_memory", record.read.input_memory},  {"context", static_cast<int>(choice.context)},
      {"footprints", absolute(choice.footprints)}, {"footprint_id", choice.footprint_id},
      {"source_level", choice.source_level}};
  if (record.read.unit) json["unit"] = *record.read.unit;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

PlaceRecord place_record_of(const std::string& text) {
  const Json json = Json::parse(text);
  PlaceRecord record;
  record.input = json.at("input");
  record.read.up = static_cast<Up>(json.at("up").get<int>());
  record.read.input_memory = json.at("input_memory");
  if (json.contains("unit")) record.read.unit = json.at("unit").get<double>();
  record.read.cloud_units = units_of_cloud;
  record.choice = {.mode = SceneMode::kScene,
                   .context = static_cast<ContextMode>(json.at("context").get<int>()),
                   .footprints = json.at("footprints"),
                   .footprint_id = json.at("footprint_id"),
                   .source_level = json.at("source_level")};
  return record;
}

void add_place_again(const PlaceRecord& record, const SceneOutput& output, const Tell& tell,
                     Scene& built) {
  const auto give_up = [&](const std::string& cause) {
    built.failures.push_back({record.input, cause + "; what is around its buildings is left out"});
  };
  Inputs found;
  try {
    found = open_inputs({record.input}, record.read, record.choice, output, tell);
  } catch (const Error& e) {
    return give_up(std::string("cannot be opened again: ") + e.what());
  }
  const std::vector<std::string>& names = found.scene->names;
  for (const Building& b : built.buildings)
    if (std::find(names.begin(), names.end(), b.source.name) == names.end())
      return give_up("has no building " + b.source.name + " any more: run colod segment again");
  add_place(found, built);
}

}  // namespace colod
