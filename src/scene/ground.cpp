// Based on: the usual raster view of terrain filters (Zhang et al., "A progressive morphological
// filter for removing nonground measurements", IEEE TGRS 41(4), 2003), but grown from the rim
// inward: here the question is mainly whether there is any ground at all.
// Differs: --rules robust only; the paper is given buildings. Thresholds are metres of real
// buildings, not of any file.
// Notation: top, low: highest and lowest surface over a cell; h: the ground's height, known on its
// cells and taken from the nearest one elsewhere; rim: covered cells beside the open outside.
#include "ground.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "left_out.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::ground;

struct HeightRaster {
  Vec2 origin;
  double cell = 1;
  int nx = 0, ny = 0;
  std::vector<double> top, low;  ///< −∞, +∞: nothing there

  int size() const { return nx * ny; }
  bool is_covered(int c) const { return top[c] > -kInfinity; }
  int cell_of(const Vec3& p) const {
    const auto along = [](double cells, int n) {  // what is no number is in the first cell
      return cells > 0 ? static_cast<int>(std::min<double>(cells, n - 1)) : 0;
    };
    return along((p.y() - origin.y()) / cell, ny) * nx + along((p.x() - origin.x()) / cell, nx);
  }
  /// Calls visit(neighbour) for the cells within `reach` cells, itself not.
  template <typename Visit>
  void around(int c, int reach, const Visit& visit) const {
    const int x = c % nx, y = c / nx;
    for (int v = std::max(0, y - reach); v <= std::min(ny - 1, y + reach); ++v)
      for (int u = std::max(0, x - reach); u <= std::min(nx - 1, x + reach); ++u)
        if (v * nx + u != c) visit(v * nx + u);
  }
};

/// Calls visit(cell, height) at points of the face closer together than cells in so many
/// dimensions: 2, the plan, or 3.
template <int kDimensions, typename Visit>
void sample_face(const Mesh& mesh, const Face& f, const HeightRaster& r, const Visit& visit) {
  constexpr int kMostSteps = 4000;
  const Vec3 &a = mesh.vertices[f[0]], &b = mesh.vertices[f[1]], &c = mesh.vertices[f[2]];
  const auto length = [](const Vec3& side) { return side.head<kDimensions>().norm(); };
  const double longest = std::max({length(b - a), length(c - b), length(a - c)});
  if (!std::isfinite(longest)) return;
  const int n = std::clamp(static_cast<int>(std::ceil(2 * longest / r.cell)), 1, kMostSteps);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j) {
      const Vec3 p =
          a + static_cast<double>(i) / n * (b - a) + static_cast<double>(j) / n * (c - a);
      visit(r.cell_of(p), p.z());
    }
}

HeightRaster rasterize(const Mesh& mesh) {
  Box box;
  for (const Face& f : mesh.faces)
    for (const int v : f)
      if (mesh.vertices[v].allFinite()) box.extend(mesh.vertices[v]);
  HeightRaster r;
  if (box.is_empty()) return r;
  constexpr double kMostCells = 2000;  // a side
  r.cell = std::clamp(kCellShare * box.diagonal(), kLeastCell, kMostCell);
  r.cell = std::max(r.cell, box.size().head<2>().maxCoeff() / kMostCells);
  r.origin = box.min.head<2>() - Vec2::Constant(1.5 * r.cell);  // a rim of empty cells
  r.nx = static_cast<int>(box.size().x() / r.cell) + 4;
  r.ny = static_cast<int>(box.size().y() / r.cell) + 4;
  r.top.assign(r.size(), -kInfinity);
  r.low.assign(r.size(), kInfinity);
  for (const Face& f : mesh.faces)
    sample_face<2>(mesh, f, r, [&](int c, double z) {
      r.top[c] = std::max(r.top[c], z);
      r.low[c] = std::min(r.low[c], z);
    });
  return r;
}

