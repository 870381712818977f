// The numbers of the rules scene.ground and scene.hidden, and of whole scenes.
// The registry in room `rules` says what each does and why it has its value.
#pragma once

#include <cstddef>

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
// A rim closed down to a plate deeper than a storey, as watertight reconstructions close it.
constexpr double kPlate = 0.02;       // metres by which the plate is level
constexpr double kUnderPlate = 0.95;  // of what is covered that has the plate below it
constexpr double kUnevenTop = 0.05;  // metres from one plane, root mean square: a flat roof is even
constexpr double kOnePiece = 0.8;    // of the skirt's area in faces from the rim to the plate
constexpr int kLeastStrips = 64;     // of its faces: a drawn building has fewer sides

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

namespace colod::parameters::territory {

// Metres that roofs stand out from a footprint, and that it may be wrong by: maps are drawn to half
// a metre, eaves stand out by up to one. The shared cut-outs of real scenes have as much around.
constexpr double kEaves = 1.5;

}  // namespace colod::parameters::territory

namespace colod::parameters::survey {

constexpr double kCell = 0.4;          // metres: finer than walls of sheds, about as photogrammetry
constexpr double kMostCells = 64e6;    // of a map: a gibibyte
constexpr double kFarthestTile = 1e6;  // metres across, and from most tiles: a large country

}  // namespace colod::parameters::survey

// Airborne clouds; seen on made-up ones of 2 to 20 points a square metre (odd seeds, development).
namespace colod::parameters::cloud {

constexpr double kPointsACell = 2.2;    // on the mean: one of ten cells has none, which others fill
constexpr double kLargestCell = 2;      // metres: beyond, houses are a handful of cells
constexpr double kDensityCell = 4;      // metres: where the cloud is at all
constexpr double kSpike = 2;            // metres over all cells around: a bird, a wire, a pole
constexpr int kFillRounds = 4;          // cells from either side that a gap is closed over
constexpr int kSlopeRounds = 3;         // until slopes and heights agree
constexpr double kSteepestSurface = 2;  // metres a metre: what is steeper is a wall, not a roof
constexpr int kTile = 128;              // cells a side
constexpr double kNarrowestPlace = 3;   // metres: what is less wide is in another unit
constexpr double kCoarsestStep = 0.02;  // metres between numbers: as much as a scanner's noise
constexpr double kLeastGroundPoints =
    0.02;  // of the points that are ground by class, to believe it

}  // namespace colod::parameters::cloud

namespace colod::parameters::terrain {

constexpr double kWidest = 100;       // metres: blocks as wide as halls, to begin with
constexpr double kNoiseOfCell = 0.3;  // metres over what is expected, and …
constexpr double kSlope = 0.12;       // … of a block's side: low roofs fill small blocks
constexpr double kAboveGround = 0.5;  // metres
constexpr double kJoined = 0.6;       // of a hill's rim that goes on smoothly, drops the rest
constexpr double kFootRim = 0.3;  // of a level's steps that go down, where walls rise from it …
constexpr double kFootJoined = 0.15;  // … and of its rim that goes on smoothly for it to be ground
constexpr double kLevelStep = 0.2;    // metres between neighbours that are one level
constexpr double kLeastLevel = 15;    // m²
constexpr double kWall = 1.2;         // metres that a roof's rim steps down
constexpr double kRoofRim = 0.65;     // of its steps that go down: a terrace has as many that go up
constexpr double kDropping = 0.5;  // of the rim of a square of its area: where a roof ends it drops
constexpr double kLeanBlock = 25;  // metres: most hold a piece of street or yard
constexpr double kLeanReach = 2;   // metres over the plane from which on a block counts little
constexpr int kLeanRounds = 8;
constexpr double kLeastLean = 0.08;  // metres a metre

}  // namespace colod::parameters::terrain

