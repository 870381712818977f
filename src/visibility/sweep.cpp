// The rays of `--visibility sweep`: a plane sweep in every slice instead of a ray tracer.
//
// Based on: Bentley, Ottmann: Algorithms for Reporting and Counting Geometric Intersections, IEEE
//   ToC C-28, 1979 (the idea of sweeping a line over segments).
// Differs: from a ray tracer: all rays of a slice lie in it, so the outlines are cut with the slice
//   once. Rays of one direction are taken in the order of their offset across it, which is the same
//   in every slice; a segment then meets one run of them, and a block of neighbouring rays only a
//   handful of segments. Opposite directions share all of this. No ray is given up early. Where a
//   ray grazes a segment's end or a crossing, rounding decides, and Embree is asked, so that
//   both engines see the same.
// Notation: d direction; across, along: a point's coordinates on d turned left and on d; D distance
//   from a voxel to a segment along d, negative behind the voxel; a code is 2 × plane of the slice
//   + (seen from inside), planes counted from 1, 0 nothing.
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>

#include "core/error.h"
#include "core/parallel.h"
#include "parts.h"
#include "sweep_order.h"
#include "sweep_slice.h"

// One build for every processor: the loops that matter exist three times, and the loader picks. No
// build fuses multiplications with additions, so all give the same bits (CMakeLists.txt).
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define COLOD_EVERY_CPU \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define COLOD_EVERY_CPU
#endif

