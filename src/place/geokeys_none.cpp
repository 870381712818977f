// Without GDAL.
#include "core/error.h"
#include "geokeys.h"

namespace colod {

std::string wkt_of_keys(const CloudSystem&) {
  throw Error(
      Stage::kInput, "GeoTIFF keys",
      "define a projection by its parameters, which is read where colod is built with GDAL");
}

}  // namespace colod
