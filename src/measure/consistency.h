// Beside the rooms: given a ground truth of parts, do parts of a kind fall on the same layer in
// every building?
//
// A part counts as present in a mesh when three quarters of its telling samples are shown. A sample
// on the part's own faces is shown where the mesh has surface on the line along its side's own
// direction that is nearer to it than to the building with the part closed (closing.h), and no
// farther than 0.25 m. So a recess is there only where its pane is: the wall before it does not
// count, nor does the edge of its hole, sideways. Telling are samples that stand out of the closed
// building by more than half the part's relief, 0.25 m at most and 2 cm at least. This needs no
// segments, so any chain of meshes can be judged. A part appears on the first layer from which on
// it is present.
#pragma once

#include <string>
#include <vector>

#include "core/element_kind.h"
#include "core/geometry.h"

namespace colod {

struct TruthPart {
  ElementKind kind;
  int instance = 0;   ///< its number in Source::face_object
  int level = -1;     ///< the layer it is expected on; −1: not said
  double depth = -1;  ///< metres of relief; negative: not said, taken from the mesh
};

struct TruthBuilding {
  std::string name;
  std::vector<TruthPart> parts;    ///< what is judged
  std::vector<int> main_building;  ///< objects that count as body: walls, roofs, towers, rising
};

using Truth = std::vector<TruthBuilding>;

/// Reads what `colod synth` writes as truth.json, or labels: a JSON object with, per building,
/// `objects` of `index`, `type` and `function_guess_from_geometry` (kinds are then guesses by size
/// and place). Words that name no kind are kOther. Throws Error{kInput}.
Truth read_truth(const std::string& path);

/// One part in one building.
struct PlacedPart {
  std::string building;
  ElementKind kind = ElementKind::kOther;
  int instance = 0, level = -1;
  double depth = 0;           ///< metres; measured where the truth does not say
  bool is_seen = false;       ///< the source shows enough of it
  int first = -1;             ///< layer on which it appears; −1: on none
  std::vector<char> present;  ///< per layer
  std::vector<double> near;   ///< per layer: share of its telling samples within its reach of it
};

/// Judges `layers`, coarsest first, in the coordinates of `source`, whose faces carry object
/// numbers. Throws Error{kInput} when they do not.
std::vector<PlacedPart> place_parts(const Source& source, const TruthBuilding& truth,
                                    const std::vector<Mesh>& layers);

/// All parts of one kind.
struct TypeConsistency {
  ElementKind kind = ElementKind::kOther;
  int seen = 0, unseen = 0;         ///< instances; the latter count nowhere below
  int never = 0;                    ///< seen, on no layer
  int expected = 0;                 ///< on the layer that the truth expects
  std::vector<int> first, present;  ///< per layer: appear there, are present there
  double depth = 0;                 ///< median, metres
  int majority_layer = -1;          ///< on which most appear, the coarsest of equals; −1: none
  double on_majority_layer = 0;     ///< share of those seen; never counts against it
  double of_appearing = 0;          ///< the same, of those that appear on any layer
  int buildings = 0;                ///< that show the kind
  double buildings_agreeing = 0;    ///< share of those with all of its parts on that layer
};

/// Sorted by the kinds' names.
std::vector<TypeConsistency> tally_parts(const std::vector<PlacedPart>& parts, int layers);

/// For report.json and `colod eval --truth`: a JSON object by the kinds' names.
std::string consistency_json(const std::vector<TypeConsistency>& types);

}  // namespace colod
