#include "placement.h"

#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "core/error.h"
#include "place/cloud_place.h"
#include "place/place.h"
#include "read/airborne.h"

namespace colod {
namespace {

constexpr const char* kAdvice = "; the tileset stays local: use --crs and --origin";

bool is_one_place(const std::optional<Georeference>& a, const std::optional<Georeference>& b,
                  const Vec3& at) {
  if (!a || !b) return a.has_value() == b.has_value();
  if (a->offset != b->offset) return false;
  return a->crs == b->crs || metres_apart(*a, *b, at) < kSamePlace;
}

/// What all sources or the files beside them say alike; sources from memory have none.
std::optional<Georeference> georeference_of_sources(const std::vector<std::string>& paths,
                                                    const Vec3& at, const Tell& tell) {
  std::optional<Georeference> found;
  std::set<std::string> keys;
  for (const std::string& path : paths) {
    if (path.empty()) continue;
    const std::string key = place_key(path);
    if (!keys.insert(key).second) continue;
    try {
      const auto here = georeference_beside(path);
      if (keys.size() == 1)
        found = here;
      else if (!is_one_place(found, here, at))
        throw Error(Stage::kInput, key, "lies elsewhere on Earth than the other sources");
    } catch (const Error& error) {
      tell({Level::kWarning, std::string(error.what()) + kAdvice});
      return {};
    }
  }
  return found;
}

/// The map of a place that files beside the input tell of: nothing, with a warning, where it is no
/// place for these buildings.
std::optional<EarthMap> try_place(const Georeference& g, const std::vector<Vec3>& origins,
                                  const Tell& tell) {
  try {
    EarthMap map = place_on_earth(g, origins.front());
    for (const Vec3& origin : origins) map.to_ecef(origin);
    return map;
  } catch (const Error& error) {
    const bool is_named = error.item == g.source;
    tell({Level::kWarning, (is_named ? "" : g.source + ": ") + error.what() + kAdvice});
    return {};
  }
}

/// The first cloud that says itself where it is, and not where the options put it.
void tell_contradiction(const std::vector<std::string>& paths, const Georeference& given,
                        const EarthMap& map, const Vec3& at, const Tell& tell) {
  std::set<std::string> keys;
  for (const std::string& path : paths) {
    if (path.empty() || !keys.insert(place_key(path)).second) continue;
    try {
      const auto own = georeference_of_cloud(path);
      if (!own) continue;
      const EarthMap there = place_on_earth(*own, at);
      if (const double off = (there.to_ecef(at) - map.to_ecef(at)).norm(); off > kSamePlace)
        return tell({Level::kWarning, given.source + " is taken, which puts it " +
                                          std::to_string(std::llround(off)) +
                                          " m away from where " + own->source +
                                          " says itself that it is (" + there.name + ")"});
    } catch (const Error&) {
      continue;  // what cannot be understood contradicts nothing
    }
  }
}

}  // namespace

std::string place_key(const std::string& path) {
  return is_las(path) ? path : std::filesystem::path(path).parent_path().string();
}

Placement find_placement(const std::vector<std::string>& source_paths, const std::string& crs,
                         const std::string& origin, const std::vector<Vec3>& origins,
                         const Tell& tell) {
  const std::optional<Georeference> given = georeference_from_options(crs, origin);
  std::optional<Georeference> found;
  if (!given && crs.empty()) found = georeference_of_sources(source_paths, origins.front(), tell);
  std::optional<EarthMap> map;
  if (given) {
    map = place_on_earth(*given, origins.front());
    tell_contradiction(source_paths, *given, *map, origins.front(), tell);
  }
  if (found) {
    for (const std::string& w : found->warnings) tell({Level::kWarning, w});
    map = try_place(*found, origins, tell);
  }
  if (!map) {
    if (!found)
      tell({Level::kInfo,
            "no --crs, --origin or file beside the input says where this is: the tileset is "
            "local, not placed on Earth"});
    return {};
  }
  for (const std::string& w : map->warnings) tell({Level::kWarning, w});
  tell({Level::kInfo, "the tileset is placed on Earth: " + map->name + ", from " +
                          (given ? given->source : found->source)});
  return {map->to_ecef, map->name};
}

}  // namespace colod
