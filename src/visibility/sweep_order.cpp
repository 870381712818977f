// Based on: sweep.cpp.
// Differs: –
// Notation: as in sweep.cpp.
#include "sweep_order.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace colod::casting {

void Order::make(const std::vector<double>& x, const double* y, std::size_t rows, double dx,
                 double dy) {
  const std::size_t n = x.size(), count = n * rows;
  // Offsets are linear over the rows, so the corners have the least and the most.
  low_ = std::numeric_limits<double>::infinity();
  double high = -low_;
  for (const double cx : {x.front(), x.back()})
    for (const double cy : {y[0], y[rows - 1]}) {
      low_ = std::min(low_, dx * cy - dy * cx);
      high = std::max(high, dx * cy - dy * cx);
    }
  scale_ = high > low_ ? static_cast<double>(count) / (high - low_) : 0;
  first_.assign(count + 2, 0);
  std::vector<std::uint32_t> bins(count);
  for (std::size_t j = 0, v = 0; j < rows; ++j)
    for (std::size_t i = 0; i < n; ++i, ++v)
      ++first_[1 + (bins[v] = static_cast<std::uint32_t>(bin(dx * y[j] - dy * x[i])))];
  for (std::size_t b = 0; b + 1 < first_.size(); ++b) first_[b + 1] += first_[b];
  voxel.resize(count);
  for (std::size_t v = 0; v < count; ++v) voxel[first_[bins[v]]++] = static_cast<std::uint32_t>(v);
  for (std::size_t b = first_.size() - 1; b > 0; --b) first_[b] = first_[b - 1];
  first_[0] = 0;
  const auto offset = [&](std::uint32_t v) { return dx * y[v / n] - dy * x[v % n]; };
  for (std::size_t b = 0; b + 1 < first_.size(); ++b)
    if (first_[b + 1] - first_[b] > 1)
      std::sort(voxel.begin() + first_[b], voxel.begin() + first_[b + 1],
                [&](std::uint32_t v, std::uint32_t w) {
                  return std::pair(offset(v), v) < std::pair(offset(w), w);
                });
  const std::size_t padded = (count + kBlock - 1) / kBlock * kBlock;
  across.assign(padded, 0), along.assign(padded, 0);
  for (std::size_t i = 0; i < count; ++i) {
    across[i] = offset(voxel[i]);
    along[i] = dx * x[voxel[i] % n] + dy * y[voxel[i] / n];
  }
}

std::size_t Order::bin(double t) const {
  const double at = (t - low_) * scale_;  // no number where all lies at one place: the first bin
  const auto last = static_cast<double>(first_.size() - 2);
  return at > 0 ? static_cast<std::size_t>(std::min(at, last)) : 0;
}

std::size_t Order::count_until(double t, bool is_closed) const {
  const std::size_t b = bin(t);  // rising with t: what lies in lower bins is below
  const auto from = across.begin() + first_[b], to = across.begin() + first_[b + 1];
  const auto at = is_closed ? std::upper_bound(from, to, t) : std::lower_bound(from, to, t);
  return static_cast<std::size_t>(at - across.begin());
}

}  // namespace colod::casting
