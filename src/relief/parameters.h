// The numbers of the rules relief.*.
// The registry in room `rules` says what each does and why it has its value.
#pragma once

#include <cstddef>

namespace colod::parameters::relief {

constexpr double kEdgeShare = 0.3;   // of the surface: its shorter edges end at the typical one
constexpr double kCellShare = 0.35;  // of the typical edge: a cell
constexpr double kLeastCell = 0.1, kMostCell = 0.5;  // metres
constexpr double kMostCells = 400;                   // along the longer side
constexpr double kSteep = 1.7;                       // metres a metre (60°): a wall
constexpr double kSteepRun = 2.6;        // cells of a raster: what is steep over more is a roof …
constexpr double kWallOfRun = 1.5;       // … but for the wall at its end: steeper than its mean
constexpr double kLongestRun = 6;        // metres that are looked at
constexpr double kRoom = 2;              // metres around a place, where noise is measured
constexpr double kNoiseQuantile = 0.35;  // of such places: the others have edges in them
constexpr int kSamples = 500;

// Whether a mesh is melted.
constexpr double kSteepFace = 0.6;                    // |z| of a normal: steeper is a wall's
constexpr double kWindow = 1.5, kWindowEdges = 1.5;   // metres, or typical edges around a face
constexpr int kLeastSides = 8;                        // faces there
constexpr std::size_t kMostSides = 400;               // of a cube of that size, that are looked at
constexpr double kAlike = 0.5;                        // cosine between their normals
constexpr double kExactBulge = 0.003;                 // metres: less is exact, or nearly so
constexpr double kSteepest = 0.4, kLeastLean = 0.04;  // |z| of walls' normals, and its mean
constexpr double kCoarseBulge = 0.08;                 // metres, and …
constexpr double kCoarse = 0.35, kToldBulges = 2.4;  // … metres of edge, or of so many bulges; or …
constexpr double kWide = 0.8, kWideBulge = 0.05;  // … with an edge that tells no window at all
constexpr double kLeastReach = 0.3, kReachBulges = 5, kReachEdges = 0.5;  // metres, bulges, edges
constexpr double kLeastSupport = 0.1;   // of the walls that are drawn: seen, in part
constexpr double kLeastRoof = 0.15;     // of what is seen from above: with less there is no ground
constexpr double kExplained = 0.7;      // of the surface: near roofs and walls …
constexpr double kWideExplained = 0.5;  // … where nothing else can be told

// Whether it is heights on a grid.
constexpr std::size_t kLeastRaster = 60;  // faces: a shed of 8 m² with its eaves in cells of 1 m
constexpr double kSameCell = 1e-2;        // of a cell: how far its sides are rounded, and more
constexpr double kWholeCells = 0.5;  // of the plan: cells that no rim cuts, 0.84 and more of sheds
constexpr double kUpright = 1e-3;    // z of a normal: less looks aside or down …
constexpr double kMostOther = 1e-3;  // … and is no height: of the area, slivers at the rim

// Scales.
constexpr double kLeastSpan = 1;                         // metres that bumps are wide, at least
constexpr double kLeastNoise = 0.03, kMostNoise = 0.35;  // metres
constexpr double kToleranceEdge = 0.4;  // of the typical edge: what a border may leave its line …
constexpr double kToleranceNoise = 2.5;                         // … or times the noise …
constexpr double kLeastTolerance = 0.45, kMostTolerance = 0.8;  // … between these metres

// The ground around.
constexpr double kLowRim = 0.05, kHighRoof = 0.9;  // quantiles of heights
constexpr double kLeastRise = 2;                   // metres between them: a building
constexpr double kRimShare = 0.35;                 // of that rise, or …
constexpr double kRimRise = 1.5;  // … metres: what is lower at the rim is ground …
constexpr double kHang = 1.5, kHangReach = 0.8;  // metres below a place at the rim, and around it
constexpr double kMostHanging = 0.3;             // of a rim: more walls below make it a roof's
constexpr double kGroundShare = 0.5;  // … as is what is reached from there, at most so high
constexpr double kGroundSlope = 1;    // metres a metre that the ground may climb
constexpr double kLeastFeet = 3;      // metres of wall that stand on it
constexpr double kLowFoot = 0.1;      // quantile of its height at walls: the foot
constexpr double kLowCorner = 0.02;   // without ground: of all corners' heights

// Patches.
constexpr double kPatchPrice = 12;  // bumps' squares of noise that a plane must explain
constexpr double kBorderPrice = 2;  // metres of noise beside a metre of border: likewise

// Labels.
constexpr double kRough = 3, kLeastRough = 0.4;  // times the noise, and metres: a crown's residual
constexpr double kMinor = 0.15;       // of all patches' area: what may be no part of the building
constexpr double kThin = 0.45;        // metres of half its width: a parapet, or a crest of noise
constexpr double kStrip = 0.9;        // metres of half its width: next door's …
constexpr double kStripCells = 2.5;   // … or two cells, of which wider ones cannot be told …
constexpr double kStripShare = 0.35;  // … if so much of its border is where the mesh ends
constexpr double kStripArea = 0.4;    // of all patches' area: next door is no more than this
constexpr double kSlide = 0.85;      // metres a metre (40°): a strip so steep is a melted wall …
constexpr double kSlideSpan = 0.8;   // … up to so many bumps on each side
constexpr double kLeastPatch = 1.5;  // bumps' squares
constexpr double kRasterSlide = 0.75;  // cells of a raster: likewise, where a wall is one wide
constexpr int kSmoothings = 4;
constexpr double kMostOff = 9;    // squared, in noise: more is as bad
constexpr double kIsland = 0.05;  // of the largest part: one that stands apart and is of it
constexpr double kLowIsland = 3, kLowIslandShare = 0.5;  // metres, and of its height: likewise

// Borders.
constexpr double kSpread = 0.07;       // radians (4°) that pieces of one direction spread
constexpr double kFollow = 0.26;       // radians (15°): a piece takes the building's direction …
constexpr double kShortPiece = 3;      // metres: … twice that if shorter, or if it goes aside …
constexpr double kAside = 2;           // … by less than so many tolerances
constexpr double kSecondShare = 0.15;  // of all length: another direction
constexpr double kOblique = 5;         // tolerances: what is shorter and oblique is a corner
constexpr double kParallel = 0.05;     // sine between pieces that may share a line
constexpr double kLeastSine = 0.25;    // between lines that make a corner
constexpr double kReach = 3;           // tolerances that a corner may move
constexpr double kChamfer = 2.5;       // tolerances, or …
constexpr double kMelted = 1.6;        // … metres: a melted corner is no longer
constexpr double kLeastCrease = 0.12;  // metres a metre between the slopes of two roofs that meet
constexpr double kCreaseReach = 2;     // tolerances between such a border and where planes meet

// Blocks on roofs.
constexpr double kBlockNoise = 2;        // times the noise: what stands off a roof
constexpr std::size_t kMostBlocks = 24;  // of one building
constexpr double kSloping = 0.8;         // of a level top's residual: a top slopes as its roof does
constexpr double kSeenTop = 0.4;         // of its cells that are no walls
constexpr double kFlatTop = 0.45;        // of a block's rise: residual of its top

// Roofs and walls.
constexpr double kTrim = 2.5;        // times the noise: cells farther off say nothing of a roof
constexpr double kLevelSlope = 0.1;  // metres a metre (5.7°): level
constexpr double kSameTilt = 0.09;   // metres a metre between slopes that get one tilt
constexpr double kExcused = 1;       // of the noise, that this may add to a roof's residual
constexpr double kSameRoof = 2;      // times the noise, or …
constexpr double kSameRise = 0.2;    // … metres from a larger roof's plane: a roof is of it
constexpr double kLeastStep = 0.3;   // metres, or …
constexpr double kStepNoise = 1.5;   // … times the noise: a step between roofs is a wall
constexpr double kWallReach = 1.2;   // metres between a steep face and its wall
constexpr double kBeside = 1.5;      // metres into the building that its neighbours hang over
constexpr double kRoofReach = 1;     // metres between a face and its roof
constexpr double kFacing = 0.7;      // cosine between a steep face and the wall that it is of
constexpr double kLeastWall = 2;     // m² of such faces: a wall is seen

}  // namespace colod::parameters::relief
