// Based on: own work.
// Differs: --rules does not matter here: what stands hundreds of metres off a building is no part
// of it under any rule, and a box that spans both has no voxel left for the building.
// Notation: leaf = points with no gap of kLeastGap along any axis; main = the leaf with most of the
// surface.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "formats.h"

namespace colod::mesh_io {

namespace {

constexpr double kLeastGap = 100;      // metres; nothing nearer is ever a stray
constexpr double kFar = 20;            // times the main leaf's diagonal, for pieces of their own
constexpr double kFarConnected = 200;  // for what faces connect: no wall and no spire is so long
constexpr double kSmall = 0.02;        // of the main leaf's surface …
constexpr double kAbsurd = 1000;  // … and, so many diagonals away, where no scene reaches, …
constexpr double kSmallAbsurd = 0.25;  // … a large triangle left at 0,0,0 of projected coordinates
constexpr double kSmallOfPoints = 0.01;  // of its points: more than noise of a scan
constexpr int kBins = 4096;
constexpr std::size_t kMostLeaves = 1000;

/// Can there be a gap at all? Cheap: most buildings have none.
bool may_have_gap(const std::vector<Vec3>& points, const std::vector<int>& items, int axis) {
  double low = INFINITY, high = -INFINITY;
  for (const int i : items)
    low = std::min(low, points[i][axis]), high = std::max(high, points[i][axis]);
  if (!(high - low >= kLeastGap)) return false;
  const double bin = kLeastGap / 2;
  if ((high - low) / bin >= kBins) return true;
  std::vector<char> is_full(kBins + 1, 0);
  for (const int i : items) is_full[static_cast<int>((points[i][axis] - low) / bin)] = 1;
  const auto end = is_full.begin() + static_cast<int>((high - low) / bin);
  return std::find(is_full.begin(), end, 0) != end;
}

/// The items in groups between gaps along an axis; one group: there is none.
std::vector<std::vector<int>> cut(const std::vector<Vec3>& points, std::vector<int> items,
                                  int axis) {
  std::sort(items.begin(), items.end(),
            [&](int a, int b) { return points[a][axis] < points[b][axis]; });
  std::vector<std::vector<int>> groups(1);
  for (std::size_t k = 0; k < items.size(); ++k) {
    if (k > 0 && points[items[k]][axis] - points[items[k - 1]][axis] >= kLeastGap)
      groups.emplace_back();
    groups.back().push_back(items[k]);
  }
  return groups;
}

/// Point → leaf; −1: not among `items`. More than kMostLeaves are no building with strays: `count`
/// is 0 then.
std::vector<int> find_leaves(const std::vector<Vec3>& points, std::vector<int> items, int& count) {
  std::vector<int> leaf(points.size(), -1);
  std::vector<std::vector<int>> open;
  open.push_back(std::move(items));
  for (count = 0; !open.empty();) {
    std::vector<int> all = std::move(open.back());
    open.pop_back();
    std::vector<std::vector<int>> groups;
    for (int axis = 0; axis < 3 && groups.size() < 2; ++axis)
      if (may_have_gap(points, all, axis)) groups = cut(points, all, axis);
    if (groups.size() > 1) {
      for (std::vector<int>& group : groups) open.push_back(std::move(group));
    } else {
      for (const int i : all) leaf[i] = count;
      ++count;
    }
    if (open.size() + static_cast<std::size_t>(count) > kMostLeaves) return count = 0, leaf;
  }
  return leaf;
}

double area_of(const std::vector<Vec3>& p, const Face& f) {
  return 0.5 * (p[f[1]] - p[f[0]]).cross(p[f[2]] - p[f[0]]).norm();
}

/// Twice the area over the longest edge: how wide a sliver is.
double width_of(const std::vector<Vec3>& p, const Face& f) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) longest = std::max(longest, (p[f[k]] - p[f[(k + 1) % 3]]).norm());
  return longest > 0 ? 2 * area_of(p, f) / longest : 0;
}

