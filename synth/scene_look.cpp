// *Based on:* own work; atlases of photogrammetry programs, which cut surfaces into charts by where
// they look.
//
// *Differs:* no --rules here.
//
// *Notation:* axis 0, 1: ±x, ±y; 2: up; a chart is seen against its axis.
#include "scene_look.h"

#include <algorithm>
#include <cmath>

#include "image/packing.h"
#include "materials.h"

namespace colod::synth {
namespace {

constexpr double kUpright =
    0.42;  // a normal's z from which on a face belongs to a chart seen from above
constexpr double kStillFaces = 0.2;  // cosine to its axis that a face of a chart has at least
constexpr int kGutterOfTile = 2;     // texels
constexpr int kLargestTile = 8192;   // texels
constexpr double kLook = 2.2;        // m before the surface from which a wall is looked at
constexpr double kBehind = 2;        // m behind the surface up to which it is
const Vec3 kSun = Vec3(-0.5, -0.42, 0.76).normalized();

const std::array<Vec3, 5> kAxes = {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0),
                                   Vec3(0, 0, 1)};

struct Chart {
  int axis = 4;
  std::vector<int> faces;
  Vec3 right, down;
  Vec2 corner = Vec2::Constant(INFINITY), size = Vec2::Zero();

  Vec2 flat(const Vec3& p) const { return {right.dot(p), down.dot(p)}; }
};

Vec3 unit_normal(const Mesh& mesh, const Face& f) {
  const Vec3 cross = face_cross(mesh, f);
  return cross.norm() > 0 ? Vec3(cross.normalized()) : Vec3(Vec3::UnitZ());
}

/// Up to three faces beside each; −1: none.
std::vector<std::array<int, 3>> faces_beside(const Mesh& mesh) {
  struct Half {
    std::pair<int, int> edge;
    int face, side;
  };
  std::vector<Half> halves;
  for (int f = 0; f < static_cast<int>(mesh.faces.size()); ++f)
    for (int k = 0; k < 3; ++k)
      halves.push_back({std::minmax(mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]), f, k});
  std::sort(halves.begin(), halves.end(), [](const Half& a, const Half& b) {
    return std::tie(a.edge, a.face) < std::tie(b.edge, b.face);
  });
  std::vector<std::array<int, 3>> beside(mesh.faces.size(), {-1, -1, -1});
  for (std::size_t i = 0; i + 1 < halves.size(); ++i)
    if (halves[i].edge == halves[i + 1].edge) {
      beside[halves[i].face][halves[i].side] = halves[i + 1].face;
      beside[halves[i + 1].face][halves[i + 1].side] = halves[i].face;
    }
  return beside;
}

int main_axis(const Vec3& n) {
  if (n.z() > kUpright) return 4;
  if (std::abs(n.x()) > std::abs(n.y())) return n.x() > 0 ? 0 : 1;
  return n.y() > 0 ? 2 : 3;
}

/// Where each face looks, single faces as their neighbours do.
std::vector<int> choose_axes(const std::vector<Vec3>& normals,
                             const std::vector<std::array<int, 3>>& beside) {
  constexpr int kRounds = 4;
  std::vector<int> axis(normals.size());
  for (std::size_t f = 0; f < normals.size(); ++f) axis[f] = main_axis(normals[f]);
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<int> old = axis;
    for (std::size_t f = 0; f < normals.size(); ++f)
      for (int k = 0; k < 3; ++k) {
        const int a = beside[f][k], b = beside[f][(k + 1) % 3];
        if (a >= 0 && b >= 0 && old[a] == old[b] && kAxes[old[a]].dot(normals[f]) > kStillFaces)
          axis[f] = old[a];
      }
  }
  return axis;
}

std::vector<Chart> cut_charts(const Mesh& mesh, const std::vector<Vec3>& normals) {
  const auto beside = faces_beside(mesh);
  const std::vector<int> axis = choose_axes(normals, beside);
  std::vector<Chart> charts;
  std::vector<char> is_taken(mesh.faces.size(), 0);
  for (int seed = 0; seed < static_cast<int>(mesh.faces.size()); ++seed) {
    if (is_taken[seed]) continue;
    Chart chart;
    chart.axis = axis[seed], chart.faces = {seed};
    is_taken[seed] = 1;
    for (std::size_t i = 0; i < chart.faces.size(); ++i)
      for (const int f : beside[chart.faces[i]])
        if (f >= 0 && !is_taken[f] && axis[f] == chart.axis)
          is_taken[f] = 1, chart.faces.push_back(f);
    const Vec3 a = kAxes[chart.axis];
    chart.right = chart.axis == 4 ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitZ().cross(a));
    chart.down = chart.axis == 4 ? Vec3(-Vec3::UnitY()) : Vec3(-Vec3::UnitZ());
    Vec2 most = Vec2::Constant(-INFINITY);
    for (const int f : chart.faces)
      for (const int v : mesh.faces[f]) {
        chart.corner = chart.corner.cwiseMin(chart.flat(mesh.vertices[v]));
        most = most.cwiseMax(chart.flat(mesh.vertices[v]));
      }
    chart.size = most - chart.corner;
    charts.push_back(std::move(chart));
  }
  return charts;
}

