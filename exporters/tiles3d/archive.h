// 3TZ: a whole tileset in one file.
#pragma once

#include "exporters/exporter.h"

namespace colod {

/// tileset.3tz: a ZIP of stored files, tileset.json among them, whose last entry is the index
/// "@3dtilesIndex1@" (MD5 of a path → place of its local header). Large archives become ZIP64.
/// No entry may reach 4 GiB: throws Error{kOutput}.
Encoded encode_3tz(const std::vector<Encoded>& files);

}  // namespace colod
