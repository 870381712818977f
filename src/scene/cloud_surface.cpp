// Based on: surface models of airborne laser scanning: the highest point of each cell; slope
// limiters as in finite volumes (P. Roe, 1986), which leave ridges and eaves where they are.
#include "cloud_surface.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <set>
#include <sstream>

#include "core/error.h"
#include "parameters.h"
#include "read/airborne.h"

namespace colod {

namespace {

using namespace parameters::cloud;

using Clouds = std::vector<AirborneCloud>;

[[noreturn]] void refuse(const std::string& path, const std::string& cause) {
  throw Error(Stage::kInput, path, cause);
}

SceneClass class_of(int kind) {
  if (kind == 2 || kind == 9 || kind == 11) return SceneClass::kGround;  // water and roads, too
  if (kind == 6) return SceneClass::kBuilding;
  if (kind >= 3 && kind <= 5) return SceneClass::kPlant;
  return kind < 2 || kind == 12 || kind >= 19 ? SceneClass::kNothing : SceneClass::kRest;
}

/// What a first look at all points tells.
struct CloudFacts {
  Box box;
  std::size_t points = 0, ground = 0, buildings = 0, classed = 0;
  std::uint16_t brightest = 0;
};

CloudFacts look_over(const Clouds& clouds) {
  CloudFacts facts;
  for (const AirborneCloud& cloud : clouds)
    cloud.visit([&](const AirbornePoint& p) {
      facts.box.extend(p.at);
      ++facts.points;
      const SceneClass c = class_of(p.kind);
      facts.ground += c == SceneClass::kGround, facts.buildings += c == SceneClass::kBuilding;
      facts.classed += c != SceneClass::kNothing;
      for (const std::uint16_t v : p.color) facts.brightest = std::max(facts.brightest, v);
    });
  return facts;
}

double covered_area(const Clouds& clouds, const Box& box) {
  std::set<std::array<int, 2>> cells;
  for (const AirborneCloud& cloud : clouds)
    cloud.visit([&](const AirbornePoint& p) {
      const Vec2 at = (p.at - box.min).head<2>() / kDensityCell;
      cells.insert({static_cast<int>(at.x()), static_cast<int>(at.y())});
    });
  return kDensityCell * kDensityCell * static_cast<double>(cells.size());
}

HeightMap empty_map(const Box& box, double cell, bool has_color) {
  HeightMap map;
  map.cell = cell;
  map.is_sharp = true;
  map.origin = box.min.head<2>();
  map.width = static_cast<int>(box.size().x() / cell) + 1;
  map.height = static_cast<int>(box.size().y() / cell) + 1;
  map.top.assign(static_cast<std::size_t>(map.width) * map.height, NAN);
  if (has_color) map.color.assign(map.size(), Rgb{});
  return map;
}

/// Cells while points fall into them.
class Gathering {
 public:
  Gathering(HeightMap& map, const CloudFacts& facts, bool has_ground)
      : map_(map), shift_(facts.brightest > 255 ? 8 : 0) {
    off.assign(map.size(), Eigen::Vector2f::Zero());
    if (facts.classed > 0) map.told.assign(map.size(), SceneClass::kNothing);
    if (has_ground) map.ground.assign(map.size(), NAN);
  }

  void add(const AirbornePoint& p) {
    const Vec2 at = (p.at.head<2>() - map_.origin) / map_.cell;
    const int x = std::clamp(static_cast<int>(at.x()), 0, map_.width - 1);
    const int y = std::clamp(static_cast<int>(at.y()), 0, map_.height - 1);
    const std::size_t i = map_.at(x, y);
    const auto z = static_cast<float>(p.at.z());
    const SceneClass c = class_of(p.kind);
    if (!map_.ground.empty() && c == SceneClass::kGround && !(map_.ground[i] <= z))
      map_.ground[i] = z;
    if (!is_seen(i, z, c)) return;
    map_.top[i] = z;
    off[i] = Vec2(p.at.head<2>() - map_.middle(x, y)).cast<float>();
    if (!map_.told.empty()) map_.told[i] = c;
    for (std::size_t k = 0; !map_.color.empty() && k < 3; ++k)
      map_.color[i][k] = static_cast<std::uint8_t>(p.color[k] >> shift_);
  }

  std::vector<Eigen::Vector2f> off;  // per cell: its point from its middle

