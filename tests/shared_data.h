// Data that are not in this repository, beside it or in the folder that COLOD_DATA names. A test
// that wants them says so and is counted as skipped where they are not there; the same is then
// tested with what assets/ has.
#pragma once

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

namespace colod::test {

inline std::filesystem::path shared_data() {
  const char* named = std::getenv("COLOD_DATA");
  return named ? named : COLOD_SOURCE_DIR "/../shared/data";
}

}  // namespace colod::test

/// Ends a test case as skipped where `wanted` is not there. ctest knows it by these words
/// (tests/CMakeLists.txt); Catch2 has none before its third version.
#define COLOD_SKIP_WITHOUT(wanted)                                                            \
  if (!std::filesystem::exists(wanted)) {                                                     \
    WARN("test skipped, since this is not here: " << std::filesystem::path(wanted).string()); \
    return;                                                                                   \
  }                                                                                           \
  static_assert(true)
