// The rows of layer 0's selection, of clustering and of a layer's planes.
#include "coanalysis/parameters.h"
#include "parts.h"
#include "planes/planes.h"

namespace colod::rules {
namespace {

using namespace parameters::coanalysis;

std::vector<RuleInfo> program_rules() {
  return {
      {.rule = Rule::kAreaShares,
       .id = "selection.shares",
       .title = "consistency is weighed by area and averaged",
       .sees = "The term f_co of layer 0's program.",
       .does =
           "Weighs each segment by its share of the building's area and takes the mean over the "
           "other buildings, so that f_co is of the size of f_s.",
       .paper = "The paper sums over all segments and all other buildings.",
       .reason =
           "With many buildings the sum outweighs f_r: 6 of 15 scanned houses lost their main "
           "roof.",
       .parameters = {},
       .needs = {},
       .test = "coanalysis/selection: E_0 of any choice is the paper's formula, and a broken bound "
               "is minus infinity",
       .made_on = {"ingolstadt-north-scan"}},
      {.rule = Rule::kStrictBound,
       .id = "selection.bound",
       .title = "layer 0 keeps 95 % of the voxels",
       .sees = "The bound on f_r.",
       .does = "Asks for 0.95 instead of 0.8.",
       .paper = "The paper asks for 0.8.",
       .reason = "The bound decides where much is consistent, and a roof has less than a fifth of "
                 "the voxels.",
       .parameters = {{"bound", "", kRobustBound, "chosen on the scans"},
                      {"paper_bound", "", kPaperBound, "the paper's, without this rule"}},
       .needs = {},
       .test =
           "coanalysis/selection: lp_solve, and the ascent under its bound, against enumeration",
       .made_on = {"ingolstadt-north-scan"}},
      {.rule = Rule::kWholeKinds,
       .id = "selection.whole_kinds",
       .title = "the last of a kind leaves layer 0, too",
       .sees = "Elements of a kind of which most have left layer 0 by the program.",
       .does = "Takes the others off, as far as the bound on f_r lets it; the report lists each as "
               "overruled.",
       .paper = "The paper keeps the optimum as it is.",
       .reason = "The program weighs a balcony against its own building: on a small one it may be "
                 "worth its area (1 of 286 segments of synth-scan, seed 3).",
       .parameters = {},
       .needs = {Rule::kElementSegments},
       .test = "coanalysis/selection: robust: where most elements of a kind leave, the last one "
               "does, and is told of",
       .made_on = {"synth-scan"}}};
}

std::vector<RuleInfo> clustering_rules() {
  return {
      {.rule = Rule::kKinds,
       .id = "clustering.kinds",
       .title = "kinds first, then layers of whole kinds",
       .sees =
           "All segments beyond layer 0: shape, scale, where in the building's height they begin "
           "and end, how much of them looks up, and which are elements of one kind.",
       .does =
           "Finds four times as many kinds as layers by as many eigenvectors, with rows of unit "
           "length; elements of a kind are one row. Kinds come by falling median extent, and "
           "are parted in equal steps of its logarithm between the smallest and the largest tenth "
           "of all segments, so that a kind is never split over two layers and one building more "
           "or less hardly moves the borders. Where fewer kinds than layers differ, size decides.",
       .paper = "As many clusters as layers, each a layer, by falling mean volume.",
       .reason =
           "With as many eigenvectors as layers one extent reproduced 348 of 349 assignments; "
           "with more, chimneys, windows, doors and strips of roofs are kinds of their own.",
       .parameters = {{"kinds_a_layer", "", kKindsALayer, "chosen on synth-scan, seeds 1 and 2"},
                      {"same_kind", "", kSameKind,
                       "distance; samples of the same shape differ by up to 0.07"},
                      {"size_tail", "", kSizeTail,
                       "share of the segments; chosen by bench_stability on synth-scan, seeds 1, "
                       "3, 5 and 7"}},
       .needs = {},
       .test = "coanalysis/clustering: elements of a kind are on one layer, whatever their size",
       .made_on = {"synth", "synth-scan"}},
      {.rule = Rule::kSmallPlanes,
       .id = "layers.small",
       .title = "small planes of layer 0's segments wait for the finest layer",
       .sees = "The smallest planes of layer 0's segments, where these have more than 12, and "
               "planes of no segment that are as small.",
       .does = "Leaves them out of all layers but the finest.",
       .paper = "A layer has all planes of its segments.",
       .reason =
           "Reveals and canopies lie inside the body's segment and would stand on layer 0. 5 % "
           "of the polygons of layers 0 and 1 for 2 % of their mean distance.",
       .parameters = {{"together", "", kSmallPlanes, "of the area of layer 0's segments"},
                      {"each", "", kSmallPlane, "of that area: a ledge of 12 m² had waited"},
                      {"planes", "", static_cast<double>(kFewPlanes),
                       "so few are not thinned out"}},
       .needs = {},
       .test = "coanalysis/clustering: robust: the smallest planes of layer 0 wait for the finest "
               "layer",
       .made_on = {"ingolstadt-north-scan", "synth", "synth-scan"}}};
}

}  // namespace

std::vector<RuleInfo> coanalysis_rules() {
  std::vector<RuleInfo> rows = program_rules();
  const std::vector<RuleInfo> rest = clustering_rules();
  rows.insert(rows.end(), rest.begin(), rest.end());
  return rows;
}

}  // namespace colod::rules
