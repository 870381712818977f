// Based on: RFC 7946.
// Differs: of a scene that is nowhere on Earth coordinates are its own metres, which a foreign
// member says, as the format knows no such thing.
#include <nlohmann/json.hpp>
#include <numbers>

#include "footprints.h"
#include "local.h"

namespace colod {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double value, double step) { return std::round(value / step) * step; }

/// Longitude and latitude to about a centimetre; metres to the millimetre.
Json point_json(const Vec2& p, const std::optional<EarthMap>& map) {
  if (!map) return {rounded(p.x(), 1e-3), rounded(p.y(), 1e-3)};
  const Vec3 place = ecef_to_geodetic(map->to_ecef({p.x(), p.y(), 0}));
  return {rounded(place.y() * 180 / std::numbers::pi, 1e-8),
          rounded(place.x() * 180 / std::numbers::pi, 1e-8)};
}

}  // namespace

std::string footprints_geojson(const std::vector<Footprint>& footprints,
                               const std::optional<Georeference>& scene) {
  std::optional<EarthMap> map;
  if (scene) map = place_on_earth(*scene, Vec3::Zero());
  Json json = {{"type", "FeatureCollection"}};
  if (!map) json["frame"] = "x and y of the scene in metres; no place on Earth";
  json["features"] = Json::array();
  for (const Footprint& f : footprints) {
    Json parts = Json::array();
    for (const auto& part : f.parts) {
      Json rings = Json::array();
      for (const std::vector<Vec2>& ring : part) {
        Json points = Json::array();
        for (std::size_t i = 0; i <= ring.size(); ++i)
          points.push_back(point_json(ring[i % ring.size()], map));
        rings.push_back(std::move(points));
      }
      parts.push_back(std::move(rings));
    }
    Json feature = {{"type", "Feature"}, {"properties", {{"id", f.id}}}};
    for (const auto& [name, value] : f.attributes)
      if (name != "id") feature["properties"][name] = value;
    const bool is_one = parts.size() == 1;
    feature["geometry"] = {{"type", is_one ? "Polygon" : "MultiPolygon"},
                           {"coordinates", is_one ? parts[0] : parts}};
    json["features"].push_back(std::move(feature));
  }
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace colod
