// Based on: EXT_mesh_features, EXT_structural_metadata (3D Tiles Next drafts that 3D Tiles 1.1
// names).
// Differs: the same columns everywhere but for attributes of footprints, which follow.
#include "metadata.h"

#include <algorithm>
#include <map>

namespace colod {

using OrderedJson = nlohmann::ordered_json;

namespace {

/// File names may be in any encoding, strings of a property table only in UTF-8.
std::string as_utf8(const std::string& text) {
  return OrderedJson::parse(
             OrderedJson(text).dump(-1, ' ', false, OrderedJson::error_handler_t::replace))
      .get<std::string>();
}

/// Buffer views of columns. Those with the same bytes share one, as many do in a tile of one
/// building: a view takes more bytes in JSON than it has itself.
class Columns {
 public:
  explicit Columns(GltfDocument& document) : document_(document) {}
  std::size_t view(const std::string& bytes) {
    const auto known = views_.find(bytes);
    if (known != views_.end()) return known->second;
    return views_[bytes] = add_buffer_view(document_, bytes);
  }
  OrderedJson strings(const std::vector<std::string>& values);

 private:
  GltfDocument& document_;
  std::map<std::string, std::size_t> views_;
};

OrderedJson Columns::strings(const std::vector<std::string>& values) {
  std::string bytes, offsets;
  for (const std::string& value : values) {
    put(offsets, static_cast<std::uint32_t>(bytes.size()));
    bytes += as_utf8(value);
  }
  put(offsets, static_cast<std::uint32_t>(bytes.size()));
  if (bytes.empty()) bytes = std::string(1, '\0');  // a buffer view must not be empty
  OrderedJson column;
  column["values"] = view(bytes);
  column["stringOffsets"] = view(offsets);
  return column;
}

OrderedJson scalar(const char* type) { return {{"type", "SCALAR"}, {"componentType", type}}; }

/// The name of an attribute as an id of a schema: letters, digits and `_`, no other column's.
std::string column_id(const std::string& name) {
  std::string id;
  for (const char c : name) {
    const bool is_word =
        (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
    id += is_word ? c : '_';
  }
  if (id.empty() || (id[0] >= '0' && id[0] <= '9')) id = "_" + id;
  return id;
}

/// Columns of attributes: id and name, in the order in which features have them.
std::vector<std::pair<std::string, std::string>> attribute_columns(
    const std::vector<Feature>& features, const OrderedJson& others) {
  std::vector<std::pair<std::string, std::string>> out;
  const auto is_taken = [&](const std::string& id) {
    return others.contains(id) ||
           std::any_of(out.begin(), out.end(), [&](const auto& c) { return c.first == id; });
  };
  for (const Feature& f : features)
    for (const auto& attribute : f.attributes) {
      const std::string& name = attribute.first;
      if (std::any_of(out.begin(), out.end(), [&](const auto& c) { return c.second == name; }))
        continue;
      std::string id = column_id(name);
      while (is_taken(id)) id += "_";
      out.emplace_back(id, name);
    }
  return out;
}

std::string value_of(const Feature& feature, const std::string& name) {
  for (const auto& [own, value] : feature.attributes)
    if (own == name) return value;
  return "";
}

OrderedJson schema() {
  OrderedJson properties;
  properties["name"] = {{"type", "STRING"}};
  properties["layer"] = scalar("INT16");
  properties["coarsest_layer"] = scalar("INT16");
  properties["gsd"] = scalar("FLOAT32");
  properties["deviation"] = scalar("FLOAT32");
  properties["source"] = {{"type", "STRING"}};
  properties["given_name"] = {{"type", "STRING"}};
  properties["faces"] = scalar("UINT32");
  OrderedJson out;
  out["id"] = "colod";
  out["classes"]["building"]["properties"] = properties;
  return out;
}

}  // namespace

const std::string& shown_name(const ExportBuilding& building) {
  return building.given_name.empty() ? building.name : building.given_name;
}

Feature feature_of(const ExportBuilding& building, const ExportLevel& level, double deviation,
                   std::size_t faces) {
  return {building.name,
          level.layers.back(),
          level.layers.front(),
          level.gsd,
          deviation,
          building.source,
          faces,
          shown_name(building),
          building.attributes};
}

OrderedJson switching_json(const SwitchFacts& facts) {
  OrderedJson json = {{"measure", facts.measure},
                      {"scope", facts.scope},
                      {"visualError", facts.visual_error},
                      {"pixelError", facts.pixel_error},
                      {"share", facts.share},
                      {"viewportHeight", facts.viewport_height},
                      {"fovYDeg", facts.fov_y_deg}};
  for (std::size_t k = 0; k < facts.layer_gsd.size(); ++k)
    json["layers"].push_back({{"layer", k}, {"gsd", facts.layer_gsd[k]}});
  return json;
}

void add_features(GltfDocument& document, const std::vector<Feature>& features) {
  std::vector<std::string> names, given_names, sources;
  std::string layers, coarsest, gsds, deviations, faces;
  for (const Feature& f : features) {
    names.push_back(f.name);
    given_names.push_back(f.given_name);
    sources.push_back(f.source);
    put(layers, static_cast<std::int16_t>(f.layer));
    put(coarsest, static_cast<std::int16_t>(f.coarsest_layer));
    put(gsds, static_cast<float>(f.gsd));
    put(deviations, static_cast<float>(f.deviation));
    put(faces, static_cast<std::uint32_t>(f.faces));
  }
  OrderedJson table = {{"class", "building"}, {"count", features.size()}};
  Columns columns(document);
  table["properties"]["name"] = columns.strings(names);
  table["properties"]["layer"]["values"] = columns.view(layers);
  table["properties"]["coarsest_layer"]["values"] = columns.view(coarsest);
  table["properties"]["gsd"]["values"] = columns.view(gsds);
  table["properties"]["deviation"]["values"] = columns.view(deviations);
  table["properties"]["source"] = columns.strings(sources);
  table["properties"]["given_name"] = columns.strings(given_names);
  table["properties"]["faces"]["values"] = columns.view(faces);
  OrderedJson described = schema();
  OrderedJson& properties = described["classes"]["building"]["properties"];
  for (const auto& [id, name] : attribute_columns(features, properties)) {
    std::vector<std::string> values;
    for (const Feature& f : features) values.push_back(value_of(f, name));
    properties[id] = {{"name", as_utf8(name)}, {"type", "STRING"}};
    table["properties"][id] = columns.strings(values);
  }
  document.json["extensions"]["EXT_structural_metadata"] = {
      {"schema", described}, {"propertyTables", OrderedJson::array({table})}};
  for (const char* name : {"EXT_mesh_features", "EXT_structural_metadata"})
    document.json["extensionsUsed"].push_back(name);
}

OrderedJson feature_ids(std::size_t count) {
  OrderedJson out;
  out["featureIds"] =
      OrderedJson::array({{{"featureCount", count}, {"attribute", 0}, {"propertyTable", 0}}});
  return out;
}

}  // namespace colod
