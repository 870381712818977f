// Based on: the formats as their writers use them (Wavefront OBJ appendix B1, Geomview OFF).
// Differs: no library. Debian's tinyobjloader reads `nan` and `v 1 2` as zeros and CGAL's readers
// name no line; here every number goes through std::from_chars (exact, no locale) and every failure
// names its line.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "files.h"
#include "formats.h"
#include "look.h"

namespace colod::mesh_io {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

/// Does the first line of a text end in CR alone?
bool ends_in_lone_cr(std::string_view text) {
  const std::size_t end = text.find_first_of("\r\n");
  return end != text.npos && text[end] == '\r' && (end + 1 == text.size() || text[end + 1] != '\n');
}

}  // namespace

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

void fail(const std::string& path, const std::string& cause) {
  throw Error(Stage::kInput, path, cause);
}

std::string head_remarks(std::string_view text) {
  constexpr std::size_t kHead = 2000;
  std::string remarks;
  text = text.substr(0, kHead);
  for (std::size_t at = text.find('#'); at != text.npos; at = text.find('#', at)) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    remarks += std::string(text.substr(at, end - at)) + "\n";
    at = end;
  }
  return remarks;
}

Lines::Lines(std::string path, std::string_view text, int lines_before)
    : path_(std::move(path)),
      text_(text),
      line_number_(lines_before),
      has_lone_cr_(ends_in_lone_cr(text)) {}

void Lines::fail(const std::string& cause) const {
  mesh_io::fail(path_, "line " + std::to_string(line_number_) + ": " + cause);
}

bool Lines::take_line() {
  if (text_.empty()) return false;
  const std::size_t end = std::min(text_.find_first_of("\r\n"), text_.size());
  line_ = text_.substr(0, end);
  const bool is_pair = !has_lone_cr_ && text_.substr(end).starts_with("\r\n");
  text_.remove_prefix(std::min(end + (is_pair ? 2 : 1), text_.size()));
  while (!line_.empty() && is_blank(line_.back())) line_.remove_suffix(1);
  ++line_number_;
  return true;
}

bool Lines::next() {
  while (take_line())
    if (has_token()) return true;
  return false;
}

bool Lines::has_token() {
  for (;;) {
    while (!line_.empty() && is_blank(line_.front())) line_.remove_prefix(1);
    if (line_.starts_with('#')) line_ = {};
    if (!has_continuation_ || line_ != "\\") return !line_.empty();
    line_ = {};
    if (!take_line()) return false;
  }
}

std::string_view Lines::token() {
  has_token();
  std::size_t n = 0;
  while (n < line_.size() && !is_blank(line_[n])) ++n;
  std::string_view result = line_.substr(0, n);
  line_.remove_prefix(n);
  if (has_continuation_ && line_.empty() && result.ends_with('\\')) {
    line_ = result.substr(result.size() - 1);  // what is left says that the next line belongs here
    result.remove_suffix(1);
  }
  return result;
}

void Lines::move_on() {
  if (!has_token() && !next()) fail("truncated: a number is missing");
}

double Lines::number_across() {
  move_on();
  return number();
}

int Lines::integer_across() {
  move_on();
  return integer();
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

/// One that may be broken over several lines.
Vec3 read_vec3_across(Lines& lines) {
  const double x = lines.number_across(), y = lines.number_across(), z = lines.number_across();
  return {x, y, z};
}

std::string without_blanks(std::string_view s) {
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

/// An index of a corner; negative counts back from the last one.
int obj_index(Lines& lines, std::string_view token, int count) {
  int i = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), i);
  if (error != std::errc() || end != token.data() + token.size() || i == 0)
    lines.fail("'" + std::string(token.substr(0, 40)) + "' is not a vertex index");
  if (i < -count) lines.fail("a face counts back beyond the first vertex");
  return i < 0 ? count + i : i - 1;
}