/// Numbers of the sets of cells that `is_joined` connects, −1: not `is_in`; in order of cells.
std::vector<int> connect(const HeightRaster& r, const std::function<bool(int)>& is_in,
                         const std::function<bool(int, int)>& is_joined, int* count) {
  std::vector<int> set(r.size(), -1), stack;
  *count = 0;
  for (int seed = 0; seed < r.size(); ++seed) {
    if (set[seed] >= 0 || !is_in(seed)) continue;
    set[seed] = *count;
    stack = {seed};
    while (!stack.empty()) {
      const int c = stack.back();
      stack.pop_back();
      r.around(c, 1, [&](int d) {
        if (set[d] < 0 && is_in(d) && is_joined(c, d)) set[d] = *count, stack.push_back(d);
      });
    }
    ++*count;
  }
  return set;
}

/// Covered cells beside the outside: uncovered cells that are joined with the corner.
std::vector<char> find_rim(const HeightRaster& r) {
  int count = 0;
  const auto open = connect(
      r, [&](int c) { return !r.is_covered(c); }, [](int, int) { return true; }, &count);
  std::vector<char> is_rim(r.size(), 0);
  for (int c = 0; c < r.size(); ++c)
    if (open[c] == 0)  // the first cell of all is empty and outside
      r.around(c, 1, [&](int d) { is_rim[d] = r.is_covered(d); });
  return is_rim;
}

/// The height of the nearest of the given cells, breadth first.
std::vector<double> spread_heights(const HeightRaster& r, const std::vector<char>& is_ground) {
  std::vector<double> h(r.size(), kInfinity);
  std::vector<int> front;
  for (int c = 0; c < r.size(); ++c)
    if (is_ground[c]) h[c] = r.top[c], front.push_back(c);
  for (std::size_t i = 0; i < front.size(); ++i) {
    const int c = front[i];
    r.around(c, 1, [&](int d) {
      if (h[d] == kInfinity) h[d] = h[c], front.push_back(d);
    });
  }
  return h;
}

/// Metres by which the tops of cells are off one plane, root mean square.
double unevenness(const HeightRaster& r, const std::vector<char>& is_in) {
  std::vector<Vec3> points;
  for (int c = 0; c < r.size(); ++c)
    if (is_in[c]) points.push_back({c % r.nx * r.cell, c / r.nx * r.cell, r.top[c]});
  Eigen::MatrixX3d a(points.size(), 3);
  Eigen::VectorXd z(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    a.row(row) << points[i].x(), points[i].y(), 1;
    z[row] = points[i].z();
  }
  const Vec3 plane = (a.transpose() * a).ldlt().solve(a.transpose() * z);
  return std::sqrt((a * plane - z).squaredNorm() / std::max<double>(1, z.size()));
}

/// Whether most of what stands upright on a level is many strips that reach from there to the top
/// of their cell: a tool's skirt. Measured walls have several faces one above the other.
bool has_skirt(const Mesh& mesh, const HeightRaster& r, double plate) {
  double in_one_piece = 0, all = 0;
  int strips = 0;
  for (const Face& f : mesh.faces) {
    const Vec3 &a = mesh.vertices[f[0]], &b = mesh.vertices[f[1]], &c = mesh.vertices[f[2]];
    const Vec3 cross = face_cross(mesh, f);
    const double low = std::min({a.z(), b.z(), c.z()}), high = std::max({a.z(), b.z(), c.z()});
    const bool stands = std::abs(cross.z()) < kPlate * cross.norm() && low <= plate + kPlate;
    if (!stands || !cross.allFinite()) continue;
    all += cross.norm();
    if (high < r.top[r.cell_of((a + b + c) / 3)] - kNoise - kSteepest * r.cell) continue;
    in_one_piece += cross.norm();
    ++strips;
  }
  return strips >= kLeastStrips && in_one_piece >= kOnePiece * all;
}

/// Terrain that a tool has closed: uneven, with a skirt in strips and one level plate below it all.
bool is_closed_plot(const Mesh& mesh, const HeightRaster& r, const std::vector<char>& is_terrain) {
  const double plate = *std::min_element(r.low.begin(), r.low.end());
  int covered = 0, over_plate = 0;
  for (int c = 0; c < r.size(); ++c) {
    covered += r.is_covered(c);
    over_plate += r.is_covered(c) && r.low[c] <= plate + kPlate;
  }
  return over_plate >= kUnderPlate * covered && unevenness(r, is_terrain) >= kUnevenTop &&
         has_skirt(mesh, r, plate);
}