// Chosen on drawn footprints of halls and houses (development); docs/scenes.md has the figures.
namespace colod::parameters::classes {

constexpr double kLow = 1.5;     // metres over the ground: lower things are its own
constexpr double kWindow = 3.6;  // metres: narrower than half of a small gable roof
// What is not green may be smooth over less: half of a wing's roof, or a shed's. It is rough all
// the same where it is so many times less rough than what is looked at in wider windows.
constexpr double kNarrowWindow = 1.7, kNarrowTimes = 3.2;
constexpr double kLeastWindow = 1.0, kLeastTimes = 6;
constexpr double kEven = 0.08, kUneven = 0.4;  // metres off a plane: of roofs, of crowns
constexpr double kGrey = 0.04, kGreen = 0.16;  // of roofs, of leaves
constexpr double kRoughWeight = 0.7, kGreenWeight = 0.7;
constexpr double kRoof = 0.4;          // of these weights: what is less is a roof
constexpr double kCalm = 2;            // metres that a cell's neighbours decide with it
constexpr double kNarrow = 1.0;        // metres: fences are narrower than roofs of sheds
constexpr double kWallStep = 0.6;      // metres between neighbours, over the roof's own slope …
constexpr double kSteepestRoof = 2;    // … of at most so many metres a metre, 63°, …
constexpr double kSmooth = 0.15;       // … where the surface is off its plane by less
constexpr double kStep = 0.6;          // metres between roofs of different buildings
constexpr double kLeastRoof = 10;      // m²: smaller ones join a neighbour …
constexpr double kTouching = 0.25;     // … that holds this share of their rim
constexpr double kSurrounded = 0.55;   // of a rim: a level on a roof
constexpr int kRimRounds = 5;          // cells at its height that a roof takes in
constexpr int kWallRounds = 2;         // cells that melted walls are wide, and halves of parapets
constexpr double kAmid = 0.6;          // of what is rough that buildings are around
constexpr double kAround = 1.6;        // metres off: beyond melted rims
constexpr double kLeafy = 0.55;        // of what is around a smooth crown: leaves …
constexpr double kLargestCrown = 100;  // m²: … it is no larger …
constexpr double kGreenish = 0;        // … and neither red nor blue, …
constexpr double kLeafGreen = 0.035;   // … or a copse: as green as leaves in shade
constexpr int kRounds = 10;
constexpr double kLeastBuilding = 8;  // m²: sheds
// Metres; squares have an odd number of cells, so that at 0.4 m these are 2.8 and 2.0 wide.
constexpr double kHouseWidth = 2.2, kShedWidth = 1.7;  // banks and fences are long, …
constexpr double kLargestShed = 30;                    // m²: … and sheds are not
constexpr double kHeightShare = 0.7;                   // of a roof's cells …
constexpr double kLeastHeight = 2.2;                   // … at least so high

}  // namespace colod::parameters::classes

// Chosen on made-up places (seeds 1, 3 and 5) and on the drawn footprints of two real scenes; all
// of them are development. docs/log/quality.md has the figures.
namespace colod::parameters::patches {

constexpr double kNeck = 2.8;         // metres: buildings that touch are joined by less
constexpr double kLeastCore = 30;     // m²: a building that is joined to another one has more
constexpr double kTintStep = 0.8;     // metres to either side of a change of colour
constexpr double kLight = 50;         // of 255: brightness
constexpr double kHue = 0.25;         // of the brightness: a channel over the mean of the three …
constexpr double kDark = 20;          // … and this, of 255, so that dark places have no hue
constexpr double kBend = 0.3;         // metres a metre: by so much slopes change at a ridge
constexpr double kLeastTinted = 100;  // m²: what is smaller is one house, whatever its colours
constexpr double kLeastCalm = 0.8;  // of a block, that does not change its colour: else it is noise
constexpr double kLeastPatch = 4;   // m² without its rim: chimneys and skylights are smaller

}  // namespace colod::parameters::patches

// Chosen on made-up rows (seeds 1 and 3) and on the drawn footprints of two real scenes; all of
// them are development. docs/log/quality.md has the figures.
namespace colod::parameters::party_walls {

constexpr double kBlurred = 0.6;        // metres beside a line in which heights are of both sides
constexpr double kStripEnd = 1.6;       // metres beside a line that are compared
constexpr double kPiece = 3.5;          // metres of a line: roofs slope alike along it
constexpr double kEnd = 1.6;            // metres of each end of a line: roof houses do not reach it
constexpr double kLeastStep = 0.15;     // metres of height across a line
constexpr double kLeastTint = 25;       // of 255: how one channel of the colour changes across it
constexpr double kAlike = 0.6;          // of a line's pieces that step the same way …
constexpr double kAlikeStep = 0.5;      // … by more than this share of the median; both ends do
constexpr double kShortest = 4.5;       // metres of a line
constexpr double kLongest = 25;         // metres of a line: halls are deeper than houses
constexpr double kHouseWidth = 3.5;     // metres beside a line …
constexpr double kWhole = 0.7;          // … that are the building's along this share of it
constexpr double kNarrowest = 4;        // metres between two walls
constexpr double kBeyond = 1.5;         // cells that a wall goes on at both ends
constexpr double kLeastRowHouse = 25;   // m² …
constexpr double kLeastOfBlock = 0.02;  // … and of its block: halls have skylights and signs
constexpr double kLeastBlock = 150;   // m²: what is smaller is one house more often than two, …
constexpr double kLeastPair = 100;    // … from so much on also two …
constexpr double kPairShare = 0.4;    // … that have this share of it each at least
constexpr double kWing = 2.5;         // metres that a row's houses stand out from each other …
constexpr double kWingedHouse = 250;  // m²: … where the block may be one house with a wing
constexpr int kJoinRounds = 10;

}  // namespace colod::parameters::party_walls

