// Based on: regularised footprints on few directions and lines (Bauchet & Lafarge, "KIPPI", CVPR
// 2018, gathers segments so). Differs: pieces are gathered greedily, longest first. Notation: –
#include "borders.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

#include "chains.h"
#include "core/flat.h"
#include "parameters.h"

namespace colod::relief {
namespace {

using namespace parameters::relief;

constexpr double kQuarter = std::numbers::pi / 2;

/// A piece before it lies on its line.
struct Rough {
  int chain = -1;
  std::vector<Vec2> points;
  Vec2 normal = Vec2::UnitX();  ///< to its right
  double length = 0;
  int line = -1;

  Vec2 middle() const {
    Vec2 sum = Vec2::Zero();
    for (const Vec2& p : points) sum += p / static_cast<double>(points.size());
    return sum;
  }
};

double off_chord(const Vec2& p, const Vec2& a, const Vec2& b) {
  const double length = (b - a).norm();
  return length > 0 ? std::abs(cross(b - a, p - a)) / length : (p - a).norm();
}

/// Where the chain is cut into straight pieces: places of its points, both ends included.
std::vector<int> cuts_of(const Chain& chain, double tolerance) {
  const int last = static_cast<int>(chain.points.size()) - 1;
  const auto off = [&](int i, int a, int b) {
    return off_chord(chain.points[i], chain.points[a], chain.points[b]);
  };
  std::vector<int> cuts{0};
  int from = 0;
  if (chain.first == chain.last) {  // a loop has no chord: its farthest point is a corner
    for (int i = 1; i < last; ++i)
      if ((chain.points[i] - chain.points[0]).norm() >
          (chain.points[from] - chain.points[0]).norm())
        from = i;
    const std::vector<int> kept = corners_between(0, from, tolerance, off);
    cuts.insert(cuts.end(), kept.begin(), kept.end());
    cuts.push_back(from);
  }
  const std::vector<int> kept = corners_between(from, last, tolerance, off);
  cuts.insert(cuts.end(), kept.begin(), kept.end());
  cuts.push_back(last);
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  return cuts;
}

/// A loop begins where it turns: at the point farthest from its middle.
Chain started_at_corner(Chain chain) {
  if (chain.first != chain.last || chain.points.size() < 3) return chain;
  chain.points.pop_back();
  Vec2 middle = Vec2::Zero();
  for (const Vec2& p : chain.points) middle += p / static_cast<double>(chain.points.size());
  const auto farthest =
      std::max_element(chain.points.begin(), chain.points.end(), [&](const Vec2& a, const Vec2& b) {
        return (a - middle).squaredNorm() < (b - middle).squaredNorm() - 1e-9;
      });
  std::rotate(chain.points.begin(), farthest, chain.points.end());
  chain.points.push_back(chain.points.front());
  return chain;
}

/// A loop that begins amid its longest piece: no corner is at its end.
Chain started_amid_wall(Chain chain, double tolerance) {
  if (chain.first != chain.last || chain.points.size() < 3) return chain;
  chain = started_at_corner(std::move(chain));
  const std::vector<int> cuts = cuts_of(chain, tolerance);
  int longest = 0;
  for (int k = 0; k + 1 < static_cast<int>(cuts.size()); ++k)
    if (cuts[k + 1] - cuts[k] > cuts[longest + 1] - cuts[longest]) longest = k;
  chain.points.pop_back();
  const int start = (cuts[longest] + cuts[longest + 1]) / 2;
  std::rotate(chain.points.begin(), chain.points.begin() + start, chain.points.end());
  chain.points.push_back(chain.points.front());
  return chain;
}

std::vector<Chain> chains_of(const Field& field, const Labels& labels, double tolerance) {
  std::vector<Chain> chains = trace_chains(field, labels.of_cell);
  for (Chain& c : chains) c = started_amid_wall(std::move(c), tolerance);
  return chains;
}

std::vector<Rough> rough_pieces(const std::vector<Chain>& chains, double tolerance) {
  std::vector<Rough> pieces;
  for (std::size_t c = 0; c < chains.size(); ++c) {
    const std::vector<int> cuts = cuts_of(chains[c], tolerance);
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
      Rough r;
      r.chain = static_cast<int>(c);
      r.points.assign(chains[c].points.begin() + cuts[k],
                      chains[c].points.begin() + cuts[k + 1] + 1);
      const Vec2 along = r.points.back() - r.points.front();
      r.length = along.norm();
      if (r.length > 0) r.normal = Vec2(along.y(), -along.x()) / r.length;
      pieces.push_back(std::move(r));
    }
  }
  return pieces;
}

/// The direction, [0, π/2), that most length follows, square to it included.
std::optional<double> main_direction(const std::vector<Rough>& pieces, double least) {
  constexpr int kSteps = 180;
  double best = least;
  std::optional<double> direction;
  for (int s = 0; s < kSteps; ++s) {
    const double angle = kQuarter * s / kSteps;
    double sum = 0;
    for (const Rough& r : pieces) {
      if (r.line >= 0) continue;  // it follows another direction already
      const double off =
          std::remainder(std::atan2(r.normal.y(), r.normal.x()) - angle, kQuarter) / kSpread;
      sum += r.length * std::exp(-0.5 * off * off);
    }
    if (sum > best + 1e-9) best = sum, direction = angle;
  }
  return direction;
}

/// Metres and normals: pieces that follow a direction get it exactly.
void follow(double direction, double within, double tolerance, std::vector<Rough>& pieces) {
  for (Rough& r : pieces) {
    if (r.line >= 0) continue;
    const double angle = std::atan2(r.normal.y(), r.normal.x());
    const double off = std::remainder(angle - direction, kQuarter);
    const bool is_short =
        r.length < kShortPiece || r.length * std::abs(std::sin(off)) < kAside * tolerance;
    if (std::abs(off) > (is_short ? 2 * within : within)) continue;
    r.normal = {std::cos(angle - off), std::sin(angle - off)};
    r.line = 0;
  }
}

/// A short piece across the directions is what cells and melting make of a corner, or of a step: it
/// goes between neighbours that meet at right angles, and else stands square to one of them.
void square_short(double direction, double most, std::vector<Rough>& pieces) {
  const auto neighbour = [&](std::size_t k, int way) -> const Rough* {
    const std::size_t n = k + way;
    const bool is_one = n < pieces.size() && pieces[n].chain == pieces[k].chain;
    return is_one && pieces[n].line >= 0 ? &pieces[n] : nullptr;
  };
  std::vector<Rough> kept;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    Rough r = pieces[k];
    if (r.line < 0 && r.length < most) {
      const Rough *a = neighbour(k, -1), *b = neighbour(k, 1);
      if (a && b && std::abs(a->normal.dot(b->normal)) < kParallel) continue;
      const Rough* beside = a ? a : b;
      const Vec2 along = beside ? Vec2(-beside->normal.y(), beside->normal.x())
                                : Vec2(std::cos(direction), std::sin(direction));
      const bool is_square = beside || std::abs(along.dot(r.normal)) > std::sqrt(0.5);
      const Vec2 normal = is_square ? along : Vec2(-along.y(), along.x());
      r.normal = normal.dot(r.normal) < 0 ? Vec2(-normal) : normal;
      r.line = 0;
    }
    kept.push_back(std::move(r));
  }
  std::swap(pieces, kept);
}

