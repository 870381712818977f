// Any bytes as a GLB, or as a tileset.json beside a good tile: findings, never a crash.
//   fuzz_check CORPUS -max_len=8192        the first byte of an input chooses
#include "exporters/check/check.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "exporters/check/files.h"

namespace fs = std::filesystem;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data + 1), size - 1);
  std::vector<colod::Finding> findings;
  if (data[0] % 2 == 0) {
    colod::check_glb(bytes, "x.glb", findings);
    return 0;
  }
  const fs::path folder = fs::temp_directory_path() / ("colod-fuzz-" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "tileset.json", std::ios::binary) << bytes;
  std::ofstream(folder / "a.glb", std::ios::binary) << "glTF";
  colod::check_output(folder.string());
  fs::remove_all(folder);
  return 0;
}
