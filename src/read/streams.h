// Inside room `read` only: the points of a cloud, one by one, as many times as asked for.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "airborne.h"

namespace colod::mesh_io {

using TakePoint = std::function<void(const AirbornePoint&)>;

struct PointStream {
  std::function<void(const TakePoint&)>
      visit;  ///< in the file's order, units and axes; may hold NaN
  bool has_color = false;
  bool is_single = false;             ///< coordinates are of single precision
  Vec3 unit = Vec3::Ones();           ///< metres in one unit of each axis
  std::vector<std::string> warnings;  ///< without the file's name
};

/// Each throws Error{kInput} for a file that is broken; the points themselves may be found out to
/// be only when they are visited.
PointStream stream_las(const std::string& path, const ReadOptions& options);
PointStream stream_ply(const std::string& path, const ReadOptions& options);
PointStream stream_table(const std::string& path, const ReadOptions& options);

/// Whether a PLY has points and no faces, by its header.
bool is_ply_cloud(const std::string& path);

/// Whether twenty rows of numbers stand at a text's head.
bool is_table_file(const std::string& path);

}  // namespace colod::mesh_io
