// The rows of elements: parts that planes enclose only in part.
#include "elements/parameters.h"
#include "parts.h"

namespace colod::rules {
namespace {

using namespace parameters::elements;

constexpr std::string_view kPaper = "Rays alone decide.";

RuleInfo balconies_rule() {
  return {
      .rule = Rule::kBalconies,
      .id = "elements.balconies",
      .title = "balconies are told by their floor, or underside, and walls",
      .sees =
          "A floor with a corner of low walls around it and nothing below, or an underside with "
          "walls on all sides and no lid.",
      .does =
          "Calls them a balcony: its air is outside, its walls are thin, and what a scan does "
          "not show of it (inner sides, underside or floor) is added.",
      .paper = kPaper,
      .reason =
          "Rays escape from a balcony or meet its thin walls from the back: 11 of 12 were "
          "closed over on scans.",
      .parameters =
          {{"thickness", "m", balconies::kThickness, "of a wall whose other side is not seen"},
           {"thickest", "m", balconies::kThickest, "between both sides of a thin wall"},
           {"slab", "m", balconies::kSlab, "of a floor of which one side is seen"},
           {"most_beyond", "m", balconies::kMostBeyond,
            "of a balcony beyond what is seen of its floor"},
           {"least_floor", "m²", balconies::kLeastFloor, "of a floor"},
           {"least_underside", "m²", balconies::kLeastUnderside, "of an underside"},
           {"below", "m", balconies::kBelow, "below a floor: where nothing, or a room, is"},
           {"above", "m", balconies::kAboveBalcony,
            "above the walls: where a closed box has its lid"},
           {"least_rail", "m", balconies::kLeastRail, "of a wall above its floor"},
           {"most_rail", "m", balconies::kMostRail, "likewise"},
           {"least_rail_alone", "m", balconies::kLeastRailAlone,
            "of one whose floor is not seen: lower boxes are ledges"},
           {"most_area", "m²", panels::kMostArea, "of a plane of any element"},
           {"reach", "m", panels::kReach, "between planes that meet, of any element"},
           {"touch", "m", panels::kTouch, "between walls that share an edge, of any element"},
           {"upright", "", panels::kUpright, "|cosine| to the vertical of any element's wall"},
           {"level", "", panels::kLevel, "likewise of a floor or ceiling"},
           {"alike", "", panels::kAlike, "cosine of directions that count as the same"}},
      .needs = {},
      .test = "elements/elements: a balcony is found with its four planes and the air in it",
      .made_on = {"ingolstadt-north-scan", "synth-scan"}};
}

std::vector<RuleInfo> room_rules() {
  return {
      {.rule = Rule::kLoggias,
       .id = "elements.loggias",
       .title = "loggias and shop fronts are told by ceiling and cheeks",
       .sees = "A ceiling, a back and two cheeks that stand out of a facade, with a room above.",
       .does = "Calls them a loggia: its air is outside, and a floor is added where none shows.",
       .paper = kPaper,
       .reason = "A scan from the street shows no floor; rays give ceiling and cheeks to several "
                 "segments.",
       .parameters = {{"least_depth", "m", loggias::kLeastDepth, "of a loggia"},
                      {"most_depth", "m", loggias::kMostDepth, "likewise"},
                      {"least_width", "m", loggias::kLeastWidth, "likewise"},
                      {"most_width", "m", panels::kMostWidth, "likewise"},
                      {"most_cheek", "m²", panels::kMostCheek,
                       "of a wall beside it; of chimneys and bays, too"},
                      {"above", "m", loggias::kAbove, "above it: where a room must be"}},
       .needs = {},
       .test = "elements/elements: a loggia is found, the space between two bays is none",
       .made_on = {"ingolstadt-north-scan", "synth-scan"}},
      {.rule = Rule::kChimneys,
       .id = "elements.chimneys",
       .title = "chimneys are told by facing walls, also without top or one side",
       .sees = "Three or four upright planes around a narrow shaft that no room is behind.",
       .does = "Calls them a chimney, solid inside; top or side are added where none shows. A "
               "segment of little else is one of the kind.",
       .paper = kPaper,
       .reason = "Scans show no top of a chimney, or a corner only: rays escape. And by shape and "
                 "size alone 8 of 16 chimneys of a made-up street were on layer 1, 8 on layer 2.",
       .parameters = {{"least", "m", chimneys::kLeastChimney, "between its walls"},
                      {"most", "m", panels::kMostChimney, "likewise"},
                      {"most_corner", "m", chimneys::kMostCorner,
                       "of one of which only a corner is seen"},
                      {"least_foot", "m", chimneys::kLeastFoot,
                       "above the building's foot: lower ones are pillars"},
                      {"across", "", chimneys::kAcross,
                       "cosine between its two pairs of walls at most"},
                      {"least_walls", "", chimneys::kLeastWalls,
                       "of a segment's area: walls with an opposite one"}},
       .needs = {},
       .test =
           "elements/elements: a whole chimney is told by walls on all sides, whatever its size",
       .made_on = {"synth-scan", "synth"}}};
}

std::vector<RuleInfo> facade_rules() {
  return {
      {.rule = Rule::kBays,
       .id = "elements.bays",
       .title = "bays are told by front, sides and facade",
       .sees = "A front before a facade with two sides, square or splayed.",
       .does = "Calls them a bay.",
       .paper = kPaper,
       .reason = "Rays give a small house's bay to its body.",
       .parameters = {{"away", "", bays::kAway, "cosine of its sides' normals at most"},
                      {"least_depth", "m", bays::kLeastDepthOfBay, "of a bay"},
                      {"most_depth", "m", bays::kMostDepthOfBay, "likewise"},
                      {"least_width", "m", bays::kLeastWidthOfBay, "likewise"},
                      {"most_width", "m", bays::kMostWidthOfBay, "likewise"},
                      {"least_height", "m", bays::kLeastHeight, "likewise"},
                      {"most_front", "m²", bays::kMostFront, "of its front"}},
       .needs = {},
       .test = "elements/elements: a bay is told by its sides, its front and the facade, square or "
               "splayed",
       .made_on = {"synth-scan"}},
      {.rule = Rule::kDormers,
       .id = "elements.dormers",
       .title = "dormers are told by a small roof on a large one",
       .sees = "A small roof that stands out of a steeper or larger one, with walls below.",
       .does = "Calls them a dormer; on a mansard its cheeks are added where none shows.",
       .paper = kPaper,
       .reason = "A dormer is open to the attic, and a mansard hides its cheeks from scans.",
       .parameters = {{"least_roof", "m²", dormers::kLeastRoof, "of its roof"},
                      {"most_roof", "m²", dormers::kMostRoof, "likewise"},
                      {"least_host", "", dormers::kLeastHost, "times that: the large roof's area"},
                      {"crossing", "", dormers::kCrossing, "cosine between both at most: 15°"},
                      {"least_relief", "m", dormers::kLeastRelief, "that it stands out"},
                      {"steep", "", dormers::kSteep, "upward part of a steep roof's normal: 57°"},
                      {"most_wall", "m²", dormers::kMostWall, "of its walls"}},
       .needs = {},
       .test = "elements/elements: a dormer is told by a small roof that stands out of a steep one",
       .made_on = {"ingolstadt-north-scan", "synth-scan"}},
      {.rule = Rule::kWindows,
       .id = "elements.windows",
       .title = "windows and doors are told by pane and reveals",
       .sees = "A pane behind a facade with two reveals at least.",
       .does = "Calls them a window; a missing lintel or jamb is added.",
       .paper = kPaper,
       .reason = "A window is about as deep as a voxel is wide: rays gave pane and reveals to "
                 "several segments, and a layer with one but not the other set its facade back.",
       .parameters = {{"least_depth", "m", windows::kLeastDepthOfWindow, "from pane to facade"},
                      {"most_depth", "m", windows::kMostDepthOfWindow, "likewise"},
                      {"beside", "m", windows::kBeside, "a reveal begins at the pane's edge"},
                      {"across", "", windows::kAcrossPane, "|cosine| of its normal to the pane's"},
                      {"facing", "", windows::kFacing, "cosine of its normal and the way inward"},
                      {"least_pane", "m²", windows::kLeastPane, "of a pane"},
                      {"most_pane", "m²", windows::kMostPane, "more is the back of a loggia"},
                      {"reveals", "", static_cast<double>(windows::kReveals), "at least"}},
       .needs = {},
       .test = "elements/elements: a window is found by its pane and reveals, two of them at least",
       .made_on = {"ingolstadt-north", "synth"}}};
}

}  // namespace

std::vector<RuleInfo> element_rules() {
  std::vector<RuleInfo> rows{balconies_rule()};
  for (auto part : {room_rules(), facade_rules()})
    rows.insert(rows.end(), part.begin(), part.end());
  return rows;
}

}  // namespace colod::rules
