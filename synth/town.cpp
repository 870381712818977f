// *Based on:* towns on hills: streets, rows, perimeter blocks, gardens, yards.
//
// *Differs:* no --rules here.
//
// *Notation:* the town's frame has its roads along x and y.
#include "town.h"

#include <algorithm>
#include <cmath>

#include "materials.h"
#include "town_filler.h"

namespace colod::synth {
namespace {

constexpr double kAround = 14;    // m of meadow beside the outermost roads
constexpr double kPad = 1.0;      // m of level ground around a building
constexpr double kPadFall = 2.2;  // m in which it meets the slope
constexpr double kWalk = 1.6;     // m, a pavement
constexpr double kReach = 2.6;    // m that eaves, bays and balconies reach beyond a plan
constexpr double kPerBlock = 9;   // buildings, about

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Metres from a plot's rectangle, 0 inside.
double distance_to(const Plot& plot, const Vec2& world) {
  const Vec2 p = plot.to_own(world);
  const double dx = std::max({-p.x(), p.x() - plot.drawn.width, 0.0});
  const double dy = std::max({-p.y(), p.y() - plot.drawn.depth, 0.0});
  return std::hypot(dx, dy);
}

/// Every eight blocks have all kinds, so that each place has.
BlockKind draw_kind(Random& r, std::vector<BlockKind>& deck) {
  using enum BlockKind;
  if (deck.empty())
    deck = {kGardens, kGardens, kGardens, kRows, kPerimeter, kCourts, kWorks, kWorks};
  const int i = r.pick(static_cast<int>(deck.size()));
  const BlockKind kind = deck[i];
  deck.erase(deck.begin() + i);
  return kind;
}

}  // namespace

const char* name_of(PlotKind kind) {
  switch (kind) {
    case PlotKind::kDetached:
      return "house";
    case PlotKind::kRow:
      return "row_house";
    case PlotKind::kCourt:
      return "court";
    case PlotKind::kHall:
      return "hall";
    case PlotKind::kOffice:
      return "office";
    case PlotKind::kShed:
      break;
  }
  return "shed";
}

Box Plot::around() const {
  Box box;
  for (const double x : {-kReach, drawn.width + kReach})
    for (const double y : {-kReach, drawn.depth + kReach}) {
      const Vec2 p = to_world({x, y});
      box.extend(Vec3(p.x(), p.y(), 0));
    }
  return box;
}

Box Prop::around() const {
  const double reach = kind == PropKind::kTree ? 1.2 * half.x() : half.norm();
  Box box;
  box.min = Vec3(at.x() - reach, at.y() - reach, 0);
  box.max = Vec3(at.x() + reach, at.y() + reach, 0);
  return box;
}

double Prop::top(const Vec2& world) const {
  const Vec2 p = Eigen::Rotation2Dd(-yaw) * (world - at);
  const double rough = noise(cell(2.5 * world.x()), cell(2.5 * world.y()), seed);
  if (kind == PropKind::kTree) {
    const double angle = std::atan2(p.y(), p.x());
    const double lobes = 1 + 0.1 * std::sin(3 * angle + static_cast<double>(seed % 7)) +
                         0.06 * std::sin(7 * angle + static_cast<double>(seed % 5));
    const double r = p.norm() / (half.x() * lobes);
    if (r >= 1) return -INFINITY;
    return foot + height * (0.45 + 0.55 * std::sqrt(1 - r * r)) - 0.9 * rough;
  }
  if (std::abs(p.x()) > half.x() || std::abs(p.y()) > half.y()) return -INFINITY;
  if (kind == PropKind::kHedge) return foot + height - 0.25 * rough;
  const bool is_bonnet =
      kind == PropKind::kCar && (p.x() > 0.45 * half.x() || p.x() < -0.85 * half.x());
  return foot + (is_bonnet ? 0.6 : 1) * height;
}

Town::Town(int buildings, std::uint64_t seed) : seed_(seed) {
  Random r(seed * 7919 + 17);
  yaw_ = r.uniform(-0.35, 0.35);
  const double steep = r.uniform(0.02, 0.07), downhill = r.uniform(0, 2 * M_PI);
  slope_ = steep * Vec2(std::cos(downhill), std::sin(downhill));
  for (int i = 0; i < 4; ++i) {
    const double length = r.uniform(110, 320), angle = r.uniform(0, 2 * M_PI);
    waves_.push_back({2 * M_PI / length * Vec2(std::cos(angle), std::sin(angle)),
                      r.uniform(0, 2 * M_PI), length * r.uniform(0.004, 0.011)});
  }
  const int blocks = static_cast<int>(std::ceil(buildings / kPerBlock));
  columns_ = std::max(1, static_cast<int>(std::lround(std::sqrt(0.8 * blocks))));
  std::vector<BlockKind> deck;
  for (int i = 0; static_cast<int>(plots_.size()) < buildings || i % columns_ != 0; ++i) {
    Block block;
    block.corner = {(i % columns_) * (kBlockWidth + kRoad), (i / columns_) * (kBlockDepth + kRoad)};
    const Vec2 corner = block.corner;
    const BlockFill fill =
        fill_block(r, draw_kind(r, deck), buildings - static_cast<int>(plots_.size()));
    block.terrace = fill.terrace, block.is_paved = fill.is_paved;
    for (Plot plot : fill.plots) {
      plot.origin = to_world(corner + plot.origin), plot.yaw += yaw_;
      plot.foot = hills(plot.to_world(0.5 * Vec2(plot.drawn.width, plot.drawn.depth)));
      block.plots.push_back(static_cast<int>(plots_.size()));
      plots_.push_back(std::move(plot));
    }
    blocks_.push_back(std::move(block));
    rows_ = i / columns_ + 1;
    for (Prop prop : fill.props) {
      prop.at = to_world(corner + prop.at), prop.yaw += yaw_;
      prop.foot = ground(prop.at);
      props_.push_back(prop);
    }
  }
  const Vec2 high(columns_ * (kBlockWidth + kRoad), rows_ * (kBlockDepth + kRoad));
  for (const double x : {-kRoad - kAround, high.x() + kAround})
    for (const double y : {-kRoad - kAround, high.y() + kAround}) {
      const Vec2 p = to_world({x, y});
      box_.extend(Vec3(p.x(), p.y(), 0));
    }
}

double Town::hills(const Vec2& world) const {
  double z = 60 + slope_.dot(world);
  for (const Wave& w : waves_) z += w.height * std::sin(w.direction.dot(world) + w.phase);
  return z;
}

int Town::block_at(const Vec2& town) const {
  const double px = kBlockWidth + kRoad, py = kBlockDepth + kRoad;
  const int column = static_cast<int>(std::floor(town.x() / px));
  const int row = static_cast<int>(std::floor(town.y() / py));
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return -1;
  if (town.x() - column * px > kBlockWidth || town.y() - row * py > kBlockDepth) return -1;
  return row * columns_ + column;
}

double Town::ground(const Vec2& world) const {
  const Vec2 town = to_town(world);
  double z = hills(world);
  const int b = block_at(town);
  if (b < 0 || b >= static_cast<int>(blocks_.size())) return z;
  const Block& block = blocks_[b];
  const Vec2 in = town - block.corner;
  const double rim = std::min({in.x(), in.y(), kBlockWidth - in.x(), kBlockDepth - in.y()});
  if (block.terrace > 0) {
    const double steps = z / block.terrace, level = std::floor(steps);
    const double terraced = block.terrace * (level + smooth_step((steps - level - 0.88) / 0.12));
    z += smooth_step(rim / 3) * (terraced - z);
  }
  double nearest = kPad + kPadFall;
  const Plot* pad = nullptr;
  for (const int p : block.plots)
    if (const double d = distance_to(plots_[p], world); d < nearest) nearest = d, pad = &plots_[p];
  if (!pad) return z;
  const double share = smooth_step((kPad + kPadFall - nearest) / kPadFall);
  return z + std::min(share, smooth_step(rim / 2)) * (pad->foot - z);
}

GroundKind Town::kind_at(const Vec2& world) const {
  const Vec2 town = to_town(world);
  const double px = kBlockWidth + kRoad, py = kBlockDepth + kRoad;
  if (town.x() < -kRoad || town.y() < -kRoad || town.x() > columns_ * px || town.y() > rows_ * py)
    return GroundKind::kMeadow;
  if (const int b = block_at(town); b >= 0)
    return blocks_[b].is_paved ? GroundKind::kPaved : GroundKind::kGarden;
  return std::abs(on_road(world).x()) > kRoad / 2 - kWalk ? GroundKind::kWalk : GroundKind::kRoad;
}

Vec2 Town::on_road(const Vec2& world) const {
  const Vec2 town = to_town(world);
  const double px = kBlockWidth + kRoad, py = kBlockDepth + kRoad;
  const auto from_middle = [](double at, double pitch) {
    const double t = at + kRoad / 2;
    return t - pitch * std::round(t / pitch);
  };
  const double x = from_middle(town.x(), px), y = from_middle(town.y(), py);
  return std::abs(x) < std::abs(y) ? Vec2(x, town.y()) : Vec2(y, town.x());
}

}  // namespace colod::synth
