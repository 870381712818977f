// The whole job as a list of verbs: sources → segments → layers → meshes. No file formats here.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "clustering.h"
#include "extraction.h"
#include "frame.h"
#include "mesh_io.h"
#include "metrics.h"
#include "options.h"
#include "segments.h"
#include "selection.h"

namespace colod {

/// One layer of one building with its measures.
struct Layer {
  int layer = 0;        ///< 0 = coarsest
  PolygonMesh mesh;     ///< building-local metres, axes parallel to the world's; empty: failed
  int segments = 0;     ///< on layers ≤ this one
  Validity validity;    ///< of the mesh as written (doubles), self-intersections included
  Distances distances;  ///< source against the layer
  double geometric_error = 0;  ///< metres, one-sided Hausdorff, never less than a finer layer's
  std::string failure;         ///< why there is no mesh; empty: there is one
};

/// Seconds of wall clock per stage; buildings overlap when several threads run.
struct Timings {
  double read = 0, planes = 0, visibility = 0, segments = 0, similarity = 0, extraction = 0,
         measure = 0, export_ = 0;
};

/// All that is known of one building.
struct Building {
  Source source;  ///< in its local frame
  Frame frame;    ///< local → world
  Planes planes;
  Segments segments;
  std::vector<Descriptor> descriptors;  ///< per segment
  std::vector<int> layer_of_segment;    ///< 0..l_n − 1
  std::vector<Layer> layers;            ///< l_n of them unless the building failed
  Timings timings;
  std::vector<std::string> warnings;
  std::string failure;  ///< why the building has no layer at all; empty: it has

  bool has_failed() const;
};

struct Scene {
  std::vector<Building> buildings;    ///< in the order of the input
  std::vector<ReadFailure> failures;  ///< inputs that could not be read
  Selection selection;
  Clustering clustering;
  double coanalysis_seconds = 0;
};

/// Called from one thread at a time when a building has passed a stage.
using Progress =
    std::function<void(const std::string& building, const char* stage, int done, int total)>;

/// Rooms 2 to 5 for one building. Failures are recorded in the building, nothing is thrown.
Building segment_building(Source source, const Options& options);

/// Rooms 6 and 7 over all buildings: sets layer_of_segment.
void analyze_scene(Scene& scene, const Options& options);

/// Rooms 8 and 9 and the measures for one building.
void mesh_building(Building& building, const Options& options);

/// All of it.
Scene build_scene(ReadResult input, const Options& options, const Progress& progress = {});

}  // namespace colod