 private:
  bool is_seen(std::size_t i, float z, SceneClass c) const {
    if (std::isnan(map_.top[i])) return true;
    if (!map_.told.empty() && map_.told[i] != c) {
      if (map_.told[i] == SceneClass::kBuilding) return false;
      if (c == SceneClass::kBuilding) return true;
    }
    return z > map_.top[i];
  }

  HeightMap& map_;
  int shift_;
};

/// Known cells among the eight around.
template <typename Body>
void around(const HeightMap& map, const std::vector<float>& top, int x, int y, Body body) {
  for (int v = std::max(0, y - 1); v <= std::min(map.height - 1, y + 1); ++v)
    for (int u = std::max(0, x - 1); u <= std::min(map.width - 1, x + 1); ++u)
      if (const std::size_t j = map.at(u, v); (u != x || v != y) && !std::isnan(top[j])) body(j);
}

/// What stands out of all around it is no surface.
void drop_spikes(HeightMap& map) {
  const std::vector<float> before = map.top;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const std::size_t i = map.at(x, y);
      float least = INFINITY, most = -INFINITY;
      around(map, before, x, y, [&](std::size_t j) {
        least = std::min(least, before[j]), most = std::max(most, before[j]);
      });
      const auto spike = static_cast<float>(kSpike);
      if (before[i] > most + spike || before[i] < least - spike) map.top[i] = NAN;
    }
}

/// The gentler one of two slopes, none where they disagree: ridges and eaves stay.
double limited(double a, double b) {
  if (std::isnan(a)) a = b;
  if (std::isnan(b)) b = a;
  if (std::isnan(a) || a * b <= 0) return 0;
  const double slope = std::abs(a) < std::abs(b) ? a : b;
  return std::abs(slope) > kSteepestSurface ? 0 : slope;
}

/// Heights of points → of the middles of their cells.
void move_to_middles(HeightMap& map, const std::vector<Eigen::Vector2f>& off) {
  const std::vector<float> points = map.top;
  for (int round = 0; round < kSlopeRounds; ++round) {
    const std::vector<float> z = map.top;
    const auto slope = [&](int x, int y, int dx, int dy) {
      const int u = x + dx, v = y + dy;
      if (u < 0 || v < 0 || u >= map.width || v >= map.height) return double(NAN);
      return (z[map.at(u, v)] - z[map.at(x, y)]) / (map.cell * (dx + dy));
    };
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) {
        const std::size_t i = map.at(x, y);
        if (std::isnan(points[i])) continue;
        const double along_x = limited(slope(x, y, -1, 0), slope(x, y, 1, 0));
        const double along_y = limited(slope(x, y, 0, -1), slope(x, y, 0, 1));
        map.top[i] = static_cast<float>(points[i] - along_x * off[i].x() - along_y * off[i].y());
      }
  }
}

/// Gaps of a few cells take the middle one of what is around, with its class and colour.
void fill_gaps(HeightMap& map) {
  for (int round = 0; round < kFillRounds; ++round) {
    const std::vector<float> before = map.top;
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) {
        const std::size_t i = map.at(x, y);
        if (!std::isnan(before[i])) continue;
        std::vector<std::pair<float, std::size_t>> near;
        around(map, before, x, y, [&](std::size_t j) { near.emplace_back(before[j], j); });
        if (near.size() < 3) continue;  // the cloud ends here
        std::nth_element(near.begin(), near.begin() + static_cast<long>(near.size() / 2),
                         near.end());
        const auto [z, j] = near[near.size() / 2];
        map.top[i] = z;
        if (!map.told.empty()) map.told[i] = map.told[j];
        if (!map.color.empty()) map.color[i] = map.color[j];
      }
  }
}

double cell_for(double density, const CloudFacts& facts, const std::string& path) {
  const Vec3 size = facts.box.size();
  const double cell = std::sqrt(kPointsACell / density);
  if (cell > kLargestCell)
    refuse(path, "has " + std::to_string(density).substr(0, 4) +
                     " points a m², too few to tell buildings by: one in 2 m² is needed");
  return std::max({cell, parameters::survey::kCell,
                   std::sqrt(size.x() * size.y() / parameters::survey::kMostCells)});
}

/// What tells that coordinates have too few digits for where they are.
void tell_rounding(const std::vector<std::string>& files, const Clouds& clouds, const Box& box,
                   std::vector<std::string>& warnings) {
  const double farthest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  const double step = farthest * std::numeric_limits<float>::epsilon();
  if (step < kCoarsestStep) return;
  std::ostringstream size;
  size << std::setprecision(2) << step;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (clouds[i].is_single())
      warnings.push_back(files[i] +
                         ": its coordinates are of single precision, which is as coarse as " +
                         size.str() +
                         " m where they lie: write them in double precision, or less an "
                         "offset that --origin then says");
}