/// What places look like.
class Colors {
 public:
  explicit Colors(const Sight& sight) : sight_(sight) {}

  Light at(const Vec3& p, const Vec3& normal, const Vec3& axis) const {
    const int object = sight_.object_below(p, normal);
    const int plots = static_cast<int>(sight_.town.plots().size());
    if (object < 0) return lit(ground(p, normal), normal);
    if (object < plots) return building(object, p, normal, axis);
    return lit(prop(sight_.town.props()[object - plots], p, normal), normal);
  }

 private:
  static Light lit(const Light& own, const Vec3& normal) {
    const double sun = std::max(0.0, kSun.dot(normal));
    return (0.55 + 0.6 * sun) * own;
  }

  static double grain(const Vec3& p, double size, long seed) {
    return smooth_noise(p / size, seed);
  }

  Light ground(const Vec3& p, const Vec3& normal) const {
    const Light grass =
        (0.6 + 0.25 * grain(p, 0.25, 1) + 0.35 * grain(p, 1.9, 2)) * Light(0.13, 0.2, 0.05);
    const double fine = 0.85 + 0.2 * grain(p, 0.2, 3);
    const GroundKind kind = sight_.town.kind_at(p.head<2>());
    if (normal.z() < 0.55) return fine * Light(0.3, 0.27, 0.23);
    switch (kind) {
      case GroundKind::kRoad: {
        const Vec2 on = sight_.town.on_road(p.head<2>());
        const bool is_mark = std::abs(on.x()) < 0.1 && on.y() - 6 * std::floor(on.y() / 6) < 3;
        return is_mark ? Light(0.7, 0.7, 0.68) : Light(fine * Light(0.1, 0.1, 0.105));
      }
      case GroundKind::kWalk:
        return fine * Light(0.33, 0.32, 0.3);
      case GroundKind::kPaved:
        return fine * Light(0.24, 0.235, 0.22);
      case GroundKind::kMeadow:
        return grass + Light(0.03, 0.02, 0);
      case GroundKind::kGarden:
        break;
    }
    return grain(p, 3.1, 5) > 0.88 ? Light(fine * Light(0.2, 0.14, 0.08)) : grass;
  }

  static Light prop(const Prop& prop, const Vec3& p, const Vec3& normal) {
    if (prop.kind == PropKind::kTree || prop.kind == PropKind::kHedge) {
      const double tone = noise(prop.seed, 1, 2);
      const Light leaf = Light(0.05 + 0.07 * tone, 0.12 + 0.06 * tone, 0.03);
      return (0.5 + 0.6 * grain(p, 0.3, prop.seed) + 0.4 * grain(p, 0.9, 3)) * leaf;
    }
    if (prop.kind == PropKind::kFence)
      return (0.8 + 0.3 * grain(p, 0.15, 4)) * Light(0.26, 0.18, 0.11);
    if (normal.z() < 0.4 && p.z() > prop.foot + 0.6 * prop.height) return {0.03, 0.035, 0.04};
    const double hue = noise(prop.seed, 7, 1);
    if (hue < 0.3) return {0.65, 0.65, 0.66};
    if (hue < 0.55) return {0.05, 0.05, 0.055};
    return hue < 0.75 ? Light(0.4, 0.04, 0.04) : Light(0.08, 0.13, 0.35);
  }

  /// Paler than paint, each house in a tone of its own; decks are gravel.
  static Light weathered(const Spot& spot, long seed) {
    constexpr double kPale = 0.35;
    const Vec3& p = spot.place;
    const double dirt = 0.8 + 0.35 * grain(p, 1.3, seed);
    const double tone = noise(seed, 8, 1), shade = 0.75 + 0.5 * noise(seed, 9, 2);
    if (spot.normal.z() > 0.985)
      return dirt * shade * (0.8 + 0.3 * grain(p, 0.2, 1)) * Light(0.3, 0.29, 0.27);
    const Light own = Paint(0, seed).at(spot, p);
    const Light pale = (1 - kPale) * own + kPale * own.mean() * Light::Ones();
    return dirt * shade * pale.cwiseProduct(Light(1, 0.92 + 0.2 * tone, 0.85 + 0.4 * tone));
  }

