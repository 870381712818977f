// Based on: the formats as their writers use them (Wavefront OBJ appendix B1, Geomview OFF, the
// STL of 3D Systems, CGAL's XYZ and PWN).
// Differs: no library. Debian's tinyobjloader reads `nan` and `v 1 2` as zeros and CGAL's readers
// name no line; here every number goes through std::from_chars (exact, no locale) and every failure
// names its line.
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>

#include "mesh_io_formats.h"

namespace colod::mesh_io {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// The number a token spells; NaN for `nan`, `1.#QNAN` and overflow. False: not a number.
bool parse_number(std::string_view token, double& value) {
  if (!token.empty() && token.front() == '+') token.remove_prefix(1);
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error == std::errc::result_out_of_range)  // 1e-400 is zero, 1e400 no coordinate
    value = token.find("e-") != token.npos || token.find("E-") != token.npos ? 0.0 : NAN;
  else if (error != std::errc())
    return false;
  if (end == token.data() + token.size()) return true;
  value = NAN;
  return *end == '#';  // what Microsoft's printf makes of NaN
}

}  // namespace

void fail(const std::string& path, const std::string& cause) {
  throw Error(Stage::kInput, path, cause);
}

void Lines::fail(const std::string& cause) const {
  mesh_io::fail(path_, "line " + std::to_string(line_number_) + ": " + cause);
}

bool Lines::next() {
  while (!text_.empty()) {
    const std::size_t end = text_.find('\n');
    line_ = text_.substr(0, end);
    text_.remove_prefix(end == text_.npos ? text_.size() : end + 1);
    ++line_number_;
    if (has_token() && line_.front() != '#') return true;
  }
  return false;
}

bool Lines::has_token() {
  while (!line_.empty() && is_blank(line_.front())) line_.remove_prefix(1);
  return !line_.empty();
}

std::string_view Lines::token() {
  has_token();
  std::size_t n = 0;
  while (n < line_.size() && !is_blank(line_[n])) ++n;
  const std::string_view result = line_.substr(0, n);
  line_.remove_prefix(n);
  return result;
}

double Lines::number() {
  const std::string_view t = token();
  if (t.empty()) fail("a number is missing");
  double value = 0;
  if (!parse_number(t, value)) fail("'" + std::string(t.substr(0, 40)) + "' is not a number");
  return value;
}

int Lines::integer() {
  const std::string_view t = token();
  if (t.empty()) fail("a number is missing");
  int value = 0;
  const auto [end, error] = std::from_chars(t.data(), t.data() + t.size(), value);
  if (error != std::errc() || end != t.data() + t.size())
    fail("'" + std::string(t.substr(0, 40)) + "' is not a whole number that fits");
  return value;
}

namespace {

Vec3 read_vec3(Lines& lines) {
  const double x = lines.number(), y = lines.number(), z = lines.number();
  return {x, y, z};
}

std::string trimmed(std::string_view s) {
  while (!s.empty() && is_blank(s.front())) s.remove_prefix(1);
  while (!s.empty() && is_blank(s.back())) s.remove_suffix(1);
  return std::string(s);
}

/// Names get numbers in the order in which they come.
struct Numbering {
  std::map<std::string, int> number_of;
  std::vector<std::string> names;

  int number(const std::string& name) {
    const auto [it, is_new] = number_of.emplace(name, static_cast<int>(names.size()));
    if (is_new) names.push_back(name);
    return it->second;
  }
};

/// One corner `v`, `v/vt`, `v//vn` or `v/vt/vn`; negative counts back from the last vertex.
int obj_corner(Lines& lines, std::string_view token, int points) {
  token = token.substr(0, token.find('/'));
  int i = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), i);
  if (error != std::errc() || end != token.data() + token.size() || i == 0)
    lines.fail("'" + std::string(token.substr(0, 40)) + "' is not a vertex index");
  if (i < 0 && -i > points) lines.fail("a face counts back beyond the first vertex");
  return i < 0 ? points + i : i - 1;
}

}  // namespace

RawFile read_obj(const std::string& path, const std::string& bytes) {
  std::string joined = bytes;
  for (std::size_t at = joined.find("\\\n"); at != joined.npos; at = joined.find("\\\n", at))
    joined[at] = joined[at + 1] = ' ';
  RawFile raw;
  Numbering groups, objects;
  int group = -1, object = -1, short_faces = 0, first_short = 0;
  Lines lines(path, joined);
  while (lines.next()) {
    const std::string_view key = lines.token();
    if (key == "v") {
      raw.points.push_back(read_vec3(lines));
    } else if (key == "f") {
      const int begin = static_cast<int>(raw.corners.size());
      while (lines.has_token())
        raw.corners.push_back(
            obj_corner(lines, lines.token(), static_cast<int>(raw.points.size())));
      if (raw.corners.size() - begin < 3) {
        raw.corners.resize(begin);
        if (++short_faces == 1) first_short = lines.line_number();
        continue;
      }
      raw.face_begin.push_back(begin);
      raw.face_group.push_back(group);
      raw.face_part.push_back(object);
    } else if (key == "g") {
      group = groups.number(trimmed(lines.rest()));
    } else if (key == "o") {
      object = objects.number(trimmed(lines.rest()));
    }
  }
  if (groups.names.empty()) raw.face_group.clear();
  if (objects.names.empty()) raw.face_part.clear();
  raw.parts = objects.names;
  if (short_faces > 0)
    raw.warnings.push_back(std::to_string(short_faces) +
                           " faces with fewer than 3 corners left out, first in line " +
                           std::to_string(first_short));
  return raw;
}

