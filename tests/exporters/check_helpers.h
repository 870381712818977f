// What tests of `info --check` share: findings by their codes, and a GLB from its parts.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "exporters/check/check.h"

namespace colod::test {

using Codes = std::set<std::string>;

inline Codes codes_of(const std::vector<Finding>& findings) {
  Codes out;
  for (const Finding& f : findings) out.insert(f.code);
  return out;
}

/// Codes found in a GLB.
inline Codes check(const std::string& glb) {
  std::vector<Finding> findings;
  check_glb(glb, "x.glb", findings);
  return codes_of(findings);
}

/// A GLB of a JSON chunk, which is padded, and a BIN chunk as it is.
inline std::string packed(std::string json, const std::string& binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto four = [](std::size_t v) {
    const auto value = static_cast<std::uint32_t>(v);
    return std::string(reinterpret_cast<const char*>(&value), 4);
  };
  return "glTF" + four(2) + four(28 + json.size() + binary.size()) + four(json.size()) + "JSON" +
         json + four(binary.size()) + std::string("BIN\0", 4) + binary;
}

}  // namespace colod::test