namespace colod::casting {
namespace {

using Code = std::uint16_t;
/// A cache line of codes.
constexpr std::size_t kLine = 32;
/// Bytes of codes a thread holds at most, more when a row of voxels alone needs it.
constexpr std::size_t kCodeBytes = std::size_t{8} << 20;
/// Bytes of orders held for the whole run; beyond, every task makes its own.
constexpr std::size_t kOrderBytes = std::size_t{256} << 20;
/// Slices that a task takes at once, with one look at each order.
constexpr std::size_t kSlices = 2;
/// D takes the upper bits of a word, the code the lower ones: the nearest is the smallest word.
constexpr std::uint64_t kCodeMask = 0xffff;
/// Rays nearer than this to a segment's end or to where two segments cross, in units of the box's
/// radius, graze: single precision decides what they meet, so the reference is asked.
constexpr double kGraze = 4e-6;
/// A segment before the rays of one direction: D = start + slope × across − along for the rays
/// `from` … `to` − 1 of the order.
struct Candidate {
  double slope, start;
  std::uint64_t code;  ///< seen along d
  std::uint32_t from, to;
};

/// One direction in one slice.
struct Sweep {
  std::vector<Candidate> candidates;
  std::vector<std::uint32_t> first;  ///< candidates of block b: entries[first[b]] … first[b + 1]
  std::vector<std::uint32_t> entries;
};

/// Words of D and code: the smallest, unsigned, is the nearest ahead; the smallest, signed, the
/// nearest behind.
struct Nearest {
  std::array<std::uint64_t, kBlock> ahead;
  std::array<std::int64_t, kBlock> behind;
};

inline std::uint64_t word(const Candidate& c, double across, double along) {
  const double distance = c.start + c.slope * across - along;
  return (std::bit_cast<std::uint64_t>(distance) & ~kCodeMask) | c.code;
}

/// Fills the codes seen by the order's voxels along d and against it.
COLOD_EVERY_CPU void sweep_blocks(const Sweep& sweep, const double* across, const double* along,
                                  const std::uint32_t* voxel, std::size_t count, Code* ahead,
                                  Code* behind) {
  Nearest nearest;
  std::array<Code, kBlock> code_ahead, code_behind;
  for (std::size_t start = 0, b = 0; start < count; start += kBlock, ++b) {
    const double *t = across + start, *s = along + start;
    nearest.ahead.fill(std::numeric_limits<std::uint64_t>::max());
    nearest.behind.fill(std::numeric_limits<std::int64_t>::max());
    for (std::uint32_t e = sweep.first[b]; e < sweep.first[b + 1]; ++e) {
      const Candidate c = sweep.candidates[sweep.entries[e]];
      if (c.from <= start && c.to >= start + kBlock) {
        for (std::size_t i = 0; i < kBlock; ++i) {
          const std::uint64_t w = word(c, t[i], s[i]);
          nearest.ahead[i] = std::min(nearest.ahead[i], w);
          nearest.behind[i] = std::min(nearest.behind[i], static_cast<std::int64_t>(w));
        }
      } else {
        const std::size_t from = std::max<std::size_t>(c.from, start) - start;
        const std::size_t to = std::min<std::size_t>(c.to, start + kBlock) - start;
        for (std::size_t i = from; i < to; ++i) {
          const std::uint64_t w = word(c, t[i], s[i]);
          nearest.ahead[i] = std::min(nearest.ahead[i], w);
          nearest.behind[i] = std::min(nearest.behind[i], static_cast<std::int64_t>(w));
        }
      }
    }
    for (std::size_t i = 0; i < kBlock; ++i) {
      const auto a = static_cast<std::int64_t>(nearest.ahead[i]);
      const std::int64_t r = nearest.behind[i];
      code_ahead[i] = static_cast<Code>(a >= 0 ? a : 0);
      code_behind[i] = static_cast<Code>(r < 0 ? r ^ 1 : 0);
    }
    const std::size_t end = std::min(kBlock, count - start);
    for (std::size_t i = 0; i < end; ++i) {
      ahead[voxel[start + i]] = code_ahead[i];
      behind[voxel[start + i]] = code_behind[i];
    }
  }
}

/// What a line of voxels saw: counts, and the directions at which the code changes.
struct Line {
  std::array<Code, kLine> inside, met;
  std::vector<std::array<Code, kLine>> changes;  ///< bit k % 16 of changes[k / 16]
};

/// `codes` is by direction, `stride` apart.
COLOD_EVERY_CPU void count_line(const Code* codes, std::size_t stride, int nr, Line& line) {
  line.inside.fill(0), line.met.fill(0);
  for (auto& group : line.changes) group.fill(0);
  line.changes[0].fill(1);
  for (int k = 0; k < nr; ++k) {
    const Code* now = codes + static_cast<std::size_t>(k) * stride;
    const Code* before = k > 0 ? now - stride : now;
    const Code bit = static_cast<Code>(1 << (k % 16));
    Code* changes = line.changes[static_cast<std::size_t>(k / 16)].data();
    for (std::size_t i = 0; i < kLine; ++i) {
      line.inside[i] = static_cast<Code>(line.inside[i] + (now[i] & 1));
      line.met[i] = static_cast<Code>(line.met[i] + (now[i] > 1 ? 1 : 0));
      changes[i] = static_cast<Code>(changes[i] | (now[i] != before[i] ? bit : 0));
    }
  }
}

class Sweeper {
 public:
  Sweeper(const Job& job, HitGrid& grid)
      : job_(job), reference_(job, grid), reach_(kGraze * 0.5 * grid.box.diagonal()), grid_(grid) {
    const std::size_t n = size();
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t v = axis == 0 ? i : axis == 1 ? i * n : i * n * n;
        const double c = grid.center(v)[axis] - job.center[axis];
        at_[axis].push_back(static_cast<float>(c));  // as the ray tracer sees it
      }
    const std::size_t row = n * static_cast<std::size_t>(grid.nr) * sizeof(Code) * kSlices;
    const std::size_t most = std::clamp<std::size_t>(kCodeBytes / row, 1, n);
    bands_ = (n + most - 1) / most;
    rows_ = (n + bands_ - 1) / bands_;
    bands_ = (n + rows_ - 1) / rows_;
    for (int k = 0; k < grid.nr; ++k) directions_.push_back(direction(k, grid.nr));
    // With an even number of directions, the second half is the first turned round.
    pairs_ = static_cast<std::size_t>(grid.nr % 2 == 0 ? grid.nr / 2 : grid.nr);
    if (Order::bytes(n * n) * pairs_ <= kOrderBytes) make_orders();
  }

