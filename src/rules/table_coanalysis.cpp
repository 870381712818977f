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
      {.rule = Rule::kAlike,
       .id = "selection.alike",
       .title = "alike segments near 2 % decide together",
       .sees = "Segments of several buildings that are alike and whose shares lie near that of a "
               "main segment.",
       .does = "Takes the median of their shares for each.",
       .paper = "The paper has no such step.",
       .reason =
           "A stairhead with 2.1 % of one block's voxels and another with 1.9 % are one kind.",
       .parameters = {{"doubt", "", kDoubt, "times the share, and a part of it: near it"},
                      {"alike", "", kAlike, "similarity of segments that decide together"},
                      {"most", "", static_cast<double>(kMostAlike),
                       "neighbours in size that are looked at on each side: a bound"}},
       .needs = {Rule::kMainSegments},
       .test = "coanalysis/selection: robust: alike segments near 2 % decide together, others for "
               "themselves",
       .made_on = {"synth", "synth-scan"}},
      {.rule = Rule::kMainSegments,
       .id = "selection.main",
       .title = "main segments join layer 0",
       .sees = "Segments of at least 2 % of their building's voxels that the program dropped.",
       .does = "Puts them on layer 0.",
       .paper = "The paper keeps the optimum as it is.",
       .reason = "The literal optimum leaves 6 of 15 scanned houses without their main roof.",
       .parameters = {{"share", "", kMainShare, "of the voxels; chosen on the scans"},
                      {"spire_weight", "", kSpireWeight, "times a spire's voxels"}},
       .needs = {},
       .test = "coanalysis/selection: robust adds every segment with at least 2 % of the voxels, "
               "paper does not",
       .made_on = {"ingolstadt-north-scan"}},
      {.rule = Rule::kLesserSegments,
       .id = "selection.lesser",
       .title = "lesser segments leave layer 0",
       .sees = "Segments of less than 2 % of the voxels that the program kept.",
       .does = "Takes them off, smallest first, while the bound on f_r holds.",
       .paper = "The paper keeps the optimum as it is.",
       .reason =
           "A building alone, whose f_co is 0, keeps whatever has little area for its voxels: "
           "12 of 12 segments of an arch, 16 of 36 of a photogrammetric house.",
       .parameters = {},
       .needs = {},
       .test = "coanalysis/selection: robust: segments of little volume leave, as far as the bound "
               "on f_r lets them",
       .made_on = {"mvs"}}};
}

std::vector<RuleInfo> clustering_rules() {
  return {
      {.rule = Rule::kFlatSegments,
       .id = "clustering.flat",
       .title = "flat segments are set aside",
       .sees = "Segments of one plane, or thinner than 5 cm.",
       .does =
           "Leaves them out of the spectrum; each then joins the layer of nearest median extent.",
       .paper = "All segments go into the spectrum.",
       .reason = "Whitening makes flat segments a class of their own, and the clusters would be "
                 "\"flat\" and \"not flat\".",
       .parameters = {{"thin", "m", kThin, "thinner is flat, and the whitening's floor"},
                      {"thin_relative", "", kThinRelative, "of the longest axis: likewise"}},
       .needs = {},
       .test = "coanalysis/clustering: flat segments go to the layer of their size, without moving "
               "the others",
       .made_on = {"ingolstadt-north-scan"}},
      {.rule = Rule::kMedianExtent,
       .id = "clustering.extent",
       .title = "layers come by median extent",
       .sees = "The clusters of the spectrum.",
       .does = "Orders them by the median of their segments' longest extents.",
       .paper = "The paper orders by mean volume.",
       .reason = "Leaving out one building of 15 swapped layers.",
       .parameters = {},
       .needs = {},
       .test = "coanalysis/clustering: kinds that differ are told apart and ordered by size",
       .made_on = {"ingolstadt-north-scan"}},
      {.rule = Rule::kKinds,
       .id = "clustering.kinds",
       .title = "what differs by noise only is of one kind",
       .sees = "Whether there are as many segments as layers that differ by more than the noise of "
               "their samples.",
       .does = "Lets size decide where there are not.",
       .paper = "The spectrum always decides.",
       .reason = "Segments that are all alike were parted by the noise of their samples.",
       .parameters = {{"same_kind", "", kSameKind,
                       "distance; samples of the same shape differ by up to 0.02"}},
       .needs = {},
       .test = "coanalysis/clustering: none, one, fewer than clusters, identical, flat only, no "
               "extent",
       .made_on = {"synth"}},
      {.rule = Rule::kElementLayers,
       .id = "clustering.elements",
       .title = "all elements of a kind are on one layer",
       .sees = "Balconies, loggias, dormers, bays and windows of all buildings.",
       .does = "Puts each kind on the layer on which most of them are.",
       .paper = "The spectrum alone decides.",
       .reason = "What is of a kind is so whatever its size.",
       .parameters = {},
       .needs = {Rule::kElementSegments},
       .test = "coanalysis/clustering: what is of a kind is on one layer, whatever its size",
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
