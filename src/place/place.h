// Where on Earth the input's coordinates are: from options or from files that lie beside the input.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry.h"

namespace colod {

/// A reference system and what must be added to the input's coordinates to be in it.
struct Georeference {
  std::string crs;             ///< "EPSG:n", "EPSG:n+m", WKT, or "ENU:latitude,longitude" (degrees)
  Vec3 offset = Vec3::Zero();  ///< easting, northing, height; metres
  std::string source;          ///< the option or the file that says so, for messages
  std::vector<std::string> warnings = {};  ///< what contradicts it or was left out, one line each
};

/// A georeference ready for use.
struct EarthMap {
  std::function<Vec3(const Vec3& world)>
      to_ecef;                        ///< metres, WGS 84 (EPSG:4978); thread-safe;
                                      ///< throws Error{kInput} outside the CRS's domain
  std::string name;                   ///< of the CRS
  std::vector<std::string> warnings;  ///< what had to be assumed, one line each
};

/// From --crs and --origin; empty strings: not given. `crs` "local": nothing, not even sidecars.
/// With a CRS the origin is easting,northing[,height] in it; without one it is
/// latitude,longitude[,height] of WGS 84, and the input's axes are east, north and up there.
/// Throws Error{kUsage}.
std::optional<Georeference> georeference_from_options(const std::string& crs,
                                                      const std::string& origin);

/// Where a tileset.json, alone or in a .3tz, says that its tiles are, when that is on Earth (ECEF):
/// axes east, north and up about the middle of its root's bounding volume. Nothing for a local one,
/// and for what is no tileset. Throws Error{kInput} for a .3tz that is no archive.
std::optional<Georeference> georeference_of_tileset(const std::string& path);

/// ECEF → the axes of a georeference "ENU:latitude,longitude,height", in metres.
Eigen::Matrix4d local_from_ecef(const Georeference& georeference);

/// From a tileset.json, a .3tz, a LAS or LAZ or a folder of these itself, else from files beside an
/// input file or folder: metadata.xml (SRS, SRSOrigin; also above folders called Data and Tile_*),
/// odm_georeferencing_model_geo.txt (from folders odm_* also in
/// ../odm_georeferencing), Pix4D's
/// *_offset.xyz with its .prj. Nothing where there is none. Of a cloud that says itself where it
/// is, files beside it that say otherwise are a warning, and where its own word is of no use, they
/// stand for it with one. Throws Error{kInput} naming a file that is there and cannot be
/// understood.
std::optional<Georeference> georeference_beside(const std::string& input);

/// Coordinates are always easting, northing, height, whatever order the CRS declares its axes in,
/// and metres, whatever its units. Heights are ellipsoidal unless the CRS is compound; where the
/// grid for a compound CRS's heights is not installed, they are taken as ellipsoidal with a
/// warning. `probe` is a point of the input, to try operations with. Throws Error{kUsage} for an
/// unknown CRS and for one that is not projected (degrees).
EarthMap place_on_earth(const Georeference& georeference, const Vec3& probe);

}  // namespace colod