  std::size_t slabs() const { return (size() + kSlices - 1) / kSlices; }
  std::size_t bands() const { return bands_; }
  std::size_t pieces() const { return size() * bands_; }

  /// Fills the pieces of some slices' rows: those of slice z are at z × bands() + band.
  void cast(std::size_t slab, std::size_t band, std::vector<Piece>& pieces) const {
    const std::size_t first_row = band * rows_, rows = std::min(rows_, size() - first_row);
    const std::size_t z0 = slab * kSlices, slices = std::min(kSlices, size() - z0);
    std::unique_ptr<Work> lent = lend();
    Work& work = *lent;
    work.stride = kLine * ((size() * rows + kLine - 1) / kLine | 1);
    for (std::size_t s = 0; s < slices; ++s) {
      work.slices[s] = cut(at_[2][z0 + s]);
      work.codes[s].resize(work.stride * static_cast<std::size_t>(grid_.nr));
    }
    for (std::size_t pair = 0; pair < pairs_; ++pair) {
      if (orders_.empty()) make_order(work.order, band, pair);
      const Order& order = orders_.empty() ? work.order : orders_[band * pairs_ + pair];
      for (std::size_t s = 0; s < slices; ++s) {
        sweep(work, s, pair, order);
        settle_grazes(work, s, pair, order, (z0 + s) * size() * size() + first_row * size());
      }
    }
    for (std::size_t s = 0; s < slices; ++s)
      pieces[(z0 + s) * bands_ + band] = collect(work, s, (z0 + s) * size() + first_row, rows);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(lent));
  }

 private:
  struct Work {
    std::array<Slice, kSlices> slices;
    std::array<std::vector<Code>, kSlices> codes;  ///< of each slice, by direction, then voxel
    std::size_t stride = 0;                        ///< codes of a direction; an odd number of lines
    Order order;
    Sweep sweep;
    std::vector<std::uint32_t> grazing;  ///< voxels of the order whose rays graze
    std::vector<Code> behind;            ///< an odd number of directions: not asked for
  };

  /// What an earlier task has left, or new: fresh memory costs as much as filling it.
  std::unique_ptr<Work> lend() const {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<Work>();
    std::unique_ptr<Work> work = std::move(idle_.back());
    idle_.pop_back();
    return work;
  }

  std::size_t size() const { return static_cast<std::size_t>(grid_.ns); }

  void make_order(Order& order, std::size_t band, std::size_t pair) const {
    const std::size_t first = band * rows_;
    const Direction& d = directions_[pair];
    order.make(at_[0], at_[1].data() + first, std::min(rows_, size() - first),
               static_cast<float>(d.x), static_cast<float>(d.y));
  }

  void make_orders() {
    orders_.resize(bands_ * pairs_);
    parallel_for(orders_.size(),
                 [&](std::size_t i) { make_order(orders_[i], i / pairs_, i % pairs_); });
  }

  Slice cut(double z) const {
    Slice slice = cut_slice(job_, z, reach_, grid_.box.diagonal());
    if (slice.planes.size() > (kCodeMask - 1) / 2)
      throw Error(Stage::kProcess, "visibility",
                  "more than 32767 planes cross one slice: use --visibility embree");
    return slice;
  }

