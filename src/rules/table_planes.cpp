// The rows of growing planes and of making them regular.
#include <cmath>

#include "parts.h"
#include "planes/parameters.h"
#include "planes/planes.h"

namespace colod::rules {
namespace {

using namespace parameters::planes;

constexpr std::string_view kRightAngles =
    "planes/planes: a noisy corner of two walls gives two upright, orthogonal planes that meet";

std::vector<RuleInfo> growing_rules() {
  return {
      {.rule = Rule::kNoise,
       .id = "planes.noise",
       .title = "the distance of growing follows the noise",
       .sees = "How far the flattest tenth of neighbourhoods is off its own planes.",
       .does = "Grows planes at a multiple of that, between 0.03 m and --distance.",
       .paper = "The paper grows at a fixed 0.2 m.",
       .reason = "0.2 m swallows recesses of models and of good scans.",
       .parameters =
           {{"factor", "", kNoiseFactor,
             "three residuals of a whole wall, which on scans is 2.3 times that of 1.5 m of it "
             "(0.012 m against 0.027 m on simulated photogrammetry)"},
            {"radius", "m", kNoiseRadius, "of a neighbourhood: sees bumps beside white noise"},
            {"least", "m", kLeastDistance, "the least distance; chosen on the scans"},
            {"most", "m", kMostDistance, "the paper's"},
            {"most_share", "", kMostDistanceShare, "of the diagonal: likewise, of small sources"}},
       .needs = {},
       .test = "planes/planes: walls three centimetres apart are one plane, twenty are two; of few "
               "planes all stay",
       .made_on = {"ingolstadt-north-scan", "mvs"}},
      {.rule = Rule::kFewPlanes,
       .id = "planes.few",
       .title = "an exact model of few planes keeps each of them",
       .sees = "Sources flat to the millimetre that have at most 12 planes when grown at 3 mm.",
       .does = "Keeps the planes so grown; offsets join within 2 mm only.",
       .paper = "The paper grows at a fixed 0.2 m.",
       .reason = "Walls of blocks that bend by a centimetre became one, and lost to every peer.",
       .parameters = {{"distance", "m", kPlainDistance, "what files with millimetres have"},
                      {"planes", "", static_cast<double>(kFewPlanes),
                       "a block has no more; chosen on 40 block models"}},
       .needs = {},
       .test = "planes/planes: walls three centimetres apart are one plane, twenty are two; of few "
               "planes all stay",
       .made_on = {"delft"}},
      {.rule = Rule::kSmoothNormals,
       .id = "planes.smooth",
       .title = "normals are smoothed for the angle test",
       .sees = "Sources with more noise than 5 mm.",
       .does = "Averages normals over neighbours, twice, for the test of --angle only.",
       .paper = "The paper tests raw normals.",
       .reason = "Faces of scans turn by more than 30° on a flat wall.",
       .parameters = {{"noise", "m", kSmoothedNoise, "below, normals need no smoothing"}},
       .needs = {Rule::kGrowing},
       .test = "planes/planes: a noisy corner of two walls gives two upright, orthogonal planes "
               "that meet",
       .made_on = {"ingolstadt-north-scan"}},
      {.rule = Rule::kGrowing,
       .id = "planes.growing",
       .title = "own growing of regions",
       .sees = "Faces, or points, in the order of how flat their surroundings are.",
       .does = "Grows regions with a running covariance; a plane is fitted again when its region "
               "has grown by 30 %.",
       .paper = "The paper takes CGAL's region growing.",
       .reason = "0.2 to 0.8 s where CGAL's took 1 to 11 s on 110 to 265 thousand faces.",
       .parameters = {{"refit_growth", "", kRefitGrowth, "chosen for speed; not tried elsewhere"}},
       .needs = {},
       .test = "planes/planes: a box has six outward planes with exact outlines",
       .made_on = {"ingolstadt-north-scan", "mvs"}},
      {.rule = Rule::kRegionArea,
       .id = "planes.area",
       .title = "regions are dropped by area, not by count",
       .sees = "Regions under a share of the building's area, or under what the noise allows.",
       .does = "Drops them, never the largest; of clouds also those of too few points. Keeps at "
               "most 4000.",
       .paper = "The paper drops regions of fewer than 20 faces or points (--min-points).",
       .reason = "20 faces refuse walls of two triangles: block models had no plane at all.",
       .parameters = {{"least_share", "", kLeastShare, "of the building's area"},
                      {"least_share_exact", "", kLeastShareExact,
                       "where it is flat to the millimetre: large houses have windows, too"},
                      {"most_share", "", kMostShare, "a region this large is never too small"},
                      {"area_of_distance", "m", kAreaOfDistance,
                       "m² for a metre of growing distance: rougher surfaces need larger regions"},
                      {"least_area", "m²", kLeastArea, "the least of that"},
                      {"least_area_rough", "m²", kLeastAreaRough, "the most of that"},
                      {"most_planes", "", static_cast<double>(kMostPlanes), "a bound on the work"}},
       .needs = {},
       .test = "planes/planes: a window's reveal is a plane on a large building, too, where there "
               "is no noise",
       .made_on = {"ingolstadt-north-scan", "ingolstadt-north", "synth"}}};
}

std::vector<RuleInfo> merging_rules() {
  return {
      {.rule = Rule::kCoplanar,
       .id = "planes.coplanar",
       .title = "nearly coplanar neighbours are one plane",
       .sees = "Neighbouring regions within 12° whose common plane fits both.",
       .does = "Joins them, best fit first.",
       .paper = "The paper has no such step.",
       .reason = "An exact partition keeps its topology whatever the planes are, but only merged "
                 "planes give clean cells.",
       .parameters = {{"angle", "°", std::acos(kMergeAngleCosine) * kDegrees,
                       "between normals; chosen on the scans"},
                      {"rms", "", kMergeRms, "of the growing distance: residual of each"},
                      {"opposite_rms", "m", kOppositeRms,
                       "residual where they look opposite ways: both sides of one sheet"}},
       .needs = {},
       .test = "planes/planes: a sheet with both sides modelled is one plane",
       .made_on = {"ingolstadt-north-scan", "mvs"}},
      {.rule = Rule::kSheetSides,
       .id = "planes.sheets",
       .title = "what looks opposite ways is one plane only as the sides of a sheet",
       .sees = "Two regions of a mesh on one plane that look opposite ways.",
       .does = "Keeps them apart unless half of the smaller lies over the larger.",
       .paper = "The paper joins nothing.",
       .reason = "A tower's wall and the gable that it stands before became one plane that looked "
                 "one way: cells before the other half seemed to be inside.",
       .parameters = {{"share", "", kSheetShare, "of the smaller one's area"}},
       .needs = {Rule::kCoplanar},
       .test = "planes/planes: walls that look opposite ways on one plane are two planes",
       .made_on = {"ingolstadt-north"}},
      {.rule = Rule::kOffsets,
       .id = "planes.offsets",
       .title = "parallel planes within the noise are one",
       .sees = "Offsets of parallel planes that are nearer than a share of the growing distance, "
               "or 5 cm.",
       .does = "Gives them one offset, by area; neighbours become one plane.",
       .paper = "The paper has no such step.",
       .reason = "Two walls a noise apart leave slivers all over an exact partition.",
       .parameters = {{"width", "", kOffsetWidth, "of the growing distance"},
                      {"least", "m", kLeastOffset, "but no less, unless planes are few and exact,"},
                      {"least_share", "", kLeastOffsetShare, "of the diagonal, of small sources"}},
       .needs = {},
       .test = "planes/planes: parallel planes within the distance share normal and offset bit for "
               "bit",
       .made_on = {"ingolstadt-north-scan", "mvs"}}};
}

std::vector<Parameter> move_parameters() {
  return {{"move_share", "", kMoveShare, "of the growing distance: what aligning may cost at most"},
          {"least_move", "m", kLeastMove,
           "what it may cost an exact model: files have millimetres, and walls had moved by 4 mm"},
          {"upright", "", kUpright, "sine of what counts as level or upright"},
          {"turn", "°", kTurn * kDegrees, "the most that a region turns"},
          {"turn_small", "°", kTurnSmall * kDegrees, "likewise one under 1 m²"},
          {"small_area", "m²", kSmallArea, "that"}};
}

std::vector<RuleInfo> direction_rules() {
  return {
      {.rule = Rule::kUpright,
       .id = "planes.upright",
       .title = "walls are upright and floors level",
       .sees = "Planes within some degrees of upright or level, as far as their own noise "
               "excuses a turn.",
       .does = "Turns them about their middle.",
       .paper = "The paper aligns nothing.",
       .reason = "Right angles, and 5 to 9 % fewer polygons on scans (with the other alignments).",
       .parameters = move_parameters(),
       .needs = {},
       .test = kRightAngles,
       .made_on = {"ingolstadt-north-scan", "mvs"}},
      {.rule = Rule::kFamilies,
       .id = "planes.families",
       .title = "walls are parallel or at right angles",
       .sees = "Directions of walls; each joins the first family of four that it fits.",
       .does = "Turns it to that; what fits no family takes the direction of an earlier plane.",
       .paper = "The paper aligns nothing.",
       .reason = "As planes.upright; its numbers hold for this one, too.",
       .parameters = {},
       .needs = {},
       .test = kRightAngles,
       .made_on = {"ingolstadt-north-scan", "mvs"}},
      {.rule = Rule::kTilts,
       .id = "planes.tilts",
       .title = "slopes share their tilt",
       .sees = "Slopes whose tilts differ by less than 5°.",
       .does = "Gives the later the tilt of the earlier where its noise excuses it.",
       .paper = "The paper aligns nothing.",
       .reason = "A ridge between two sides of one tilt is level.",
       .parameters = {{"same_tilt", "°", kSameTilt * kDegrees, "not tried elsewhere"}},
       .needs = {},
       .test = "planes/planes: a gable house has seven planes, the roof's two sides at one tilt",
       .made_on = {"ingolstadt-north-scan"}},
      {.rule = Rule::kNarrowStrips,
       .id = "planes.narrow",
       .title = "narrow strips take the building's directions",
       .sees = "Strips about a metre wide, which hardly know their direction.",
       .does = "Lets them turn by up to 10° to one that is there.",
       .paper = "The paper aligns nothing.",
       .reason = "Parapets and ledges of scans lean by more than walls do.",
       .parameters = {{"most_turn", "°", kMostTurn * kDegrees, "not tried elsewhere"},
                      {"narrow", "m", kNarrow, "standard deviation across the strip"}},
       .needs = {},
       .test = "rules/effects: each rule of planes changes a source that was made for it",
       .made_on = {"ingolstadt-north-scan"}}};
}

RuleInfo absorb_rule() {
  return {.rule = Rule::kAbsorb,
          .id = "planes.absorb",
          .title = "what is left joins a plane that it lies on",
          .sees = "Faces or points of no region that lie on a neighbouring region's plane.",
          .does = "Adds them to it, nearest first; the plane stays, its outline grows.",
          .paper = "The paper leaves them out.",
          .reason = "Outlines with holes let rays through.",
          .parameters = {},
          .needs = {},
          .test = "rules/effects: each rule of planes changes a source that was made for it",
          .made_on = {"ingolstadt-north-scan"}};
}

}  // namespace

std::vector<RuleInfo> plane_rules() {
  std::vector<RuleInfo> rows = growing_rules();
  for (auto part : {merging_rules(), direction_rules()})
    rows.insert(rows.end(), part.begin(), part.end());
  rows.push_back(absorb_rule());
  return rows;
}

}  // namespace colod::rules
