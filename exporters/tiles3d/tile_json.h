// What buildings' tiles and the context's have in common in the tileset's JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "core/geometry.h"

namespace colod {

constexpr double kRise = 1.01;        // a parent's error is at least this times its children's
constexpr double kLeastError = 1e-3;  // metres; of a tile that has children, or coarse pixels

/// A bounding volume, z up.
inline nlohmann::ordered_json box_json(const Box& box) {
  const Vec3 c = box.center(), h = 0.5 * box.size();
  return {{"box", {c.x(), c.y(), c.z(), h.x(), 0, 0, 0, h.y(), 0, 0, 0, h.z()}}};
}

}  // namespace colod
