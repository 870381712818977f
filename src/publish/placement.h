// Inside room `publish`: where a scene's tileset stands on Earth.
#pragma once

#include <string>
#include <vector>

#include "exporters/exporter.h"
#include "messages.h"

namespace colod {

/// By --crs and --origin, else by what lies beside the sources; where that is contradictory or
/// cannot be read nowhere, with a warning: never an invented place. Throws Error{kUsage} for
/// options that name no place.
Placement find_placement(const std::vector<std::string>& source_paths, const std::string& crs,
                         const std::string& origin, const std::vector<Vec3>& origins,
                         const Tell& tell);

}  // namespace colod
