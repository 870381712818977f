// Based on: what programs write as XYZ, PWN, PTS, ASC, CSV and TXT, see point_table.cpp.
#include "look.h"
#include "point_table.h"

namespace colod::mesh_io {

namespace {

/// Normals and colours that the rows have, by name or by what all of them tell.
void set_extras(const std::vector<TableRow>& rows, const TableReader& table,
                const TableFacts& facts, bool is_pwn, RawFile& raw) {
  const bool is_named = table.columns().has_normals() || is_pwn;
  const int normals = is_named ? 0 : facts.first_of_normals();
  if (normals >= 0)
    for (const TableRow& row : rows) raw.normals.push_back(row.vector(normals));
  raw.has_doubtful_normals = !is_named && normals >= 0 && facts.are_doubtful(normals);
  const int colors = facts.first_of_colors();
  if (table.columns().has_colors()) {
    const double one = facts.full_color();
    for (const TableRow& row : rows)
      raw.point_colors.push_back(
          rgb_of(row.color[0] / one, row.color[1] / one, row.color[2] / one));
  } else if (colors >= 0) {
    for (const TableRow& row : rows) {
      const Vec3 c = row.vector(colors) / 255;
      raw.point_colors.push_back(rgb_of(c[0], c[1], c[2]));
    }
  }
  if (normals < 0 && !table.has_header() && facts.has_more() && raw.point_colors.empty())
    raw.warnings.push_back("columns 4 to 6 are no unit normals and were left out");
}

}  // namespace

RawFile read_points(const std::string& path, const std::string& bytes, bool is_pwn) {
  RawFile raw;
  raw.remarks = head_remarks(bytes);
  Lines lines(path, bytes);
  TableReader table(is_pwn);
  TableFacts facts;
  std::vector<TableRow> rows;
  while (lines.next())
    if (const auto row = table.take(lines)) facts.add(*row), rows.push_back(*row);
  if (rows.empty()) lines.fail("no line holds the three numbers of a point");
  for (const TableRow& row : rows) raw.points.push_back(row.at);
  set_extras(rows, table, facts, is_pwn, raw);
  return raw;
}

}  // namespace colod::mesh_io