/// Decides about the leaves of one mesh or cloud.
class Judge {
 public:
  Judge(const std::vector<Vec3>& points, const std::vector<Face>& faces, std::vector<int> leaf,
        int count)
      : points_(points), faces_(faces), leaf_(std::move(leaf)), box_(count), weight_(count, 0) {}

  std::vector<char> judge() {
    measure();
    main_ = static_cast<int>(std::max_element(weight_.begin(), weight_.end()) - weight_.begin());
    if (!(weight_[main_] > 0)) return {};
    is_far_.assign(weight_.size(), 1);
    keep_nearer(kFar);
    keep_connected();
    if (!is_small(kSmall)) {
      keep_nearer(kAbsurd);
      if (!is_small(kSmallAbsurd)) return {};
    }
    std::vector<char> is_stray(points_.size(), 0);
    for (std::size_t i = 0; i < leaf_.size(); ++i) is_stray[i] = is_far(static_cast<int>(i));
    const bool is_any = std::find(is_stray.begin(), is_stray.end(), 1) != is_stray.end();
    return is_any ? is_stray : std::vector<char>();
  }

 private:
  bool is_far(int point) const { return leaf_[point] >= 0 && is_far_[leaf_[point]]; }
  double reach(double times) const { return std::max(kLeastGap, times * box_[main_].diagonal()); }
  double distance(int l) const {
    const Vec3 beyond = (box_[main_].min - box_[l].max).cwiseMax(box_[l].min - box_[main_].max);
    return beyond.cwiseMax(0.0).norm();
  }

  void measure() {
    for (std::size_t i = 0; i < leaf_.size(); ++i)
      if (leaf_[i] >= 0) box_[leaf_[i]].extend(points_[i]), weight_[leaf_[i]] += faces_.empty();
    for (const Face& f : faces_)
      if (leaf_[f[0]] >= 0 && leaf_[f[0]] == leaf_[f[1]] && leaf_[f[0]] == leaf_[f[2]])
        weight_[leaf_[f[0]]] += area_of(points_, f);
  }

  /// What lies nearer than so many diagonals is not far.
  void keep_nearer(double times) {
    for (std::size_t l = 0; l < is_far_.size(); ++l)
      if (distance(static_cast<int>(l)) < reach(times)) is_far_[l] = 0;
  }

  /// A face that leads to a far leaf makes it a part of the building, unless it is a sliver that no
  /// building has.
  void keep_connected() {
    for (const Face& f : faces_) {
      const auto far = std::count_if(f.begin(), f.end(), [&](int v) { return is_far(v); });
      if (far == 0 || far == 3) continue;
      for (const int v : f)
        if (is_far(v) && (distance(leaf_[v]) < reach(kFarConnected) ||
                          width_of(points_, f) > box_[main_].diagonal()))
          is_far_[leaf_[v]] = 0;
    }
  }

  /// All that is far together, faces between far leaves included: of the main leaf's surface.
  bool is_small(double most) const {
    double far = 0;
    for (const Face& f : faces_)
      if (is_far(f[0]) && is_far(f[1]) && is_far(f[2])) far += area_of(points_, f);
    for (std::size_t l = 0; l < is_far_.size() && faces_.empty(); ++l)
      if (is_far_[l]) far += weight_[l];
    return far <= (faces_.empty() ? kSmallOfPoints : most) * weight_[main_];
  }

  const std::vector<Vec3>& points_;
  const std::vector<Face>& faces_;
  std::vector<int> leaf_;
  std::vector<Box> box_;
  std::vector<double> weight_;  // square metres, or points
  std::vector<char> is_far_;
  int main_ = 0;
};

