// Inside room `read` only: what a file says, word for word, before read.cpp validates it.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/geometry.h"
#include "read.h"

namespace colod::mesh_io {

/// Polygons over points, as written in the file: nothing welded, turned, scaled or checked yet.
struct RawFile {
  std::vector<Vec3> points;     ///< file units, file axes; may hold NaN
  std::vector<Vec3> normals;    ///< per point, or empty
  std::vector<int> corners;     ///< point indices of all polygons, possibly out of range
  std::vector<int> face_begin;  ///< start in `corners` per polygon; the end is the next start
  std::vector<int> face_group;  ///< per polygon: OBJ `g` or PLY `object`; empty: the file has none
  std::vector<int> face_part;   ///< per polygon: index into `parts`; empty: the file has none
  std::vector<int> face_material;  ///< per polygon: index into `materials`, −1: none; or empty
  std::vector<Vec2f> corner_uvs;   ///< as long as `corners`, 0,0 the upper left; or empty
  std::vector<Rgb> corner_colors;  ///< as long as `corners`; or empty
  std::vector<Rgb> point_colors;   ///< per point, for corners without; or empty
  std::vector<Material> materials;
  std::vector<ImagePlace> images;     ///< that materials name
  std::vector<std::string> parts;     ///< OBJ `o` objects, glTF nodes: one building each when split
  std::vector<int> part_parent;       ///< per part: the part that it is a level of detail of, −1:
                                      ///< none; empty: none of them is
  std::vector<std::string> groups;    ///< OBJ `g`, by the numbers in face_group; empty: unnamed
  std::vector<std::string> warnings;  ///< what the reader skipped
  bool has_doubtful_normals = false;  ///< perhaps colours: kept where the surface agrees
  std::string remarks;                ///< comments at the file's head: which program wrote it
  bool is_soup = false;               ///< faces share no points (STL, glTF): weld equal ones
  bool is_from_memory = false;        ///< no other file stands beside it
  bool is_turned = false;             ///< already z up (glTF turns itself)
  bool is_metric = false;             ///< in metres, by the file's own word
  Vec3 origin = Vec3::Zero();         ///< metres, added after units and axes (our own GLBs' extras)

  int face_count() const { return static_cast<int>(face_begin.size()); }
  int face_end(int f) const {
    return f + 1 < face_count() ? face_begin[f + 1] : static_cast<int>(corners.size());
  }
};

/// Faces of fewer than three corners, which readers leave out.
struct ShortFaces {
  int count = 0;
  std::string first;  ///< where: "line 4", "face 7"

  void add(const std::string& place) {
    if (count++ == 0) first = place;
  }
  /// A warning, where there are any.
  void report(RawFile& raw) const {
    if (count > 0)
      raw.warnings.push_back(std::to_string(count) +
                             " faces with fewer than 3 corners left out, first in " + first);
  }
};

/// The lines of a text file with their numbers: comments from `#` on and empty lines skipped,
/// tokens by blanks. Lines end in LF, CR LF or CR.
class Lines {
 public:
  /// `lines_before`: lines of the file above `text`.
  Lines(std::string path, std::string_view text, int lines_before = 0);

  /// From now on a backslash at the end of a line that tokens are taken from joins the next one.
  void allow_continuation() { has_continuation_ = true; }

  bool next();               ///< moves to the next line that holds something; false at the end
  std::string_view token();  ///< empty at the end of the line
  bool has_token();
  std::string_view rest() const { return line_; }  ///< what is left of the line
  double number();                                 ///< next token as a double; NaN and inf allowed
  double number_across();  ///< the same, on a later line where this one ends
  int integer();           ///< next token as an int
  int integer_across();
  int line_number() const { return line_number_; }
  std::size_t bytes_left() const { return text_.size(); }
  [[noreturn]] void fail(const std::string& cause) const;  ///< Error{kInput} naming the line

 private:
  bool take_line();
  void move_on();