  /// As the clean model shows it where a camera looked along the chart's axis.
  Light building(int plot, const Vec3& p, const Vec3& normal, const Vec3& axis) const {
    const Standing& house = sight_.standing.at(plot);
    const Vec3 own = house.to_own(p);
    const Mesh& mesh = house.model.source.mesh;
    Spot spot{own, normal, ElementKind::kPlain};
    const RayHit hit = house.rays.first_hit(own + kLook * axis, -axis, 0, kLook + kBehind);
    int face = hit ? hit.triangle : -1;
    if (hit && !hit.is_inside)
      spot.place = own + (kLook - hit.distance) * axis;
    else if (const NearestPoint near = house.rays.nearest(own); near.triangle >= 0)
      face = near.triangle, spot.place = near.point;
    if (face >= 0) {
      spot.normal = unit_normal(mesh, mesh.faces[face]);
      const int part = house.model.source.face_object[face];
      if (part >= 0) spot.kind = house.model.parts[part].kind;
    }
    return lit(weathered(spot, static_cast<long>(house.plot->seed % 1000003)), spot.normal);
  }

  const Sight& sight_;
};

/// A picture that remembers which texels have been painted.
struct Canvas {
  Raster raster;
  std::vector<char> is_painted;

  Canvas(int width, int height)
      : raster(width, height), is_painted(static_cast<std::size_t>(width) * height, 0) {}
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * raster.width + x; }
};

void set_texel(Canvas& canvas, int x, int y, const Light& light) {
  for (int c = 0; c < 3; ++c)
    canvas.raster.at(x, y)[c] = to_srgb(static_cast<float>(std::clamp(light[c], 0.0, 1.0)));
  canvas.is_painted[canvas.index(x, y)] = 1;
}

struct Placed {
  Chart chart;
  PackedRect rect;
  double texel = 0.1;

  Vec2 texels(const Vec3& p) const {
    return (chart.flat(p) - chart.corner) / texel +
           Vec2(rect.x + kGutterOfTile, rect.y + kGutterOfTile);
  }
};

/// Texels whose middle lies in a face, or up to one beside it.
void paint_face(const Mesh& mesh, const Face& f, const Vec3& normal, const Placed& placed,
                const Colors& colors, Canvas& canvas) {
  std::array<Vec2, 3> q;
  Vec2 low = Vec2::Constant(INFINITY), high = Vec2::Constant(-INFINITY);
  for (int k = 0; k < 3; ++k) {
    q[k] = placed.texels(mesh.vertices[f[k]]);
    low = low.cwiseMin(q[k]), high = high.cwiseMax(q[k]);
  }
  const auto cross = [](const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); };
  const double twice = cross(q[1] - q[0], q[2] - q[0]);
  if (std::abs(twice) < 1e-9) return;
  const PackedRect& r = placed.rect;
  const int x1 = std::min(r.x + r.width - 1, static_cast<int>(high.x() + 1));
  const int y1 = std::min(r.y + r.height - 1, static_cast<int>(high.y() + 1));
  for (int y = std::max(r.y, static_cast<int>(low.y() - 1)); y <= y1; ++y)
    for (int x = std::max(r.x, static_cast<int>(low.x() - 1)); x <= x1; ++x) {
      const Vec2 at(x + 0.5, y + 0.5);
      Vec3 weight;
      double outside = 0;
      for (int k = 0; k < 3; ++k) {
        const Vec2 side = q[(k + 2) % 3] - q[(k + 1) % 3];
        weight[k] = cross(side, at - q[(k + 1) % 3]) / twice;
        outside = std::max(outside, -weight[k] * std::abs(twice) / (side.norm() + 1e-9));
      }
      if (outside > 1 || (outside > 0 && canvas.is_painted[canvas.index(x, y)])) continue;
      weight = weight.cwiseMax(0.0);
      weight /= weight.sum();
      Vec3 p = Vec3::Zero();
      for (int k = 0; k < 3; ++k) p += weight[k] * mesh.vertices[f[k]];
      set_texel(canvas, x, y, colors.at(p, normal, kAxes[placed.chart.axis]));
    }
}

/// What no face shows is as what lies beside it, so that filters see no black.
void spread(Canvas& canvas) {
  constexpr int kRounds = 4;
  Raster& raster = canvas.raster;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<char> was = canvas.is_painted;
    for (int y = 0; y < raster.height; ++y)
      for (int x = 0; x < raster.width; ++x) {
        if (was[canvas.index(x, y)]) continue;
        for (const auto& [dx, dy] : {std::pair(-1, 0), {1, 0}, {0, -1}, {0, 1}}) {
          const int i = std::clamp(x + dx, 0, raster.width - 1);
          const int j = std::clamp(y + dy, 0, raster.height - 1);
          if (!was[canvas.index(i, j)]) continue;
          std::copy_n(raster.at(i, j), 3, raster.at(x, y));
          canvas.is_painted[canvas.index(x, y)] = 1;
          break;
        }
      }
  }
}

