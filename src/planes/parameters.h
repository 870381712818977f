// The numbers of the rules planes.*.
// The registry in room `rules` says what each does and why it has its value.
#pragma once

#include <cmath>
#include <cstddef>

namespace colod::parameters::planes {

constexpr double kFloaterArea = 2;        // m²: a component at least this large is never a floater
constexpr double kFloaterShare = 0.002;   // of the area: likewise
constexpr double kFloaterDistance = 0.2;  // metres: what lies closer to the building belongs to it
constexpr double kHangingArea = 10;       // m²: a component in the air is dropped up to here …
constexpr double kHangingShare = 0.01;    // of the area: … and here …
constexpr double kHangingHeight = 1;      // metres over the foot; lower ones stand on something
constexpr double kHangingDistance = 1;    // metres: … if no surface lies closer, where it is no
                                          // smaller than kFloaterArea
// --rules paper: points that stand for a mesh.
constexpr double kSampleDensity = 100;   // a square metre: 10 cm apart, half the growing distance
constexpr double kLeastSamples = 20000;  // a building, however small …
constexpr double kMostSamples =
    400000;  // … or large: the paper's models have 1,000 to 588,000 vertices
constexpr double kNoiseRadius = 1.5;  // metres: wide enough to see bumps beside white noise
// Three residuals of a whole wall, which on scans is 2.3 times that of 1.5 m of it (0.012 m against
// 0.027 m on simulated photogrammetry).
constexpr double kNoiseFactor = 7;
constexpr double kMoveShare = 1.0 / 3;  // of the growing distance: what aligning may cost
constexpr double kLeastMove = 0.0005;   // metres: likewise without noise; files have mm
constexpr double kOffsetWidth = 0.6;    // of the growing distance: parallel planes are one …
constexpr double kLeastOffset = 0.05;   // metres: … and closer than this …
constexpr double kLeastOffsetShare = 0.0025;  // … or this share of the building's diagonal
constexpr double kPlainDistance = 0.003;      // metres: planes of exact models that have few
constexpr double kMostDistance = 0.2;         // metres
constexpr double kReliefDistance = 0.1;       // metres: between planes of a relief, at least
constexpr double kLeastShare = 1e-4;          // of the building's area: the least region …
constexpr double kLeastShareExact = 3e-5;  // … of an exact model: large houses have windows, too
constexpr double kMostShare = 0.01;        // a region this large is never too small
constexpr double kMostDistanceShare = 0.02;  // of the diagonal: likewise
constexpr double kAreaOfDistance = 2.5;  // m² a metre of growing distance: the least region …
constexpr double kLeastArea = 0.05;      // … between these m², whatever its share is
constexpr double kLeastAreaRough = 0.25;
constexpr std::size_t kMostPlanes = 4000;
constexpr double kSmoothedNoise =
    0.005;  // metres: below, normals need no smoothing; kClean ends at 4.3 mm
constexpr double kRefitGrowth = 1.3;
constexpr double kMergeAngleCosine = 0.9781;  // 12°
constexpr double kMergeRms = 0.6;             // of the growing distance
constexpr double kOppositeRms = 0.006;        // metres: both sides of one sheet …
constexpr double kSheetShare = 0.5;           // … that lie over each other: of the smaller's area
constexpr double kUpright = 0.17;             // sine of what may be turned level or upright
constexpr double kMostTurn =
    10 * (M_PI / 180);                      // of a narrow strip, which hardly knows its direction
constexpr double kTurn = 3 * (M_PI / 180);  // of any other region, and …
constexpr double kTurnSmall = 5 * (M_PI / 180);  // … of one under this many m²:
constexpr double kSmallArea = 1;
constexpr double kSameTilt = 5 * (M_PI / 180);  // between slopes that get one tilt
constexpr double kNarrow = 0.3;      // metres: standard deviation across a strip about a metre wide
constexpr double kSmallHole = 0.25;  // m²
constexpr double kSpeck = 0.05;      // m², and of the outline's area: rings that are dropped
constexpr double kBorderReach = 2;   // growing distances, or spacings, that a border is drawn
constexpr double kMostBorderReach = 0.3;  // metres, at most
constexpr double kCornerReach = 1.5;      // of that reach: likewise to a corner of three planes
constexpr double kLeastSine = 0.25;       // of the angle between planes that are drawn together
// A plane looks inward when most rays escape at its back and few at its front. Both: an open sheet,
// which keeps the normals it was scanned with.
constexpr double kLeastBack = 0.5, kMostFront = 0.35, kMostFrontOfFloor = 0.05,
                 kClearMajority = 0.35;
// Clouds. Airborne scanners see roofs from above only, however the normals were estimated.
constexpr double kRoofTilt = 0.2;       // |z| of the normal: what is flatter is a roof
constexpr double kOpenSky = 0.7;        // share of steep rays that leave a roof's upper side
constexpr double kAirborneShare = 0.5;  // of the planes' area that is roof
constexpr double kBesideWall = 0.5;     // metres off a wall, where a roof would stand above
constexpr double kSheltered = 0.6, kUnsheltered = 0.25;  // share of steep rays that meet it
constexpr std::size_t kMostSides = 2500;  // of a shape: more take half a minute to cut
constexpr double kFinest = 0.01;  // metres between a side and its arc: twice in both directions

}  // namespace colod::parameters::planes
