// The rows of outlines, of which way planes look, and of what rays make of them.
#include "parts.h"
#include "planes/parameters.h"
#include "visibility/parameters.h"

namespace colod::rules {
namespace {

using namespace parameters;

std::vector<RuleInfo> drawing_rules() {
  return {
      {.rule = Rule::kHoles,
       .id = "planes.holes",
       .title = "small holes of outlines are filled",
       .sees = "Holes and specks of an outline under an area.",
       .does = "Fills the holes, drops the specks.",
       .paper = "The paper keeps the α-shape, or the union of a mesh's faces, as it is.",
       .reason = "Horizontal rays leak through gaps.",
       .parameters = {{"hole", "m²", planes::kSmallHole, "a hole that is filled"},
                      {"speck", "m²", planes::kSpeck,
                       "a ring that is dropped, also as a share of the outline's area"}},
       .needs = {},
       .test = "planes/planes: a hole stays a clockwise ring, a small one is filled",
       .made_on = {"ingolstadt-north-scan"}},
      {.rule = Rule::kBorders,
       .id = "planes.borders",
       .title = "borders are drawn onto the lines where planes meet",
       .sees = "Vertices of an outline near the line, or the corner, that its plane has in common "
               "with neighbours.",
       .does = "Moves them there, unless the outline's area would change by much.",
       .paper = "The paper keeps outlines as they are.",
       .reason =
           "Horizontal rays leak through gaps between neighbours. Without it the mean distance "
           "of layer 1 was 7 % larger over 187 buildings.",
       .parameters = {{"reach", "", planes::kBorderReach,
                       "growing distances (of clouds point spacings, if more)"},
                      {"most_reach", "m", planes::kMostBorderReach, "at most"},
                      {"corner_reach", "", planes::kCornerReach, "of that: to a corner"},
                      {"least_sine", "", planes::kLeastSine, "of the angle between such planes"}},
       .needs = {},
       .test = "planes/planes: a noisy corner of two walls gives two upright, orthogonal planes "
               "that meet",
       .made_on = {"ingolstadt-north-scan"}}};
}

std::vector<RuleInfo> orientation_rules() {
  return {
      {.rule = Rule::kOrientation,
       .id = "planes.orientation",
       .title = "planes seen on their back are turned",
       .sees = "Planes from whose back most rays escape and from whose front few do.",
       .does = "Turns them outward.",
       .paper = "The paper takes normals as they are given.",
       .reason = "Some models are wound inward, scans have flipped parts: 10 % of planes do no "
                 "harm, 30 % break every later room.",
       .parameters =
           {{"least_back", "", planes::kLeastBack, "share of rays that escape at the back"},
            {"most_front", "", planes::kMostFront, "share that escape at the front"},
            {"most_front_of_floor", "", planes::kMostFrontOfFloor,
             "likewise of what looks up, which was seen from above: only a floor shut in on all "
             "sides is turned"},
            {"clear_majority", "", planes::kClearMajority, "difference of both shares"}},
       .needs = {},
       .test = "planes/planes: walls wound inward are turned by rays",
       .made_on = {"ingolstadt-north-scan", "points"}},
      {.rule = Rule::kAirborne,
       .id = "planes.airborne",
       .title = "roofs of airborne clouds look to the sky",
       .sees = "Clouds that are mostly roof: roofs that look down under the open sky, walls with "
               "their roof in front of them.",
       .does = "Turns them.",
       .paper = "The paper takes normals as they are given.",
       .reason =
           "Such clouds have next to no walls that could stop rays, so that planes.orientation "
           "is told nothing.",
       .parameters =
           {{"roof_tilt", "", planes::kRoofTilt, "|z| of a normal: what is flatter is a roof"},
            {"airborne_share", "", planes::kAirborneShare, "of all area that is roof"},
            {"open_sky", "", planes::kOpenSky, "share of steep rays that leave a roof"},
            {"beside_wall", "m", planes::kBesideWall, "off a wall, where a roof would be above"},
            {"sheltered", "", planes::kSheltered, "share of steep rays that meet it there"},
            {"unsheltered", "", planes::kUnsheltered, "share that may on the other side"}},
       .needs = {Rule::kOrientation},
       .test = "rules/effects: each rule of planes changes a source that was made for it",
       .made_on = {"als/block-a"}}};
}

std::vector<RuleInfo> visibility_rules() {
  return {
      {.rule = Rule::kPartyWalls,
       .id = "visibility.party",
       .title = "a voxel is inside although party walls are missing",
       .sees = "Voxels with fewer than half of their rays on inner sides, and hardly any on outer "
               "ones.",
       .does = "Counts them as inside.",
       .paper = "The paper asks for half of the rays.",
       .reason =
           "Party walls are missing in scans. Without it the mean distance of layer 0 was 23 % "
           "larger over 187 buildings.",
       .parameters = {{"inside", "", visibility::kPartyInside, "of the rays, at least"},
                      {"outside", "", visibility::kPartyOutside, "of the rays, at most"}},
       .needs = {},
       .test = "visibility/visibility: missing party walls leave a terraced house valid only with "
               "the rule for them",
       .made_on = {"ingolstadt-north-scan"}},
      {.rule = Rule::kWideOutlines,
       .id = "visibility.outlines",
       .title = "outlines are wider for the rays",
       .sees = "Borders of outlines.",
       .does = "Moves them outward, for the casting of rays only.",
       .paper = "The paper casts at outlines as they are.",
       .reason = "Few rays escape through cracks between neighbours.",
       .parameters = {{"border_ratio", "", visibility::kBorderRatio,
                       "of the growing distance; chosen on the scans"},
                      {"sharpest", "", visibility::kSharpest,
                       "bounds how far a sharp corner moves: some 40° and less by less"}},
       .needs = {},
       .test =
           "visibility/visibility: wider outlines close the cracks at the corners of a room, to "
           "the letter they stay open",
       .made_on = {"ingolstadt-north-scan"}}};
}

}  // namespace

std::vector<RuleInfo> outline_rules() {
  std::vector<RuleInfo> rows = drawing_rules();
  for (auto part : {orientation_rules(), visibility_rules()})
    rows.insert(rows.end(), part.begin(), part.end());
  return rows;
}

}  // namespace colod::rules
