// Inside the synth room: houses over plans of several wings, with towers and annexes.
#pragma once

#include "roofs.h"

namespace colod::synth {

enum class RoofKind { kHipped, kFlat, kMansard };

struct ShapedRoof {
  RoofKind kind = RoofKind::kHipped;
  HippedRoof hips;             ///< of a mansard: its lower slope
  double overhang = 0;         ///< 0: the roof stands on the walls
  double thickness = 0.2;      ///< of the eaves' edge, where there is an overhang
  double parapet = 0;          ///< metres that walls rise over a flat roof without overhang
  double parapet_width = 0.3;  ///< metres
  double run = 1.2;            ///< of a mansard's lower slopes [m]
  double upper_slope = 0;      ///< of its top; 0: flat
};

/// A tower or an annex before a wall.
struct Block {
  int edge = 0;                 ///< of the outer ring, from corner `edge` on
  double start = 0, width = 4;  ///< along the edge [m]
  double depth = 3;             ///< from it [m]
  int sides = 4;                ///< 4: a rectangle; more: a polygon's half
  double height = 3;            ///< of its roof at the wall
  double slope = 0;             ///< by which its roof falls away from the wall
  double spire = 0;             ///< metres that its roof rises to a point
};

struct Wall {
  int facet = -1;
  bool is_street = false, is_court = false;
  bool is_corner_start = true, is_corner_end = true;  ///< nothing stands before the wall there
  bool is_whole = true;                               ///< no block divides it
  double top = 0;
};

struct ShapedBody {
  std::vector<Wall> walls, block_walls;
  RoofFacets roof;
  std::vector<int> decks;  ///< flat roofs
};

ShapedBody add_shaped_body(House& house, const Plan& plan, double eaves, const ShapedRoof& roof,
                           const std::vector<Block>& blocks);

}  // namespace colod::synth
