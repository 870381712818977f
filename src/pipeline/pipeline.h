// The whole job as a list of verbs: sources → segments → layers → meshes. No file formats here.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bake/bake.h"
#include "coanalysis/clustering.h"
#include "coanalysis/selection.h"
#include "core/error.h"
#include "core/options.h"
#include "extraction/extraction.h"
#include "measure/consistency.h"
#include "measure/looks.h"
#include "measure/metrics.h"
#include "measure/switching.h"
#include "read/frame.h"
#include "read/read.h"
#include "segments/segments.h"

namespace colod {

/// Why a layer's mesh is the next finer layer's. Both keep the chain right for a viewer.
enum class StandIn {
  kNone,      ///< it is its own
  kRicher,    ///< it had more vertices or faces than the finer one: harmless, the finer one is
              ///< simpler and nearer to the source
  kInvented,  ///< most of its tops and many sides were far from the source: a failure
  kVolume  ///< it enclosed another volume, so it had lost a part of the building or gained one: a
           ///< failure of the layer
};

/// As in report.json: "richer", "invented", "volume"; empty for kNone.
const char* to_string(StandIn reason);
/// Whether it hides that the layer went wrong.
bool is_failure(StandIn reason);

/// A layer's texture as it was written.
struct LayerTexture {
  BakeFacts facts;
  std::size_t bytes = 0;  ///< of the encoded image
};

/// One layer of one building with its measures.
struct Layer {
  int layer = 0;        ///< 0 = coarsest
  PolygonMesh mesh;     ///< building-local metres, axes parallel to the world's; empty: failed
  int segments = 0;     ///< on layers ≤ this one
  Validity validity;    ///< of the mesh as written (doubles), self-intersections included
  Distances distances;  ///< source against the layer
  Looks looks;          ///< places are in the frame of the mesh
  LayerSight sight;     ///< against the finest layer, for switching
  double own_gsd = 0;  ///< metres a pixel: where the layer may stand by this building's measure …
  double gsd = 0;      ///< … and where it does (set by switches.h)
  std::size_t bytes = 0;  ///< of its mesh as the building's GLB packs it; 0: none written
  std::optional<LayerTexture> texture;  ///< none: none was made
  std::string failure;                  ///< why there is no mesh; empty: there is one
  StandIn stand_in = StandIn::kNone;
  double invented =
      -1;  ///< 0..1 of its surface far from the source (measure/scene_part.h); −1: unknown
};

/// Seconds of wall clock per stage; buildings overlap when several threads run.
struct Timings {
  double read = 0, planes = 0, visibility = 0, segments = 0, similarity = 0, extraction = 0,
         measure = 0, pictures = 0, export_ = 0;
};

/// What the report says of data that may have been let go.
struct Counts {
  std::size_t vertices = 0, faces = 0;  ///< of the source; points count as vertices
  std::size_t planes = 0;
  double diagonal = 0;  ///< metres, of the source's box
};

/// All that is known of one building.
struct Building {
  Source source;  ///< in its local frame
  Counts counts;
  Frame frame;  ///< local → world
  Planes planes;
  Segments segments;
  std::vector<Descriptor> descriptors;  ///< per segment
  std::vector<int> layer_of_segment;    ///< 0..l_n − 1
  std::vector<Layer> layers;            ///< l_n of them unless the building failed
  Timings timings;
  bool has_texture = false;       ///< the source shows more than one colour a face …
  bool has_colors = false;        ///< … or any colour at all
  std::vector<LeftOut> left_out;  ///< of the source, and why
  double solid = -1;  ///< m³ that the source encloses (measure/solid.h); −1: not measured
  std::vector<std::string> lost_looks;  ///< textures that are wanted and not there, one line each
  std::vector<std::string> warnings;
  std::string failure;        ///< why the building has no layer at all; empty: it has
  bool is_dismissed = false;  ///< found on a place, and none after all: `failure` says why

