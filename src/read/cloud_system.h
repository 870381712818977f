// What a LAS or LAZ file says of its own reference system, word for word: room `place` understands
// it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry.h"

namespace colod {

/// Records of the user LASF_Projection: WKT (2112) or GeoTIFF's keys with the numbers and texts
/// that these refer to (34735 to 34737), in the file's variable length records or, of LAS 1.4,
/// behind its points.
struct CloudSystem {
  std::string wkt;                  ///< empty: none
  std::vector<std::uint16_t> keys;  ///< version, revision, minor revision, count, then four a key:
                                    ///< id, where its value is, how many, value; empty: none
  std::vector<double> numbers;      ///< that keys refer to
  std::string texts;                ///< likewise, each with a `|` behind it
  bool prefers_wkt = false;         ///< by the header's bit for it, where both are there
  Vec3 middle = Vec3::Zero();       ///< of the box in the header; the file's units
  std::vector<std::string> problems;  ///< records that cannot be read, one line each

  bool is_empty() const { return wkt.empty() && keys.empty(); }
  /// A key that is one whole number; none: not there, or no number.
  std::optional<int> key(int id) const;
  /// A key that refers to one of `numbers`.
  std::optional<double> number(int id) const;
};

/// Reads the header and its records, not the points; packed points do not matter. What is no LAS
/// has no system.
CloudSystem read_cloud_system(const std::string& path);

/// Units of a cloud's axes, by its reference system.
struct CloudUnits {
  Vec3 metres = Vec3::Ones();  ///< in one unit of x, y and z
  std::string text;            ///< "US survey foot"; empty: metres, or nothing is said
  std::string doubt;           ///< what had to be assumed; empty: nothing
};
using UnitsOf = std::function<CloudUnits(const CloudSystem&)>;

/// LAS and LAZ files that lie in a folder itself, sorted; none where it holds other models, too.
std::vector<std::string> clouds_alone_in(const std::string& folder);

}  // namespace colod
