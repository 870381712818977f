// Differs: the paper has no such step. Voxels and rays follow the axes: without it a turned
// building is another building.
//
// Notation: weight = area of a face in mm² (1 for a point), theta = direction of a wall's normal
// modulo 90 degrees.

#include "frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

namespace colod {
namespace {

constexpr double kGrid = 65536;        // local coordinates are multiples of 2^-16 m
constexpr double kWallNormalZ = 0.35;  // |n_z| below which a face counts as a wall
constexpr double kQuarter = std::numbers::pi / 2;

/// A piece of surface: what votes for the main direction. Weights are integers, so that sums do not
/// depend on order.
struct Patch {
  Vec3 centroid;
  Vec3 normal;
  std::int64_t weight;
};

std::vector<Patch> patches(const Source& source, const Vec3& origin) {
  std::vector<Patch> result;
  if (source.is_mesh()) {
    for (const Face& f : source.mesh.faces) {
      const Vec3 cross = face_cross(source.mesh, f);
      const double length = cross.norm();
      if (!(length > 0)) continue;
      const auto& v = source.mesh.vertices;
      const Vec3 centroid = ((v[f[0]] - origin) + (v[f[1]] - origin) + (v[f[2]] - origin)) / 3;
      const double weight = std::min(length * 0.5 * 1e6, 1e12);  // mm², at most 1 km²
      result.push_back({centroid, cross / length, std::llround(weight)});
    }
  } else {
    const bool has_normals = source.cloud.normals.size() == source.cloud.points.size();
    for (std::size_t i = 0; i < source.cloud.points.size(); ++i)
      result.push_back({source.cloud.points[i] - origin,
                        has_normals ? source.cloud.normals[i] : Vec3(Vec3::UnitZ()), 1});
  }
  return result;
}

/// Direction of a wall's normal in [0, 90) degrees, in units of 2^-40 of a quarter turn: so fine
/// that a turned building gets the same local coordinates after rounding.
constexpr std::int64_t kTurn = std::int64_t{1} << 40;
std::int64_t quarter_angle(const Vec3& normal) {
  double t = std::atan2(normal.y(), normal.x()) / kQuarter;
  t -= std::floor(t);
  return std::llround(t * kTurn) % kTurn;
}

/// Difference a − b modulo a quarter turn, in [−kTurn/2, kTurn/2).
std::int64_t turn_difference(std::int64_t a, std::int64_t b) {
  std::int64_t d = (a - b) % kTurn;
  if (d < -kTurn / 2) d += kTurn;
  if (d >= kTurn / 2) d -= kTurn;
  return d;
}

/// The strongest wall direction modulo 90 degrees: peak of a smoothed histogram, refined by means
/// of its neighbourhood.
double main_direction(const std::vector<Patch>& all) {
  struct Vote {
    std::int64_t angle;
    std::int64_t weight;
  };
  std::vector<Vote> votes;
  for (const Patch& p : all)
    if (std::abs(p.normal.z()) < kWallNormalZ && p.normal.head<2>().norm() > 0.5)
      votes.push_back({quarter_angle(p.normal), p.weight});
  constexpr int kBins = 360;
  std::vector<std::int64_t> bins(kBins, 0);
  for (const Vote& v : votes) bins[v.angle * kBins / kTurn] += v.weight;
  std::int64_t best = -1;
  int peak = 0;
  for (int b = 0; b < kBins; ++b) {
    std::int64_t sum = 0;
    for (int d = -8; d <= 8; ++d) sum += (9 - std::abs(d)) * bins[(b + d + kBins) % kBins];
    if (sum > best) best = sum, peak = b;
  }
  std::int64_t angle = peak * kTurn / kBins + kTurn / kBins / 2;
  for (int round = 0; round < 20; ++round) {  // mean shift within 4 degrees
    constexpr std::int64_t kReach = kTurn * 4 / 90;
    std::int64_t weight = 0;
    __int128 sum = 0;
    for (const Vote& v : votes) {
      const std::int64_t d = turn_difference(v.angle, angle);
      if (std::abs(d) <= kReach) weight += v.weight, sum += static_cast<__int128>(d) * v.weight;
    }
    if (weight == 0) break;
    const auto shift = static_cast<std::int64_t>(sum / weight);
    if (shift == 0) break;
    angle += shift;
  }
  angle = ((angle % kTurn) + kTurn) % kTurn;
  return static_cast<double>(angle) / kTurn * kQuarter;
}

/// Of the four frames that share a main direction, the one with the longer spread along x and the
/// longer tail to +x (to +y when the building is symmetric in x).
int quadrant(const std::vector<Patch>& all, double yaw) {
  const Frame frame{Vec3::Zero(), yaw};
  double weight = 0;
  Vec3 mean = Vec3::Zero();
  for (const Patch& p : all) weight += p.weight, mean += p.weight * p.centroid;
  if (!(weight > 0)) return 0;
  mean /= weight;
  Vec3 second = Vec3::Zero(), third = Vec3::Zero();
  for (const Patch& p : all) {
    const Vec3 d = frame.to_local(p.centroid - mean);
    second += p.weight * d.cwiseProduct(d);
    third += p.weight * d.cwiseProduct(d).cwiseProduct(d);
  }
  second /= weight, third /= weight;
  const auto skew = [&](int axis) {
    return third[axis] / std::pow(std::max(second[axis], 1e-12), 1.5);
  };
  const bool is_y_long = second.y() > second.x() * 1.0001;
  // Seen in the frame turned by a quarter, x' = y and y' = −x.
  const double along = is_y_long ? skew(1) : skew(0);
  const double across = is_y_long ? -skew(0) : skew(1);
  const bool is_reversed = std::abs(along) > 1e-3 ? along < 0 : across < -1e-3;
  return (is_y_long ? 1 : 0) + (is_reversed ? 2 : 0);
}

Vec3 rounded(const Vec3& p) {
  return (p * kGrid).array().round().matrix() / kGrid + Vec3::Zero();  // + 0: no negative zeros
}

bool is_less(const Vec3& a, const Vec3& b) {
  return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z());
}

std::vector<int> sorted_order(const std::vector<Vec3>& points) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    if (is_less(points[a], points[b])) return true;
    if (is_less(points[b], points[a])) return false;
    return a < b;
  });
  return order;
}

