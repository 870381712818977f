// Inside room `measure`: how much one task takes.
#pragma once

#include <cstddef>

namespace colod {

constexpr std::size_t kGrainOfQueries = 256;  // of nearest points
constexpr std::size_t kGrainOfRays = 64;

}  // namespace colod
