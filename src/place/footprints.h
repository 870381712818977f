// Outlines of buildings from a map: GeoJSON, GeoPackage, Shapefile, CityJSON, FlatGeobuf and what
// else GDAL reads. The only door to GDAL.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "place.h"

namespace colod {

using Attribute = std::pair<std::string, std::string>;  ///< name and value, UTF-8

/// The plan of a building in the scene's coordinates.
struct Footprint {
  std::string id;  ///< the attribute that names it; differs from all others'
  std::vector<std::vector<std::vector<Vec2>>> parts;  ///< per part its rings, the outer one first;
                                                      ///< open, no point twice
  std::vector<Attribute> attributes;                  ///< all of them, in the file's order
};

struct FootprintProblem {
  std::string id;
  std::string message;  ///< why it is left out; one line
};

struct Footprints {
  std::vector<Footprint> all;              ///< in the file's order
  std::vector<FootprintProblem> problems;  ///< of those that are left out
  std::vector<std::string> warnings;       ///< what was mended or assumed
  std::string crs;                         ///< of the file, by name; empty: it says none
};

/// Whether this program was built with GDAL.
bool can_read_footprints();

/// All polygons of all layers of a file. A scene on Earth has its footprints transformed from the
/// file's reference system (a file without one is in the scene's); one that is nowhere takes them
/// in its own metres, whatever the file says. `id`: the attribute that names buildings; empty:
/// `id`, `ID`, `name` or the feature's number. Heights are dropped. Polygons that cross themselves
/// are mended, equal ids become different, both with a warning. Throws Error{kInput} for a file
/// that cannot be read or holds no polygon, Error{kUsage} for an `id` that is no attribute and
/// where the program was built without GDAL.
Footprints read_footprints(const std::string& path, const std::string& id,
                           const std::optional<Georeference>& scene);

/// A building's plan as the text of a GeoJSON file: in longitude and latitude where the scene is
/// on Earth, else in its own metres.
std::string footprints_geojson(const std::vector<Footprint>& footprints,
                               const std::optional<Georeference>& scene);

}  // namespace colod
