// colod: chains of clean, watertight levels of detail, consistent over all buildings of a scene.
//
// This header is the library's manual, and all of it. Link `colod::colod` (CMake) or `colod`
// (pkg-config); only the C++17 standard library is needed to use it.
//
//   colod::Scene scene = colod::build({"houses/"}, {{"layers", "3"}, {"format", "glb,3dtiles"}});
//   for (const colod::Building& b : scene.buildings()) std::cout << b.name << '\n';
//   scene.write("out");
//
// Words. A *layer* is a level of detail of one building: layer 0 is the coarsest, the last one the
// finest, which is the other way round than engines count. A scene's buildings are worked on
// together, so that parts of a kind stand on the same layer everywhere: give all of them in one
// call.
//
// Units. Metres, z up, right-handed. Input may be otherwise and say so (options `unit`, `up`). A
// mesh that comes out is local to its building, with axes parallel to the input's; add the
// building's `origin` for the input's coordinates.
//
// Options are those of `colod build`, by the same names without dashes in front, and values are
// spelled as there: {"ns", "64"}, {"rules", "paper"}, {"format", "glb,obj"}; a flag is
// {"recursive", "true"}. list_options() names all of them. What is left out has its default. Two do
// not go with arrays, `split` and `recursive`.
//
// Errors. What stops the job as a whole (an unknown option, a path that does not exist, a folder
// that cannot be written to) throws Error. What goes wrong with one building or file does not: it
// keeps its place, with the reason in Building::failure, Layer::failure and messages().
//
// Threads. A job uses all cores, or as many threads as the option `threads` says. Several jobs may
// run at once, on scenes of their own, and give the same bytes as one after the other; only the
// small program that selects layer 0 waits for the other's. One Scene may be read from several
// threads. The same input and options give the same bytes with any number of threads; times and
// memory in the report are apart from that.
//
// Versions. Names live in a namespace that carries the version of the binary interface, `colod_v0`,
// for which `colod` is an alias. While it is 0, a new minor version may change it; the name of the
// shared library then changes too.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#define COLOD_API __attribute__((visibility("default")))

namespace colod_v0 {

/// Such as "0.1.0"; of the library that is loaded.
COLOD_API const char* version();

/// Why a job stopped. The numbers are the exit codes of the program.
enum class Fault {
  kUsage = 2,     ///< an option, its value, or an index
  kInput = 3,     ///< what was to be read
  kProcess = 4,   ///< a stage, or memory
  kOutput = 5,    ///< what was to be written
  kCancelled = 6  ///< a callback said so
};

/// what() is one line, "item: cause"; `item` is the option, file or building.
class COLOD_API Error : public std::runtime_error {
 public:
  Error(Fault fault, const std::string& item, const std::string& cause);
  ~Error() override;
  Fault fault() const { return fault_; }
  const std::string& item() const { return item_; }