/// Parallel pieces within `tolerance` share a line; long ones say where it is.
std::vector<Line> gather(double tolerance, std::vector<Rough>& pieces) {
  std::vector<int> order(pieces.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return pieces[a].length > pieces[b].length; });
  std::vector<Line> lines;
  std::vector<double> weight;
  for (const int i : order) {
    Rough& r = pieces[i];
    r.line = -1;
    double nearest = tolerance;
    for (std::size_t l = 0; l < lines.size(); ++l) {
      if (std::abs(cross(lines[l].normal, r.normal)) > kParallel) continue;
      const double off = std::abs(lines[l].normal.dot(r.middle()) - lines[l].offset);
      if (off < nearest) nearest = off, r.line = static_cast<int>(l);
    }
    if (r.line < 0) {
      r.line = static_cast<int>(lines.size());
      lines.push_back({r.normal, r.normal.dot(r.middle())});
      weight.push_back(0);
    }
    Line& line = lines[r.line];
    const double sum = weight[r.line] + r.length;
    if (sum > 0) line.offset += (line.normal.dot(r.middle()) - line.offset) * r.length / sum;
    weight[r.line] = sum;
  }
  return lines;
}

std::optional<Vec2> crossing(const Line& a, const Line& b) {
  const double sine = cross(a.normal, b.normal);
  if (std::abs(sine) < kLeastSine) return std::nullopt;
  return Vec2(a.offset * b.normal.y() - b.offset * a.normal.y(),
              b.offset * a.normal.x() - a.offset * b.normal.x()) /
         sine;
}

