// Clouds of LAS points in other formats, made up for tests.
#pragma once

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "las_files.h"

namespace colod::test {

/// Where a LAS of these points has one, to a millimetre.
inline Vec3 las_place(const LasPoint& p) {
  Vec3 at;
  for (int k = 0; k < 3; ++k)
    at[k] = static_cast<double>(std::lround(1000 * p.at[k])) * 0.001 + kLasOffset[k];
  return at;
}

/// Rows of x, y, z, with `has_kinds` a class behind them, and a header that names them.
inline std::string table_of(const std::vector<LasPoint>& points, bool has_kinds,
                            const std::string& header = "", const char* separator = " ") {
  std::string out = header.empty() ? "" : header + "\n";
  for (const LasPoint& p : points) {
    const Vec3 at = las_place(p);
    char row[120];
    std::snprintf(row, sizeof row, "%.3f%s%.3f%s%.3f", at.x(), separator, at.y(), separator,
                  at.z());
    out += row + (has_kinds ? separator + std::to_string(p.kind) : std::string()) + "\n";
  }
  return out;
}

enum class PlyCoding { kText, kLittle, kBig };

/// Doubles, with a class where `has_kinds`; an element without use stands before the vertices.
inline std::string ply_of(const std::vector<LasPoint>& points, PlyCoding coding, bool has_kinds,
                          const std::string& type = "double") {
  const char* const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  std::string out = "ply\nformat " + std::string(names[static_cast<int>(coding)]) +
                    " 1.0\nelement camera 1\nproperty list uchar uchar view\nelement vertex " +
                    std::to_string(points.size()) + "\nproperty " + type + " x\nproperty " + type +
                    " y\nproperty " + type + " z\n" +
                    (has_kinds ? "property uchar classification\n" : "") + "end_header\n";
  const auto append = [&](auto value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if (coding == PlyCoding::kBig) std::reverse(bytes, bytes + sizeof value);
    out.append(bytes, sizeof value);
  };
  if (coding == PlyCoding::kText) return out + "2 7 7\n" + table_of(points, has_kinds);
  out += std::string("\2\7\7");
  for (const LasPoint& p : points) {
    const Vec3 at = las_place(p);
    for (int k = 0; k < 3; ++k)
      if (type == "float")
        append(static_cast<float>(at[k]));
      else
        append(at[k]);
    if (has_kinds) append(static_cast<std::uint8_t>(p.kind));
  }
  return out;
}

}  // namespace colod::test
