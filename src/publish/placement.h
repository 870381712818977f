// Inside room `publish`: where a scene's tileset stands on Earth.
#pragma once

#include <string>
#include <vector>

#include "exporters/exporter.h"
#include "messages.h"

namespace colod {

/// By --crs and --origin, else by what clouds say themselves or what lies beside the sources; where
/// that is contradictory or cannot be read nowhere, with a warning: never an invented place. Throws
/// Error{kUsage} for options that name no place. `source_paths` may have those of place_key once
/// each.
Placement find_placement(const std::vector<std::string>& source_paths, const std::string& crs,
                         const std::string& origin, const std::vector<Vec3>& origins,
                         const Tell& tell);

/// What of a source's path tells where it is: the file of a cloud, else the folder.
std::string place_key(const std::string& path);

}  // namespace colod
