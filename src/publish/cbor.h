// What is kept between two runs, as bytes: CBOR, which holds any number exactly.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace colod {

inline std::string cbor_of(const nlohmann::json& json) {
  std::string bytes;
  nlohmann::json::to_cbor(json, bytes);
  return bytes;
}

}  // namespace colod
