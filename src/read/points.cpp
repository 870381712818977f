// Based on: what programs write as XYZ, PWN, PTS, ASC, CSV and TXT: a point a line.
// Differs: no library. Separators are blanks, commas or semicolons, decimals may have a comma, a
// header line names columns, unit vectors without a negative value are taken for colours until the
// surface says otherwise, and so are three columns of bytes that reach beyond numbers of classes.
#include <algorithm>
#include <array>
#include <cmath>

#include "files.h"
#include "formats.h"
#include "look.h"

namespace colod::mesh_io {

namespace {

constexpr int kMostHeaderLines = 20;
constexpr int kTableRows = 20;           // fewer points are no building
constexpr int kExtras = 6;               // columns beside x, y and z that are looked at
constexpr double kUnitTolerance = 0.02;  // normals may be written with two decimals
constexpr double kUnitShare = 0.99;      // of the rows
constexpr double kMostClass = 31;        // of LAS up to 1.3

using Fields = std::vector<std::string_view>;

std::string_view trimmed(std::string_view s, std::string_view what = " \t\v\f\"'") {
  const std::size_t first = s.find_first_not_of(what);
  if (first == s.npos) return {};
  return s.substr(first, s.find_last_not_of(what) - first + 1);
}

Fields split(std::string_view line, std::string_view separators) {
  Fields fields;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
    fields.push_back(trimmed(line.substr(at, end - at)));
    at = end + 1;
  }
  return fields;
}

Fields split_at_blanks(std::string_view line) {
  Fields fields = split(line, " \t\v\f");
  std::erase_if(fields, [](std::string_view f) { return f.empty(); });
  return fields;
}

/// Commas stand inside of numbers: each blank-separated word has at most one, and not at its ends.
bool has_decimal_commas(std::string_view line) {
  const Fields words = split_at_blanks(line);
  return words.size() >= 3 && std::all_of(words.begin(), words.end(), [](std::string_view w) {
           return !w.starts_with(',') && !w.ends_with(',') &&
                  std::count(w.begin(), w.end(), ',') <= 1;
         });
}

/// ';', ',' or ' ', which stands for blanks.
char separator_of(std::string_view line) {
  if (line.find(';') != line.npos) return ';';
  return line.find(',') != line.npos && !has_decimal_commas(line) ? ',' : ' ';
}

/// Up to a comment; an empty last field is none.
Fields fields_of(std::string_view line, char separator) {
  Fields fields = separator == ' ' ? split_at_blanks(line) : split(line, {&separator, 1});
  const auto comment = std::find_if(fields.begin(), fields.end(), [](std::string_view f) {
    return f.starts_with('#') || f.starts_with("//");
  });
  fields.erase(comment, fields.end());
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
  return fields;
}

/// False: not a number. Nothing at all is NaN.
bool parse(std::string_view field, char separator, double& value) {
  value = NAN;
  if (field.empty()) return true;
  if (separator == ',' || field.find(',') == field.npos) return parse_number(field, value);
  std::string with_point(field);
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return parse_number(with_point, value);
}

double value_or_nan(std::string_view field, char separator) {
  double value;
  return parse(field, separator, value) ? value : NAN;
}

/// Where x, y, z, the normal and the colour stand; −1: nowhere.
struct Columns {
  std::array<int, 9> of = {0, 1, 2, -1, -1, -1, -1, -1, -1};

