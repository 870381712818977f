// Based on: the STL of 3D Systems, 1989.
// Differs: text is told from binary by what it holds, not by its first word alone; words may stand
// in capitals and on any line; a text of several solids is taken as several objects.
#include <cstring>

#include "files.h"
#include "formats.h"

namespace colod::mesh_io {

namespace {

RawFile read_binary(const std::string& path, const std::string& bytes) {
  std::uint32_t faces = 0;
  if (bytes.size() < 84) fail(path, "truncated: an STL header takes 84 bytes");
  std::memcpy(&faces, bytes.data() + 80, 4);
  const std::size_t present = (bytes.size() - 84) / 50;
  if (present < faces)
    fail(path, "truncated at face " + std::to_string(present) + " of " + std::to_string(faces));
  RawFile raw;
  raw.is_soup = true;
  raw.remarks = bytes.substr(0, 80);
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

/// What stands behind `solid` or `endsolid` on the line.
std::string rest_of_line(Lines& lines) {
  std::string name;
  while (lines.has_token()) name += (name.empty() ? "" : " ") + std::string(lines.token());
  return name;
}

/// The words of a text STL one after the other, whatever lines they stand on.
class Text {
 public:
  Text(const std::string& path, const std::string& bytes) : lines_(path, bytes) {
    raw_.is_soup = true;
  }

  RawFile read() {
    while (lines_.next())
      while (lines_.has_token()) take(lower(std::string(lines_.token())));
    if (!is_ended_) lines_.fail("truncated: `endsolid` is missing");
    if (raw_.parts.size() < 2) raw_.face_part.clear(), raw_.parts.clear();
    return std::move(raw_);
  }

 private:
  void take(const std::string& word) {
    if (word == "solid" || word == "endsolid") {
      end_loop(0);
      is_ended_ = word == "endsolid";
      const std::string name = rest_of_line(lines_);
      if (!is_ended_)
        raw_.parts.push_back(name.empty() ? std::to_string(raw_.parts.size() + 1) : name);
    } else if (word == "vertex") {
      add_corner();
    } else if (word == "endloop") {
      end_loop(3);
    }
  }

  void add_corner() {
    if (corners_ == 3) lines_.fail("a facet of more than 3 corners");
    if (corners_++ == 0) {
      raw_.face_begin.push_back(static_cast<int>(raw_.corners.size()));
      raw_.face_part.push_back(static_cast<int>(raw_.parts.size()) - 1);
    }
    raw_.corners.push_back(static_cast<int>(raw_.points.size()));
    const double x = lines_.number_across(), y = lines_.number_across();
    raw_.points.emplace_back(x, y, lines_.number_across());
  }

  void end_loop(int expected) {
    if (corners_ != expected) lines_.fail("a facet of " + std::to_string(corners_) + " corners");
    corners_ = 0;
  }

  Lines lines_;
  RawFile raw_;
  int corners_ = 0;
  bool is_ended_ = false;
};

bool is_text(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n\v\f");
  if (first == text.npos || text.find('\0') < first + 512) return false;
  return lower(text.substr(first, 5)) == "solid";
}

}  // namespace

RawFile read_stl(const std::string& path, const std::string& bytes) {
  std::uint32_t faces = 0;
  if (bytes.size() >= 84) std::memcpy(&faces, bytes.data() + 80, 4);
  if (bytes.size() >= 84 && bytes.size() == 84 + 50 * std::size_t{faces})
    return read_binary(path, bytes);
  const std::string text = as_text(bytes);
  return is_text(text) ? Text(path, text).read() : read_binary(path, bytes);
}

}  // namespace colod::mesh_io
