// Footprints → who owns which ground: what is cut along exact borders.
#pragma once

#include <memory>
#include <vector>

#include "place/footprints.h"

namespace colod {

/// Triangles of the plan, each of one building: its footprint and what lies within reach of its
/// eaves, where that is nearer to it than to any other footprint. Footprints that share a border
/// meet there exactly; of ground that several cover the first has it.
class Territories {
 public:
  /// O(corners · log corners) but for footprints that crowd each other.
  explicit Territories(const std::vector<Footprint>& footprints);
  ~Territories();
  Territories(Territories&&) noexcept;
  /// The same without some buildings' pieces: what was theirs is over none.
  Territories without(const std::vector<char>& is_out) const;
  /// All of them as one building's, 0, with corners left out that are no farther off than
  /// `tolerance`, in metres.
  Territories coarser(double tolerance) const;

  std::size_t count() const;
  /// Of a building's territory; heights are infinite.
  const Box& box(std::size_t building) const;
  /// m² of a building's footprint that is its own.
  double area(std::size_t building) const;

  /// Of a mesh: what lies over the building's territory, or, of −1, over none. Faces that cross a
  /// border are cut there; texture coordinates and colours go along. Vertices that nothing uses are
  /// left out. Thread-safe.
  Source cut_out(const Source& source, int building) const;

  /// Whether a place is some building's.
  bool covers(const Vec2& p) const;

  /// The triangles, seen from above, and whose each is.
  struct Piece {
    std::array<Vec2, 3> corners;  ///< counter-clockwise
    int building;
  };
  const std::vector<Piece>& pieces() const;

 private:
  struct Impl;
  explicit Territories(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace colod
