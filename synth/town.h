// Inside the synth room: where everything of a made-up scene stands.
#pragma once

#include "plans.h"
#include "scene.h"

namespace colod::synth {

enum class PlotKind { kDetached, kRow, kCourt, kHall, kOffice, kShed };
const char* name_of(PlotKind kind);

/// One building, as little of it as it takes to make it again.
struct Plot {
  PlotKind kind = PlotKind::kDetached;
  std::uint64_t seed = 1;
  std::uint64_t row = 0;  ///< what the houses of one row share; 0: stands free
  DrawnPlan drawn;        ///< in its own frame, the street before y = 0
  Vec2 origin = Vec2::Zero();
  double yaw = 0;   ///< radians
  double foot = 0;  ///< metres, of the level ground that it stands on

  Vec2 to_world(const Vec2& p) const { return origin + Eigen::Rotation2Dd(yaw) * p; }
  Vec2 to_own(const Vec2& p) const { return Eigen::Rotation2Dd(-yaw) * (p - origin); }
  /// Around what stands here, with eaves and balconies.
  Box around() const;
};

enum class PropKind { kTree, kHedge, kCar, kFence };

struct Prop {
  PropKind kind = PropKind::kTree;
  Vec2 at = Vec2::Zero();
  double yaw = 0;            ///< radians
  Vec2 half = Vec2::Zero();  ///< metres, half its sides; a tree's x: the crown's radius
  double foot = 0, height = 1;
  long seed = 0;

  Box around() const;
  /// Metres, of its top over a place; −infinity beside it.
  double top(const Vec2& p) const;
};

enum class GroundKind { kRoad, kWalk, kGarden, kPaved, kMeadow };

/// Blocks of buildings between roads on hilly ground. Memory: some hundred bytes a building.
class Town {
 public:
  Town(int buildings, std::uint64_t seed);

  const std::vector<Plot>& plots() const { return plots_; }
  const std::vector<Prop>& props() const { return props_; }
  /// In x and y, with some meadow around it.
  const Box& box() const { return box_; }
  std::uint64_t seed() const { return seed_; }

  /// Metres: hills, roads along them, terraces, and a level place for each building.
  double ground(const Vec2& world) const;
  GroundKind kind_at(const Vec2& world) const;
  /// Metres from the middle of the nearest road, and along it.
  Vec2 on_road(const Vec2& world) const;

 private:
  struct Wave {
    Vec2 direction;
    double phase, height;
  };

  double hills(const Vec2& world) const;
  Vec2 to_town(const Vec2& world) const { return Eigen::Rotation2Dd(-yaw_) * world; }
  Vec2 to_world(const Vec2& town) const { return Eigen::Rotation2Dd(yaw_) * town; }
  /// −1: on a road, or beside the town.
  int block_at(const Vec2& town) const;

  std::uint64_t seed_;
  double yaw_;
  int columns_ = 1, rows_ = 1;
  Vec2 slope_;
  std::vector<Wave> waves_;
  std::vector<Plot> plots_;
  std::vector<Prop> props_;
  struct Block {
    Vec2 corner = Vec2::Zero();  ///< in the town's frame
    double terrace = 0;          ///< metres a step; 0: none
    bool is_paved = false;
    std::vector<int> plots;
  };
  std::vector<Block> blocks_;
  Box box_;
};

}  // namespace colod::synth
