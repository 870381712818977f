// The row of what is melted.
#include "coanalysis/parameters.h"
#include "core/drawn.h"
#include "parts.h"
#include "relief/parameters.h"

namespace colod::rules {
namespace {

using namespace parameters;

std::vector<Parameter> melted_numbers() {
  return {
      {"exact_bulge", "m", relief::kExactBulge,
       "residual of the flattest quarter of all pieces of wall and roof: less is exact"},
      {"least_lean", "", relief::kLeastLean,
       "z of the walls' normals, their mean: scans from the street have at most 0.03, since noise "
       "leans both ways, drones' 0.04 and more"},
      {"coarse_bulge", "m", relief::kCoarseBulge,
       "of meshes whose walls do not lean: scans from the street have 0.024, sparse ones 0.07"},
      {"wide", "m", relief::kWide,
       "typical edge: nothing but roofs and walls can be told, however flat they are"},
      {"wide_bulge", "m", relief::kWideBulge, "of such meshes"},
      {"coarse", "m", relief::kCoarse,
       "typical edge, or 2.4 bulges: windows cannot be told; small round towers bulge as much"},
      {"least_drawn", "", kLeastDrawn,
       "share of the surface that is upright or level to the last digit: what people draw"},
      {"least_support", "", relief::kLeastSupport,
       "of the walls that are drawn, in faces of the mesh: terrain has no walls"},
      {"least_roof", "", relief::kLeastRoof,
       "of what is seen from above: with less the building was taken for ground, and there is "
       "none"},
      {"explained", "", relief::kExplained,
       "share of the surface that must lie near the roofs and walls: canopies and bridges are no "
       "relief"},
      {"wide_explained", "", relief::kWideExplained,
       "likewise, of wide edges: scraps under a roof make up the rest"},
      {"least_reach", "m", relief::kLeastReach, "near, at least"},
      {"least_span", "m", relief::kLeastSpan, "width of bumps, at least; else the typical edge"},
      {"patch_price", "", relief::kPatchPrice,
       "bumps' squares of noise that a roof's plane must explain; half of it changes hardly "
       "anything on 66 cut-outs"},
      {"border_price", "m", relief::kBorderPrice, "of noise beside a metre of border: likewise"},
      {"least_tolerance", "m", relief::kLeastTolerance, "that borders may leave their lines"},
      {"most_tolerance", "m", relief::kMostTolerance, "likewise, where edges and noise are larger"},
      {"least_rise", "m", relief::kLeastRise, "of a building over its ground"},
      {"ground_slope", "", relief::kGroundSlope, "that the ground may climb without a wall"},
      {"most_hanging", "", relief::kMostHanging,
       "of the rim of what is low: walls that hang below it, which make it a roof"},
      {"strip", "m", relief::kStrip, "half the width of what is cut from next door"},
      {"roof_share", "", coanalysis::kRoofShare, "of the plan: a larger roof is on each layer"},
      {"thin", "m", relief::kThin, "half the width of what is no roof of its own"},
      {"slide", "", relief::kSlide, "slope of a strip that is the side of a melted wall"},
      {"melted", "m", relief::kMelted, "length of a melted corner"},
      {"oblique", "", relief::kOblique,
       "tolerances: a piece of border that is shorter and follows no direction is a corner or "
       "step"},
      {"level_slope", "", relief::kLevelSlope, "of a roof that may be level"},
      {"excused", "", relief::kExcused,
       "of the noise, that this may add to a roof's residual; with half of it eaves were level on "
       "58 % of the length, not 95"},
      {"same_roof", "", relief::kSameRoof,
       "times the noise from the plane of a larger roof: it is of it"},
      {"same_rise", "m", relief::kSameRise, "likewise"},
      {"whole_cells", "", relief::kWholeCells,
       "of the plan in half squares of one size, for heights on a grid: sheds that a rim cuts have "
       "0.84 and more, no other mesh has any"},
      {"steep_run", "cells", relief::kSteepRun,
       "of such a grid: steeper than 60 degrees over more is a roof, a wall is one cell wide, two "
       "across a corner"},
      {"wall_of_run", "", relief::kWallOfRun,
       "times the slope of what is steep there: the wall below such a roof"},
      {"raster_slide", "cells", relief::kRasterSlide,
       "half the width of a steep strip of such a grid that is the side of a wall"},
      {"block_noise", "", relief::kBlockNoise,
       "times the noise: what stands off a roof and may be a block"},
      {"flat_top", "", relief::kFlatTop, "of a block's rise: residual of its top"},
      {"seen_top", "", relief::kSeenTop, "of a block's cells, that are no walls"},
      {"least_step", "m", relief::kLeastStep, "between roofs that have a wall between them"}};
}

RuleInfo melted_rule() {
  return {
      .rule = Rule::kRelief,
      .id = "relief.melted",
      .title = "a melted mesh is read as roofs and upright walls",
      .sees =
          "Meshes of which no more than the relief is known: those whose walls lean outward, as "
          "heights and pictures from above give them, and those so coarse or bulging that windows "
          "cannot be told, if roofs and walls explain them; and those that are heights on a square "
          "grid, as an airborne cloud's surface is, if roofs and walls are what they show.",
      .does =
          "Draws the mesh as heights along most of its border, parts the ground around, joins "
          "neighbouring pieces of roof while a plane explains less than it costs, raises blocks "
          "where the heights stand off a roof, draws borders onto few lines of few directions, and "
          "hands on these roofs and the upright walls between them as planes; a roof over a tenth "
          "of "
          "the plan is on each layer, and has all its walls on each layer that it is on.",
      .paper = "The paper grows planes in space, of whatever surface.",
      .reason =
          "Each bump became a plane: of 47 buildings of a drone scene the finest layer had more "
          "triangles than its source on 38, with flaps, spikes and walls that lean.",
      .parameters = melted_numbers(),
      .needs = {},
      .test = "relief/relief: a melted hall is its walls and one roof, at any size and density",
      .made_on = {"bocimi", "machangara"}};
}

}  // namespace

std::vector<RuleInfo> relief_rules() { return {melted_rule()}; }

}  // namespace colod::rules
