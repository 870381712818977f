// What the records of a LAS or LAZ file mean: its place on Earth and the units of its axes.
#pragma once

#include <optional>
#include <string>

#include "place.h"
#include "read/cloud_system.h"

namespace colod {

/// Units of a cloud's axes: by GeoTIFF's keys for them, else by the axes of its system. Heights of
/// which nothing is said have the horizontal unit, which is a doubt where that is no metre. Degrees
/// and what is not understood count as metres.
CloudUnits units_of_cloud(const CloudSystem& system);

/// Where a LAS or LAZ file, or all those of a folder that holds nothing else to read, say
/// themselves that they are. What of it had to be left out is among its warnings. Nothing where
/// none says anything, and for other inputs. Throws Error{kInput} naming the file for a system that
/// is unknown, cut, or in degrees, and for files of one folder that lie more than a metre off each
/// other.
std::optional<Georeference> georeference_of_cloud(const std::string& input);

/// Metres between the places that two georeferences give to one point; infinite where one of them
/// has none for it.
double metres_apart(const Georeference& a, const Georeference& b, const Vec3& at);

/// What differs by less is one place: realizations of a datum, and the digits of parameters.
constexpr double kSamePlace = 1;  // metre

}  // namespace colod
