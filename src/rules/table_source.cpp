// The rows of what is parted from a source before planes are sought.

#include "core/drawn.h"
#include "parts.h"
#include "planes/parameters.h"
#include "rounds/parameters.h"
#include "scene/parameters.h"

namespace colod::rules {
namespace {

using namespace parameters;

RuleInfo ground_rule() {
  return {
      .rule = Rule::kGround,
      .id = "scene.ground",
      .title = "the ground that a mesh stands on is left out",
      .sees =
          "A surface seen from above that holds most of a mesh's rim, has no storey below it "
          "there, and from which walls rise.",
      .does =
          "Leaves out the faces of the ground and of cars, bushes and other low or small "
          "things on it, and reports how much that was.",
      .paper = "The paper is given buildings alone.",
      .reason = "The ground would be facets of every layer and would spoil every distance.",
      .parameters =
          {{"cell_share", "", ground::kCellShare, "of the diagonal: a cell of the height raster"},
           {"least_cell", "m", ground::kLeastCell, "the smallest cell"},
           {"most_cell", "m", ground::kMostCell, "the largest cell"},
           {"noise", "m", ground::kNoise, "height between neighbouring cells of one ground"},
           {"steepest", "", ground::kSteepest, "slope of the ground, besides the noise"},
           {"overhang", "m", ground::kOverhang,
            "how far a flat roof's rim stands out from its walls: what is below a rim is looked "
            "for "
            "so far in, since blocks with an overhang had lost all below their roof"},
           {"least_rim", "", ground::kLeastRim, "share of the rim that the ground holds"},
           {"mostly", "", ground::kMostly, "share of the ground's rim without a storey below it"},
           {"rise", "m", ground::kRise, "height of a building"},
           {"least_built", "", ground::kLeastBuilt, "share of the covered cells that are built"},
           {"surely_built", "m²", ground::kSurelyBuilt,
            "enough whatever the share, so that a plot may be as large as it likes"},
           {"foot", "m", ground::kFoot, "height by which walls have come down to the ground"},
           {"reach", "m", ground::kReach, "how far eaves stand out from their wall"},
           {"small_blob", "", ground::kSmallBlob,
            "of the largest building's area: what is smaller goes with the ground"},
           {"ground_layer", "m", ground::kGroundLayer,
            "level faces this near to the ground go with it; 0.25 m left a bank of earth at "
            "mvs-with-ground/house_a's foot, which tilted a wall"},
           {"ground_normal", "", ground::kGroundNormal,
            "upright component of a level face: the ground banks up at walls"},
           {"on_ground", "m", ground::kOnGround, "what ends lower is part of the ground"}},
      .needs = {},
      .test = "scene/ground: the house is kept, its ground is not",
      .made_on = {"mvs-with-ground", "mvs"}};
}

RuleInfo hidden_rule() {
  return {
      .rule = Rule::kHidden,
      .id = "scene.hidden",
      .title = "what nobody sees from outside is left out",
      .sees =
          "Faces of rooms, furniture and slabs, and sides on which parts touch, where they are "
          "2 % of a mesh's surface. Outside is where a cube that comes from around can stand, "
          "where nothing stands above, and a cavity that is widely open.",
      .does = "Leaves those faces out, cut where others meet them, and reports how much that was.",
      .paper = "The paper is given shells.",
      .reason =
          "Stacked boxes lost their ground floor, since a slab's underside and the body's top "
          "are one plane that looks one way; furnished models kept every room on every layer.",
      .parameters =
          {{"cube", "m", hidden::kCube, "wider and higher than windows and doors"},
           {"finest", "m", hidden::kFinest, "a voxel of most buildings: a ninth of the cube"},
           {"most_voxels", "", hidden::kMostVoxels, "a bound: larger buildings get larger voxels"},
           {"depth", "m", hidden::kDepth, "at least, and two voxels: reveals are no deeper"},
           {"open_share", "", hidden::kOpenShare,
            "of a cavity's walls that are open: a porch of 2 by 2 by 4 m has 0.11, rooms 0.02 to "
            "0.05, a shop without its front 0.07"},
           {"least_hidden", "", hidden::kLeastHidden, "of the area: less is a fold, no inside"},
           {"least_hidden_drawn", "", hidden::kLeastHiddenDrawn,
            "likewise, of what people draw: parts sunk into others"},
           {"least_drawn", "", kLeastDrawn,
            "share of the surface that is upright or level to the last digit: what people draw"},
           {"gate_samples", "", hidden::kGateSamples, "points that decide whether to look closer"},
           {"sample_area", "m²", hidden::kSampleArea,
            "that a point of a face stands for: of 0.25, all of a chimney's face lay below the "
            "roof that its tip stands over"},
           {"most_samples", "", hidden::kMostSamples, "points of a face"},
           {"rays", "", hidden::kRays, "of a point, over the sphere"},
           {"seen", "", hidden::kSeen, "rays that see it: one may slip through a seam"},
           {"lift", "m", hidden::kLift, "off the face that rays start"},
           {"mostly_seen", "", hidden::kMostlySeen, "share of a piece's points that are seen"}},
      .needs = {},
      .test = "scene/hidden: boxes that stand on each other are one shell",
      .made_on = {"ingolstadt-north", "delft"}};
}

RuleInfo floaters_rule() {
  return {.rule = Rule::kFloaters,
          .id = "planes.floaters",
          .title = "small loose pieces are dropped",
          .sees =
              "Connected components under an area that come near no larger one; in the air larger "
              "ones, too.",
          .does = "Leaves them out of planes and of all distances, and reports how much that was.",
          .paper = "The paper has no such step: each becomes planes.",
          .reason = "They were 26 to 48 % of all planes of the simulated scans.",
          .parameters = {{"area", "m²", planes::kFloaterArea,
                          "a component at least this large is none"},
                         {"share", "", planes::kFloaterShare, "of the area: likewise"},
                         {"distance", "m", planes::kFloaterDistance,
                          "what lies closer to the building belongs to it"},
                         {"hanging_area", "m²", planes::kHangingArea,
                          "a component in the air is one up to here"},
                         {"hanging_share", "", planes::kHangingShare, "of the area: likewise"},
                         {"hanging_height", "m", planes::kHangingHeight,
                          "over the foot: what is lower stands on something"},
                         {"hanging_distance", "m", planes::kHangingDistance,
                          "of those over `area`: what lies closer belongs to the building"}},
          .needs = {},
          .test = "planes/planes: a floater is dropped, an unconnected piece on the wall is kept",
          .made_on = {"ingolstadt-north-scan"}};
}

RuleInfo faces_rule() {
  return {
      .rule = Rule::kFaces,
      .id = "planes.faces",
      .title = "a mesh is grown face by face",
      .sees = "Meshes.",
      .does =
          "Grows regions over faces that share an edge; a region's outline is the union of its "
          "faces.",
      .paper =
          "The paper counts points: they are spread over the mesh, and an outline is the "
          "α-shape of a region's points.",
      .reason =
          "A mesh knows its surface and its borders to the last digit, and the least region of "
          "20 points depends on how densely they lie.",
      .parameters = {{"sample_density", "per m²", planes::kSampleDensity,
                      "points on a mesh without the rule: 10 cm apart"},
                     {"least_samples", "", planes::kLeastSamples, "of a building: at least"},
                     {"most_samples", "", planes::kMostSamples, "likewise: at most"}},
      .needs = {},
      .test = "planes/planes: without the rule for faces a mesh is points, whatever its triangles",
      .made_on = {}};
}

RuleInfo round_sides_rule() {
  return {
      .rule = Rule::kRoundSides,
      .id = "rounds.sides",
      .title = "the sides of a round shape are found together",
      .sees =
          "In a mesh that is exact to millimetres, faces turned about a vertical or level axis "
          "in equal steps: domes, spires, towers, apses, vaults.",
      .does = "Makes each side a plane of its own, which no tolerance joins, drops or turns.",
      .paper = "The paper knows planes only, grown one by one.",
      .reason =
          "Grown one by one, neighbouring sides of a dome joined in patches with chips "
          "between them.",
      .parameters =
          {{"most_step", "°", rounds::kMostStep * kDegrees, "twelve sides and more are round"},
           {"least_step", "°", rounds::kLeastStep * kDegrees, "finer steps are not told apart"},
           {"least_bend", "°", rounds::kLeastBend * kDegrees,
            "between faces of two sides: small near an apex"},
           {"off_plane", "m", rounds::kOffPlane, "that a side's corners may be off its plane"},
           {"on_axis", "m", rounds::kOnAxis, "files have mm, and narrow sides turn by them"},
           {"same_step", "", rounds::kSameStep, "of the step: how far steps may differ"},
           {"least_meridians", "", rounds::kLeastMeridians, "edges between columns that agree"},
           {"closed_share", "", rounds::kClosedShare,
            "of all columns: the others are hidden in a house"},
           {"least_share", "", rounds::kLeastShare, "of the source's area"},
           {"least_area", "m²", rounds::kLeastArea, "smaller ones are pipes and balusters"},
           {"least_together", "", rounds::kLeastTogether, "columns side by side that make a row"},
           {"alike", "", rounds::kAlike, "cosine of a narrow face's normal and its side's"},
           {"steepest", "", rounds::kSteepest, "of a normal across the axis: less has no column"},
           {"hardly_fewer", "", rounds::kHardlyFewer,
            "of the faces that a looser tolerance places: then the tighter one is taken"},
           {"joined", "m", rounds::kJoined, "between the ends of rows that follow each other"},
           {"most_sides", "", planes::kMostSides, "of a shape: more take half a minute to cut"},
           {"finest", "m", planes::kFinest,
            "between a side and its arc where a shape has more sides than that"}},
      .needs = {Rule::kFaces},
      .test =
          "rounds/rounds: a dome is rows and columns of sides, whatever its size and where it "
          "stands",
      .made_on = {}};
}

RuleInfo ellipses_rule() {
  return {
      .rule = Rule::kEllipses,
      .id = "rounds.ellipses",
      .title = "what is elliptical is round in a narrowed plan",
      .sees = "Curved pieces of an exact mesh whose plan spreads farther one way than across.",
      .does =
          "Looks for closed round shapes about an upright axis in the mesh without that stretch.",
      .paper = "The paper knows planes only, grown one by one.",
      .reason =
          "The sides of an elliptical dome had chips between them as those of a round one had.",
      .parameters = {{"least_corners", "", static_cast<double>(rounds::kLeastCorners),
                      "of the plan: a polygon of fewer sides is not round"},
                     {"narrowest", "", rounds::kNarrowest,
                      "of the longer axis: tolerances grow as it shrinks"},
                     {"round", "", rounds::kRound,
                      "of the longer axis: from there on it is a circle"},
                     {"same", "", rounds::kSameStretch, "between two stretches"}},
      .needs = {Rule::kRoundSides},
      .test =
          "rounds/rounds: elliptical domes are round ones that were narrowed, however they are "
          "turned",
      .made_on = {}};
}

}  // namespace

std::vector<RuleInfo> source_rules() {
  return {ground_rule(), hidden_rule(),      floaters_rule(),
          faces_rule(),  round_sides_rule(), ellipses_rule()};
}

}  // namespace colod::rules
