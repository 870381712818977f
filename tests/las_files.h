// LAS files made up for tests.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "core/geometry.h"

namespace colod::test {

/// Added to all points, as projected coordinates are.
const Vec3 kLasOffset(690000, 5330000, 500);

constexpr std::array<std::size_t, 11> kLengths = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::array<std::size_t, 11> kColorAt = {0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};

struct LasPoint {
  Vec3 at;
  int kind = 6;
  bool is_withheld = false;
};

template <typename T>
void set_at(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof(T));
}

inline std::string las(const std::vector<LasPoint>& points, int minor, int format,
                       std::size_t extra = 0) {
  const std::size_t head = minor == 4 ? 375 : minor == 3 ? 235 : 227;
  const std::size_t length = kLengths[format] + extra;
  std::string bytes(head + 10 + points.size() * length, '\0');
  bytes.replace(0, 4, "LASF");
  set_at<std::uint8_t>(bytes, 24, 1),
      set_at<std::uint8_t>(bytes, 25, static_cast<std::uint8_t>(minor));
  set_at<std::uint16_t>(bytes, 94, static_cast<std::uint16_t>(head));
  set_at<std::uint32_t>(bytes, 96, static_cast<std::uint32_t>(head + 10));
  set_at<std::uint8_t>(bytes, 104, static_cast<std::uint8_t>(format));
  set_at<std::uint16_t>(bytes, 105, static_cast<std::uint16_t>(length));
  const bool is_new = minor == 4 && format >= 6;  // the old count is then 0
  set_at<std::uint32_t>(bytes, 107, is_new ? 0 : static_cast<std::uint32_t>(points.size()));
  if (minor == 4) set_at<std::uint64_t>(bytes, 247, points.size());
  for (int k = 0; k < 3; ++k)
    set_at(bytes, 131 + 8 * k, 0.001), set_at(bytes, 155 + 8 * k, kLasOffset[k]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t p = head + 10 + i * length;
    for (int k = 0; k < 3; ++k)
      set_at(bytes, p + 4 * k, static_cast<std::int32_t>(std::lround(1000 * points[i].at[k])));
    const auto kind = static_cast<std::uint8_t>(points[i].kind);
    if (format >= 6) {
      set_at(bytes, p + 16, kind);
      set_at<std::uint8_t>(bytes, p + 15, points[i].is_withheld ? 4 : 0);
    } else {
      set_at<std::uint8_t>(bytes, p + 15, kind | (points[i].is_withheld ? 128 : 0));
    }
    for (std::size_t k = 0; kColorAt[format] > 0 && k < 3; ++k)
      set_at<std::uint16_t>(bytes, p + kColorAt[format] + 2 * k,
                            static_cast<std::uint16_t>(256 * ((i + k) % 200)));
  }
  return bytes;
}

/// A variable length record; `is_late`: one of LAS 1.4 behind the points.
struct LasRecord {
  int id;
  std::string bytes;
  bool is_late = false;
};

/// GeoTIFF's directory of keys that are whole numbers.
inline LasRecord geokeys(const std::vector<std::array<int, 2>>& keys) {
  std::string bytes(8 * (1 + keys.size()), '\0');
  set_at<std::uint16_t>(bytes, 0, 1), set_at<std::uint16_t>(bytes, 2, 1);
  set_at<std::uint16_t>(bytes, 6, static_cast<std::uint16_t>(keys.size()));
  for (std::size_t i = 0; i < keys.size(); ++i) {
    set_at<std::uint16_t>(bytes, 8 * i + 8, static_cast<std::uint16_t>(keys[i][0]));
    set_at<std::uint16_t>(bytes, 8 * i + 12, 1);
    set_at<std::uint16_t>(bytes, 8 * i + 14, static_cast<std::uint16_t>(keys[i][1]));
  }
  return {34735, bytes};
}

/// A LAS with records of the user LASF_Projection.
inline std::string with_records(std::string bytes, const std::vector<LasRecord>& records) {
  std::string early, late;
  std::uint32_t early_count = 0, late_count = 0;
  for (const LasRecord& r : records) {
    std::string head(r.is_late ? 60 : 54, '\0');
    head.replace(2, 15, "LASF_Projection");
    set_at<std::uint16_t>(head, 18, static_cast<std::uint16_t>(r.id));
    if (r.is_late)
      set_at<std::uint64_t>(head, 20, r.bytes.size());
    else
      set_at<std::uint16_t>(head, 20, static_cast<std::uint16_t>(r.bytes.size()));
    (r.is_late ? late : early) += head + r.bytes;
    ++(r.is_late ? late_count : early_count);
  }
  std::uint16_t head_size;
  std::memcpy(&head_size, bytes.data() + 94, 2);
  std::uint32_t begin;
  std::memcpy(&begin, bytes.data() + 96, 4);
  set_at<std::uint32_t>(bytes, 96, begin + static_cast<std::uint32_t>(early.size()));
  set_at<std::uint32_t>(bytes, 100, early_count);
  if (late_count > 0) {
    set_at<std::uint64_t>(bytes, 235, bytes.size() + early.size());
    set_at<std::uint32_t>(bytes, 243, late_count);
  }
  return bytes.insert(head_size, early) + late;
}

}  // namespace colod::test
