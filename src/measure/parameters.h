// The numbers of the rule chain.scene_part.
// The registry in room `rules` says what each does and why it has its value.
#pragma once

namespace colod::parameters::scene_part {

constexpr double kReach = 0.5;         // metres from the source, or …
constexpr double kReachShare = 0.02;   // … of its diagonal: farther is invented
constexpr double kOpenBorder = 0.5;    // of the root of the area: a shorter border is a crack
constexpr double kGentle_deg = 30;     // between two tops: roofs' ridges mostly bend more
constexpr double kCoplanar_deg = 0.5;  // no edge at all
constexpr double kNotUpright = 0.1, kAllUpright = 0.8;  // of the source's area
constexpr int kManyTops = 6;           // a hipped roof has four, a hipped one with a wing six …
constexpr double kMostlyGentle = 0.8;  // … which meet in ridges: terrain of 20 to 200 m had 0.92
constexpr double kManyValleys = 0.3;   // … and 0.42 to 0.52, a roof has hardly a valley
constexpr double kHardlyEnclosed = 0.1;         // of the layer's volume
constexpr double kThin = 1, kThinShare = 0.08;  // metres, and of the root of the layer's area
constexpr double kFalseTops = 0.5;              // 72 airborne clouds have 0.3 at most
constexpr double kFalseSides = 0.3;  // a corner of two walls has 0.46, walls all round have 0

}  // namespace colod::parameters::scene_part