  bool has_colors() const { return of[6] >= 0 && of[7] >= 0 && of[8] >= 0; }
  int last() const { return std::max({of[0], of[1], of[2]}); }
  bool has_normals() const { return of[3] >= 0 && of[4] >= 0 && of[5] >= 0; }
};

/// By a header's words, where they name all three axes.
Columns columns_of(const Fields& names) {
  static const std::vector<std::string> headings[9] = {
      {"x", "easting", "east", "lon", "longitude", "rechtswert", "coordx", "xcoord"},
      {"y", "northing", "north", "lat", "latitude", "hochwert", "coordy", "ycoord"},
      {"z", "height", "elevation", "altitude", "h", "coordz", "zcoord"},
      {"nx", "normalx", "normal_x"},
      {"ny", "normaly", "normal_y"},
      {"nz", "normalz", "normal_z"},
      {"r", "red"},
      {"g", "green"},
      {"b", "blue"}};
  Columns found{{-1, -1, -1, -1, -1, -1, -1, -1, -1}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string name = lower(std::string(trimmed(names[i], " \t/\"'")));
    name = name.substr(0, name.find_first_of("([ "));  // units behind it
    for (std::size_t k = 0; k < 9; ++k)
      if (found.of[k] < 0 && std::count(headings[k].begin(), headings[k].end(), name) > 0)
        found.of[k] = static_cast<int>(i);
  }
  const bool is_complete = found.of[0] >= 0 && found.of[1] >= 0 && found.of[2] >= 0;
  return is_complete ? found : Columns{};
}

bool is_row(const Fields& fields, char separator, const Columns& columns) {
  if (static_cast<int>(fields.size()) <= columns.last()) return false;
  for (int k = 0; k < 3; ++k) {
    double value;
    if (!parse(fields[columns.of[k]], separator, value)) return false;
  }
  return true;
}

bool is_count(const Fields& fields) {
  return fields.size() == 1 && !fields[0].empty() &&
         fields[0].find_first_not_of("0123456789") == std::string_view::npos;
}

/// A table while it is read.
class Table {
 public:
  Table(const std::string& path, const std::string& text, bool is_pwn)
      : lines_(path, text), is_pwn_(is_pwn) {
    raw_.remarks = head_remarks(text);
  }

  RawFile read() {
    while (lines_.next()) take(lines_.rest());
    if (raw_.points.empty()) lines_.fail("no line holds the three numbers of a point");
    if (columns_.has_normals() || is_pwn_)
      set_normals(0);
    else
      find_normals();
    find_colors();
    if (is_without_normals_ && raw_.point_colors.empty())
      raw_.warnings.push_back("columns 4 to 6 are no unit normals and were left out");
    return std::move(raw_);
  }

 private:
  void take(std::string_view line) {
    if (raw_.points.empty()) separator_ = separator_of(line);
    const Fields fields = fields_of(line, separator_);
    if (fields.empty() || is_count(fields)) return;
    if (raw_.points.empty() && !is_row(fields, separator_, columns_)) return take_header(fields);
    take_row(fields);
  }

  void take_header(const Fields& fields) {
    if (lower(std::string(fields[0])) == "ncols")
      lines_.fail(
          "this is a grid, not points: `gdal_translate -of XYZ IN.asc OUT.xyz` converts it");
    double value;
    const bool has_words = std::any_of(fields.begin(), fields.end(), [&](std::string_view f) {
      return !parse(f, separator_, value);
    });
    if (!has_words || ++header_lines_ > kMostHeaderLines) return take_row(fields);
    columns_ = columns_of(fields);
  }

  void take_row(const Fields& fields) {
    const std::size_t needed = is_pwn_ ? 6 : static_cast<std::size_t>(columns_.last()) + 1;
    if (fields.size() < needed)
      lines_.fail("a point needs " + std::to_string(needed) + " numbers, found " +
                  std::to_string(fields.size()));
    double v[3];
    for (int k = 0; k < 3; ++k)
      if (const std::string_view f = fields[columns_.of[k]]; !parse(f, separator_, v[k]))
        lines_.fail("'" + std::string(f.substr(0, 40)) + "' is not a number");
    raw_.points.emplace_back(v[0], v[1], v[2]);
    std::array<float, kExtras> extra;
    const int first = columns_.has_normals() ? columns_.of[3] : columns_.last() + 1;
    for (int k = 0; k < kExtras; ++k) {
      const int at = columns_.has_normals() && k < 3 ? columns_.of[3 + k] : first + k;
      const bool is_there = at < static_cast<int>(fields.size());
      extra[k] = is_there ? static_cast<float>(value_or_nan(fields[at], separator_)) : NAN;
    }
    extras_.push_back(extra);
    if (columns_.has_colors()) take_color(fields);
  }