/// An OBJ while its lines are read.
class ObjReader {
 public:
  ObjReader(const std::string& path, const std::string& bytes)
      : lines_(path, bytes), library_(path) {
    raw_.remarks = head_remarks(bytes);
    lines_.allow_continuation();
  }

  RawFile read() {
    while (lines_.next()) read_line(lower(std::string(lines_.token())));
    if (groups_.names.empty()) raw_.face_group.clear();
    if (objects_.names.empty()) raw_.face_part.clear();
    raw_.parts = objects_.names;
    raw_.groups = groups_.names;
    short_faces_.report(raw_);
    add_look();
    return std::move(raw_);
  }

 private:
  void read_line(const std::string& key) {
    if (key == "v") {
      add_point();
    } else if (key == "vt") {
      const std::vector<double> uv = numbers_left();
      uvs_.emplace_back(uv.empty() ? NAN : uv[0], uv.size() < 2 ? 0 : uv[1]);
    } else if (key == "f") {
      add_face();
    } else if (key == "g") {
      group_ = groups_.number(without_blanks(lines_.rest()));
    } else if (key == "o") {
      object_ = objects_.number(without_blanks(lines_.rest()));
    } else if (key == "mtllib") {
      library_.load(without_blanks(lines_.rest()));
    } else if (key == "usemtl") {
      material_ = library_.number(without_blanks(lines_.rest()));
    }
  }

  /// The numbers at the head of what is left of a line, which is not taken: whatever stands there,
  /// shapes do not depend on it.
  std::vector<double> numbers_left() const {
    std::vector<double> out;
    std::string_view rest = lines_.rest();
    for (double value = 0; out.size() < 5;) {
      while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
      const std::size_t end = std::min(rest.find_first_of(" \t\v\f"), rest.size());
      if (end == 0 || !parse_number(rest.substr(0, end), value)) break;
      out.push_back(value);
      rest.remove_prefix(end);
    }
    return out;
  }

  /// Three coordinates, and perhaps the colour that many programs write behind them.
  void add_point() {
    raw_.points.push_back(read_vec3(lines_));
    const std::vector<double> more = numbers_left();
    if (more.size() == 3 && raw_.point_colors.size() + 1 == raw_.points.size())
      raw_.point_colors.push_back(rgb_of(more[0], more[1], more[2]));
  }

  void add_face() {
    const std::size_t begin = raw_.corners.size();
    while (lines_.has_token()) add_corner(lines_.token());
    if (raw_.corners.size() - begin < 3) {
      raw_.corners.resize(begin);
      corner_uv_.resize(begin);
      short_faces_.add("line " + std::to_string(lines_.line_number()));
      return;
    }
    raw_.face_begin.push_back(static_cast<int>(begin));
    raw_.face_group.push_back(group_);
    raw_.face_part.push_back(object_);
    raw_.face_material.push_back(material_);
  }

  /// `v`, `v/vt`, `v//vn` or `v/vt/vn`. Texture coordinates that are no index are none.
  void add_corner(std::string_view token) {
    const std::size_t slash = std::min(token.find('/'), token.size());
    raw_.corners.push_back(
        obj_index(lines_, token.substr(0, slash), static_cast<int>(raw_.points.size())));
    token.remove_prefix(std::min(slash + 1, token.size()));
    token = token.substr(0, token.find('/'));
    int i = 0;
    std::from_chars(token.data(), token.data() + token.size(), i);
    corner_uv_.push_back(i < 0 ? static_cast<int>(uvs_.size()) + i : i - 1);
  }

  /// What has texture coordinates, and a material that no file defines for want of a file, has lost
  /// its image.
  void lose_images() {
    for (int f = 0; f < raw_.face_count(); ++f) {
      const int m = raw_.face_material[f];
      if (m < 0 || library_.materials()[m].is_defined) continue;
      const auto begin = corner_uv_.begin();
      if (std::any_of(begin + raw_.face_begin[f], begin + raw_.face_end(f),
                      [](int i) { return i >= 0; }))
        raw_.materials[m].image = library_.lost_image();
    }
  }