/// Lets go of the faces that touch a stray and of the vertices that none uses any more.
void drop(Source& source, const std::vector<char>& is_stray) {
  Mesh& mesh = source.mesh;
  std::vector<int> number(mesh.vertices.size(), -1), faces;
  Mesh kept;
  std::vector<int> objects;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Face& f = mesh.faces[i];
    if (is_stray[f[0]] || is_stray[f[1]] || is_stray[f[2]]) continue;
    for (const int v : f) number[v] = 0;
    kept.faces.push_back(f);
    faces.push_back(static_cast<int>(i));
    if (!source.face_object.empty()) objects.push_back(source.face_object[i]);
  }
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(kept.vertices.size());
    kept.vertices.push_back(mesh.vertices[v]);
  }
  for (Face& f : kept.faces)
    for (int& v : f) v = number[v];
  mesh = std::move(kept);
  source.face_object = std::move(objects);
  source.look.pick(faces);
}

void drop_points(Source& source, const std::vector<char>& is_stray) {
  PointCloud kept;
  std::vector<int> which;
  const PointCloud& cloud = source.cloud;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (is_stray[i]) continue;
    which.push_back(static_cast<int>(i));
    kept.points.push_back(cloud.points[i]);
    if (!cloud.normals.empty()) kept.normals.push_back(cloud.normals[i]);
  }
  source.cloud = std::move(kept);
  source.look.pick(which);
}

/// Of what goes: the area of whole pieces, not of slivers that lead to a stray vertex.
LeftOut measure(const Source& s, const std::vector<char>& is_stray) {
  LeftOut out;
  double total = 0;
  for (const Face& f : s.mesh.faces) {
    const int strays = is_stray[f[0]] + is_stray[f[1]] + is_stray[f[2]];
    const double area = strays == 0 || strays == 3 ? face_area(s.mesh, f) : 0;
    total += area;
    if (strays == 3) out.area += area;
  }
  const std::vector<Vec3>& points = s.is_mesh() ? s.mesh.vertices : s.cloud.points;
  const auto count = std::count(is_stray.begin(), is_stray.end(), 1);
  out.share = s.is_mesh() ? (total > 0 ? out.area / total : 0)
                          : static_cast<double>(count) / static_cast<double>(points.size());
  Box kept;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!is_stray[i]) kept.extend(points[i]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_stray[i]) continue;
    const Vec3 beyond = (kept.min - points[i]).cwiseMax(points[i] - kept.max).cwiseMax(0.0);
    out.farthest = std::max(out.farthest, beyond.norm());
  }
  return out;
}

}  // namespace

std::vector<char> find_strays(const std::vector<Vec3>& points, const std::vector<Face>& faces) {
  std::vector<char> is_used(points.size(), faces.empty());
  for (const Face& f : faces)
    for (const int v : f) is_used[v] = 1;
  std::vector<int> items;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (is_used[i] && is_usable(points[i])) items.push_back(static_cast<int>(i));
  if (items.empty()) return {};
  int leaves = 0;
  std::vector<int> leaf = find_leaves(points, std::move(items), leaves);
  if (leaves < 2) return {};
  return Judge(points, faces, std::move(leaf), leaves).judge();
}

void leave_out_strays(Source& s) {
  const std::vector<Vec3>& points = s.is_mesh() ? s.mesh.vertices : s.cloud.points;
  const std::vector<char> is_stray = find_strays(points, s.mesh.faces);
  if (is_stray.empty()) return;
  const LeftOut out = measure(s, is_stray);
  const auto count = std::count(is_stray.begin(), is_stray.end(), 1);
  s.warnings.push_back(std::to_string(count) + (s.is_mesh() ? " vertices" : " points") +
                       " left out with their faces: they lie " +
                       std::to_string(std::llround(out.farthest)) +
                       " m away from all the rest; --split component keeps pieces apart");
  s.left_out.push_back(out);
  if (s.is_mesh())
    drop(s, is_stray);
  else
    drop_points(s, is_stray);
}

}  // namespace colod::mesh_io
