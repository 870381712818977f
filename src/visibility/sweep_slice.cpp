// Based on: sweep.cpp.
// Differs: –
// Notation: as in sweep.cpp.
#include "sweep_slice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace colod::casting {
namespace {

/// Of a plane's pieces in a slice: those that are off its common line by more than the rounding of
/// corners explains, in units of the box's radius, are not joined.
constexpr double kStraight = 0x1p-20;
/// Segments that cross at a flat angle are that near for long: the least sine looked after.
constexpr double kFlattest = 0.1;

/// One triangle's cut, along and across the plane's line.
struct Cut {
  double low, high;
  std::array<double, 2> from, to;
};

/// Where the edge between two corners below and above z crosses it. The lower corner comes first,
/// so that both triangles of an edge get the same point.
std::array<double, 2> cross(const std::array<float, 3>& below, const std::array<float, 3>& above,
                            double z) {
  const double t = (z - below[2]) / (static_cast<double>(above[2]) - below[2]);
  return {below[0] + t * (static_cast<double>(above[0]) - below[0]),
          below[1] + t * (static_cast<double>(above[1]) - below[1])};
}

/// Both ends of the triangle's cut at z; false where it does not reach both sides.
bool cut_triangle(const std::array<float, 3>* corner, double z,
                  std::array<std::array<double, 2>, 2>& ends) {
  int count = 0;
  for (int i = 0; i < 3; ++i) {
    const auto &a = corner[i], &b = corner[(i + 1) % 3];
    if ((a[2] < z) == (b[2] < z)) continue;
    ends[count++] = a[2] < z ? cross(a, b, z) : cross(b, a, z);
  }
  return count == 2;
}

/// Appends one plane's cuts as segments; those that touch or overlap on one line become one.
void join_cuts(std::vector<Cut>& cuts, const std::array<double, 2>& normal, double straight,
               int plane, std::vector<Segment>& out) {
  std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) {
    return std::pair(a.low, a.high) < std::pair(b.low, b.high);
  });
  const auto off = [&](const std::array<double, 2>& p) {
    return normal[0] * p[0] + normal[1] * p[1];
  };
  for (std::size_t i = 0; i < cuts.size();) {
    Cut joined = cuts[i];
    double least = std::min(off(joined.from), off(joined.to));
    double most = std::max(off(joined.from), off(joined.to));
    for (++i; i < cuts.size() && cuts[i].low <= joined.high; ++i) {
      const double from = off(cuts[i].from), to = off(cuts[i].to);
      if (std::max({most, from, to}) - std::min({least, from, to}) > straight) break;
      least = std::min({least, from, to}), most = std::max({most, from, to});
      if (cuts[i].high > joined.high) joined.high = cuts[i].high, joined.to = cuts[i].to;
    }
    out.push_back({joined.from[0], joined.from[1], joined.to[0], joined.to[1], plane});
  }
}

/// Where two segments cross, or come so near that a ray could take one end for the other's side.
void add_crossings(Slice& slice, double reach) {
  const auto turn = [](const Segment& g, double x, double y) {
    return ((g.x1 - g.x0) * (y - g.y0) - (g.y1 - g.y0) * (x - g.x0)) /
           std::hypot(g.x1 - g.x0, g.y1 - g.y0);
  };
  for (std::size_t i = 0; i < slice.segments.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Segment &g = slice.segments[i], &h = slice.segments[j];
      const double a = turn(g, h.x0, h.y0), b = turn(g, h.x1, h.y1);
      if (std::min(a, b) > reach || std::max(a, b) < -reach || !(a != b)) continue;
      const double c = turn(h, g.x0, g.y0), d = turn(h, g.x1, g.y1);
      if (std::min(c, d) > reach || std::max(c, d) < -reach) continue;
      const double t = std::clamp(a / (a - b), 0.0, 1.0);
      const double sine = std::abs(a - b) / std::hypot(h.x1 - h.x0, h.y1 - h.y0);
      slice.corners.push_back(
          {h.x0 + t * (h.x1 - h.x0), h.y0 + t * (h.y1 - h.y0), reach / std::max(sine, kFlattest)});
    }
}

}  // namespace

Slice cut_slice(const Job& job, double z, double reach, double diagonal) {
  Slice slice;
  std::vector<Cut> cuts;
  const Soup& soup = job.soup;
  std::array<std::array<double, 2>, 2> ends;
  for (std::size_t i = 0; i < soup.plane_of_triangle.size();) {
    const int plane = soup.plane_of_triangle[i];
    const auto& n = job.normal[plane];
    const double length = std::hypot(n[0], n[1]);
    cuts.clear();
    bool is_touched = false;  // at a corner, as near as single precision sees
    for (; i < soup.plane_of_triangle.size() && soup.plane_of_triangle[i] == plane; ++i) {
      for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
        if (std::abs(soup.corners[c][2] - z) <= reach) {
          slice.corners.push_back({soup.corners[c][0], soup.corners[c][1], reach});
          is_touched = true;
        }
      if (!cut_triangle(&soup.corners[3 * i], z, ends)) continue;
      const auto on_line = [&](const std::array<double, 2>& p) {
        return n[0] * p[1] - n[1] * p[0];
      };
      double low = on_line(ends[0]), high = on_line(ends[1]);
      if (low > high) std::swap(low, high), std::swap(ends[0], ends[1]);
      cuts.push_back({low, high, ends[0], ends[1]});
    }
    if (cuts.empty() && !is_touched) continue;
    // What `normal` times a point rounds by: the steeper the plane, the more of it is length.
    const double straight = kStraight * 0.5 * diagonal * std::max(length, 1e-3);
    join_cuts(cuts, n, straight, static_cast<int>(slice.planes.size()), slice.segments);
    slice.planes.push_back(plane);
  }
  for (const Segment& g : slice.segments)
    slice.corners.insert(slice.corners.end(), {{g.x0, g.y0, reach}, {g.x1, g.y1, reach}});
  add_crossings(slice, reach);
  return slice;
}

}  // namespace colod::casting
