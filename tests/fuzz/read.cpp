// Any bytes as a file of any format: an Error or valid sources, never a crash.
//   fuzz_read CORPUS -max_len=8192        the first byte of an input chooses the format
#include "read/read.h"

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "read/airborne.h"

namespace {

constexpr std::array kSuffixes{".obj", ".ply", ".off", ".stl",  ".gltf", ".glb",
                               ".xyz", ".pwn", ".csv", ".b3dm", ".las"};

void check(const colod::Source& source) {
  const auto count = static_cast<int>(source.mesh.vertices.size());
  for (const colod::Vec3& v : source.mesh.vertices)
    if (!v.allFinite()) std::abort();
  for (const colod::Face& f : source.mesh.faces)
    for (const int i : f)
      if (i < 0 || i >= count) std::abort();
  for (const colod::Vec3& v : source.cloud.points)
    if (!v.allFinite()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string path =
      std::filesystem::temp_directory_path() /
      ("colod-fuzz-" + std::to_string(getpid()) + kSuffixes[data[0] % kSuffixes.size()]);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data + 1), static_cast<std::streamsize>(size - 1));
  try {
    for (const colod::Source& source : colod::read_sources({path}).sources) check(source);
  } catch (const colod::Error&) {
  }
  try {
    colod::read_cloud_system(path);
    if (colod::is_cloud(path))
      colod::AirborneCloud(path, {}).visit([](const colod::AirbornePoint& p) {
        if (!p.at.allFinite()) std::abort();
      });
  } catch (const colod::Error&) {
  }
  unlink(path.c_str());
  return 0;
}
