// What stands for zip.cpp where minizip was absent when the program was configured.
#include "formats.h"
#include "zip.h"

namespace colod::mesh_io {

std::vector<LeftOut> unzip(const std::string& path, const std::string&, std::uint64_t) {
  fail(path,
       "an archive is not read: this program was built without minizip (libminizip-dev); `unzip "
       "IN.3tz -d DIR` unpacks it, then DIR is the input");
}

std::optional<std::string> read_zipped(const std::string&, const std::string&, std::uint64_t) {
  return {};
}

}  // namespace colod::mesh_io