/// Of coordinates in degrees or in another unit.
void check_extent(const std::string& path, const Box& box) {
  if (box.size().head<2>().maxCoeff() >= kNarrowestPlace) return;
  refuse(path, "is less than " + std::to_string(static_cast<int>(kNarrowestPlace)) +
                   " m wide: coordinates in degrees must be projected first (PROJ's cs2cs, QGIS), "
                   "other units --unit says");
}

}  // namespace

CloudSurface surface_of(const std::vector<std::string>& files, const ReadOptions& options) {
  Clouds clouds;
  std::vector<std::string> warnings;
  bool has_color = true;
  for (const std::string& file : files) {
    clouds.emplace_back(file, options);
    has_color &= clouds.back().has_color();
    for (const std::string& w : clouds.back().warnings()) warnings.push_back(file + ": " + w);
  }
  const CloudFacts facts = look_over(clouds);
  if (facts.points < 3) refuse(files[0], "has no points but noise and what was withheld");
  check_extent(files[0], facts.box);
  tell_rounding(files, clouds, facts.box, warnings);
  if (facts.buildings == facts.points)
    refuse(files[0],
           "holds points of buildings alone (class 6) and no ground that they stand on: --scene "
           "buildings takes a file for one building");
  CloudSurface out;
  out.warnings = std::move(warnings);
  out.points = facts.points;
  out.density = static_cast<double>(facts.points) / covered_area(clouds, facts.box);
  const bool has_ground =
      static_cast<double>(facts.ground) > kLeastGroundPoints * static_cast<double>(facts.points);
  out.map = empty_map(facts.box, cell_for(out.density, facts, files[0]),
                      has_color && facts.brightest > 0);
  Gathering cells(out.map, facts, has_ground);
  for (const AirborneCloud& cloud : clouds)
    cloud.visit([&](const AirbornePoint& p) { cells.add(p); });
  drop_spikes(out.map);
  move_to_middles(out.map, cells.off);
  fill_gaps(out.map);
  if (!has_ground)
    out.warnings.push_back(files[0] +
                           ": no points of class 2 (ground): the ground is found by its shape");
  return out;
}

namespace {

/// Steps between cells along one side of a map, shared out evenly.
struct Steps {
  int steps, tiles;
  explicit Steps(int cells) : steps(std::max(1, cells - 1)), tiles((steps + kTile - 1) / kTile) {}
  int begin(int tile) const { return static_cast<int>(static_cast<long>(steps) * tile / tiles); }
};

}  // namespace

int tile_count(const HeightMap& map) { return Steps(map.width).tiles * Steps(map.height).tiles; }

Source surface_tile(const HeightMap& map, int tile) {
  const Steps across(map.width), along(map.height);
  const int column = tile % across.tiles, row = tile / across.tiles;
  const int x0 = across.begin(column), x1 = std::min(across.begin(column + 1), map.width - 1);
  const int y0 = along.begin(row), y1 = std::min(along.begin(row + 1), map.height - 1);
  const int width = x1 - x0 + 1;
  std::vector<int> number(static_cast<std::size_t>(width) * (y1 - y0 + 1), -1);
  Source out;
  const auto add = [&](const std::array<std::array<int, 2>, 3>& corners) {
    Face face;
    std::array<Rgb, 3> colors;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [x, y] = corners[k];
      const std::size_t cell = map.at(x, y);
      if (std::isnan(map.top[cell])) return;
      int& n = number[static_cast<std::size_t>(y - y0) * width + (x - x0)];
      if (n < 0) {
        n = static_cast<int>(out.mesh.vertices.size());
        const Vec2 p = map.middle(x, y);
        out.mesh.vertices.emplace_back(p.x(), p.y(), map.top[cell]);
      }
      face[k] = n;
      if (!map.color.empty()) colors[k] = map.color[cell];
    }
    out.mesh.faces.push_back(face);
    if (!map.color.empty()) out.look.colors.push_back(colors);
  };
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      add({{{x, y}, {x + 1, y}, {x + 1, y + 1}}});
      add({{{x, y}, {x + 1, y + 1}, {x, y + 1}}});
    }
  return out;
}

}  // namespace colod
