// Inside room `read` only: which triangles of a file are one building.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats.h"
#include "read.h"

namespace colod::mesh_io {

/// The triangles of a file and the polygon each came from.
struct Triangles {
  std::vector<Face> faces;
  std::vector<Face> corners;  ///< of each: places in the file's list of corners
  std::vector<int> polygon;
};

/// A building of a file.
struct Part {
  std::string name;   ///< follows the file's stem; empty: the stem alone
  std::string given;  ///< as the file writes it; empty: the file names nothing
};

struct Parting {
  std::vector<int> part_of;  ///< triangle → part; −1: a coarser level of detail of one of them
  std::vector<Part> parts;
  std::string message;  ///< what was decided that a reader may have meant otherwise, and the option
                        ///< that overrules it; one line; empty: nothing
};

/// Points with equal coordinates: point → the lowest index of them.
std::vector<int> weld(const std::vector<Vec3>& points);

/// Parts of `how`. kAuto takes objects and nodes as buildings where each looks like one, joins
/// those that touch or cover one that does, keeps the finest of the levels of detail that names
/// tell, takes groups for buildings where all stand apart, and parts bodies that look like
/// buildings and stand apart.
Parting part_buildings(const RawFile& raw, const Triangles& all, Split how);

/// The name without its level of detail: "house" of "house_LOD1", "" of "lod2.2"; none: it tells no
/// level.
std::optional<std::string> name_without_level(const std::string& name);

}  // namespace colod::mesh_io
