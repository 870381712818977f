// Inside room `bake` only: which places of a row lie in a convex shape.
#pragma once

#include <algorithm>

namespace colod::bake {

/// Places begin … end − 1 of a row.
struct Span {
  int begin, end;

  /// Keeps those where base + slope · x is no less than 0, and at most two beyond them.
  void narrow(double base, double slope) {
    constexpr double kLevel = 1e-9;  // slopes below it say nothing of a row's places
    constexpr double kFar = 1e6;     // what an int holds
    if (slope > -kLevel && slope < kLevel) return;
    const int border = static_cast<int>(std::clamp(-base / slope, -kFar, kFar));
    if (slope > 0)
      begin = std::max(begin, border - 1);
    else
      end = std::min(end, border + 2);
  }

  /// Lets go of the places at both ends for which `holds` does not hold.
  template <typename Holds>
  void shrink(const Holds& holds) {
    while (begin < end && !holds(begin)) ++begin;
    while (begin < end && !holds(end - 1)) --end;
  }
};

}  // namespace colod::bake
