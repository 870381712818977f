// Inside room `bake` only: what of the source the places of a chart show, a window of it at once.
#pragma once

#include <vector>

#include "charts.h"
#include "probe.h"

namespace colod::bake {

/// What a place of a chart shows straight along its normal, before the chart or behind it.
struct Sighting {
  int face = -1;     ///< −1: nothing that agrees within reach
  float offset = 0;  ///< metres along the normal
};

/// Places on a chart, row by row; metres from its upper left corner.
struct SampleGrid {
  Vec2 begin;  ///< the first
  double step;
  int columns, rows;

  Vec2 at(int x, int y) const { return begin + step * Vec2(x, y); }
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * columns + x; }
};

/// The faces of the source that a chart may show. It keeps references to all that it is given.
class Sight {
 public:
  Sight() = default;
  /// O(faces).
  Sight(const Mesh& source, const Probe& probe, const Chart& chart, double reach);

  /// Per place the face that lies nearest; passes on where `is_hole` says so. O(faces + places that
  /// they cover).
  std::vector<Sighting> look(const SampleGrid& grid, const Probe::Holes& is_hole) const;

  /// False: nothing that agrees lies within kNearest of a place of the chart's plane, whatever way.
  bool may_be_near(const Vec2& q) const;

  /// A face's corners: places on the chart, and metres along the normal.
  std::array<Vec3, 3> corners(int face) const;

 private:
  /// A face and the box of its shadow on the chart.
  struct Candidate {
    int face;
    Eigen::Vector2f least, most;
  };
  void mark_near(const Vec2& least, const Vec2& most);
  void draw(int face, const SampleGrid& grid, const Probe::Holes& is_hole,
            std::vector<Sighting>& out) const;

  const Mesh* source_ = nullptr;
  const Chart* chart_ = nullptr;
  double reach_ = 0;
  std::vector<Candidate> candidates_;
  // Whether one that is near to the plane has its shadow's box there; row by row.
  std::vector<char> is_near_;
  int columns_ = 0, rows_ = 0;
};

}  // namespace colod::bake
