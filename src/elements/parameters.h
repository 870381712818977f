// The numbers of the rules elements.*.
// The registry in room `rules` says what each does and why it has its value.
#pragma once

#include <cstddef>

namespace colod::parameters::elements::balconies {

constexpr double kThickness = 0.12;  // metres of a wall whose other side is not seen
constexpr double kThickest = 0.35;   // metres between both sides of a thin wall
constexpr double kSlab = 0.18;       // metres of a floor of which only one side is seen
constexpr double kMostBeyond =
    1.5;  // metres of a balcony beyond the part of its floor that is seen
constexpr double kLeastFloor = 0.5, kLeastUnderside = 1;  // m²
constexpr double kBelow = 1.0;         // metres below a floor: where nothing or a room is
constexpr double kAboveBalcony = 0.3;  // metres above the walls: where a closed box has its lid
constexpr double kLeastRail = 0.4, kMostRail = 1.6;  // metres of a balcony's wall above its floor
constexpr double kLeastRailAlone = 0.7;  // of one whose floor is not seen: lower boxes are ledges

}  // namespace colod::parameters::elements::balconies

namespace colod::parameters::elements::chimneys {

constexpr double kLeastChimney = 0.25;  // metres between a chimney's walls
constexpr double kMostCorner = 1.3;     // metres of a chimney of which only a corner is seen
constexpr double kLeastFoot = 1;        // metres above the building's foot: lower ones are pillars
constexpr double kAcross = 0.4;         // |cosine| of its two pairs of walls at most
constexpr double kLeastWalls = 0.6;     // of its area: walls with an opposite one

}  // namespace colod::parameters::elements::chimneys

namespace colod::parameters::elements::bays {

constexpr double kAway = -0.4;  // cosine of its sides' normals at most: a splayed bay's cross
constexpr double kLeastDepthOfBay = 0.35, kMostDepthOfBay = 1.8;  // metres
constexpr double kLeastWidthOfBay = 1, kMostWidthOfBay = 5;
constexpr double kLeastHeight = 1.8;
constexpr double kMostFront = 25;  // m²

}  // namespace colod::parameters::elements::bays

namespace colod::parameters::elements::windows {

constexpr double kLeastDepthOfWindow = 0.05,
                 kMostDepthOfWindow = 0.6;  // metres from the pane to the facade
constexpr double kBeside = 0.12;            // metres: a reveal begins at the pane's edge
constexpr double kAcrossPane = 0.35;        // |cosine| of its normal to the pane's
constexpr double kFacing = 0.7;             // cosine between a reveal's normal and the way inward
constexpr double kLeastPane = 0.3, kMostPane = 16;  // m²: more is the back of a loggia
constexpr std::size_t kReveals = 2;                 // at least

}  // namespace colod::parameters::elements::windows

namespace colod::parameters::elements::dormers {

constexpr double kLeastRoof = 0.7, kMostRoof = 8;  // m² of T
constexpr double kLeastHost = 4;                   // times T's area: R's
constexpr double kCrossing = 0.966;                // cosine (15°) of T and R at most
constexpr double kLeastRelief = 0.35;              // metres
constexpr double kSteep = 0.55;                    // upward part of the normal: 57°
constexpr double kMostWall = 6;                    // m² of a dormer's wall

}  // namespace colod::parameters::elements::dormers

namespace colod::parameters::elements::loggias {

constexpr double kLeastDepth = 0.5, kMostDepth = 4;  // metres of a loggia
constexpr double kLeastWidth = 0.8;
constexpr double kAbove = 0.5;  // metres above a loggia: where a room must be

}  // namespace colod::parameters::elements::loggias

namespace colod::parameters::elements::panels {

constexpr double kUpright = 0.35;     // |cosine| to the vertical of a wall's normal
constexpr double kLevel = 0.95;       // of a floor's or a ceiling's
constexpr double kAlike = 0.9;        // cosine of directions that count as the same
constexpr double kMostArea = 25;      // m² of a plane of such a part
constexpr double kReach = 0.35;       // metres between planes that meet
constexpr double kMostCheek = 12;     // m² of a wall beside a loggia, a chimney or a bay
constexpr double kMostWidth = 15;     // metres of a loggia
constexpr double kMostChimney = 2.5;  // metres between a chimney's walls
constexpr double kTouch = 0.2;        // metres between walls that share an edge

}  // namespace colod::parameters::elements::panels
