// Based on: what programs write as XYZ, PWN, PTS, ASC, CSV and TXT, see point_table.cpp.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "blocks.h"
#include "files.h"
#include "point_table.h"
#include "streams.h"

namespace colod::mesh_io {

namespace {

constexpr std::size_t kTableHead = 4096;  // bytes: twenty rows and more

/// A table that is read as often as asked for.
struct TableFile {
  std::string path;
  bool is_pwn = false;
  std::uint64_t begin = 0;  // behind a byte order mark
  std::string text;         // of a file in UTF-16, which is turned as a whole; else empty

  TableFile(const std::string& file, const ReadOptions& options)
      : path(file), is_pwn(lower(std::filesystem::path(file).extension().string()) == ".pwn") {
    const std::string head = file_head(path, kTableHead);
    if (head.starts_with("\xEF\xBB\xBF")) begin = 3;
    if (head.starts_with("\xFF\xFE") || head.starts_with("\xFE\xFF"))
      text = as_text(read_bytes(path, options.input_memory));
  }

  template <typename Take>
  TableReader visit(Take take) const {
    TableReader table(is_pwn);
    int before = 0;
    const auto read = [&](std::string_view data) {
      Lines lines(path, data, before);
      while (lines.next())
        if (const auto row = table.take(lines)) take(*row);
      before = lines.line_number();
    };
    if (!text.empty()) return read(text), table;
    Blocks blocks(path, begin, true);
    for (std::string_view data; blocks.next(data); data = {}) read(data);
    return table;
  }
};

/// How a row's colour is told; −1: it has none.
struct TableColors {
  bool is_named = false;
  int first = -1;
  double one = 255;

  std::array<std::uint16_t, 3> of(const TableRow& row) const {
    std::array<std::uint16_t, 3> out{};
    if (!is_named && first < 0) return out;
    for (std::size_t k = 0; k < 3; ++k) {
      const double v = is_named ? row.color[k] : row.extra[static_cast<std::size_t>(first) + k];
      const double byte = std::isfinite(v) ? 255 * v / one : 0;
      out[k] = static_cast<std::uint16_t>(std::lround(std::clamp(byte, 0.0, 255.0)));
    }
    return out;
  }
};

}  // namespace

bool is_table_file(const std::string& path) {
  return is_point_table(as_text(file_head(path, kTableHead)));
}

PointStream stream_table(const std::string& path, const ReadOptions& options) {
  const TableFile file(path, options);
  TableFacts facts;
  std::size_t rows = 0;
  const TableReader table = file.visit([&](const TableRow& row) { facts.add(row), ++rows; });
  if (rows == 0) fail(path, "no line holds the three numbers of a point");
  TableColors colors;
  colors.is_named = table.columns().has_colors();
  if (!colors.is_named) colors.first = facts.first_of_colors();
  if (colors.is_named) colors.one = facts.full_color();
  PointStream out;
  out.unit = Vec3::Constant(options.unit.value_or(1));
  out.has_color = colors.is_named || colors.first >= 0;
  out.visit = [file, colors](const TakePoint& take) {
    file.visit([&](const TableRow& row) { take({row.at, row.kind, colors.of(row)}); });
  };
  return out;
}

}  // namespace colod::mesh_io
