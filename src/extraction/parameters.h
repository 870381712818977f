// The numbers of the rules extraction.*.
// The registry in room `rules` says what each does and why it has its value.
#pragma once

#include <array>
#include <cstddef>

namespace colod::parameters::extraction::spares {

// Of mean distance, what a facet must save, and one of a body of its own: to which layer that
// belongs was found among its like. A box on a face adds five facets.
constexpr double kFacetWorth = 2.5e-4, kBodyWorth = 8e-4;
constexpr std::size_t kBodyPlanes = 4;  // so many planes are a body …
constexpr int kBodyFacets = 5;          // … or so many facets more
constexpr double kMissed = 3e-4;        // mean distance that spares must make up to be tried

}  // namespace colod::parameters::extraction::spares

namespace colod::parameters::extraction::walls {

constexpr double kSimplify = 0.4;     // metres: how far a border may leave its line
constexpr double kLeastBorder = 1.5;  // metres of border that ask for a wall
constexpr double kBeside = 0.5;       // metres beyond the border, where a roof would go on
constexpr double kSameRoof = 0.7;     // metres of height that still count as the same roof
constexpr double kSupport = 0.8;      // metres between a border and the wall that carries it
constexpr double kTogether = 0.35;    // metres between borders that share a wall
constexpr double kParallel = 0.985;   // cosine of 10 degrees

}  // namespace colod::parameters::extraction::walls

namespace colod::parameters::extraction::sheets {

constexpr double kThickness = 0.08;   // metres of a slab
constexpr double kLeastFar = 0.05;    // metres from the surface: nearer is no sheet …
constexpr double kFar = 2;            // … nor nearer than that times the layer's tolerance
constexpr double kJoined = 0.1;       // metres, at least: a border nearer to something ends there
constexpr double kLeastAcross = 0.5;  // cosine to a border's normal of that of a sheet that ends it
constexpr double kLevel = 0.9;        // |z| of a normal: a step's …
constexpr double kAboveFoot = 0.6;    // … metres above the foot: it stands on the ground
constexpr double kLift = 0.02;        // metres off a sheet
constexpr double kLeastArea = 0.5;    // m² of a sheet …
constexpr double kLeastShare = 1e-3;  // … and of all planes' area
constexpr double kLeastSeen = 0.3;    // of a sheet: on both sides
constexpr double kSpacing = 0.12;     // metres between places that are looked at
constexpr double kBend = 0.06;        // metres that a border may leave its outline
constexpr double kInset = 0.06;       // metres from a border: where it is looked at
constexpr double kLeastCut = 0.15;    // metres of a border's part that is cut

}  // namespace colod::parameters::extraction::sheets

namespace colod::parameters::extraction::corners {

constexpr double kStandsOut = 0.05;  // metres: a cell that a plane would part by less fits
constexpr double kLeastLevel = 0.5;  // |z| of a normal: what ends a parapet

}  // namespace colod::parameters::extraction::corners

namespace colod::parameters::extraction::label {

constexpr std::array<double, 4> kEscapes = {1.0, 0.6, 0.3, 0.1};
constexpr double kEnough = 0.6;      // share of the outlines on the surface that ends the search
constexpr double kWorthwhile = 0.1;  // share that another trial must add
constexpr double kLittle = 0.2;      // share of the outlines below which a warning is due

}  // namespace colod::parameters::extraction::label

namespace colod::parameters::extraction::surface {

constexpr double kShortest = 3e-3;       // metres: shorter edges are contracted …
constexpr double kShortestPaper = 1e-3;  // … under the paper's rules
constexpr double kNarrowest = 2.5e-3;    // metres: edges of narrower facets likewise
constexpr double kMostLost = 0.03;       // of a body's volume

}  // namespace colod::parameters::extraction::surface

namespace colod::parameters::extraction::contraction {

constexpr double kLongest = 16;    // times the width: an edge of a narrow facet that may go
constexpr double kPlanar = 0.998;  // cosine between a triangle and its facet

}  // namespace colod::parameters::extraction::contraction

namespace colod::parameters::extraction::prune {

constexpr double kSliver = 0.05;        // metres: facets narrower than this carry no plane
constexpr double kLeastCovered = 0.15;  // of a plane's facets that must lie under its outline
constexpr double kMostPruned = 0.03;    // of the worthwhile planes' surface

}  // namespace colod::parameters::extraction::prune

namespace colod::parameters::extraction::leaders {

constexpr double kAlike_deg = 25;  // between the normals of a plane and its leader

}  // namespace colod::parameters::extraction::leaders

namespace colod::parameters::extraction::evidence {

constexpr std::array<double, 3> kElevations = {0, 20, 40};
constexpr std::array<double, 2> kSteep = {80, 88};
constexpr double kRoofVote = 0.7;  // of a ray that meets nothing, where a roof stands above
constexpr double kThinCell = 0.1;  // metres: thinner cells follow their neighbours
constexpr double kSmallCell = 0.2, kLargeCell = 20;  // m³: one sample below, nine above

}  // namespace colod::parameters::extraction::evidence

namespace colod::parameters::extraction::cut {

constexpr double kClipShare = 1.0 / 3;  // of the growing distance: what a cut must reach into

}  // namespace colod::parameters::extraction::cut

namespace colod::parameters::extraction::plan {

constexpr double kBoxGrowth = 0.05;  // of the diagonal
constexpr double kSnap = 0.05;       // metres: a side nearer than this to a plane takes its place
constexpr double kWholeSide = 0.2;   // of the side's area: a plane that may draw it in by more
constexpr double kSnapCosine = 0.9998;  // 1.1 degrees
constexpr double kRidge = 0.5;          // metres that a ridge may rise above the outlines at it
constexpr double kSteepest = 0.1, kFlattest = 0.995;  // cosines of a pitched roof's slope
constexpr double kThinnest = 0.5;  // metres: a layer flatter than this is extruded inward

}  // namespace colod::parameters::extraction::plan

namespace colod::parameters::extraction::min_cut {

constexpr double kLocalVote = 0.25;  // of an outline for the cells it separates, per m²
constexpr double kDiscount = 0.9;    // of smoothness on a fully covered facet

}  // namespace colod::parameters::extraction::min_cut

namespace colod::parameters::extraction::simplify {

constexpr double kLeastVote = 0.25;    // what a cell counts at least, however unsure its side is
constexpr double kFacetPrice = 0.002;  // of tolerance × surface: volume that a facet must shape
constexpr double kMostPrice = 0.02;    // m³, likewise: on the finest layer of a clean model
constexpr double kMostMoved = 4;       // times the tolerance: how far saving a facet may go

}  // namespace colod::parameters::extraction::simplify

namespace colod::parameters::extraction::components {

constexpr double kSubstantial = 0.05;  ///< of the largest component: one that is kept besides it
constexpr double kNoOther = 2;         ///< likewise: none is

}  // namespace colod::parameters::extraction::components
