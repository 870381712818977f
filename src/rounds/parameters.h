// The numbers of the rules rounds.sides and rounds.layers.
// The registry in room `rules` says what each does and why it has its value.
#pragma once

#include <cstddef>
#include <numbers>

namespace colod::parameters::rounds {

constexpr double kMostStep = 31 * std::numbers::pi / 180;  ///< twelve sides and more are round
constexpr double kOffPlane = 0.003;  ///< metres that a side's corners may be off its plane
constexpr double kLeastBend =
    0.05 * (std::numbers::pi / 180);  // between faces of two sides: small near an apex
constexpr double kLeastStep = 1.5 * (std::numbers::pi / 180);
constexpr double kOnAxis = 0.01;       // metres: files have mm, and narrow sides turn by them
constexpr double kSameStep = 0.05;     // of the step
constexpr int kLeastMeridians = 4;     // different ones
constexpr double kClosedShare = 0.6;   // of all columns: the others are hidden in a house
constexpr double kLeastShare = 0.01;   // of the source's area
constexpr double kLeastArea = 5;       // m²: smaller ones are pipes and balusters
constexpr int kLeastTogether = 3;      // columns side by side that make a row
constexpr double kAlike = 0.98;        // cosine of a narrow face's normal and its side's
constexpr double kSteepest = 0.01;     // of a normal across the axis: less has no column
constexpr double kHardlyFewer = 0.98;  // of the faces that a looser tolerance places
constexpr double kJoined = 0.02;       // metres between the ends of rows that follow each other

// Of what is elliptical, which is round in a plan that is narrowed.
constexpr std::size_t kLeastCorners = 12;  // of the plan: a polygon of fewer sides is not round
constexpr double kNarrowest = 0.25;        // of the longer axis: tolerances grow as it shrinks
constexpr double kRound = 0.995;           // a circle
constexpr double kSameStretch = 0.002;     // between two stretches

}  // namespace colod::parameters::rounds

namespace colod::parameters::round_layers {

constexpr double kSameLength = 2.5;  // rows of a run differ by less: a drum is no row of its dome
constexpr double kLeastTurn = 0.02;  // radians: what files with mm do not turn by chance
constexpr double kHardlyFewerSides = 0.75;  // of the sides: then all stay

}  // namespace colod::parameters::round_layers
