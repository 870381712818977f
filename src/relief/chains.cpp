// Based on: borders of labelled images as a planar graph. Differs: – . Notation: a corner is one of
// the grid's; its four edges go right, up, left, down.
#include "chains.h"

#include <array>
#include <optional>

namespace colod::relief {
namespace {

class Tracer {
 public:
  Tracer(const Field& field, const std::vector<int>& label)
      : f_(field), label_(label), columns_(field.columns + 1), is_done_(4 * corners(), 0) {}

  std::vector<Chain> run() {
    for (int corner = 0; corner < corners(); ++corner)
      if (is_junction(corner))
        for (int way = 0; way < 4; ++way) trace(corner, way);
    for (int corner = 0; corner < corners(); ++corner)
      for (int way = 0; way < 4; ++way) trace(corner, way);
    return std::move(chains_);
  }

 private:
  int corners() const { return (f_.columns + 1) * (f_.rows + 1); }
  int label(int column, int row) const {
    const bool is_in = column >= 0 && row >= 0 && column < f_.columns && row < f_.rows;
    return is_in ? label_[row * f_.columns + column] : kOutside;
  }
  /// Labels left and right of the edge that leaves the corner; none: there is no border.
  std::optional<std::array<int, 2>> sides(int corner, int way) const {
    const int c = corner % columns_, r = corner / columns_;
    const std::array<std::array<int, 4>, 4> cells{
        {{c, r, c, r - 1}, {c - 1, r, c, r}, {c - 1, r - 1, c - 1, r}, {c, r - 1, c - 1, r - 1}}};
    const auto& at = cells[way];
    const int left = label(at[0], at[1]), right = label(at[2], at[3]);
    if (left == right) return std::nullopt;
    return std::array{left, right};
  }
  int beyond(int corner, int way) const {
    return corner + std::array{1, columns_, -1, -columns_}[way];
  }
  int degree(int corner) const {
    int n = 0;
    for (int way = 0; way < 4; ++way) n += sides(corner, way).has_value();
    return n;
  }
  bool is_junction(int corner) const {
    const int n = degree(corner);
    return n != 0 && n != 2;
  }
  Vec2 place(int corner) const {
    return f_.origin + f_.cell * Vec2(corner % columns_, corner / columns_);
  }

  void trace(int corner, int way) {
    const auto labels = sides(corner, way);
    if (!labels || is_done_[4 * corner + way]) return;
    Chain chain{(*labels)[0], (*labels)[1], {place(corner)}, corner, corner};
    while (true) {
      is_done_[4 * corner + way] = 1;
      corner = beyond(corner, way);
      is_done_[4 * corner + (way + 2) % 4] = 1;
      chain.points.push_back(place(corner));
      if (is_junction(corner) || corner == chain.first) break;
      const int back = (way + 2) % 4;
      for (int next = 0; next < 4; ++next)
        if (next != back && sides(corner, next)) {
          way = next;
          break;
        }
    }
    chain.last = corner;
    chains_.push_back(std::move(chain));
  }

  const Field& f_;
  const std::vector<int>& label_;
  int columns_;
  std::vector<char> is_done_;  // per corner and way
  std::vector<Chain> chains_;
};

}  // namespace

std::vector<Chain> trace_chains(const Field& field, const std::vector<int>& label) {
  return Tracer(field, label).run();
}

}  // namespace colod::relief
