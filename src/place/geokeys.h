// Inside room `place` only: GeoTIFF's keys → a reference system, where they name none by a number.
#pragma once

#include <string>

#include "read/cloud_system.h"

namespace colod {

/// WKT of the projected system that keys define by its parameters; empty: not understood. Throws
/// Error{kInput} where the program was built without GDAL. Thread-safe.
std::string wkt_of_keys(const CloudSystem& system);

}  // namespace colod
