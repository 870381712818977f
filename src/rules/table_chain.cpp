// The rows of extraction and of the chain of layers.
#include "coanalysis/parameters.h"
#include "extraction/parameters.h"
#include "measure/parameters.h"
#include "parts.h"
#include "pipeline/parameters.h"
#include "planes/planes.h"
#include "rounds/parameters.h"

namespace colod::rules {
namespace {

using namespace parameters;

std::vector<RuleInfo> layer_rules() {
  return {
      {.rule = Rule::kMissingPlanes,
       .id = "extraction.missing",
       .title = "planes that layer 0 cannot do without join it",
       .sees = "Larger planes of finer layers, as sets: a segment's, or what layer 0's own leave "
               "out.",
       .does = "Adds a set to layer 0, and so to all, where that brings the surface nearer to all "
               "outlines by what its facets are worth.",
       .paper = "A layer has the planes of its segments.",
       .reason =
           "Segments are told by what rays meet, not by what a surface needs: layer 0 had fins "
           "before gables, lost walls and notches. On airborne clouds a sixth less mean "
           "distance for 4 % more polygons.",
       .parameters =
           {{"plane", "", coanalysis::kSpareShare, "of all area: smaller planes never join"},
            {"set", "", coanalysis::kSparesShare, "of all area: nor does less together"},
            {"facet", "", extraction::spares::kFacetWorth,
             "of the diagonal that a facet must bring: at 0.0002 a chimney and a bay came "
             "to layer 0 without their like"},
            {"body_facet", "", extraction::spares::kBodyWorth,
             "likewise of a body of its own, whose layer was found among its like"},
            {"body_planes", "", static_cast<double>(extraction::spares::kBodyPlanes),
             "planes of a body"},
            {"body_facets", "", extraction::spares::kBodyFacets, "facets more: likewise"},
            {"missed", "", extraction::spares::kMissed,
             "of the diagonal: mean distance that a set must make up to be tried"}},
       .needs = {},
       .test = "coanalysis/clustering: spares are the larger planes that layer 0 lacks, a set a "
               "plain segment",
       .made_on = {"ingolstadt-north", "ingolstadt-north-scan", "als/block-a", "mvs"}},
      {.rule = Rule::kRoundLayers,
       .id = "rounds.layers",
       .title = "round shapes have fewer sides on coarser layers",
       .sees = "Round shapes on a layer that is not the finest.",
       .does =
           "Draws them with 8 columns on layer 0, twice as many on each finer one, and rows that "
           "turn about as much; closed ones keep their cross-section's area, others their ends.",
       .paper = "A layer has whole planes or none.",
       .reason =
           "A dome of 200 sides is no coarse layer; one without some of its rings is a crown.",
       .parameters =
           {{"sides", "", layers::kSides, "columns on layer 0; an octagon still reads as round"},
            {"same_length", "", round_layers::kSameLength,
             "ratio of rows of a run: a drum is no row of its dome"},
            {"least_bend", "rad", round_layers::kLeastTurn,
             "between rows: what files with mm do not turn by chance"},
            {"hardly_fewer", "", round_layers::kHardlyFewerSides, "of the sides: then all stay"},
            {"cap_cosine", "", layers::kCapCosine, "between an end's normal and the axis"},
            {"cap_reach", "m", layers::kCapReach, "that an end may be off its row"},
            {"least_drawn", "", layers::kLeastDrawn,
             "of a new side: less is what a house leaves of it"}},
       .needs = {Rule::kRoundSides},
       .test = "pipeline/rounds: domes are exact on the finest layer and regular on coarser ones",
       .made_on = {}},
      {.rule = Rule::kTolerance,
       .id = "extraction.tolerance",
       .title = "what is within a layer's tolerance is no detail of its own",
       .sees = "Which layer it is, and how large and how exact the building.",
       .does = "Gives extraction.leaders and extraction.facets a tolerance; sides of the rectangle "
               "snap within it.",
       .paper = "Every plane is cut, every cell stays.",
       .reason = "Noise finds walls twice, and an exact partition keeps every chip: a third to a "
                 "half of the polygons go, the mean distance stays within a few per cent.",
       .parameters =
           {{"coarsest", "", layers::kTolerance,
             "of the diagonal, on layer 0; half of it on each finer layer"},
            {"finest", "", layers::kLeastTolerance,
             "of the diagonal, on the finest layer; on all of an exact model of few planes"}},
       .needs = {},
       .test = "extraction/extraction: what is within the tolerance of a larger plane is no detail "
               "of its own",
       .made_on = {"ingolstadt-north-scan", "mvs", "mvs-with-ground", "synth-scan"}}};
}

std::vector<RuleInfo> soundness_rules() {
  return {
      {.rule = Rule::kVolume,
       .id = "chain.volume",
       .title = "a layer of another volume takes the next finer mesh",
       .sees =
           "Coarser layers whose volume is off that of a finer one by more than a fifth, or whose "
           "tops and sides are mostly invented (chain.scene_part has the numbers).",
       .does = "Puts the finer mesh in their place and reports a failure.",
       .paper = "Such a layer is kept.",
       .reason = "It has lost a part of the building, or invented one.",
       .parameters = {{"change", "", layers::kVolumeChange, "of the finer layer's volume"}},
       .needs = {},
       .test = "rules/effects: a layer that lost its building is replaced only by the rule for it",
       .made_on = {"ingolstadt-north-scan", "als/block-a"}},
      {.rule = Rule::kScenePart,
       .id = "chain.scene_part",
       .title = "what looks like a part of a scene is refused",
       .sees = "An open source and its finest layer: terrain, a bare wall, or mostly invention.",
       .does = "Fails the building with the reason; nothing is written for it. What was found on a "
               "place is no failure: it stays as the source shows it, with a warning.",
       .paper = "The paper is given buildings.",
       .reason = "Patches of terrain were shipped as boxes.",
       .parameters =
           {{"reach", "m", scene_part::kReach, "from the source: farther is invented"},
            {"reach_share", "", scene_part::kReachShare, "of the diagonal: likewise, if more"},
            {"open_border", "", scene_part::kOpenBorder,
             "of the root of the area: a shorter border is a crack"},
            {"not_upright", "", scene_part::kNotUpright, "of the area that is upright: terrain"},
            {"all_upright", "", scene_part::kAllUpright, "of the area: a wall"},
            {"many_tops", "", scene_part::kManyTops,
             "planar tops: a hipped roof has four, one with a wing six"},
            {"gentle", "°", scene_part::kGentle_deg, "between two tops: ridges mostly bend more"},
            {"coplanar", "°", scene_part::kCoplanar_deg, "no edge at all"},
            {"mostly_gentle", "", scene_part::kMostlyGentle,
             "of the edges: terrain of 20 to 200 m had 0.92"},
            {"many_valleys", "", scene_part::kManyValleys,
             "of the edges: terrain had 0.42 to 0.52, a roof has hardly a valley"},
            {"hardly_enclosed", "", scene_part::kHardlyEnclosed, "of the layer's volume: a wall"},
            {"thin", "m", scene_part::kThin, "a slab"},
            {"thin_share", "", scene_part::kThinShare, "of the root of its area: likewise"},
            {"false_tops", "", scene_part::kFalseTops,
             "invented of the tops: 72 airborne clouds have 0.3 at most"},
            {"false_sides", "", scene_part::kFalseSides,
             "invented of the sides: a corner of two walls has 0.46, walls all round have 0"}},
       .needs = {},
       .test = "pipeline/losses: terrain, walls and corners look like parts of a scene",
       .made_on = {"als/block-a", "bocimi-buildings", "ingolstadt-north", "mvs"}}};
}

}  // namespace

std::vector<RuleInfo> chain_rules() {
  std::vector<RuleInfo> rows = layer_rules();
  const std::vector<RuleInfo> rest = soundness_rules();
  rows.insert(rows.end(), rest.begin(), rest.end());
  return rows;
}

}  // namespace colod::rules
