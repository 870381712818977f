// Based on: what programs write as XYZ, PWN, PTS, ASC, CSV and TXT: a point a line.
// Differs: no library. Separators are blanks, commas or semicolons, decimals may have a comma, a
// header line names columns, unit vectors without a negative value are taken for colours until the
// surface says otherwise, and so are three columns of bytes that reach beyond numbers of classes.
#include "point_table.h"

#include <algorithm>
#include <cmath>

#include "files.h"

namespace colod::mesh_io {

namespace {

using Fields = std::vector<std::string_view>;

constexpr int kMostHeaderLines = 20;
constexpr int kTableRows = 20;           // fewer points are no building
constexpr double kUnitTolerance = 0.02;  // normals may be written with two decimals
constexpr double kUnitShare = 0.99;      // of the rows
constexpr double kMostClass = 31;        // of LAS up to 1.3

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

/// By a header's words, where they name all three axes.
std::optional<TableColumns> columns_of(const Fields& names) {
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
  static const std::vector<std::string> classes = {"classification", "class",
                                                   "scalar_classification"};
  TableColumns found;
  found.of.fill(-1);
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string name = lower(std::string(trimmed(names[i], " \t/\"'")));
    name = name.substr(0, name.find_first_of("([ "));  // units behind it
    for (std::size_t k = 0; k < 9; ++k)
      if (found.of[k] < 0 && std::count(headings[k].begin(), headings[k].end(), name) > 0)
        found.of[k] = static_cast<int>(i);
    if (found.kind < 0 && std::count(classes.begin(), classes.end(), name) > 0)
      found.kind = static_cast<int>(i);
  }
  const bool is_complete = found.of[0] >= 0 && found.of[1] >= 0 && found.of[2] >= 0;
  return is_complete ? std::optional(found) : std::nullopt;
}

bool is_row(const Fields& fields, char separator, const TableColumns& columns) {
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

}  // namespace

int class_number(double value) { return value >= 0 && value <= 255 ? static_cast<int>(value) : 0; }

std::optional<TableRow> TableReader::take(const Lines& lines) {
  const std::string_view line = lines.rest();
  if (!has_rows_) separator_ = separator_of(line);
  const Fields fields = fields_of(line, separator_);
  if (fields.empty() && !has_rows_ && line.starts_with("//"))  // as CloudCompare names columns
    columns_ = columns_of(fields_of(line.substr(2), separator_)).value_or(columns_);
  if (fields.empty() || is_count(fields)) return {};
  if (!has_rows_ && !is_row(fields, separator_, columns_) && take_header(fields, lines)) return {};
  has_rows_ = true;
  return row_of(fields, lines);
}

bool TableReader::take_header(const Fields& fields, const Lines& lines) {
  if (lower(std::string(fields[0])) == "ncols")
    lines.fail("this is a grid, not points: `gdal_translate -of XYZ IN.asc OUT.xyz` converts it");
  double value;
  const bool has_words = std::any_of(fields.begin(), fields.end(), [&](std::string_view f) {
    return !parse(f, separator_, value);
  });
  if (!has_words || ++header_lines_ > kMostHeaderLines) return false;
  columns_ = columns_of(fields).value_or(TableColumns());
  return true;
}

TableRow TableReader::row_of(const Fields& fields, const Lines& lines) const {
  const std::size_t needed = is_pwn_ ? 6 : static_cast<std::size_t>(columns_.last()) + 1;
  if (fields.size() < needed)
    lines.fail("a point needs " + std::to_string(needed) + " numbers, found " +
               std::to_string(fields.size()));
  TableRow row;
  for (int k = 0; k < 3; ++k)
    if (const std::string_view f = fields[columns_.of[k]]; !parse(f, separator_, row.at[k]))
      lines.fail("'" + std::string(f.substr(0, 40)) + "' is not a number");
  const auto number = [&](int at) {
    const bool is_there = at >= 0 && at < static_cast<int>(fields.size());
    return is_there ? static_cast<float>(value_or_nan(fields[at], separator_)) : NAN;
  };
  const int first = columns_.has_normals() ? columns_.of[3] : columns_.last() + 1;
  for (int k = 0; k < kExtras; ++k)
    row.extra[k] = number(columns_.has_normals() && k < 3 ? columns_.of[3 + k] : first + k);
  if (columns_.has_colors())
    for (int k = 0; k < 3; ++k) {
      const int at = columns_.of[6 + k];
      row.color[k] = at < static_cast<int>(fields.size()) ? number(at) : 0.0f;
    }
  if (columns_.kind >= 0) row.kind = class_number(number(columns_.kind));
  return row;
}

void TableFacts::add(const TableRow& row) {
  if (rows_++ == 0) {
    has_more_ = row.vector(0).allFinite();
    least_.fill(Vec3::Constant(INFINITY)), most_.fill(Vec3::Constant(-INFINITY));
  }
  for (std::size_t first = 0; first < kStarts; ++first) {
    const Vec3 v = row.vector(static_cast<int>(first));
    units_[first] += std::abs(v.norm() - 1) < kUnitTolerance;
    has_negative_[first] |= v.minCoeff() < 0;
    has_others_[first] |=
        !(v.array() >= 0).all() || !(v.array() <= 255).all() || v != v.array().floor().matrix();
    least_[first] = least_[first].cwiseMin(v), most_[first] = most_[first].cwiseMax(v);
  }
  brightest_ = std::max({brightest_, row.color[0], row.color[1], row.color[2]});
}

int TableFacts::first_of_normals() const {
  for (const int first : {0, 3, 1})
    if (static_cast<double>(units_[static_cast<std::size_t>(first)]) >=
        kUnitShare * static_cast<double>(rows_))
      return first;
  return -1;
}

/// Classes, returns and users' bits are small numbers; of a colour some component is not, and each
/// of its own columns varies.
bool TableFacts::are_bytes(int first) const {
  const auto i = static_cast<std::size_t>(first);
  return !has_others_[i] && (most_[i].array() > kMostClass).all() &&
         (most_[i].array() > least_[i].array()).all();
}

int TableFacts::first_of_colors() const {
  for (const int first : {0, 1, 3})
    if (are_bytes(first)) return first;
  return -1;
}

bool is_point_table(const std::string& head) {
  Lines lines("", head);
  TableColumns columns;
  int rows = 0, others = 0;
  while (rows < kTableRows && others < kMostHeaderLines && lines.next()) {
    const char separator = separator_of(lines.rest());
    const Fields fields = fields_of(lines.rest(), separator);
    if (fields.empty() || is_count(fields)) continue;
    if (is_row(fields, separator, columns)) {
      ++rows;
    } else {
      if (rows > 0 || lower(std::string(fields[0])) == "ncols") return false;
      columns = columns_of(fields).value_or(TableColumns()), ++others;
    }
  }
  return rows >= kTableRows;
}

}  // namespace colod::mesh_io
