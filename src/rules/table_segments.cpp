// The rows of segments.
#include "parts.h"
#include "segments/parameters.h"

namespace colod::rules {
namespace {

using namespace parameters::segments;

std::vector<RuleInfo> grouping_rules() {
  return {
      {.rule = Rule::kHistograms,
       .id = "segments.histograms",
       .title = "groups merge by how much of each plane they see",
       .sees = "Neighbouring groups of voxels, by the intersection of their normalised hit "
               "histograms.",
       .does = "Merges the best pair first while that is over 0.5.",
       .paper = "The paper counts a plane as common from its first shared hit on, and takes pairs "
                "in the order of a queue.",
       .reason =
           "One stray ray joins what has nothing in common: buildings collapse into \"walls\" "
           "and \"roofs\".",
       .parameters = {{"overlap", "", kMergeOverlap, "the paper's"}},
       .needs = {},
       .test = "segments/segments: one stray hit joins groups by the paper's rule, not by the "
               "histogram",
       .made_on = {"ingolstadt-north-scan"}},
      {.rule = Rule::kSpecks,
       .id = "segments.specks",
       .title = "groups of a few voxels join a neighbour",
       .sees = "Groups of fewer than 20 voxels.",
       .does = "Joins each to the neighbour that sees most alike.",
       .paper = "The paper has no such step.",
       .reason = "A few voxels are rounding of the grid, no part.",
       .parameters = {{"least_voxels", "", static_cast<double>(kLeastVoxels),
                       "chosen with 64 and 100 voxels a side; does not follow --ns"}},
       .needs = {},
       .test = "segments/segments: groups that are not kept join their best neighbour, reaching "
               "over each other",
       .made_on = {"ingolstadt-north-scan"}},
      {.rule = Rule::kDetails,
       .id = "segments.details",
       .title = "details that share a surface are one",
       .sees = "Groups with little of the enclosed voxels that touch with a fifth of a surface.",
       .does = "Joins them, closest contact first, as long as they stay small.",
       .paper = "The paper has no such step.",
       .reason = "Horizontal rays part a dormer's or a chimney's box from its roof.",
       .parameters = {{"share", "", kDetailShare, "of the enclosed voxels: the most of a detail"},
                      {"contact", "", kDetailContact, "of the surface of one of the two"}},
       .needs = {},
       .test = "segments/segments: details that share much of a surface are one, as long as they "
               "stay small",
       .made_on = {"ingolstadt-north-scan"}},
      {.rule = Rule::kBehind,
       .id = "segments.behind",
       .title = "a plane belongs to what lies right behind it",
       .sees =
           "The first voxel with a group one to two and a half voxels behind points of a plane.",
       .does = "Gives the plane to the group behind most of its area.",
       .paper = "The paper gives it to the group with most hits on it.",
       .reason = "A dormer is open to the attic, whose thousands of voxels outvote its own; level "
                 "planes get no hits from level rays at all.",
       .parameters = {{"first_step", "", kSteps[0], "voxels behind the plane"},
                      {"second_step", "", kSteps[1], "likewise"},
                      {"third_step", "", kSteps[2], "likewise; chosen on the scans"}},
       .needs = {},
       .test = "segments/segments: robust: chimney, bay and recess are segments of their own",
       .made_on = {"ingolstadt-north-scan"}}};
}

std::vector<RuleInfo> alcove_rules() {
  return {
      {.rule = Rule::kAlcoves,
       .id = "segments.alcoves",
       .title = "the closed pass comes first, with all planes",
       .sees = "After the closed pass, voxels outside of the building half of whose rays meet "
               "small planes from outside.",
       .does = "Makes alcoves of them, which take planes mostly in front of their voxels.",
       .paper = "Algorithm 1: every plane under --alcove-area is turned in a first pass.",
       .reason = "Turning takes the main body away wherever walls are small.",
       .parameters = {{"small_ratio", "", kSmallRatio,
                       "of the largest plane: the most a plane of an alcove may be"},
                      {"front_share", "", kFrontShare,
                       "of a plane's area in front of which an alcove must lie"}},
       .needs = {},
       .test = "segments/segments: robust: without alcove area a recess belongs to what is behind "
               "it",
       .made_on = {"ingolstadt-north-scan"}},
      {.rule = Rule::kAlcoveGuard,
       .id = "segments.guard",
       .title = "an alcove is a real recess",
       .sees = "The planes that an alcove takes.",
       .does = "Leaves them with what is behind them unless they are three at least, two that face "
               "each other and two that cross.",
       .paper = "The paper has no such step.",
       .reason = "A corner between two walls is no recess.",
       .parameters = {{"facing", "", kFacing, "cosine between normals that face each other"},
                      {"parallel", "", kParallel, "cosine up to which normals cross: 20°"},
                      {"planes", "", static_cast<double>(kLeastPlanes), "of a recess"}},
       .needs = {Rule::kAlcoves},
       .test = "segments/segments: an alcove needs three planes, two that face and two that cross",
       .made_on = {"ingolstadt-north-scan"}}};
}

std::vector<RuleInfo> form_rules() {
  return {
      {.rule = Rule::kElementSegments,
       .id = "segments.elements",
       .title = "an element is one segment",
       .sees = "Balconies, loggias, bays, dormers and windows (elements.*).",
       .does = "Makes them one segment: that which has most of them and little else, or a new one.",
       .paper = "Rays alone decide.",
       .reason = "Rays give a balcony's floor to the body, a loggia's ceiling and cheeks and a "
                 "window's reveals to several segments.",
       .parameters = {{"most_others", "", kMostOthers,
                       "of the element's area: planes of others in the segment that takes it"},
                      {"same", "", kSameElement,
                       "of its area that an earlier one has taken: it is that one"}},
       .needs = {},
       .test = "elements/elements: balconies and loggias are segments of their own, whole",
       .made_on = {"ingolstadt-north-scan", "ingolstadt-north", "synth", "synth-scan"}},
      {.rule = Rule::kFidelity,
       .id = "segments.fidelity",
       .title = "fidelity is what opens: volume and outline",
       .sees = "Which segments' planes the rays of each enclosed voxel meet.",
       .does =
           "A voxel is lost with the segments that it sees most of, as many as leave it less than "
           "half of what its rays met; a part of the outline, seen along the three axes, with "
           "all voxels of its column. Where an alcove is dropped the building closes over it.",
       .paper = "A voxel is its segment's; volume only.",
       .reason =
           "A pane that a few voxels see most of counted as 2 % of a house, and a spire, which "
           "has little volume, as nothing: rules of thumb had to overrule the program.",
       .parameters = {{"outline", "", kOutlineShare,
                       "of the fidelity; with 0.25 a spire goes, with 0.5 repeated balconies and "
                       "chimneys stay (synth-scan, seeds 1 and 2)"},
                      {"together", "", kMostTogether,
                       "segments of a set: a bound; what only more of them open together counts as "
                       "never lost"}},
       .needs = {},
       .test = "segments/fidelity: a pane is worth nothing, a wing its volume, a spire its outline",
       .made_on = {"synth-scan"}}};
}

}  // namespace

std::vector<RuleInfo> segment_rules() {
  std::vector<RuleInfo> rows = grouping_rules();
  for (auto part : {alcove_rules(), form_rules()})
    rows.insert(rows.end(), part.begin(), part.end());
  return rows;
}

}  // namespace colod::rules