  /// Who may be met where, in one slice along one pair of directions.
  void collect_candidates(Sweep& sweep, const Slice& slice, const Direction& d,
                          const Order& order) const {
    const double dx = static_cast<float>(d.x), dy = static_cast<float>(d.y);
    sweep.candidates.clear();
    sweep.first.assign((order.voxel.size() + kBlock - 1) / kBlock + 1, 0);
    for (const Segment& g : slice.segments) {
      double t0 = dx * g.y0 - dy * g.x0, t1 = dx * g.y1 - dy * g.x1;
      double s0 = dx * g.x0 + dy * g.y0, s1 = dx * g.x1 + dy * g.y1;
      if (t1 < t0) std::swap(t0, t1), std::swap(s0, s1);
      const auto& normal = job_.normal[slice.planes[g.plane]];
      if (!(t0 < t1) || d.x * normal[0] + d.y * normal[1] == 0) continue;
      const std::size_t from = order.count_below(t0), to = order.count_to(t1);
      if (from == to) continue;
      const double slope = (s1 - s0) / (t1 - t0);
      const int code = 2 * (g.plane + 1) + d.is_inside(normal);
      sweep.candidates.push_back({slope, s0 - slope * t0, static_cast<std::uint64_t>(code),
                                  static_cast<std::uint32_t>(from),
                                  static_cast<std::uint32_t>(to)});
      for (std::size_t b = from / kBlock; b <= (to - 1) / kBlock; ++b) ++sweep.first[b];
    }
    // Counts become ends, which come down to begins as the entries are filled in from behind.
    for (std::size_t b = 1; b < sweep.first.size(); ++b) sweep.first[b] += sweep.first[b - 1];
    sweep.entries.resize(sweep.first.back());
    for (std::size_t c = 0; c < sweep.candidates.size(); ++c)
      for (std::size_t b = sweep.candidates[c].from / kBlock;
           b <= (sweep.candidates[c].to - 1) / kBlock; ++b)
        sweep.entries[--sweep.first[b]] = static_cast<std::uint32_t>(c);
  }

  void sweep(Work& work, std::size_t s, std::size_t pair, const Order& order) const {
    collect_candidates(work.sweep, work.slices[s], directions_[pair], order);
    Code* ahead = work.codes[s].data() + pair * work.stride;
    Code* behind = ahead + pairs_ * work.stride;
    if (pairs_ == static_cast<std::size_t>(grid_.nr)) {
      work.behind.resize(work.stride);
      behind = work.behind.data();
    }
    sweep_blocks(work.sweep, order.across.data(), order.along.data(), order.voxel.data(),
                 order.voxel.size(), ahead, behind);
  }

  /// Asks the reference where rays graze. `first_voxel` is the order's.
  void settle_grazes(Work& work, std::size_t s, std::size_t pair, const Order& order,
                     std::size_t first_voxel) const {
    const double dx = static_cast<float>(directions_[pair].x),
                 dy = static_cast<float>(directions_[pair].y);
    work.grazing.clear();
    for (const auto& [x, y, reach] : work.slices[s].corners) {
      const double t = dx * y - dy * x;
      for (std::size_t i = order.count_below(t - reach);
           i < order.voxel.size() && order.across[i] <= t + reach; ++i)
        work.grazing.push_back(order.voxel[i]);
    }
    std::sort(work.grazing.begin(), work.grazing.end());
    work.grazing.erase(std::unique(work.grazing.begin(), work.grazing.end()), work.grazing.end());
    for (const std::uint32_t v : work.grazing)
      for (std::size_t k = pair; k < directions_.size(); k += pairs_) {
        const int seen = reference_.look(first_voxel + v, static_cast<int>(k));
        const int code = code_of(seen, work.slices[s].planes);
        if (code >= 0) work.codes[s][k * work.stride + v] = static_cast<Code>(code);
      }
  }

  /// −1: of a plane that this slice does not cut.
  static int code_of(int seen, const std::vector<int>& planes) {
    if (seen < 0) return 0;
    const auto at = std::lower_bound(planes.begin(), planes.end(), seen / 2);
    if (at == planes.end() || *at != seen / 2) return -1;
    return 2 * static_cast<int>(at - planes.begin() + 1) + seen % 2;
  }

