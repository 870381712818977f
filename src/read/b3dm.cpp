// Based on: 3D Tiles 1.0, Batched 3D Model.
// Differs: the batch table is not read: a tile of a scene is one surface.
#include <cstring>
#include <nlohmann/json.hpp>

#include "formats.h"

namespace colod::mesh_io {

namespace {

constexpr std::size_t kHeader = 28;

/// What all coordinates of the glTF are about; zero where nothing is said.
Vec3 rtc_center(const std::string& path, std::string_view table) {
  const nlohmann::json json = nlohmann::json::parse(table, nullptr, false);
  if (!json.is_object() || !json.contains("RTC_CENTER")) return Vec3::Zero();
  const nlohmann::json& center = json["RTC_CENTER"];
  if (!center.is_array() || center.size() != 3 || !center[0].is_number() ||
      !center[1].is_number() || !center[2].is_number())
    fail(path, "b3dm: its RTC_CENTER is not three numbers");
  return {center[0].get<double>(), center[1].get<double>(), center[2].get<double>()};
}

}  // namespace

RawFile read_b3dm(const std::string& path, const std::string& bytes, const ReadOptions& options) {
  const auto number = [&](std::size_t at) {
    std::uint32_t value;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  };
  if (bytes.size() < kHeader || !bytes.starts_with("b3dm"))
    fail(path, "b3dm: truncated, or another format");
  std::size_t begin = kHeader;
  for (const std::size_t at : {12, 16, 20, 24}) begin += number(at);
  if (number(8) > bytes.size() || begin >= bytes.size())
    fail(path, "b3dm: truncated: the header says " + std::to_string(number(8)) +
                   " bytes, the file has " + std::to_string(bytes.size()));
  const std::string_view table(bytes.data() + kHeader, number(12));
  RawFile raw = read_gltf(path, std::string_view(bytes).substr(begin), options, begin);
  raw.origin += rtc_center(path, table);
  return raw;
}

}  // namespace colod::mesh_io
