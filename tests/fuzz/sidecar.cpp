// Any bytes as the file beside a source that says where on Earth it is, and as --crs and --origin:
// an Error or a place, never a crash.
//   fuzz_sidecar CORPUS -max_len=65536     the first byte of an input chooses
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "place/place.h"

namespace fs = std::filesystem;

namespace {

constexpr std::array kNames{"metadata.xml", "odm_georeferencing_model_geo.txt", "x_offset.xyz"};

void place(const colod::Georeference& found) { colod::place_on_earth(found, {0, 0, 0}); }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data + 1), size - 1);
  const std::size_t kind = data[0] % (kNames.size() + 1);
  const fs::path folder = fs::temp_directory_path() / ("colod-fuzz-" + std::to_string(getpid()));
  fs::create_directories(folder);
  try {
    if (kind == kNames.size()) {
      const std::size_t cut = bytes.find('\n');
      const std::string origin = cut == std::string::npos ? "" : bytes.substr(cut + 1);
      if (const auto found = colod::georeference_from_options(bytes.substr(0, cut), origin))
        place(*found);
    } else {
      std::ofstream(folder / kNames[kind], std::ios::binary) << bytes;
      if (const auto found = colod::georeference_beside((folder / "x.obj").string())) place(*found);
    }
  } catch (const colod::Error&) {
  }
  fs::remove_all(folder);
  return 0;
}