  /// As the header names its columns.
  void take_color(const Fields& fields) {
    std::array<float, 3> color{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(columns_.of[6 + k]);
      if (at < fields.size()) color[k] = static_cast<float>(value_or_nan(fields[at], separator_));
    }
    named_colors_.push_back(color);
  }

  Vec3 vector(std::size_t row, int first) const {
    const auto& e = extras_[row];
    return {e[first], e[first + 1], e[first + 2]};
  }

  void set_normals(int first) {
    for (std::size_t i = 0; i < extras_.size(); ++i) raw_.normals.push_back(vector(i, first));
  }

  /// The columns behind the coordinates, or behind an intensity or a colour, that are unit vectors.
  void find_normals() {
    for (const int first : {0, 3, 1}) {
      std::size_t units = 0;
      bool has_negative = false;
      for (std::size_t i = 0; i < extras_.size(); ++i) {
        const Vec3 n = vector(i, first);
        units += std::abs(n.norm() - 1) < kUnitTolerance;
        has_negative = has_negative || n.minCoeff() < 0;
      }
      if (static_cast<double>(units) < kUnitShare * static_cast<double>(extras_.size())) continue;
      raw_.has_doubtful_normals = !has_negative;
      return set_normals(first);
    }
    is_without_normals_ = header_lines_ == 0 && vector(0, 0).allFinite();
  }

  /// Colours by name, of 0..1, bytes or 16 bits by the largest of them all; else the first three
  /// columns of bytes: behind the coordinates, an intensity or the normal.
  void find_colors() {
    if (named_colors_.size() == raw_.points.size()) {
      float most = 0;
      for (const auto& c : named_colors_) most = std::max({most, c[0], c[1], c[2]});
      const double one = most > 255 ? 65535 : most > 1 ? 255 : 1;
      for (const auto& c : named_colors_)
        raw_.point_colors.push_back(rgb_of(c[0] / one, c[1] / one, c[2] / one));
      return;
    }
    for (const int first : {0, 1, 3}) {
      if (!are_bytes(first)) continue;
      for (std::size_t i = 0; i < extras_.size(); ++i) {
        const Vec3 c = vector(i, first) / 255;
        raw_.point_colors.push_back(rgb_of(c[0], c[1], c[2]));
      }
      return;
    }
  }

  /// Classes, returns and users' bits are small numbers; of a colour some component is not, and
  /// each of its own columns varies.
  bool are_bytes(int first) const {
    Vec3 least = Vec3::Constant(INFINITY), most = Vec3::Constant(-INFINITY);
    for (std::size_t i = 0; i < extras_.size(); ++i) {
      const Vec3 v = vector(i, first);
      if (!(v.array() >= 0).all() || !(v.array() <= 255).all() || v != v.array().floor().matrix())
        return false;
      least = least.cwiseMin(v), most = most.cwiseMax(v);
    }
    return (most.array() > kMostClass).all() && (most.array() > least.array()).all();
  }

  Lines lines_;
  bool is_pwn_;
  char separator_ = ' ';
  int header_lines_ = 0;
  Columns columns_;
  bool is_without_normals_ = false;
  std::vector<std::array<float, kExtras>> extras_;
  std::vector<std::array<float, 3>> named_colors_;  // one a point, where a header names them
  RawFile raw_;
};

}  // namespace

bool is_point_table(const std::string& head) {
  Lines lines("", head);
  Columns columns;
  int rows = 0, others = 0;
  while (rows < kTableRows && others < kMostHeaderLines && lines.next()) {
    const char separator = separator_of(lines.rest());
    const Fields fields = fields_of(lines.rest(), separator);
    if (fields.empty() || is_count(fields)) continue;
    if (is_row(fields, separator, columns)) {
      ++rows;
    } else {
      if (rows > 0 || lower(std::string(fields[0])) == "ncols") return false;
      columns = columns_of(fields), ++others;
    }
  }
  return rows >= kTableRows;
}

RawFile read_points(const std::string& path, const std::string& bytes, bool is_pwn) {
  return Table(path, bytes, is_pwn).read();
}

}  // namespace colod::mesh_io