// Chosen on the drawn footprints of two real scenes and on made-up places (seeds 1 to 7), all of
// them development. docs/log/quality.md has the figures.
namespace colod::parameters::annexes {

constexpr double kAnnexWidth = 5;         // metres: houses are wider
constexpr double kAnnexShare = 1.0 / 12;  // of the area of the building that it leans on
constexpr double kLeaning = 0.25;         // of its rim, where it leans
constexpr double kAnnexHeight = 0.5;      // of the building's: walls that have melted, stairs
constexpr int kAnnexRounds = 4;           // one leans on another

}  // namespace colod::parameters::annexes

namespace colod::parameters::outlines {

constexpr double kStraight = 0.6;  // metres off a side: a cell and a half
constexpr double kSquare = 0.3;    // radians off a main direction
constexpr double kAreaChange = 0.1;
constexpr double kLeastPart = 8;   // m²: the largest part of a building is always one
constexpr double kLeastHole = 12;  // m², of a courtyard

}  // namespace colod::parameters::outlines

namespace colod::parameters::context {

constexpr std::size_t kMostChildren = 4;
constexpr double kLargestPicture = 2048;  // pixels a side: 12 MiB while it is drawn, times cells
constexpr int kSmallPicture = 512;        // pixels a side: a whole place, seen from afar
constexpr int kCellsAPixel = 2;           // along each side: thin things do not flicker
constexpr int kQuality = 85;              // of JPEG, as bakes have it
constexpr int kCoarseQuality = 75;    // … of a source's coarse tiles, which were packed before
constexpr double kLeastTexel = 0.01;  // metres: what a drone sees
constexpr std::size_t kMostFaces = 60'000;  // of a coarser tile: what a client draws at once
constexpr std::size_t kFewFaces = 20'000;   // … of the coarsest
constexpr int kMostRelaxed = 8;             // times the error is doubled for it
constexpr int kMostAbove = 12;              // levels above the one that holds all
constexpr double kFarthest = 2;  // times that error: what a simplified tile's vertices may be off
constexpr int kMostKept = 4;     // rounds of keeping what is farther off
constexpr std::size_t kMostMeasured = 100'000;  // vertices that a tile's distance is measured at

}  // namespace colod::parameters::context

namespace colod::parameters::closing {

constexpr double kSide = 2;          // metres: of squares, that follow banks
constexpr double kBare = 0.7;        // metres over the terrain: what is seen there is ground
constexpr double kGrid = 1e-6;       // metres: places that differ by less become one
constexpr int kTintCells = 4;        // along a side, of which the ground's colour is the mean
constexpr double kSkirt = 0.3;       // metres below: more than squares are off within their sides
constexpr double kAside = 0.005;     // metres beside an edge: on which side of a border it lies
constexpr double kLeastEdge = 1e-3;  // metres, seen from above

}  // namespace colod::parameters::closing

namespace colod::parameters::whole_place {

constexpr double kMostCellsOfPlan = 4e6;
constexpr double kLeastSide = 50;  // metres of the plan: a plot is narrower, or holds one house
constexpr double kLeastTile = 18;  // metres, cut straight: a shed with its plot is smaller
constexpr double kLeastPiece = 5;  // metres, cut straight, for a doubt: a row house, or a remnant
constexpr double kStraightSide = 0.02;   // metres from the plane of a side: coordinates are rounded
constexpr double kStraightShare = 1e-3;  // of the plan, likewise
constexpr double kLongSide = 0.6;        // of the plan along a side: a tile's shear is less
constexpr double kSpanned = 0.9;         // of a side that the border spans
constexpr int kStraightSides = 2;        // of a tile: at a scene's edge the others may be ragged
constexpr double kLeastGround = 0.3;     // of the plan
constexpr double kLeastHouse = 30;       // m²: a garage is no second building
constexpr int kLeastHouses = 3;          // that stand apart: two may be a house and its barn
constexpr int kTogether = 5;             // cells: 2 m between roofs is no gap
constexpr int kLeastHousesOfTile = 2;    // where it is cut straight
constexpr double kBareGround = 0.75;     // of the plan, where no building stands
constexpr double kBareBuilt = 0.03;      // of a tile where no house stands whole
constexpr double kAtTop = 1;             // metres: the foot of a wall lies lower
constexpr double kMostAtTop = 0.5;       // of a tile's border
constexpr double kFilled = 0.8;          // of its box that a tile covers; cut-outs 0.75 at most
constexpr double kGroundAtRim = 0.05;    // of plan and border: a building without plot has none
constexpr double kLeastCut = 4;          // metres of a house on one side's border: more than a tree
constexpr double kCutOff = 0.2;          // of its outline, on all sides

}  // namespace colod::parameters::whole_place