 private:
  Fault fault_;
  std::string item_;
};

using Options = std::map<std::string, std::string>;

struct OptionInfo {
  std::string name;      ///< key of Options
  std::string help;      ///< one line, with unit and default
  bool is_flag = false;  ///< its value is "true" or "false"
};

/// All keys that Options may have, in the order of `colod build --help`.
COLOD_API std::vector<OptionInfo> list_options();

using Point = std::array<double, 3>;
using Triangle = std::array<std::int32_t, 3>;  ///< counter-clockwise seen from outside

/// A building that goes in from memory.
struct NamedMesh {
  std::string name;                 ///< UTF-8; the building's given_name
  std::vector<Point> points;        ///< at least three; those that are not finite are left out
  std::vector<Triangle> triangles;  ///< indices into `points`; empty: a cloud of points
  std::vector<Point> normals;       ///< of a cloud, as many as points; empty: estimated
};

/// What comes out: polygons with holes, and the same surface as triangles.
struct Mesh {
  std::vector<Point> points;
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> polygon_of_triangle;  ///< as many as triangles
  std::vector<Point> normals;                     ///< unit, outward; one a polygon
  /// Polygon p has the rings polygon_rings[p] to polygon_rings[p + 1] - 1: first its border,
  /// counter-clockwise seen from outside, then its holes, clockwise. One longer than `normals`.
  std::vector<std::int32_t> polygon_rings;
  /// Ring r has the points ring_points[ring_offsets[r]] to ring_points[ring_offsets[r + 1] - 1].
  std::vector<std::int32_t> ring_offsets;
  std::vector<std::int32_t> ring_points;  ///< indices into `points`
};

/// One level of detail; its mesh is Scene::mesh.
struct Layer {
  int layer = 0;         ///< 0 = coarsest
  double gsd = 0;        ///< metres a pixel: it may be shown where a pixel covers at least that
  double deviation = 0;  ///< metres, two-sided, from the finest layer
  bool is_like_finer =
      false;            ///< hardly differs from the next finer one: they share one mesh in files
  std::string failure;  ///< why it has no mesh; empty: it has
};

struct Building {
  std::string name;           ///< unique in the scene, safe as a file name
  std::string given_name;     ///< as the input writes it
  std::string source;         ///< path of the file it came from; empty: from memory
  Point origin{};             ///< of its meshes, in the input's coordinates
  std::string failure;        ///< why it has no layer at all; empty: it has
  bool has_lost = false;      ///< a body, layer or texture of it is gone: messages() says which
  std::vector<Layer> layers;  ///< coarsest first
};

struct Message {
  enum class Level { kInfo, kWarning, kError };
  Level level = Level::kInfo;
  std::string text;  ///< names what it is about
};

/// A file to be: its path below the folder ('/' separated) and its bytes.
struct File {
  std::string path;
  std::string bytes;
};

/// A building has passed a stage, "segments" or "layers": all pass the first, then all the second.
struct Progress {
  std::string building;
  std::string stage;
  int done = 0, total = 0;  ///< buildings that have passed this stage, of how many
};

/// Both may be empty. What they throw ends the job and reaches the caller.
struct Callbacks {
  /// Called from one thread at a time, not always the same one.
  std::function<void(const Progress&)> progress;
  /// Asked between buildings, stages and layers, from several threads at once; true ends the job
  /// with Error{kCancelled}. Nothing has been written then.
  std::function<bool()> cancel;
};

/// A finished scene.
class COLOD_API Scene {
 public:
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  /// Sorted by name. Files that could not be read are in messages() only.
  const std::vector<Building>& buildings() const;

  /// Of buildings()[building].layers[layer]; empty where that failed. Throws Error{kUsage} for
  /// indices out of range.
  Mesh mesh(std::size_t building, std::size_t layer) const;

  /// Failures, losses and warnings; once files were made, also what happened there.
  std::vector<Message> messages() const;

  /// As the program's exit code: 0 all done and nothing lost; 1 something failed or was lost, the
  /// rest is there; 3 nothing could be read; 4 no building has come out.
  int status() const;

  /// What was done, building by building and layer by layer; docs/outputs.md describes it.
  std::string report_json() const;

  /// All files that write() writes, as the option `format` asks, sorted by path: GLBs, tilesets,
  /// report.json, and report.html unless no-report-html is set. All of them are in memory at once.
  std::vector<File> files() const;

  /// Makes the folder unless it is there, and writes each file to a temporary name and renames it,
  /// tileset.json after the tiles that it names. Files of the same names are replaced, others
  /// stay. Throws Error{kOutput}.
  void write(const std::string& folder) const;

 private:
  struct Impl;
  explicit Scene(std::unique_ptr<Impl> impl);
  friend struct Access;
  std::unique_ptr<Impl> impl_;
};

/// The buildings of files and folders: OBJ, PLY, OFF, STL, glTF/GLB, and points as LAS, PLY, XYZ,
/// PTS, CSV, PWN; docs/options.md says how files are taken apart into buildings.
COLOD_API Scene build(const std::vector<std::string>& paths, const Options& options = {},
                      const Callbacks& callbacks = {});

/// Buildings in memory, each one building. Names need not differ. Not an overload: {"a", "b"} could
/// be meant for either.
COLOD_API Scene build_meshes(const std::vector<NamedMesh>& meshes, const Options& options = {},
                             const Callbacks& callbacks = {});

}  // namespace colod_v0

#ifndef COLOD_NO_ALIAS  // inside the library, whose own rooms are called colod
namespace colod = colod_v0;
#endif