Vec2 onto(const Line& line, const Vec2& p) {
  return p + (line.offset - line.normal.dot(p)) * line.normal;
}

/// Where pieces on these lines meet near p.
Vec2 corner_near(const Vec2& p, const std::vector<int>& at, const std::vector<Line>& lines,
                 double reach) {
  double nearest = reach;
  std::optional<Vec2> best;
  for (std::size_t a = 0; a < at.size(); ++a)
    for (std::size_t b = a + 1; b < at.size(); ++b)
      if (const auto x = crossing(lines[at[a]], lines[at[b]]); x && (*x - p).norm() < nearest)
        nearest = (*x - p).norm(), best = x;
  return best ? *best : onto(lines[at.front()], p);
}

/// A short piece between two that meet beyond it, or that lie on one line, is a melted corner.
void drop_short(const std::vector<Line>& lines, double tolerance, std::vector<Rough>& pieces) {
  const auto is_dropped = [&](std::size_t k) {
    if (k == 0 || k + 1 >= pieces.size()) return false;
    if (pieces[k].length > std::max(kChamfer * tolerance, kMelted)) return false;
    const Rough &a = pieces[k - 1], &b = pieces[k + 1];
    if (a.chain != pieces[k].chain || b.chain != pieces[k].chain) return false;
    if (a.line == b.line) return true;
    const auto x = crossing(lines[a.line], lines[b.line]);
    return x && (*x - pieces[k].middle()).norm() < std::max(kChamfer * tolerance, kMelted);
  };
  std::vector<Rough> kept;
  bool is_gone = false;  // of two in a row one stays
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    is_gone = !is_gone && is_dropped(k);
    if (!is_gone) kept.push_back(pieces[k]);
  }
  std::swap(pieces, kept);
}

/// Pieces with common corners: inside a chain of two neighbours' lines, at a junction of all.
std::vector<Piece> join(const std::vector<Chain>& chains, const std::vector<Rough>& rough,
                        const std::vector<Line>& lines, double tolerance) {
  std::map<int, std::vector<int>> lines_at;  // per junction
  std::map<int, Vec2> place;
  const auto is_first = [&](std::size_t k) {
    return k == 0 || rough[k - 1].chain != rough[k].chain;
  };
  const auto is_last = [&](std::size_t k) {
    return k + 1 == rough.size() || rough[k + 1].chain != rough[k].chain;
  };
  for (std::size_t k = 0; k < rough.size(); ++k) {
    const Chain& c = chains[rough[k].chain];
    if (is_first(k)) lines_at[c.first].push_back(rough[k].line), place[c.first] = c.points.front();
    if (is_last(k)) lines_at[c.last].push_back(rough[k].line), place[c.last] = c.points.back();
  }
  const double reach = kReach * tolerance;
  std::vector<Piece> pieces;
  for (std::size_t k = 0; k < rough.size(); ++k) {
    const Chain& c = chains[rough[k].chain];
    const auto inner = [&](std::size_t a, std::size_t b) {
      const Vec2 p = 0.5 * (rough[a].points.back() + rough[b].points.front());
      return corner_near(p, {rough[a].line, rough[b].line}, lines, reach);
    };
    const Vec2 from = is_first(k) ? corner_near(place[c.first], lines_at[c.first], lines, reach)
                                  : inner(k - 1, k);
    const Vec2 to =
        is_last(k) ? corner_near(place[c.last], lines_at[c.last], lines, reach) : inner(k, k + 1);
    pieces.push_back({c.left, c.right, from, to, rough[k].line});
  }
  return pieces;
}

/// Where two roofs meet without a step their planes say where, not the cells.
void draw_creases(const Field& field, const Labels& labels, const std::vector<Chain>& chains,
                  double tolerance, std::vector<Rough>& pieces, std::vector<Line>& lines) {
  for (Rough& r : pieces) {
    const Chain& c = chains[r.chain];
    if (c.left == kOutside || c.right == kOutside) continue;
    const Patch &a = labels.patches[c.left], &b = labels.patches[c.right];
    const Vec2 across = a.slope - b.slope;
    const double tilt = across.norm();
    if (tilt < kLeastCrease) continue;
    const Line line{across / tilt, (b.level - a.level) / tilt + across.dot(field.origin) / tilt};
    const auto off = [&](const Vec2& p) { return std::abs(line.normal.dot(p) - line.offset); };
    if (std::max(off(r.points.front()), off(r.points.back())) > kCreaseReach * tolerance) continue;
    r.line = static_cast<int>(lines.size());
    lines.push_back(line);
  }
}