  std::string path_;
  std::string_view text_, line_;
  int line_number_;
  bool has_continuation_ = false;
  bool has_lone_cr_ = false;  // lines end in CR: an LF behind one belongs to what follows
};

/// The number a token spells; NaN for `nan`, `1.#QNAN` and overflow. False: not a number.
bool parse_number(std::string_view token, double& value);

/// What stands behind `#` in the first lines of a text.
std::string head_remarks(std::string_view text);

/// Throws Error{kInput, path, "<place>: <cause>"}.
[[noreturn]] void fail(const std::string& path, const std::string& cause);

/// One reader a format: `bytes` is the whole file. All throw Error{kInput} naming line, vertex or
/// face.
RawFile read_obj(const std::string& path, const std::string& bytes);
RawFile read_off(const std::string& path, const std::string& bytes);
RawFile read_stl(const std::string& path, const std::string& bytes);
RawFile read_points(const std::string& path, const std::string& bytes, bool is_pwn);
/// LAS 1.0 to 1.4: the points of class 6 (building); in a file without any, those whose class is
/// not ground, plants, noise or another known thing. LAZ is unpacked by laszip, las2las or pdal.
RawFile read_las(const std::string& path, std::string_view bytes, const ReadOptions& options);
RawFile read_laz(const std::string& path, std::string_view bytes, const ReadOptions& options);
RawFile read_ply(const std::string& path, const std::string& bytes);
/// `options` say which level is read, and what it and the files beside it may take. `begin`: where
/// in the file `bytes` begin, which go on to its end.
RawFile read_gltf(const std::string& path, std::string_view bytes, const ReadOptions& options,
                  std::size_t begin = 0);
/// A batched model of 3D Tiles: the glTF in it, about its RTC_CENTER.
RawFile read_b3dm(const std::string& path, const std::string& bytes, const ReadOptions& options);

/// Farther from 0,0,0 than any local coordinates: such are seen from the middle of the Earth.
constexpr double kEarth = 6e6;

/// The class that a number stands for, as LAS numbers them; 0: it is none.
int class_number(double value);

/// Do twenty lines of at least three numbers stand at the head of a text? For files whose names end
/// in .asc, .csv or .txt, which may hold anything.
bool is_point_table(const std::string& head);

/// Triangles of one polygon, convex or not, with the polygon's own winding: `n - 2` index triples
/// into `ring`, a closed loop of points. Ear clipping, at most n² tests of a corner.
std::vector<Face> triangulate_ring(const std::vector<Vec3>& ring);

/// Beyond it squares and products of coordinates lose all digits.
constexpr double kFarthest = 1e12;
inline bool is_usable(const Vec3& p) { return (p.array().abs() <= kFarthest).all(); }

/// The points of a file without faces, in metres: those that can be used, with unit normals.
/// Throws Error{kInput} when fewer than three are left.
Source read_cloud(const std::string& path, const RawFile& raw);

/// Per point, whether it belongs to a stray: a small piece, or a vertex of slivers, absurdly far
/// from all the rest, as a stray triangle or a vertex left at 0,0,0 of a file in projected
/// coordinates. Without `faces` a cloud's. Empty: none.
std::vector<char> find_strays(const std::vector<Vec3>& points, const std::vector<Face>& faces);

/// Lets go of them with a warning; `s` is in metres.
void leave_out_strays(Source& s);

/// How a file is to be read, and what is doubtful about that.
struct Reading {
  bool is_y_up = false;         ///< the axes as the reader gives them are to be turned
  bool is_turned_back = false;  ///< a glTF whose content is z up, whatever the format says
  double unit = 1;              ///< metres
  std::vector<std::string> doubts;
};

/// Throws Error{kInput} when the coordinates look like degrees, unless options.unit is given.
Reading judge(const std::string& path, const RawFile& raw, const ReadOptions& options);

/// Estimated unit normals of a cloud, oriented outward as well as can be told. Writes
/// `cloud.normals`; returns a warning.
std::string estimate_normals(PointCloud& cloud);

}  // namespace colod::mesh_io