  /// Coordinates as materials place them, from the upper left.
  void add_look() {
    for (const MtlMaterial& m : library_.materials()) raw_.materials.push_back(m.material);
    lose_images();
    raw_.images = library_.images();
    raw_.warnings.insert(raw_.warnings.end(), library_.warnings().begin(),
                         library_.warnings().end());
    if (raw_.point_colors.size() != raw_.points.size()) raw_.point_colors.clear();
    if (raw_.materials.empty()) raw_.face_material.clear();
    if (raw_.images.empty()) return;
    raw_.corner_uvs.assign(raw_.corners.size(), Vec2f(NAN, NAN));
    for (int f = 0; f < raw_.face_count(); ++f) {
      if (raw_.face_material[f] < 0) continue;
      const MtlMaterial& m = library_.materials()[raw_.face_material[f]];
      for (int c = raw_.face_begin[f]; c < raw_.face_end(f); ++c) {
        const int i = corner_uv_[c];
        if (i < 0 || i >= static_cast<int>(uvs_.size())) continue;
        const Vec2 uv = m.scale.cwiseProduct(uvs_[i]) + m.shift;
        raw_.corner_uvs[c] = Vec2(uv.x(), 1 - uv.y()).cast<float>();
      }
    }
  }

  Lines lines_;
  MtlLibrary library_;
  RawFile raw_;
  Numbering groups_, objects_;
  int group_ = -1, object_ = -1, material_ = -1;
  std::vector<Vec2> uvs_;
  std::vector<int> corner_uv_;  // per corner: index into uvs_, perhaps one that is not there
  ShortFaces short_faces_;
};

}  // namespace

RawFile read_obj(const std::string& path, const std::string& bytes) {
  return ObjReader(path, bytes).read();
}

RawFile read_off(const std::string& path, const std::string& bytes) {
  Lines lines(path, bytes);
  if (!lines.next()) fail(path, "the file is empty");
  std::string key(lines.token());
  if (key == "off" || key == "coff") key = "OFF";
  if (!key.ends_with("OFF")) lines.fail("this is no OFF header");
  const bool has_normals = key.find('N') != key.npos;
  if (key.find('4') != key.npos || key.find('n') != key.npos)
    lines.fail("only three-dimensional OFF is read");
  if (lines.has_token() && lines.rest().substr(0, 6) == "BINARY")
    lines.fail("binary OFF is not read");
  if (!lines.has_token() && !lines.next()) lines.fail("truncated: the counts are missing");
  const int points = lines.integer_across();
  const bool is_broken = !lines.has_token();  // then the count of edges has a line of its own, too
  const int faces = lines.integer_across();
  if (is_broken) lines.integer_across();
  if (points < 0 || faces < 0) lines.fail("a count is negative");
  RawFile raw;
  for (int i = 0; i < points; ++i) {
    if (!lines.next())
      lines.fail("truncated: " + std::to_string(i) + " of " + std::to_string(points) + " vertices");
    raw.points.push_back(read_vec3_across(lines));
    if (has_normals) raw.normals.push_back(read_vec3_across(lines));
  }
  ShortFaces short_faces;
  for (int f = 0; f < faces; ++f) {
    if (!lines.next())
      lines.fail("truncated: " + std::to_string(f) + " of " + std::to_string(faces) + " faces");
    const int corners = lines.integer();
    if (corners < 0) lines.fail("a face with a negative number of corners");
    if (corners < 3) {
      short_faces.add("line " + std::to_string(lines.line_number()));
      continue;
    }
    raw.face_begin.push_back(static_cast<int>(raw.corners.size()));
    for (int c = 0; c < corners; ++c) raw.corners.push_back(lines.integer_across());
  }
  short_faces.report(raw);
  return raw;
}

}  // namespace colod::mesh_io
