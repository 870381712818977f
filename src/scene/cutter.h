// Inside room `scene` only: a source that grows from faces, and parts of faces, of another.
#pragma once

#include <map>

#include "core/geometry.h"

namespace colod {

constexpr double kLeastFace = 1e-7;  ///< m²: a part of less is none

/// Texture coordinates, colours and object numbers go along.
class Cutter {
 public:
  explicit Cutter(const Source& from);

  void add_whole(std::size_t face);
  /// `polygon`: convex; its corners as weights of the face's own.
  void add_part(std::size_t face, const std::vector<Vec3>& polygon);

  Source take() { return std::move(out_); }

 private:
  int old_vertex(int v);
  int vertex(std::size_t f, const Vec3& weights);
  int on_edge(int a, int b, const Vec3& p);
  void add(std::size_t f, const Face& face, const std::array<Vec3, 3>& weights);
  void add_look(std::size_t f, const std::array<Vec3, 3>& weights);

  const Source& from_;
  Source out_;
  std::vector<int> number_;  // of a vertex in the result; −1: not there
  std::map<std::array<double, 3>, int> cut_;
  std::map<std::array<int, 2>, std::vector<int>> on_edges_;  // numbers, by the ends of the edge
};

}  // namespace colod
