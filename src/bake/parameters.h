// The numbers of room `bake`.
#pragma once

namespace colod::parameters::bake {

constexpr int kGutter = 2;         ///< texels about a chart: two charts are four apart, so that two
                                   ///< levels of a mip chain keep them apart
constexpr int kBlock = 4;          ///< texels that sides of charts and atlases are multiples of:
                                   ///< blocks of texture compressors
constexpr double kBorder = 1.5;    ///< texels beyond a facet's border that repeat it: what bilinear
                                   ///< filtering reads there
constexpr double kAgrees = 0.35;   ///< cosine between the normals of a facet and of what it shows
constexpr double kNearest = 0.25;  ///< metres: a nearest point farther away is smeared from the rim
                                   ///< of what is seen, as below an eaves without walls
constexpr double kCarried = 0.5;   ///< metres that a colour is carried into what nobody saw: more
                                   ///< looks smeared, less leaves specks of the mean in windows
constexpr double kTogether = 0.04;  ///< metres: samples so close show the same face beside them …
constexpr int kMostTogether = 4;    ///< … if no more than so many lie along a side
constexpr int kMostLayers = 4;      ///< surfaces that a ray passes that do not agree
constexpr double kLift = 2e-3;      ///< metres before a facet where a ray begins, against rounding
constexpr double kOnEdge = 1e-9;  ///< of a triangle's area: places on a shared edge belong to both
constexpr double kOneSample = 1.5;   ///< source texels a texel may cover with one sample
constexpr int kMostSamples = 16;     ///< along each side of a texel
constexpr int kNeighbours = 6;       ///< of a point, that tell how dense the cloud is about it
constexpr double kSplat = 0.75;      ///< half a square's side, of the mean distance to them: on a
                                     ///< square lattice squares then meet whatever their turn
constexpr double kLeastSeen = 0.03;  ///< of a chart's texels: fewer say nothing of the rest
constexpr int kProbes = 24;  ///< samples across a chart that tell whether anything of it is seen,
constexpr int kMostProbes = 96;  ///< along it at most,
constexpr int kLeastAsked = 32;  ///< and on it at least, to tell
constexpr int kParts = 4;        ///< along each side of a triangle, that tell what it lies against
constexpr double kCrease = 0.766;  ///< cosine, 40 degrees: faces that meet more sharply are two
                                   ///< surfaces, each with its own normals
constexpr double kUpright = 0.5;   ///< upright part of a wall's normal at most: what nobody saw of
                                   ///< walls looks like walls

}  // namespace colod::parameters::bake
