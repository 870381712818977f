// Inside the synth room: what stands in one block between four roads.
#pragma once

#include "town.h"

namespace colod::synth {

constexpr double kBlockWidth = 72, kBlockDepth = 56;  // m
constexpr double kRoad = 9;                           // m, with its pavements

/// In the block's frame, its lower left corner at the origin; no foot is known yet.
struct BlockFill {
  std::vector<Plot> plots;
  std::vector<Prop> props;
  double terrace = 0;  ///< metres a step of its ground; 0: none
  bool is_paved = false;
};

enum class BlockKind { kGardens, kRows, kPerimeter, kCourts, kWorks };

/// At most `most` buildings; 0 makes a park.
BlockFill fill_block(Random& random, BlockKind kind, int most);

}  // namespace colod::synth
