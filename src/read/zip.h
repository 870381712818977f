// Inside room `read` only: ZIP archives. The only door to minizip.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace colod::mesh_io {

/// An entry that was not unpacked.
struct LeftOut {
  std::string name;   ///< as it stands in the archive: any bytes
  std::string file;   ///< where it would lie; empty: nowhere in the folder
  std::string cause;  ///< continues "entry 'x'"
};

/// All files of an archive into a folder that is there. `most_bytes`: of one file. Throws
/// Error{kInput} as Unpacked says.
std::vector<LeftOut> unzip(const std::string& path, const std::string& folder,
                           std::uint64_t most_bytes);

/// One file of an archive; none where it is not there, cannot be read or takes more. Throws
/// Error{kInput} for what is no archive.
std::optional<std::string> read_zipped(const std::string& path, const std::string& name,
                                       std::uint64_t most_bytes);

}  // namespace colod::mesh_io