/// Coarser where the picture would be too large.
std::vector<Placed> place_charts(std::vector<Chart> charts, double texel,
                                 std::array<int, 2>& size) {
  std::vector<Placed> placed;
  for (Chart& chart : charts) placed.push_back({std::move(chart), {}, texel});
  for (int attempt = 0; attempt < 40; ++attempt) {
    std::vector<PackedRect> rects;
    for (Placed& p : placed) {
      if (attempt > 0) p.texel *= 1.2;
      const auto side = [&](double metres) {
        return (static_cast<int>(std::ceil(metres / p.texel)) + 2 * kGutterOfTile + 3) / 4 * 4;
      };
      rects.push_back({side(p.chart.size.x()), side(p.chart.size.y())});
    }
    size = pack_rects(rects, kLargestTile);
    if (size[0] == 0) continue;
    for (std::size_t i = 0; i < placed.size(); ++i) placed[i].rect = rects[i];
    break;
  }
  return placed;
}

}  // namespace

SynthClass Sight::class_of(int object) const {
  const int plots = static_cast<int>(town.plots().size());
  if (object < 0) return SynthClass::kGround;
  if (object < plots) return SynthClass::kBuilding;
  const PropKind kind = town.props()[object - plots].kind;
  return kind == PropKind::kTree || kind == PropKind::kHedge ? SynthClass::kPlant
                                                             : SynthClass::kRest;
}

int Sight::object_below(const Vec3& p, const Vec3& normal) const {
  constexpr int kSteps = 3;
  const double step = view.cell;
  for (int i = 1; i <= kSteps; ++i) {
    const Vec2 in = p.head<2>() - i * step * normal.head<2>();
    const std::size_t at = view.at(view.column(in.x()), view.row(in.y()));
    // A wall's foot may lie before what it belongs to, and a rim beyond it.
    if (i == kSteps || std::abs(normal.z()) > 0.7 || view.top[at] > p.z() - 0.3)
      return view.object[at];
  }
  return SkyView::kGround;
}

void paint_tile(const Sight& sight, double texel, SynthTile& tile) {
  const Mesh& mesh = tile.mesh;
  std::vector<Vec3> normals;
  for (const Face& f : mesh.faces) normals.push_back(unit_normal(mesh, f));
  std::array<int, 2> size = {0, 0};
  const std::vector<Placed> placed = place_charts(cut_charts(mesh, normals), texel, size);
  Canvas canvas(size[0], size[1]);
  const Colors colors(sight);
  tile.uvs.resize(mesh.faces.size());
  for (const Placed& p : placed)
    for (const int f : p.chart.faces) {
      paint_face(mesh, mesh.faces[f], normals[f], p, colors, canvas);
      for (int k = 0; k < 3; ++k) {
        const Vec2 at = p.texels(mesh.vertices[mesh.faces[f][k]]);
        tile.uvs[f][k] =
            Vec2f(static_cast<float>(at.x() / size[0]), static_cast<float>(at.y() / size[1]));
      }
    }
  spread(canvas);
  tile.picture = std::move(canvas.raster);
}

void tell_truth(const Sight& sight, const TilePlace& place, SynthTile& tile) {
  const SkyView& view = sight.view;
  const int width = 2 * place.columns, height = 2 * place.rows;
  const int x0 = 2 * place.i0, y0 = 2 * place.j0;
  tile.truth = Raster(width, height);
  tile.truth_corner = view.cell * Vec2(x0, y0);
  const int plots = static_cast<int>(sight.town.plots().size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int object = view.object[view.at(x0 + x, y0 + y)];
      const int number = object >= 0 && object < plots ? object + 1 : 0;
      std::uint8_t* pixel = tile.truth.at(x, height - 1 - y);
      pixel[0] = static_cast<std::uint8_t>(sight.class_of(object));
      pixel[1] = static_cast<std::uint8_t>(number >> 8);
      pixel[2] = static_cast<std::uint8_t>(number & 255);
    }
  for (const Face& f : tile.mesh.faces) {
    const auto& v = tile.mesh.vertices;
    const Vec3 middle = (v[f[0]] + v[f[1]] + v[f[2]]) / 3;
    const int object = sight.object_below(middle, unit_normal(tile.mesh, f));
    tile.face_class.push_back(static_cast<std::uint8_t>(sight.class_of(object)));
  }
}

}  // namespace colod::synth
