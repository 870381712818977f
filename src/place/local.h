// Inside room `place` only: places in degrees, and axes east, north and up about one.
#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "place.h"

namespace colod {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kFarthest = 1e8;  ///< metres: no system's coordinates reach it

/// "a,b" or "a,b,c", blanks allowed around; nothing when it is anything else.
std::optional<std::vector<double>> numbers(const std::string& text);

/// A text of any length for a message.
std::string shortened(const std::string& text);

/// Radians and metres of WGS 84, ellipsoidal.
Vec3 geodetic_to_ecef(double latitude, double longitude, double height);
/// Latitude, longitude (radians) and height.
Vec3 ecef_to_geodetic(const Vec3& ecef);

struct LocalPlace {
  Vec3 centre;           ///< ECEF
  Eigen::Matrix3d axes;  ///< columns: east, north, up in ECEF
};

/// Of "ENU:latitude,longitude[,height]". Throws Error{kUsage}.
LocalPlace local_place(const Georeference& georeference);

}  // namespace colod