  /// Writes what the voxels of a slice's rows are, and the hits of the kept ones.
  Piece collect(const Work& work, std::size_t s, std::size_t first_row, std::size_t rows) const {
    const std::size_t count = rows * size(), first_voxel = first_row * size();
    Piece piece;
    piece.rays = count * static_cast<std::uint64_t>(grid_.nr);
    Line line;
    line.changes.resize((static_cast<std::size_t>(grid_.nr) + 15) / 16);
    const std::size_t code_count = 2 * work.slices[s].planes.size() + 2;
    Runs runs{std::vector<std::uint32_t>(code_count),
              std::vector<std::uint64_t>(code_count / 64 + 1)};
    for (std::size_t at = 0; at < count; at += kLine) {
      const Code* codes = work.codes[s].data() + at;
      count_line(codes, work.stride, grid_.nr, line);
      for (std::size_t i = 0; i < std::min(kLine, count - at); ++i) {
        const std::size_t v = first_voxel + at + i;
        const int in = line.inside[i], out = line.met[i] - in;
        grid_.is_valid[v] = job_.rule.is_valid(in, out);
        if (!job_.rule.is_kept(in, out)) continue;
        const std::size_t before = piece.hits.size();
        append_hits(codes + i, work.stride, line, i, work.slices[s].planes, runs, piece.hits);
        grid_.first[v + 1] = piece.hits.size() - before;
      }
    }
    return piece;
  }

  /// Counts by code, all zero between voxels, and a bit for each code met.
  struct Runs {
    std::vector<std::uint32_t> count;
    std::vector<std::uint64_t> met;
  };

  /// One voxel's hits by rising plane. Neighbouring directions mostly see the same, so directions
  /// are taken run by run: where a code ends, it gets the direction added, where one begins, taken
  /// off. There are hardly any branches to guess: the bits of `met` give the codes in order.
  void append_hits(const Code* codes, std::size_t stride, const Line& line, std::size_t i,
                   const std::vector<int>& planes, Runs& runs, std::vector<Hit>& hits) const {
    Code code = 0;
    for (std::size_t group = 0; group < line.changes.size(); group += 4) {
      std::uint64_t left = 0;
      for (std::size_t g = group; g < std::min(group + 4, line.changes.size()); ++g)
        left |= static_cast<std::uint64_t>(line.changes[g][i]) << (16 * (g - group));
      for (; left != 0; left &= left - 1) {
        const auto k = static_cast<std::uint32_t>(16 * group) +
                       static_cast<std::uint32_t>(std::countr_zero(left));
        runs.count[code] += k;
        code = codes[k * stride];
        runs.count[code] -= k;
        runs.met[code / 64] |= std::uint64_t{1} << (code % 64);
      }
    }
    runs.count[code] += static_cast<std::uint32_t>(grid_.nr);
    runs.count[0] = 0, runs.met[0] &= ~std::uint64_t{1};
    const std::size_t first = hits.size();
    for (std::size_t w = 0; w < runs.met.size(); ++w)
      for (; runs.met[w] != 0; runs.met[w] &= runs.met[w] - 1) {
        const std::size_t c = 64 * w + static_cast<std::size_t>(std::countr_zero(runs.met[w]));
        const auto plane = static_cast<std::uint32_t>(planes[c / 2 - 1]);
        if (hits.size() == first || hits.back().plane != plane) hits.push_back({plane, 0, 0});
        (c % 2 == 1 ? hits.back().inside : hits.back().outside) =
            static_cast<std::uint16_t>(runs.count[c]);
        runs.count[c] = 0;
      }
  }

  const Job& job_;
  Reference reference_;
  double reach_;  ///< metres within which a ray grazes
  HitGrid& grid_;
  std::array<std::vector<double>, 3> at_;  ///< coordinates of the voxels' centres along each axis
  std::vector<Direction> directions_;
  std::size_t pairs_ = 0, rows_ = 0, bands_ = 0;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Work>> idle_;
  std::vector<Order> orders_;  ///< by band, then pair; empty when they would be too many
};

}  // namespace

void cast_sweep(const Job& job, HitGrid& grid) {
  const Sweeper sweeper(job, grid);
  std::vector<Piece> pieces(sweeper.pieces());
  parallel_for(sweeper.slabs() * sweeper.bands(), [&](std::size_t i) {
    sweeper.cast(i / sweeper.bands(), i % sweeper.bands(), pieces);
  });
  join_pieces(pieces, grid);
}

}  // namespace colod::casting