/// The smooth surface with most of the rim; empty: no ground.
std::vector<char> main_surface(const Mesh& mesh, const HeightRaster& r,
                               const std::vector<char>& is_rim) {
  int count = 0;
  const double step = kNoise + kSteepest * r.cell;
  const std::vector<int> surface = connect(
      r, [&](int c) { return r.is_covered(c); },
      [&](int c, int d) { return std::abs(r.top[c] - r.top[d]) <= step; }, &count);
  std::vector<int> rim(count, 0);
  int rim_cells = 0;
  for (int c = 0; c < r.size(); ++c)
    if (is_rim[c]) ++rim[surface[c]], ++rim_cells;
  const int best = static_cast<int>(std::max_element(rim.begin(), rim.end()) - rim.begin());
  if (rim_cells == 0 || rim[best] < kLeastRim * rim_cells) return {};
  // Walls that come down a storey near the rim make it an eave; a skirt is lower.
  const int reach = static_cast<int>(std::ceil(kOverhang / r.cell));
  int free = 0;
  for (int c = 0; c < r.size(); ++c) {
    if (!is_rim[c] || surface[c] != best) continue;
    double low = r.low[c];
    r.around(c, reach, [&](int d) { low = std::min(low, r.low[d]); });
    free += low > r.top[c] - kRise;
  }
  std::vector<char> is_ground(r.size(), 0);
  for (int c = 0; c < r.size(); ++c) is_ground[c] = surface[c] == best;
  const bool is_free = free >= kMostly * rim[best];
  return is_free || is_closed_plot(mesh, r, is_ground) ? is_ground : std::vector<char>();
}

/// Most cells at the buildings' border have a wall that comes down to the ground.
bool has_walls(const Mesh& mesh, const HeightRaster& r, const std::vector<double>& h,
               const std::vector<char>& is_built) {
  std::vector<double> foot(r.size(), kInfinity);  // metres above the ground, itself not
  for (const Face& f : mesh.faces)
    sample_face<3>(mesh, f, r, [&](int c, double z) {
      if (z > h[c] + kGroundLayer) foot[c] = std::min(foot[c], z - h[c]);
    });
  const int reach = static_cast<int>(std::ceil(kReach / r.cell));
  int border = 0, walled = 0;
  for (int c = 0; c < r.size(); ++c) {
    if (!is_built[c] || r.top[c] < h[c] + kRise) continue;
    bool is_border = false;
    double least = foot[c];
    r.around(c, 1, [&](int d) { is_border |= r.is_covered(d) && !is_built[d]; });
    if (!is_border) continue;
    r.around(c, reach, [&](int d) { least = std::min(least, foot[d]); });
    ++border;
    walled += least <= kFoot;
  }
  return border > 0 && 2 * walled >= border;
}

struct Blob {
  int cells = 0;
  std::vector<double> heights;

  double height() {
    const auto place = heights.begin() + 3 * heights.size() / 4;
    std::nth_element(heights.begin(), place, heights.end());
    return *place;
  }
};

/// Which built cells are buildings: large and high enough. Empty: none is.
std::vector<char> find_buildings(const HeightRaster& r, const std::vector<double>& h,
                                 const std::vector<char>& is_built, int* dropped) {
  int count = 0;
  const std::vector<int> number = connect(
      r, [&](int c) { return is_built[c] != 0; }, [](int, int) { return true; }, &count);
  std::vector<Blob> blobs(count);
  for (int c = 0; c < r.size(); ++c)
    if (number[c] >= 0)
      ++blobs[number[c]].cells, blobs[number[c]].heights.push_back(r.top[c] - h[c]);
  int largest = 0;
  std::vector<char> is_kept(count, 0);
  for (int b = 0; b < count; ++b)
    if ((is_kept[b] = blobs[b].height() >= kRise)) largest = std::max(largest, blobs[b].cells);
  if (largest == 0) return {};
  *dropped = 0;
  for (int b = 0; b < count; ++b) {
    is_kept[b] = is_kept[b] && blobs[b].cells >= kSmallBlob * largest;
    *dropped += !is_kept[b];
  }
  std::vector<char> is_building(r.size(), 0);
  for (int c = 0; c < r.size(); ++c) is_building[c] = number[c] >= 0 && is_kept[number[c]];
  return is_building;
}