/// Lines go where the walls near their pieces are, by area; melted edges alone put them beside.
void fit_lines(const std::vector<Rough>& pieces, const std::vector<WallSample>& walls,
               double tolerance, std::vector<Line>& lines) {
  std::vector<std::vector<std::pair<double, double>>> offs(lines.size());  // metres, m²
  for (const WallSample& w : walls)
    for (const Rough& r : pieces) {
      const Line& line = lines[r.line];
      const double off = line.normal.dot(w.place) - line.offset;
      if (std::abs(off) > kWallReach || std::abs(line.normal.dot(w.normal)) < kFacing) continue;
      const Vec2 along(-line.normal.y(), line.normal.x());
      const double a = along.dot(r.points.front()), b = along.dot(r.points.back());
      const double t = along.dot(w.place);
      if (t > std::min(a, b) && t < std::max(a, b)) offs[r.line].emplace_back(off, w.area);
    }
  for (std::size_t l = 0; l < lines.size(); ++l) {
    std::sort(offs[l].begin(), offs[l].end());
    double total = 0, passed = 0;
    for (const auto& [off, area] : offs[l]) total += area;
    if (total < kLeastWall) continue;
    for (const auto& [off, area] : offs[l])
      if ((passed += area) >= 0.5 * total) {
        lines[l].offset += std::clamp(off, -tolerance, tolerance);
        break;
      }
  }
}

/// To the line through all of its points: ends alone lie off the wall.
Vec2 fitted_normal(const Rough& r) {
  const Vec2 middle = r.middle();
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Vec2& p : r.points) spread += (p - middle) * (p - middle).transpose();
  const double angle = 0.5 * std::atan2(2 * spread(0, 1), spread(0, 0) - spread(1, 1));
  const Vec2 normal(-std::sin(angle), std::cos(angle));
  return normal.dot(r.normal) < 0 ? Vec2(-normal) : normal;
}

double total_length(const std::vector<Rough>& pieces) {
  double total = 0;
  for (const Rough& r : pieces) total += r.length;
  return total;
}

}  // namespace

double find_direction(const Field& field, const Labels& labels, double tolerance) {
  std::vector<Chain> chains = chains_of(field, labels, tolerance);
  std::erase_if(chains, [](const Chain& c) { return c.left != kOutside && c.right != kOutside; });
  std::vector<Rough> pieces = rough_pieces(chains, tolerance);
  for (Rough& r : pieces) {
    r.normal = fitted_normal(r);
    r.length *= r.length;  // the longer a piece, the better it knows the direction
  }
  const double direction = main_direction(pieces, 0).value_or(0);
  double sum = 0, weight = 0;
  for (const Rough& r : pieces) {
    const double off = std::remainder(std::atan2(r.normal.y(), r.normal.x()) - direction, kQuarter);
    if (std::abs(off) < kSpread) sum += r.length * off, weight += r.length;
  }
  return weight > 0 ? direction + sum / weight : direction;
}

Borders find_borders(const Field& field, const Labels& labels, const std::vector<WallSample>& walls,
                     double direction, double tolerance) {
  const std::vector<Chain> chains = chains_of(field, labels, tolerance);
  std::vector<Rough> rough = rough_pieces(chains, tolerance);
  follow(direction, kFollow, tolerance, rough);
  if (const auto second = main_direction(rough, kSecondShare * total_length(rough)))
    follow(*second, kFollow, tolerance, rough);
  square_short(direction, kOblique * tolerance, rough);
  Borders borders;
  borders.lines = gather(tolerance, rough);
  fit_lines(rough, walls, tolerance, borders.lines);
  draw_creases(field, labels, chains, tolerance, rough, borders.lines);
  drop_short(borders.lines, tolerance, rough);
  borders.pieces = join(chains, rough, borders.lines, tolerance);
  return borders;
}

}  // namespace colod::relief
