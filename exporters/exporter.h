// What all exporters share: they see results, never the pipeline, and return bytes; files.* alone
// writes them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "../src/geometry.h"

namespace colod {

/// A file to be: its path below OUT ('/' separated) and its bytes.
struct Encoded {
  std::string path;
  std::string bytes;
};

/// How vertex data are packed: plain floats, KHR_draco_mesh_compression, or
/// EXT_meshopt_compression.
enum class Compression { kNone, kDraco, kMeshopt };

/// One layer of one building as exporters see it. Coordinates: building-local metres, z up, axes
/// parallel to the world's (the pipeline has undone the frame's yaw); world = local +
/// ExportBuilding::origin.
struct ExportLayer {
  int layer = 0;  ///< 0 = coarsest
  PolygonMesh mesh;
  double geometric_error = 0;  ///< metres, measured: the one-sided Hausdorff distance source →
                               ///< layer and, after measure_visible_errors, to finer layers both
                               ///< ways; never less than a finer layer's
};

struct ExportBuilding {
  std::string name;
  std::string source;               ///< file it came from
  Vec3 origin = Vec3::Zero();       ///< world position of the local origin
  std::vector<ExportLayer> layers;  ///< coarsest first; not empty; layers that failed are absent
};

/// Where the scene stands on Earth.
struct Placement {
  std::function<Vec3(const Vec3& world)> to_ecef;  ///< thread-safe; empty: nowhere on Earth
  std::string name;                                ///< of the reference system, for readers
};

}  // namespace colod
