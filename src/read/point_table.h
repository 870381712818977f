// Inside room `read` only: tables of points, a row after the other.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats.h"

namespace colod::mesh_io {

constexpr int kExtras = 6;  // columns beside x, y and z that are looked at

/// Where x, y, z, the normal, the colour and the class stand; −1: nowhere.
struct TableColumns {
  std::array<int, 9> of = {0, 1, 2, -1, -1, -1, -1, -1, -1};
  int kind = -1;  ///< of the class

  bool has_colors() const { return of[6] >= 0 && of[7] >= 0 && of[8] >= 0; }
  int last() const { return std::max({of[0], of[1], of[2]}); }
  bool has_normals() const { return of[3] >= 0 && of[4] >= 0 && of[5] >= 0; }
};

struct TableRow {
  Vec3 at;
  std::array<float, kExtras> extra;  ///< what stands beside it, the normal first where one is
                                     ///< named; NaN: nothing
  std::array<float, 3> color{};      ///< as a header names it
  int kind = 0;                      ///< class, as LAS numbers them
  Vec3 vector(int first) const { return {extra[first], extra[first + 1], extra[first + 2]}; }
};

/// Lines → rows. The first of them say what the table is like.
class TableReader {
 public:
  explicit TableReader(bool is_pwn) : is_pwn_(is_pwn) {}

  /// The row of a line that `lines` has moved to; none: a comment, a count, a header. Throws
  /// Error{kInput} naming the line for what is no row.
  std::optional<TableRow> take(const Lines& lines);

  const TableColumns& columns() const { return columns_; }
  bool has_header() const { return header_lines_ > 0; }

 private:
  bool take_header(const std::vector<std::string_view>& fields, const Lines& lines);
  TableRow row_of(const std::vector<std::string_view>& fields, const Lines& lines) const;

  bool is_pwn_, has_rows_ = false;
  char separator_ = ' ';
  int header_lines_ = 0;
  TableColumns columns_;
};

/// What all rows together tell of columns that no header names.
class TableFacts {
 public:
  void add(const TableRow& row);

  /// Where among the extras unit vectors stand: behind the coordinates, or behind an intensity or a
  /// colour; −1: nowhere.
  int first_of_normals() const;
  /// They have no negative value: colours, perhaps.
  bool are_doubtful(int first) const { return !has_negative_[static_cast<std::size_t>(first)]; }
  /// Where three columns of bytes stand that are a colour: behind the coordinates, an intensity or
  /// the normal; −1: nowhere.
  int first_of_colors() const;
  /// Three numbers stand behind the coordinates of the first row.
  bool has_more() const { return has_more_; }
  /// What a full component of a colour that a header names is: 1, 255 or 65535.
  double full_color() const { return brightest_ > 255 ? 65535 : brightest_ > 1 ? 255 : 1; }

 private:
  bool are_bytes(int first) const;

  static constexpr std::size_t kStarts = kExtras - 2;
  std::size_t rows_ = 0;
  std::array<std::size_t, kStarts> units_{};
  std::array<bool, kStarts> has_negative_{}, has_others_{};  // no bytes
  std::array<Vec3, kStarts> least_, most_;
  bool has_more_ = false;
  float brightest_ = 0;
};

}  // namespace colod::mesh_io