/// Old index → new index of the sorted, merged vertices, which replace `vertices`.
std::vector<int> sort_and_merge(std::vector<Vec3>& vertices) {
  const std::vector<int> order = sorted_order(vertices);
  std::vector<int> new_index(vertices.size());
  std::vector<Vec3> merged;
  for (int old : order) {
    if (merged.empty() || merged.back() != vertices[old]) merged.push_back(vertices[old]);
    new_index[old] = static_cast<int>(merged.size()) - 1;
  }
  vertices = std::move(merged);
  return new_index;
}

/// The corners' coordinates and colours of the faces that stayed, which begin at another corner
/// now.
void localize_look(const Source& source, const Source& local, const std::vector<int>& new_index,
                   const std::vector<int>& original, Appearance& look) {
  look.pick(original);
  for (std::size_t f = 0; f < original.size(); ++f) {
    const Face& before = source.mesh.faces[static_cast<std::size_t>(original[f])];
    int first = 0;
    while (first < 2 && new_index[before[first]] != local.mesh.faces[f][0]) ++first;
    if (!look.uvs.empty())
      std::rotate(look.uvs[f].begin(), look.uvs[f].begin() + first, look.uvs[f].end());
    if (!look.colors.empty())
      std::rotate(look.colors[f].begin(), look.colors[f].begin() + first, look.colors[f].end());
  }
}