struct Site {
  HeightRaster raster;
  std::vector<double> ground;     ///< h
  std::vector<char> is_building;  ///< empty: there is no ground to part from
  int things = 0;                 ///< that stand about
};

Site survey(const Mesh& mesh) {
  Site site{rasterize(mesh), {}, {}, 0};
  const HeightRaster& r = site.raster;
  if (r.size() == 0) return site;
  const std::vector<char> is_ground = main_surface(mesh, r, find_rim(r));
  if (is_ground.empty()) return site;
  site.ground = spread_heights(r, is_ground);
  const std::vector<double>& h = site.ground;
  std::vector<char> is_built(r.size(), 0);
  int covered = 0, built = 0;
  for (int c = 0; c < r.size(); ++c) {
    is_built[c] = r.is_covered(c) && r.top[c] > h[c] + kOnGround;
    covered += r.is_covered(c);
    built += r.is_covered(c) && r.top[c] > h[c] + kRise;
  }
  const double least = std::min(kLeastBuilt * covered, kSurelyBuilt / (r.cell * r.cell));
  if (built < least || !has_walls(mesh, r, h, is_built)) return site;
  site.is_building = find_buildings(r, h, is_built, &site.things);
  return site;
}

/// A cell beside a building is its wall's too.
std::vector<char> widened(const HeightRaster& r, const std::vector<char>& is_in) {
  std::vector<char> wide = is_in;
  for (int c = 0; c < r.size(); ++c)
    if (is_in[c]) r.around(c, 1, [&](int d) { wide[d] = 1; });
  return wide;
}

Source keep_faces(const Source& source, const std::vector<char>& is_kept) {
  Source part = source;
  part.mesh = {};
  part.face_object.clear();
  std::vector<int> kept;
  std::vector<char> is_used(source.mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < is_kept.size(); ++i)
    for (const int v : source.mesh.faces[i]) is_used[v] |= is_kept[i];
  std::vector<int> number(is_used.size(), -1);
  for (std::size_t v = 0; v < is_used.size(); ++v) {
    if (!is_used[v]) continue;
    number[v] = static_cast<int>(part.mesh.vertices.size());
    part.mesh.vertices.push_back(source.mesh.vertices[v]);
  }
  for (std::size_t i = 0; i < is_kept.size(); ++i) {
    if (!is_kept[i]) continue;
    const Face& f = source.mesh.faces[i];
    part.mesh.faces.push_back({number[f[0]], number[f[1]], number[f[2]]});
    kept.push_back(static_cast<int>(i));
    if (!source.face_object.empty()) part.face_object.push_back(source.face_object[i]);
  }
  part.look.pick(kept);
  return part;
}

}  // namespace

Source separate_ground(Source source) {
  if (!source.is_mesh()) return source;
  const Mesh& mesh = source.mesh;
  const Site site = survey(mesh);
  if (site.is_building.empty()) return source;
  const std::vector<char> is_near = widened(site.raster, site.is_building);
  std::vector<char> is_kept(mesh.faces.size(), 0);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Face& f = mesh.faces[i];
    const Vec3 center = (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3;
    const Vec3 cross = face_cross(mesh, f);
    if (!center.allFinite()) continue;
    const int c = site.raster.cell_of(center);
    const bool is_level = std::abs(cross.z()) > kGroundNormal * cross.norm();
    is_kept[i] = is_near[c] && !(is_level && center.z() < site.ground[c] + kGroundLayer);
  }
  if (std::none_of(is_kept.begin(), is_kept.end(), [](char k) { return k; })) return source;
  Source building = keep_faces(source, is_kept);
  std::vector<char> is_left_out(is_kept.size());
  for (std::size_t i = 0; i < is_kept.size(); ++i) is_left_out[i] = !is_kept[i];
  building.left_out.push_back(
      measure_left_out(source, is_left_out, LeftOut::Reason::kGround, source.left_out));
  char text[160];
  std::snprintf(text, sizeof text,
                "stands on its own ground: %.0f m2 of terrain and %d things on it are left out",
                building.left_out.back().area, site.things);
  building.warnings.push_back(text);
  return building;
}

}  // namespace colod
