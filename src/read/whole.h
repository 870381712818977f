// Inside room `read` only: from a file's bytes to triangles, and from these to a source.
#pragma once

#include <string>
#include <vector>

#include "formats.h"
#include "split.h"

namespace colod::mesh_io {

/// What a file of any format that is read says; text formats without their byte order mark. Throws
/// Error{kInput}.
RawFile read_raw(const std::string& path, const ReadOptions& options);

/// Throws Error{kInput} for indices out of range and for polygons of more corners than are read.
void check_faces(const std::string& path, const RawFile& raw);

/// Polygons with unusable corners are left out and counted in `dropped`.
Triangles triangulate(const RawFile& raw, int& dropped);

/// The chosen triangles as one source, with only the vertices that they use, in the file's order.
Source take(const RawFile& raw, const Triangles& all, const std::vector<int>& chosen);

/// Whether any face has an area.
bool has_area(const Mesh& mesh);

}  // namespace colod::mesh_io
