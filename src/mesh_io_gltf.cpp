#include "mesh_io_formats.h"

namespace colod::mesh_io {

RawFile read_gltf(const std::string& path, const std::string&) {
  fail(path, "glTF is not read yet");
}

}  // namespace colod::mesh_io
