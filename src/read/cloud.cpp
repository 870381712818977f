// Based on: own work.
// Differs: --rules does not matter here.
// Notation: none.
#include <algorithm>
#include <cmath>
#include <functional>

#include "formats.h"

namespace colod::mesh_io {

namespace {

constexpr double kAlike = 0.9;        // cosine: a given normal agrees with the surface
constexpr double kMostAgree = 0.7;    // share of points; colours of three classes reach a third
constexpr double kMostWithout = 0.1;  // share of points whose given normal has no length

std::size_t count_agreeing(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += std::abs(a[i].dot(b[i])) > kAlike;
  return count;
}

/// Normals that may be colours stay where the surface through the points agrees.
void settle_doubt(Source& s) {
  PointCloud estimated = s.cloud;
  const std::string warning = estimate_normals(estimated);
  const std::size_t agreeing = count_agreeing(estimated.normals, s.cloud.normals);
  if (static_cast<double>(agreeing) > kMostAgree * static_cast<double>(s.cloud.points.size()))
    return;
  s.cloud.normals = std::move(estimated.normals);
  s.warnings.push_back(
      "columns that look like normals have no negative value and do not agree with the surface: "
      "taken for colours or classes");
  s.warnings.push_back(warning);
}

/// Has the file normals that can be used at all?
bool has_normals(const RawFile& raw) {
  if (raw.normals.empty() || raw.normals.size() != raw.points.size()) return false;
  const auto without = std::count_if(raw.normals.begin(), raw.normals.end(),
                                     [](const Vec3& n) { return !(n.norm() > 0); });
  return static_cast<double>(without) <= kMostWithout * static_cast<double>(raw.normals.size());
}

/// One colour for all is none.
bool has_colors(const RawFile& raw) {
  const std::vector<Rgb>& colors = raw.point_colors;
  return colors.size() == raw.points.size() &&
         std::adjacent_find(colors.begin(), colors.end(), std::not_equal_to<>()) != colors.end();
}

}  // namespace

Source read_cloud(const std::string& path, const RawFile& raw) {
  Source s;
  const bool keeps_normals = has_normals(raw), keeps_colors = has_colors(raw);
  std::size_t dropped = 0;
  for (std::size_t i = 0; i < raw.points.size(); ++i) {
    const bool is_good = is_usable(raw.points[i]) && (!keeps_normals || raw.normals[i].norm() > 0);
    if (!is_good && ++dropped) continue;
    s.cloud.points.push_back(raw.points[i]);
    if (keeps_normals) s.cloud.normals.push_back(raw.normals[i]);
    if (!keeps_colors) continue;
    const Rgb& rgb = raw.point_colors[i];
    s.look.colors.push_back({rgb, rgb, rgb});
  }
  leave_out_strays(s);
  if (s.cloud.points.size() < 3) fail(path, "neither a face nor 3 points with usable coordinates");
  if (dropped > 0)
    s.warnings.push_back(
        std::to_string(dropped) +
        " points left out: coordinate or normal not finite, or normal of no length");
  if (!raw.normals.empty() && !keeps_normals)
    s.warnings.push_back("many normals in the file have no length");
  if (!keeps_normals)
    s.warnings.push_back(estimate_normals(s.cloud));
  else if (raw.has_doubtful_normals)
    settle_doubt(s);
  return s;
}

}  // namespace colod::mesh_io
