// Any bytes as a scene file: an Error, or buildings that can be exported, never a crash.
//   fuzz_store CORPUS -max_len=131072      start from scene files of small buildings
#include "store/store.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "publish/publish.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = std::filesystem::temp_directory_path() /
                           ("colod-fuzz-" + std::to_string(getpid()) + ".colod");
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    const colod::Store store(path, false);
    store.options();
    store.sights();
    for (const std::string& name : store.names()) {
      colod::Building building = store.building(name);
      colod::export_building(building);
    }
    store.prior();
  } catch (const colod::Error&) {
  }
  unlink(path.c_str());
  return 0;
}
