// Inside room 1 only: what a file says, word for word, before mesh_io.cpp validates it.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "error.h"
#include "geometry.h"

namespace colod::mesh_io {

/// Polygons over points, as written in the file: nothing welded, turned, scaled or checked yet.
struct RawFile {
  std::vector<Vec3> points;     ///< file units, file axes; may hold NaN
  std::vector<Vec3> normals;    ///< per point, or empty
  std::vector<int> corners;     ///< point indices of all polygons, possibly out of range
  std::vector<int> face_begin;  ///< start in `corners` per polygon; the end is the next start
  std::vector<int> face_group;  ///< per polygon: OBJ `g` or PLY `object`; empty: the file has none
  std::vector<int> face_part;   ///< per polygon: index into `parts`; empty: the file has none
  std::vector<std::string> parts;     ///< OBJ `o` objects, glTF nodes: one building each when split
  std::vector<std::string> warnings;  ///< what the reader skipped
  bool is_soup = false;               ///< faces share no points (STL, glTF): weld equal ones
  bool is_turned = false;      ///< already z up whatever ReadOptions says (glTF turns itself)
  Vec3 origin = Vec3::Zero();  ///< metres, added after units and axes (our own GLBs' extras)

  int face_count() const { return static_cast<int>(face_begin.size()); }
  int face_end(int f) const {
    return f + 1 < face_count() ? face_begin[f + 1] : static_cast<int>(corners.size());
  }
};

/// The lines of a text file with their numbers: comments and empty lines skipped, tokens by blanks.
class Lines {
 public:
  /// `lines_before`: lines of the file above `text`.
  Lines(std::string path, std::string_view text, int lines_before = 0)
      : path_(std::move(path)), text_(text), line_number_(lines_before) {}

  bool next();               ///< moves to the next line that holds something; false at the end
  std::string_view token();  ///< empty at the end of the line
  bool has_token();
  std::string_view rest() const { return line_; }  ///< what is left of the line
  double number();                                 ///< next token as a double; NaN and inf allowed
  int integer();                                   ///< next token as an int
  int line_number() const { return line_number_; }
  std::size_t bytes_left() const { return text_.size(); }
  [[noreturn]] void fail(const std::string& cause) const;  ///< Error{kInput} naming the line

 private:
  std::string path_;
  std::string_view text_, line_;
  int line_number_;
};

/// Throws Error{kInput, path, "<place>: <cause>"}.
[[noreturn]] void fail(const std::string& path, const std::string& cause);

/// One reader a format: `bytes` is the whole file. All throw Error{kInput} naming line, vertex or
/// face.
RawFile read_obj(const std::string& path, const std::string& bytes);
RawFile read_off(const std::string& path, const std::string& bytes);
RawFile read_stl(const std::string& path, const std::string& bytes);
RawFile read_xyz(const std::string& path, const std::string& bytes, bool is_pwn);
RawFile read_ply(const std::string& path, const std::string& bytes);
RawFile read_gltf(const std::string& path, const std::string& bytes, int coarser);

/// Triangles of one polygon, convex or not, with the polygon's own winding: `n - 2` index triples
/// into `ring`, a closed loop of points. Ear clipping, at most n² tests of a corner.
std::vector<Face> triangulate_ring(const std::vector<Vec3>& ring);

/// Estimated unit normals of a cloud, oriented outward as well as can be told. Writes
/// `cloud.normals`; returns a warning.
std::string estimate_normals(PointCloud& cloud);

}  // namespace colod::mesh_io
