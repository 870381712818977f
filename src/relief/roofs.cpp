// Based on: regularities of roofs (Zhou & Neumann, "2.5D building modeling by discovering global
// regularities", CVPR 2012). Differs: each is taken only where the noise excuses it. Notation: –
#include "roofs.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/flat.h"
#include "parameters.h"

namespace colod::relief {
namespace {

using namespace parameters::relief;

struct Sample {
  Vec2 place;
  double height;
};

double level_of(const std::vector<Sample>& samples, const Vec2& slope) {
  std::vector<double> levels;
  for (const Sample& s : samples) levels.push_back(s.height - slope.dot(s.place));
  return median(std::move(levels));
}

double residual_of(const std::vector<Sample>& samples, const Patch& patch) {
  double sum = 0;
  for (const Sample& s : samples) sum += std::pow(s.height - patch.height(s.place), 2);
  return samples.empty() ? 0 : std::sqrt(sum / static_cast<double>(samples.size()));
}

/// The least-squares plane.
Patch fit(const std::vector<Sample>& samples, Patch patch) {
  Eigen::Matrix3d a = 1e-6 * Eigen::Matrix3d::Identity();
  Vec3 b = Vec3::Zero();
  for (const Sample& s : samples) {
    const Vec3 v(s.place.x(), s.place.y(), 1);
    a += v * v.transpose();
    b += s.height * v;
  }
  const Vec3 x = a.ldlt().solve(b);
  patch.slope = x.head<2>();
  patch.level = x.z();
  patch.residual = residual_of(samples, patch);
  return patch;
}

/// The patch with this slope, or as it was where that costs more than the noise excuses.
Patch with_slope(const std::vector<Sample>& samples, const Patch& patch, const Vec2& slope,
                 double excused) {
  Patch turned = patch;
  turned.slope = slope;
  turned.level = level_of(samples, slope);
  turned.residual = residual_of(samples, turned);
  return turned.residual <= patch.residual + excused ? turned : patch;
}

Vec2 squared(const Vec2& slope, double direction) {
  const double tilt = slope.norm();
  if (tilt < kLevelSlope) return Vec2::Zero();
  const double angle = std::atan2(slope.y(), slope.x());
  const double off = std::remainder(angle - direction, std::numbers::pi / 2);
  return tilt * std::cos(off) * Vec2(std::cos(angle - off), std::sin(angle - off));
}

/// The larger roofs' tilts, each of all that are alike.
std::vector<double> shared_tilts(const std::vector<Patch>& patches) {
  std::vector<int> order(patches.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return patches[a].area > patches[b].area; });
  std::vector<double> tilt(patches.size(), -1);
  for (const int lead : order) {
    if (tilt[lead] >= 0) continue;
    double sum = 0, area = 0;
    std::vector<int> alike;
    for (const int p : order)
      if (tilt[p] < 0 &&
          std::abs(patches[p].slope.norm() - patches[lead].slope.norm()) < kSameTilt) {
        alike.push_back(p);
        sum += patches[p].area * patches[p].slope.norm(), area += patches[p].area;
      }
    for (const int p : alike) tilt[p] = area > 0 ? sum / area : patches[p].slope.norm();
  }
  return tilt;
}

/// Per roof a larger one in whose plane it lies, too, or itself.
std::vector<int> shared_planes(const std::vector<std::vector<Sample>>& samples,
                               const std::vector<Patch>& roofs, double reach) {
  std::vector<int> order(roofs.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return samples[a].size() > samples[b].size(); });
  std::vector<int> lead(roofs.size());
  std::iota(lead.begin(), lead.end(), 0);
  for (auto p = order.begin(); p != order.end(); ++p)
    for (auto l = order.begin(); l != p && lead[*p] == *p; ++l)
      if (lead[*l] == *l && residual_of(samples[*p], roofs[*l]) < reach) lead[*p] = *l;
  return lead;
}

}  // namespace

void regular_roofs(const Field& field, double direction, double noise, Labels& labels) {
  std::vector<std::vector<Sample>> samples(labels.patches.size());
  for (int i = 0; i < field.size(); ++i) {
    const int p = labels.of_cell[i];
    if (p < 0 || !field.has(i) || field.is_steep[i]) continue;
    const Vec2 place = field.center(i) - field.origin;
    if (std::abs(field.height[i] - labels.patches[p].height(place)) < kTrim * noise)
      samples[p].push_back({place, field.height[i]});
  }
  std::vector<Patch>& roofs = labels.patches;
  const double excused = kExcused * noise;
  for (std::size_t p = 0; p < roofs.size(); ++p) {
    if (samples[p].size() < 4) continue;
    roofs[p] = fit(samples[p], roofs[p]);
    roofs[p] = with_slope(samples[p], roofs[p], squared(roofs[p].slope, direction), excused);
  }
  const std::vector<double> tilt = shared_tilts(roofs);
  for (std::size_t p = 0; p < roofs.size(); ++p)
    if (const double own = roofs[p].slope.norm(); own > 0 && samples[p].size() >= 4)
      roofs[p] = with_slope(samples[p], roofs[p], roofs[p].slope * (tilt[p] / own), excused);
  const std::vector<int> lead =
      shared_planes(samples, roofs, std::max(kSameRise, kSameRoof * noise));
  for (int& l : labels.of_cell)
    if (l >= 0) l = lead[l];
}

}  // namespace colod::relief