  bool has_failed() const;
  /// Whether too much of the finest layer has nothing of the source behind it (kMostRagged).
  bool is_ragged() const;
  /// That, or a body of it is gone, or a layer is another's for a failure: there is a mesh, but not
  /// all is well.
  bool has_lost_shape() const;
  /// That, or a texture is lost.
  bool has_lost() const { return has_lost_shape() || !lost_looks.empty(); }
};

/// When layers switch, and how that was decided.
struct Switching {
  SwitchOptions options;
  std::vector<SceneSwitch> layers;    ///< per layer: the scene's g
  std::vector<std::string> warnings;  ///< layers that hardly any building has something for
  bool is_from_prior = false;         ///< that of another scene, whose buildings counted
};

/// A segment whose layer a rule decided against the program.
struct OverruledSegment {
  std::string building;
  int segment = 0;
  ElementKind kind = ElementKind::kPlain;
};

/// Names and values that a footprint has beside its id, in its order.
using Attributes = std::vector<std::pair<std::string, std::string>>;

/// What of a place is no building, as a tree of tiles.
struct Context {
  struct Node {
    int parent = -1;             ///< parents come before children
    double geometric_error = 0;  ///< metres, as the source has it
    bool is_added = false;       ///< its children join what it shows instead of replacing it
    double rounding = 0;         ///< metres that positions may be off, if more than the output's
    bool is_farthest = true;     ///< nothing coarser is shown for it, however far away
  };
  std::vector<Node> nodes;
  std::function<Source(std::size_t node)> read;                    ///< what it shows; thread-safe
  std::function<std::string(const std::string& text)> shown = {};  ///< a text that names files, for
                                                                   ///< the user; none: as it is
};

/// How much of a place's plan is of one class.
struct ClassArea {
  std::string name;  ///< "ground", "building", "plant", "rest"
  double area = 0;   ///< m²
};

struct Scene {
  std::vector<Building> buildings;    ///< in the order of the input
  std::vector<ReadFailure> failures;  ///< inputs that could not be read
  std::vector<std::string> warnings;  ///< of the scene as a whole, one line each
  Selection selection;
  Clustering clustering;
  std::vector<OverruledSegment> overruled;
  Switching switching;
  double coanalysis_seconds = 0;
  double export_seconds = 0;                 ///< wall clock of what is written after the last mesh
  std::string tileset_failure;               ///< why there is none; empty: there is one
  std::vector<TypeConsistency> consistency;  ///< against a truth, where there is one
  std::map<std::string, Attributes> attributes;  ///< by building's name: of footprints
  std::shared_ptr<const Context> context;  ///< what is no building; null: nothing, or left out
  std::vector<ClassArea> classes;          ///< of a place that was taken apart
  std::string found_footprints;            ///< GeoJSON; empty: none were looked for
  bool has_prior = false;              ///< layers come from another scene that was analysed before
  std::set<std::string> placed_later;  ///< buildings that were placed by what the others learnt,
                                       ///< since those were analysed together
};

/// Takes what was dismissed out of the scene, a warning each.
void leave_out_dismissed(Scene& scene);

Counts count(const Building& building);

/// Sets has_texture and has_colors by the source.
void note_look(Building& building);

/// Lets go of source and planes, by far the most of a building's memory; counts and the rest stay.
void drop_geometry(Building& building);

/// Where source and planes of the buildings lie while the scene is analysed, so that memory does
/// not grow with it (store/store.h). Called from several threads.
class Depot {
 public:
  virtual ~Depot() = default;
  /// After the segments and their descriptors: takes them away. Name, path, segments and counts
  /// stay.
  virtual void put(Building&) = 0;
  /// Before `mesh_building`: brings them back.
  virtual void get(Building&) = 0;
  /// After the measures: they are needed no more.
  virtual void drop(Building&) = 0;
};

/// Who looks at buildings on their way; each may be empty. Called from several threads.
struct Observer {
  std::function<void(const Building&)> segmented;  ///< source and planes are still there
  std::function<void(Building&)> meshed;           ///< layers are there, source and planes too
};

/// What is thrown when hooks say so. Not a std::exception: it is no failure of the building in
/// hand.
struct Cancelled {};

/// Called from one thread at a time when a building has passed a stage.
using Progress =
    std::function<void(const std::string& building, const char* stage, int done, int total)>;

/// Reads the buildings of file i of an inventory. May throw Error.
using Reader = std::function<std::vector<Source>(std::size_t)>;

/// A building whose turn has come.
struct Turn {
  Source source;                 ///< only name and path when it could not be read
  std::size_t position = 0;      ///< in the scene, which is sorted by name
  std::optional<Error> problem;  ///< why it could not be read
};

/// Reads file by file, several at a time, and hands over each building; `body` runs in parallel.
void for_each_source(const Inventory& inventory, const Reader& read,
                     const std::function<void(Turn)>& body);

/// What stands around the pipeline; all of it may be left out.
struct Hooks {
  Depot* depot = nullptr;  ///< none: everything stays in memory
  std::vector<Observer> observers;
  Progress progress;
  std::function<bool()> is_cancelled;  ///< asked between stages and layers, from several threads

  /// Throws Cancelled.
  void check() const;
};

/// Planes, segments and descriptors of one building. Failures are recorded in it, nothing is
/// thrown.
Building segment_building(Turn turn, const Options& options);

/// `coanalysis` over all buildings: selection and layers, sets layer_of_segment. With a prior each
/// building for itself, by what the prior's scene learnt. Throws Error{kUsage} when its number of
/// layers is another.
void analyze_scene(Scene& scene, const Options& options, const Prior* prior = nullptr);

/// `partition` and `extraction` and the measures for one building. Throws Cancelled only.
void mesh_building(Building& building, const Options& options, const Hooks& hooks = {});

/// Holds the layers of a building against a ground truth; `source` is its own in its local frame,
/// with object numbers. Empty where the truth does not name it or a layer failed. Throws
/// Error{kInput} when the source's faces carry no object numbers.
std::vector<PlacedPart> place_parts(const Building& building, const Source& source,
                                    const Truth& truth);

/// All of it; a file is read when its turn comes. A file that cannot be read any more leaves failed
/// buildings. Throws Cancelled.
Scene build_scene(const Inventory& inventory, const Reader& read, const Options& options,
                  const Hooks& hooks = {}, const Prior* prior = nullptr);

/// All of it on sources in memory.
Scene build_scene(ReadResult input, const Options& options, const Hooks& hooks = {},
                  const Prior* prior = nullptr);

}  // namespace colod
