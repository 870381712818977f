// The rows of extraction.
#include "extraction/parameters.h"
#include "parts.h"

namespace colod::rules {
namespace {

using namespace parameters::extraction;

constexpr std::string_view kAllCut = "A layer is cut by its own planes.";
constexpr std::string_view kNoStep = "The paper has no such step.";

std::vector<RuleInfo> candidate_rules() {
  return {
      {.rule = Rule::kSides,
       .id = "extraction.sides",
       .title = "the rectangle around a layer ends the building",
       .sees = "The box of a layer's outlines, from the foot to its top.",
       .does =
           "Adds its six sides as candidates, from which on all is outside; a plane near a side "
           "that nothing lies beyond takes its place.",
       .paper = kAllCut,
       .reason =
           "Floors and party walls are missing in scans. On five open scans the mean error is "
           "six times as large without.",
       .parameters = {{"box_growth", "", plan::kBoxGrowth, "of the diagonal: space around it"},
                      {"snap", "m", plan::kSnap, "a side nearer to a plane takes its place"},
                      {"whole_side", "", plan::kWholeSide,
                       "of the side: a plane that may draw it in by more"},
                      {"snap_cosine", "", plan::kSnapCosine, "between both: 1.1°"},
                      {"ridge", "m", plan::kRidge,
                       "air above pitched roofs, which were shaved flat"},
                      {"steepest", "", plan::kSteepest, "cosine of a pitched roof's slope"},
                      {"flattest", "", plan::kFlattest, "likewise"},
                      {"thinnest", "m", plan::kThinnest, "a flatter layer is extruded inward"}},
       .needs = {},
       .test = "extraction/extraction: a house without floor and party wall is closed at its "
               "rectangle",
       .made_on = {"ingolstadt-north-scan", "mvs"}},
      {.rule = Rule::kExtractionFoot,
       .id = "extraction.foot",
       .title = "the box goes down to the source's foot",
       .sees = "The foot of the source, where it is below all outlines.",
       .does = "Lets the box of a layer end there.",
       .paper = "The box is that of the outlines.",
       .reason = "Walls of airborne clouds end above the ground.",
       .parameters = {},
       .needs = {},
       .test = "extraction/extraction: a roof alone stands on walls down to the foot",
       .made_on = {"als/block-a"}},
      {.rule = Rule::kElementCuts,
       .id = "extraction.elements",
       .title = "elements are cut and told whole",
       .sees = "Elements that a layer's planes form.",
       .does = "Adds faces that they lack as candidates, and tells the cells within them.",
       .paper = kAllCut,
       .reason = "What a scan does not show of them is closed over, or cut away.",
       .parameters = {},
       .needs = {},
       .test = "elements/elements: what a scan misses of them stands in the mesh",
       .made_on = {"ingolstadt-north-scan", "synth-scan"}},
      {.rule = Rule::kWalls,
       .id = "extraction.walls",
       .title = "walls stand under roof borders that nothing supports",
       .sees = "Long borders of roofs with neither a roof beyond nor a wall below.",
       .does = "Adds an upright candidate under each.",
       .paper = kAllCut,
       .reason = "Facades are missing in airborne clouds. Without it the mean distance of layer 0 "
                 "was 50 % larger over 187 buildings.",
       .parameters =
           {{"simplify", "m", walls::kSimplify, "how far a border may leave its line"},
            {"shortest", "m", walls::kLeastBorder, "of border that asks for a wall"},
            {"beside", "m", walls::kBeside, "beyond the border, where a roof would go on"},
            {"step", "m", walls::kSameRoof, "of height that still counts as the same roof"},
            {"support", "m", walls::kSupport, "between a border and the wall that carries it"},
            {"together", "m", walls::kTogether, "between borders that share a wall"},
            {"parallel", "", walls::kParallel, "cosine between such borders: 10°"}},
       .needs = {},
       .test = "extraction/extraction: a concave flat roof alone gets walls under all its borders",
       .made_on = {"als/block-a"}}};
}

std::vector<RuleInfo> cutting_rules() {
  return {
      {.rule = Rule::kLeaders,
       .id = "extraction.leaders",
       .title = "planes within the tolerance share a cut",
       .sees = "Planes whose outline lies within the layer's tolerance of a larger one that looks "
               "about the same way.",
       .does = "Cuts them along that one.",
       .paper = "Every plane is cut.",
       .reason = "Noise finds walls twice: 3 % of the polygons of layer 0 for less than 1 % of the "
                 "mean distance.",
       .parameters = {{"alike", "°", leaders::kAlike_deg, "between both normals"}},
       .needs = {Rule::kTolerance},
       .test = "extraction/verbs: planes that look elsewhere are no leaders, nor are those farther "
               "than the tolerance",
       .made_on = {"ingolstadt-north-scan", "mvs", "mvs-with-ground", "synth-scan"}},
      {.rule = Rule::kReach,
       .id = "extraction.reach",
       .title = "a plane cuts where its outline reaches",
       .sees = "The convex hull of a plane's outline, grown by 10 cm.",
       .does = "Cuts the cells that it reaches, no others.",
       .paper =
           "Planes divide the whole box; where that makes more than 30,000 cells each cuts where "
           "its outline reaches, and a warning says so.",
       .reason = "Whole planes made 50 times the cells at 2,400 planes.",
       .parameters = {},
       .needs = {},
       .test = "extraction/extraction: whole planes make more cells and the same house",
       .made_on = {}},
      {.rule = Rule::kFineCuts,
       .id = "extraction.clip",
       .title = "space is cut as finely as planes are known",
       .sees = "The growing distance of the planes.",
       .does =
           "Lets cuts reach into cells by a third of it where that is less than the partition's "
           "own tolerance.",
       .paper = "The partition's own tolerance holds.",
       .reason = "Blocks whose walls bend by a centimetre lost them.",
       .parameters = {{"share", "", cut::kClipShare, "of the growing distance"}},
       .needs = {},
       .test = "extraction/extraction: simple block models are closed with their own volume",
       .made_on = {"delft"}},
      {.rule = Rule::kPruning,
       .id = "extraction.prune",
       .title = "planes that carry only slivers are left out",
       .sees = "Planes all of whose facets are narrower than 5 cm, or hardly under their outline.",
       .does = "Cuts space anew without them, twice at most.",
       .paper = "Every plane is cut.",
       .reason = "Slivers, and random planes that close a hole: 2 to 4 % of the polygons.",
       .parameters = {{"sliver", "m", prune::kSliver, "a facet narrower carries no plane"},
                      {"covered", "", prune::kLeastCovered, "of its facets under its outline"},
                      {"most_lost", "", prune::kMostPruned, "of the other planes' surface"}},
       .needs = {},
       .test = "rules/effects: each rule of extraction changes a layer of a source made for it",
       .made_on = {"ingolstadt-north", "ingolstadt-north-scan", "mvs"}}};
}

std::vector<RuleInfo> label_rules() {
  return {
      {.rule = Rule::kRings,
       .id = "extraction.rays",
       .title = "rays lie on rings, and steep ones tell roofs",
       .sees = "A cell's points: one to nine by its size.",
       .does =
           "Casts level and slightly raised rays, and steep ones that tell whether what escapes "
           "has a roof above it.",
       .paper = "Level rays from the centroid, as from voxels.",
       .reason = "Level rays alone know no roof: below one that stands on no walls all is outside.",
       .parameters = {{"first_ring", "°", evidence::kElevations[0], "of elevation"},
                      {"second_ring", "°", evidence::kElevations[1], "likewise"},
                      {"third_ring", "°", evidence::kElevations[2], "likewise"},
                      {"steep_from", "°", evidence::kSteep[0], "of steep rays"},
                      {"steep_to", "°", evidence::kSteep[1], "likewise"},
                      {"roof_vote", "", evidence::kRoofVote, "of what escapes under a roof"},
                      {"thin_cell", "m", evidence::kThinCell, "thinner follow their neighbours"},
                      {"small_cell", "m³", evidence::kSmallCell, "one point below"},
                      {"large_cell", "m³", evidence::kLargeCell, "nine points above"}},
       .needs = {},
       .test = "extraction/extraction: a house without a floor is closed at its foot",
       .made_on = {"ingolstadt-north-scan", "mvs"}},
      {.rule = Rule::kMinCut,
       .id = "extraction.min_cut",
       .title = "inside and outside are parted by a min-cut",
       .sees = "What rays say of cells, and what outlines say of the pieces between them.",
       .does = "Takes the min-cut; escaping rays count less where that explains more outlines.",
       .paper = "A cell is inside when more than half of its rays are valid hits.",
       .reason = "Single cells decide wrongly where data is missing.",
       .parameters = {{"local_vote", "", min_cut::kLocalVote, "of an outline, per m²"},
                      {"discount", "", min_cut::kDiscount, "of smoothness on a covered piece"},
                      {"first_escape", "", label::kEscapes[0], "weight of escaping rays"},
                      {"second_escape", "", label::kEscapes[1], "likewise"},
                      {"third_escape", "", label::kEscapes[2], "likewise"},
                      {"fourth_escape", "", label::kEscapes[3], "likewise"},
                      {"enough", "", label::kEnough, "of the outlines on the surface: done"},
                      {"worthwhile", "", label::kWorthwhile, "that another trial must add"},
                      {"little", "", label::kLittle, "of the outlines: a warning"}},
       .needs = {},
       .test = "extraction/extraction: a dormer and an annex stay on their house",
       .made_on = {"ingolstadt-north-scan", "mvs"}},
      {.rule = Rule::kBoxFallback,
       .id = "extraction.box",
       .title = "without any inside the layer is its box",
       .sees = "A layer no cell of which is inside.",
       .does = "Takes the box around its planes, with a warning.",
       .paper = "The layer fails.",
       .reason = "A building keeps its place on every layer.",
       .parameters = {},
       .needs = {},
       .test = "extraction/extraction: one wall alone becomes a thin body, no plane is an error",
       .made_on = {"als/block-a"}},
      {.rule = Rule::kComponents,
       .id = "extraction.components",
       .title = "an annex is part of the building",
       .sees = "Components besides the largest.",
       .does = "Keeps those of a twentieth of its volume.",
       .paper = "The largest component is kept.",
       .reason = "A detached annex was lost.",
       .parameters = {{"substantial", "", components::kSubstantial, "of the largest one's volume"}},
       .needs = {},
       .test = "extraction/extraction: a detached annex is kept, a small shed is not",
       .made_on = {"mvs", "mvs-with-ground"}},
      {.rule = Rule::kCavities,
       .id = "extraction.cavities",
       .title = "cavities are filled",
       .sees = "Outside cells that inside ones enclose.",
       .does = "Makes them inside.",
       .paper = kNoStep,
       .reason = "Nobody sees them from outside.",
       .parameters = {},
       .needs = {},
       .test = "extraction/surface: any choice of cubes gives a closed 2-manifold with the volume "
               "of its "
               "cells",
       .made_on = {"ingolstadt-north", "ingolstadt-north-scan"}}};
}

std::vector<RuleInfo> surface_rules() {
  return {
      {.rule = Rule::kFacetPrice,
       .id = "extraction.facets",
       .title = "facets that are not worth their price go",
       .sees = "Cells under or over a facet.",
       .does = "Lets them change sides where that saves facets, for a volume and a way at most.",
       .paper = kNoStep,
       .reason = "An exact partition keeps every chip: 14 to 23 % of the polygons for up to 1 % of "
                 "the mean distance.",
       .parameters = {{"price", "", simplify::kFacetPrice, "of tolerance × surface: a facet's"},
                      {"most_moved", "", simplify::kMostMoved, "tolerances of way"},
                      {"least_vote", "", simplify::kLeastVote,
                       "what a cell counts however unsure its side is"},
                      {"most_lost", "", surface::kMostLost, "of the volume"}},
       .needs = {Rule::kTolerance},
       .test = "extraction/verbs: turning cells saves facets within its limits and never turns "
               "forced cells",
       .made_on = {"ingolstadt-north-scan", "mvs", "mvs-with-ground", "synth-scan"}},
      {.rule = Rule::kPriceCap,
       .id = "extraction.price_cap",
       .title = "on the finest layer of a clean model a facet's price ends",
       .sees = "The finest layer of a model without noise.",
       .does = "Bounds the price of a facet by 20 litres.",
       .paper = kNoStep,
       .reason = "The price grows with the building: large houses lost their windows.",
       .parameters = {{"most", "m³", simplify::kMostPrice, "chosen on 15 clean models"}},
       .needs = {Rule::kFacetPrice},
       .test = "extraction/verbs: turning cells saves facets within its limits and never turns "
               "forced cells",
       .made_on = {"ingolstadt-north", "synth"}},
      {.rule = Rule::kSheets,
       .id = "extraction.sheets",
       .title = "what is drawn as a sheet becomes a thin body",
       .sees = "On the finest layer of a model without noise: outlines far from the surface that "
               "are seen on both sides.",
       .does = "Cuts a second plane behind them and planes along their borders; the cells between "
               "become inside.",
       .paper = kNoStep,
       .reason = "People draw eaves, canopies, fins and parapets without thickness, which no "
                 "labelling of cells can keep.",
       .parameters = {{"thickness", "m", sheets::kThickness, "of the slab"},
                      {"least_far", "m", sheets::kLeastFar, "from the surface"},
                      {"far", "", sheets::kFar, "times the tolerance: likewise"},
                      {"joined", "m", sheets::kJoined, "a border nearer to something ends there"},
                      {"across", "", sheets::kLeastAcross, "cosine of such a border's neighbour"},
                      {"level", "", sheets::kLevel, "|z| of a step's normal"},
                      {"step", "m", sheets::kAboveFoot, "above the foot: it stands on the ground"},
                      {"lift", "m", sheets::kLift, "off a sheet"},
                      {"area", "m²", sheets::kLeastArea, "of a sheet"},
                      {"share", "", sheets::kLeastShare, "of all planes' area"},
                      {"seen", "", sheets::kLeastSeen, "of a sheet, on both sides"},
                      {"spacing", "m", sheets::kSpacing, "between places that are looked at"},
                      {"bend", "m", sheets::kBend, "that a border may leave its outline"},
                      {"inset", "m", sheets::kInset, "from a border: where it is looked at"},
                      {"shortest", "m", sheets::kLeastCut, "of a border's part that is cut"}},
       .needs = {},
       .test = "extraction/verbs: a sheet that stands out of the building becomes a thin body",
       .made_on = {"ingolstadt-north"}},
      {.rule = Rule::kShortEdges,
       .id = "extraction.edges",
       .title = "edges under 3 mm are contracted",
       .sees = "Edges of facets.",
       .does = "Contracts those under 3 mm.",
       .paper = "Those under 1 mm.",
       .reason = "No facet thinner than a millimetre.",
       .parameters = {{"shortest", "m", surface::kShortest, "an edge"},
                      {"paper_shortest", "m", surface::kShortestPaper, "without this rule"}},
       .needs = {},
       .test = "extraction/surface: short edges are contracted",
       .made_on = {"ingolstadt-north-scan", "mvs"}},
      {.rule = Rule::kNarrowFacets,
       .id = "extraction.narrow",
       .title = "narrow facets are contracted",
       .sees = "Facets narrower than 2.5 mm, and triangles that contracting has bent.",
       .does =
           "Contracts their short edges, and longer ones where no plane moves by more than that.",
       .paper = kNoStep,
       .reason = "No facet thinner than a millimetre.",
       .parameters = {{"narrowest", "m", surface::kNarrowest, "a facet"},
                      {"longest", "", contraction::kLongest, "times that: an edge that may go"},
                      {"planar", "", contraction::kPlanar, "cosine of a triangle and its facet"}},
       .needs = {},
       .test = "extraction/surface: narrow facets are contracted where their short edges allow it",
       .made_on = {"ingolstadt-north-scan", "mvs", "synth"}}};
}

}  // namespace

std::vector<RuleInfo> extraction_rules() {
  std::vector<RuleInfo> rows = candidate_rules();
  for (auto part : {cutting_rules(), label_rules(), surface_rules()})
    rows.insert(rows.end(), part.begin(), part.end());
  return rows;
}

}  // namespace colod::rules