void localize_mesh(const Source& source, Source& local, std::vector<int>& original) {
  const std::vector<int> new_index = sort_and_merge(local.mesh.vertices);
  std::vector<std::pair<Face, int>> faces;
  std::size_t degenerate = 0;
  for (std::size_t i = 0; i < source.mesh.faces.size(); ++i) {
    Face f = source.mesh.faces[i];
    for (int& v : f) v = new_index[v];
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
    if (f[0] == f[1] || f[1] == f[2] || f[0] == f[2] || !(face_area(local.mesh, f) > 0))
      ++degenerate;
    else
      faces.emplace_back(f, static_cast<int>(i));
  }
  std::sort(faces.begin(), faces.end());
  const std::size_t kept = faces.size();
  faces.erase(std::unique(faces.begin(), faces.end(),
                          [](const auto& a, const auto& b) { return a.first == b.first; }),
              faces.end());
  if (degenerate > 0)
    local.warnings.push_back(std::to_string(degenerate) + " faces without area dropped");
  if (faces.size() < kept)
    local.warnings.push_back(std::to_string(kept - faces.size()) + " duplicate faces dropped");
  local.mesh.faces.clear();
  for (const auto& [face, item] : faces) local.mesh.faces.push_back(face), original.push_back(item);
  if (!source.look.is_empty()) localize_look(source, local, new_index, original, local.look);
}

void localize_cloud(Source& local, std::vector<int>& original) {
  const PointCloud cloud = std::move(local.cloud);
  const bool has_normals = cloud.normals.size() == cloud.points.size();
  local.cloud = {};
  for (int i : sorted_order(cloud.points)) {
    if (!local.cloud.points.empty() && local.cloud.points.back() == cloud.points[i]) continue;
    local.cloud.points.push_back(cloud.points[i]);
    if (has_normals) local.cloud.normals.push_back(cloud.normals[i]);
    original.push_back(i);
  }
  local.look.pick(original);
}

}  // namespace

Vec3 Frame::to_local(const Vec3& world) const {
  const Vec3 p = world - origin;
  const double c = std::cos(yaw), s = std::sin(yaw);
  return {c * p.x() + s * p.y(), -s * p.x() + c * p.y(), p.z()};
}

Vec3 Frame::to_world(const Vec3& local) const {
  const double c = std::cos(yaw), s = std::sin(yaw);
  return Vec3(c * local.x() - s * local.y(), s * local.x() + c * local.y(), local.z()) + origin;
}

Frame main_frame(const Source& source) {
  const Box box = bounding_box(source.is_mesh() ? source.mesh.vertices : source.cloud.points);
  Frame frame;
  if (box.is_empty()) return frame;
  frame.origin = Vec3(box.center().x(), box.center().y(), box.min.z());
  const std::vector<Patch> all = patches(source, frame.origin);
  const double direction = main_direction(all);
  frame.yaw = direction + quadrant(all, direction) * kQuarter;
  // The middle of the turned box: the same point of the building however it stood.
  Frame turned{frame.origin, frame.yaw};
  Box local;
  for (const Vec3& p : source.is_mesh() ? source.mesh.vertices : source.cloud.points)
    local.extend(turned.to_local(p));
  frame.origin = turned.to_world(Vec3(local.center().x(), local.center().y(), local.min.z()));
  return frame;
}

Source localize(const Source& source, const Frame& frame, std::vector<int>* original_item) {
  Source local = source;
  const Frame rotation{Vec3::Zero(), frame.yaw};
  for (Vec3& p : local.mesh.vertices) p = rounded(frame.to_local(p));
  for (Vec3& p : local.cloud.points) p = rounded(frame.to_local(p));
  for (Vec3& n : local.cloud.normals) n = rotation.to_local(n);
  std::vector<int> original;
  if (source.is_mesh())
    localize_mesh(source, local, original);
  else
    localize_cloud(local, original);
  if (!source.face_object.empty()) {
    local.face_object.clear();
    for (int item : original) local.face_object.push_back(source.face_object[item]);
  }
  if (original_item) *original_item = std::move(original);
  return local;
}

}  // namespace colod
