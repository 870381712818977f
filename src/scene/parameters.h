// The numbers of the rules scene.ground and scene.hidden.
// The registry in room `rules` says what each does and why it has its value.
#pragma once

namespace colod::parameters::ground {

constexpr double kLeastCell = 0.25, kMostCell = 1;  // metres
constexpr double kCellShare = 1.0 / 200;            // of the diagonal
constexpr double kNoise = 0.15;         // metres of height between neighbours, besides …
constexpr double kSteepest = 0.4;       // … this slope
constexpr double kOverhang = 2;         // metres that a flat roof's rim stands out from its walls
constexpr double kLeastRim = 0.5;       // of the rim that the ground holds
constexpr double kMostly = 0.8;         // of the ground's rim that has no storey below
constexpr double kRise = 2;             // metres that a building rises
constexpr double kLeastBuilt = 0.05;    // of the covered cells that are the building …
constexpr double kSurelyBuilt = 12;     // … or square metres: a plot may be as large as it likes
constexpr double kFoot = 1;             // metres above the ground by which walls have come down
constexpr double kReach = 1.5;          // metres that eaves stand out from their wall
constexpr double kSmallBlob = 0.05;     // of the largest one's area
constexpr double kGroundLayer = 0.4;    // metres: level faces this near to the ground are its own
constexpr double kGroundNormal = 0.35;  // of a level face, upright: the ground banks up at walls
constexpr double kOnGround = 0.5;       // metres: what ends lower is part of the ground

}  // namespace colod::parameters::ground

namespace colod::parameters::hidden {

constexpr double kCube = 2.5;          // metres: more than windows and doors are wide or high
constexpr double kFinest = kCube / 9;  // metres: a voxel of most buildings
constexpr double kDepth = 0.2;         // metres, and two voxels: from reveals the outside is nearer
// Of a cavity's walls: porches, niches and passages are open more widely (one of 2 by 2 m that goes
// 4 m deep: 0.11), rooms less (0.02 to 0.05; a shop without its front 0.07).
constexpr double kOpenShare = 0.08;
constexpr double kMostVoxels = 4e6;    // of them: larger buildings get larger voxels
constexpr double kLeastHidden = 0.02;  // of the area: what is less is a fold of what was measured …
constexpr double kLeastHiddenDrawn = 0.001;  // … or, of what people draw, an error of the samples
constexpr int kGateSamples = 4000;           // over the whole surface, to begin with
constexpr double kSampleArea = 0.06;  // m² that a sample stands for: few miss a face's visible tip
constexpr int kMostSamples = 64;      // of a face
constexpr int kRays = 64;             // of a sample, over the sphere
constexpr int kSeen = 2;              // of its rays: one may slip through a seam
constexpr double kLift = 0.002;       // metres off the face that rays start
constexpr double kMostlySeen = 0.5;   // of a piece's samples

}  // namespace colod::parameters::hidden
