// A cloud of a whole place, seen from above, point by point: memory does not follow the file.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "read.h"

namespace colod {

struct AirbornePoint {
  Vec3 at;   ///< metres, z up, in the file's frame
  int kind;  ///< class, as LAS numbers them: 2 ground, 3 to 5 plants, 6 building; 0: none is said
  std::array<std::uint16_t, 3> color;  ///< as a LAS has it: of 8 or of 16 bits; else of 8
};

/// Of LAS, LAZ, PLY without faces, and tables of points (XYZ, PTS, PWN; ASC, CSV and TXT that are
/// such). Classes are those of LAS, of a PLY's property or a table's column called classification,
/// class or scalar_Classification.
class AirborneCloud {
 public:
  /// LAZ is unpacked into the system's folder for temporary files; a table is read once to learn
  /// what its columns are. Throws Error{kInput} for what is no cloud, or cut.
  AirborneCloud(const std::string& path, const ReadOptions& options);
  ~AirborneCloud();
  AirborneCloud(AirborneCloud&&) noexcept;

  bool has_color() const;
  /// Coordinates have the digits of single precision.
  bool is_single() const;
  /// What is to be told of it, one line each, without its name.
  const std::vector<std::string>& warnings() const;
  /// In the file's order, without noise (classes 7 and 18), what was withheld, and what has no
  /// finite place. Throws Error{kInput} for a body that is broken.
  void visit(const std::function<void(const AirbornePoint&)>& take) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether a file is LAS or LAZ by its name.
bool is_las(const std::string& path);

/// Whether AirborneCloud reads it: by its name, a PLY by its header, a text by its first lines.
bool is_cloud(const std::string& path);

}  // namespace colod
