// What stands for footprints.cpp where GDAL was absent when the program was configured.
#include "core/error.h"
#include "footprints.h"

namespace colod {

bool can_read_footprints() { return false; }

Footprints read_footprints(const std::string& path, const std::string&,
                           const std::optional<Georeference>&) {
  throw Error(Stage::kUsage, "--footprints",
              path + " cannot be read: this program was built without GDAL (libgdal-dev)");
}

}  // namespace colod
