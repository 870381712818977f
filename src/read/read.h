// Files → Sources. The only room that knows file formats that come in.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cloud_system.h"
#include "core/geometry.h"

namespace colod {

enum class Split {
  kAuto,
  kNone,
  kObject,
  kGroup,
  kComponent
};  ///< how a file with several buildings is taken apart

enum class Up {
  kUnsaid,  ///< z, with a warning where what slopes tells that it is y
  kZ,
  kY,
  kAuto  ///< decided by what slopes and by the program that wrote the file, and said
};       ///< the axis of a file that points up

struct ReadOptions {
  Split split = Split::kAuto;  ///< auto: by overlap, nesting and names of glTF nodes, OBJ objects
                               ///< and groups, and bodies that stand apart; see docs/options.md
  Up up = Up::kUnsaid;         ///< glTF is y up and turned by itself; kUnsaid and kAuto doubt it
                               ///< where its content seems to be z up
  std::optional<double> unit =
      std::nullopt;            ///< metres per unit of the file, of glTF too; none: metres, with a
                               ///< warning where the size of what stands there tells otherwise
  double input_memory = 2048;  ///< MiB that one file may take, with those that it names; checked
                               ///< before they are read
  bool is_recursive = false;   ///< folders with their subfolders
  int coarser = 0;           ///< glTF: that many levels of MSFT_lod down from the finest; an error
                             ///< where there are fewer
  UnitsOf cloud_units = {};  ///< of LAS and LAZ, where `unit` is not given; empty: metres. Room
                             ///< `place` knows them: units_of_cloud
};

/// A file that could not be read; the others go on.
struct ReadFailure {
  std::string path;
  std::string message;  ///< one line naming the place and the cause
};

struct ReadResult {
  std::vector<Source>
      sources;  ///< in world coordinates, z up, metres; sorted by name; names unique
  std::vector<ReadFailure> failures;
};

/// A file that could be read and the names of the buildings in it, in its own order.
struct InputFile {
  std::string path;
  std::vector<std::string> names;  ///< unique among all files
};

struct Inventory {
  std::vector<InputFile> files;
  std::vector<ReadFailure> failures;
  std::vector<std::string> warnings;  ///< of the inputs as a whole: what was passed over

  std::size_t building_count() const {
    std::size_t count = 0;
    for (const InputFile& file : files) count += file.names.size();
    return count;
  }
};

/// What read_sources would read, without keeping it: every file is read once to learn what it
/// holds. Files are read in parallel.
Inventory take_inventory(const std::vector<std::string>& inputs, const ReadOptions& options = {});

/// The buildings of one file of an inventory, named as there. Throws Error{kInput} when the file
/// cannot be read any more or no longer holds as many.
std::vector<Source> read_file(const InputFile& file, const ReadOptions& options = {});

/// Reads every INPUT: a file, or a folder (each supported file in it, sorted by name; subfolders
/// with is_recursive). Formats: OBJ, PLY (mesh or points, text or binary), OFF, STL, glTF/GLB
/// (Draco and meshopt too), points as LAS, LAZ, XYZ, PWN, PTS, ASC, CSV, TXT. Validates:
/// coordinates finite (faces that use bad ones are dropped with a warning; points too), indices in
/// range (otherwise a failure), at least one face of positive area or 3 points; polygons are
/// fan-triangulated (concave ones by ear/CDT). Small pieces absurdly far from the rest are left
/// out. Clouds without normals get estimated and oriented ones, with a warning. Coordinates that
/// are degrees are a failure. Throws Error{kInput} only when an INPUT does not exist or a folder
/// holds no supported file.
ReadResult read_sources(const std::vector<std::string>& inputs, const ReadOptions& options = {});

/// A building that a caller holds in memory.
struct NamedArrays {
  std::string name;             ///< any text, in UTF-8
  std::vector<Vec3> points;     ///< in the unit and axes that ReadOptions say
  std::vector<Vec3> normals;    ///< per point, or empty
  std::vector<Face> triangles;  ///< empty: a cloud
};

/// As read_sources, of one building each, whatever options.split says: the same checks, and
/// failures that name the building. Sources have no path.
ReadResult take_arrays(const std::vector<NamedArrays>& buildings, const ReadOptions& options = {});

/// One file as one mesh, all its objects together, for `colod eval` and `colod info`. Throws
/// Error{kInput}. A building GLB with MSFT_lod gives the mesh of its scene (the finest layer).
Source read_single(const std::string& path, const ReadOptions& options = {});

}  // namespace colod
