#include "placement.h"

#include <filesystem>
#include <optional>
#include <set>

#include "core/error.h"
#include "place/place.h"

namespace colod {
namespace {

constexpr const char* kAdvice = "; the tileset stays local: use --crs and --origin";

/// What the files beside all sources say alike; sources from memory have none.
std::optional<Georeference> georeference_of_sources(const std::vector<std::string>& paths,
                                                    const Tell& tell) {
  std::optional<Georeference> found;
  std::set<std::string> folders;
  for (const std::string& path : paths) {
    if (path.empty()) continue;
    const std::string folder = std::filesystem::path(path).parent_path().string();
    if (!folders.insert(folder).second) continue;
    try {
      const auto here = georeference_beside(path);
      if (folders.size() == 1)
        found = here;
      else if (found.has_value() != here.has_value() ||
               (found && (found->crs != here->crs || found->offset != here->offset)))
        throw Error(Stage::kInput, folder, "lies elsewhere on Earth than the other sources");
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

}  // namespace

Placement find_placement(const std::vector<std::string>& source_paths, const std::string& crs,
                         const std::string& origin, const std::vector<Vec3>& origins,
                         const Tell& tell) {
  const std::optional<Georeference> given = georeference_from_options(crs, origin);
  std::optional<Georeference> found;
  if (!given && crs.empty()) found = georeference_of_sources(source_paths, tell);
  std::optional<EarthMap> map;
  if (given)
    map = place_on_earth(*given, origins.front());
  else if (found)
    map = try_place(*found, origins, tell);
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
