// A cloud of a whole place, LAS or LAZ, point by point: memory does not follow the file.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "read.h"

namespace colod {

struct AirbornePoint {
  Vec3 at;   ///< metres, z up, in the file's frame
  int kind;  ///< class, as LAS numbers them: 2 ground, 3 to 5 plants, 6 building
  std::array<std::uint16_t, 3> color;  ///< as the file has it: of 8 or of 16 bits
};

class AirborneCloud {
 public:
  /// LAZ is unpacked into the system's folder for temporary files. Throws Error{kInput} for what is
  /// no LAS 1.0 to 1.4, or cut.
  AirborneCloud(const std::string& path, const ReadOptions& options);
  ~AirborneCloud();
  AirborneCloud(AirborneCloud&&) noexcept;

  bool has_color() const;
  /// What is to be told of it, one line each, without its name.
  const std::vector<std::string>& warnings() const;
  /// In the file's order, without noise (classes 7 and 18) and what was withheld.
  void visit(const std::function<void(const AirbornePoint&)>& take) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether a file is one by its name.
bool is_airborne(const std::string& path);

}  // namespace colod