RawFile read_off(const std::string& path, const std::string& bytes) {
  Lines lines(path, bytes);
  if (!lines.next()) fail(path, "the file is empty");
  std::string_view key = lines.token();
  if (key.size() < 3 || key.substr(key.size() - 3) != "OFF") lines.fail("this is no OFF header");
  const bool has_normals = key.find('N') != key.npos;
  if (key.find('4') != key.npos || key.find('n') != key.npos)
    lines.fail("only three-dimensional OFF is read");
  if (lines.has_token() && lines.rest().substr(0, 6) == "BINARY")
    lines.fail("binary OFF is not read");
  if (!lines.has_token() && !lines.next()) lines.fail("truncated: the counts are missing");
  const int points = lines.integer(), faces = lines.integer();
  if (points < 0 || faces < 0) lines.fail("a count is negative");
  RawFile raw;
  for (int i = 0; i < points; ++i) {
    if (!lines.next())
      lines.fail("truncated: " + std::to_string(i) + " of " + std::to_string(points) + " vertices");
    raw.points.push_back(read_vec3(lines));
    if (has_normals) raw.normals.push_back(read_vec3(lines));
  }
  for (int f = 0; f < faces; ++f) {
    if (!lines.next())
      lines.fail("truncated: " + std::to_string(f) + " of " + std::to_string(faces) + " faces");
    const int corners = lines.integer();
    if (corners < 0) lines.fail("a face with a negative number of corners");
    if (corners < 3) continue;
    raw.face_begin.push_back(static_cast<int>(raw.corners.size()));
    for (int c = 0; c < corners; ++c) raw.corners.push_back(lines.integer());
  }
  return raw;
}

namespace {

RawFile read_stl_binary(const std::string& path, const std::string& bytes) {
  std::uint32_t faces = 0;
  if (bytes.size() < 84) fail(path, "truncated: an STL header takes 84 bytes");
  std::memcpy(&faces, bytes.data() + 80, 4);
  const std::size_t present = (bytes.size() - 84) / 50;
  if (present < faces)
    fail(path, "truncated at face " + std::to_string(present) + " of " + std::to_string(faces));
  RawFile raw;
  raw.is_soup = true;
  for (std::uint32_t f = 0; f < faces; ++f) {
    float v[9];
    std::memcpy(v, bytes.data() + 84 + 50 * std::size_t{f} + 12, sizeof v);
    raw.face_begin.push_back(static_cast<int>(raw.corners.size()));
    for (int c = 0; c < 3; ++c) {
      raw.corners.push_back(static_cast<int>(raw.points.size()));
      raw.points.emplace_back(v[3 * c], v[3 * c + 1], v[3 * c + 2]);
    }
  }
  return raw;
}

RawFile read_stl_text(const std::string& path, const std::string& bytes) {
  RawFile raw;
  raw.is_soup = true;
  Lines lines(path, bytes);
  bool is_ended = false;
  int corners = 0;
  while (lines.next()) {
    const std::string_view key = lines.token();
    is_ended = key == "endsolid";
    if (key == "vertex") {
      if (corners++ == 0) raw.face_begin.push_back(static_cast<int>(raw.corners.size()));
      raw.corners.push_back(static_cast<int>(raw.points.size()));
      raw.points.push_back(read_vec3(lines));
    } else if (key == "endloop") {
      if (corners != 3) lines.fail("a facet of " + std::to_string(corners) + " corners");
      corners = 0;
    }
  }
  if (!is_ended) lines.fail("truncated: `endsolid` is missing");
  return raw;
}

}  // namespace

RawFile read_stl(const std::string& path, const std::string& bytes) {
  std::uint32_t faces = 0;
  if (bytes.size() >= 84) std::memcpy(&faces, bytes.data() + 80, 4);
  const bool fits = bytes.size() >= 84 && bytes.size() == 84 + 50 * std::size_t{faces};
  const bool is_text = bytes.compare(0, 5, "solid") == 0 &&
                       std::string_view(bytes).substr(0, 512).find('\0') == std::string_view::npos;
  return !fits && is_text ? read_stl_text(path, bytes) : read_stl_binary(path, bytes);
}

RawFile read_xyz(const std::string& path, const std::string& bytes, bool is_pwn) {
  RawFile raw;
  Lines lines(path, bytes);
  bool is_first = true, has_normals = false, has_colours = false;
  while (lines.next()) {
    if (lines.rest().substr(0, 2) == "//") continue;
    double v[6];
    int n = 0;
    while (n < 6 && lines.has_token()) v[n++] = lines.number();
    if (is_first && n == 1) continue;  // a count
    if (n < 3 || (is_pwn && n < 6))
      lines.fail("a point needs " + std::string(is_pwn ? "6" : "3") + " numbers, found " +
                 std::to_string(n));
    const double length = n == 6 ? Vec3(v[3], v[4], v[5]).norm() : 0;
    if (is_first) {
      has_normals = is_pwn || std::abs(length - 1) < 0.01;
      has_colours = n >= 6 && !has_normals;
    }
    is_first = false;
    raw.points.emplace_back(v[0], v[1], v[2]);
    if (!has_normals) continue;
    if (n < 6) lines.fail("a normal is missing");
    raw.normals.emplace_back(v[3], v[4], v[5]);
  }
  if (has_colours) raw.warnings.push_back("columns 4 to 6 are no unit normals and were left out");
  return raw;
}

}  // namespace colod::mesh_io
