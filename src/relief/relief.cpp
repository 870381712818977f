// Based on: reconstruction of buildings from height fields (Zhou & Neumann 2010, 2012; Peters et
// al., "Automated 3D reconstruction of LoD2 and LoD1 models for all 10 million buildings of the
// Netherlands", PE&RS 88(3), 2022). Differs: from a mesh, and only where that knows no more: the
// paper's own planes follow. Notation: –
#include "relief.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "blocks.h"
#include "borders.h"
#include "core/rays.h"
#include "field.h"
#include "ground.h"
#include "labels.h"
#include "melting.h"
#include "parameters.h"
#include "patches.h"
#include "roofs.h"

namespace colod {
namespace {

using namespace relief;
using namespace parameters::relief;

/// The plan of a building: labels with their roofs, and borders.
struct Plan {
  Field field;
  Ground ground;
  Labels labels;
  Borders borders;
  double noise = 0, tolerance = 0;
  double direction = 0;  ///< radians: of most border

  Vec3 raised(const Vec2& p, int label) const {
    const double z =
        label == kOutside ? ground.foot : labels.patches[label].height(p - field.origin);
    return {p.x(), p.y(), std::max(z, ground.foot)};
  }
};

std::vector<WallSample> wall_samples(const Mesh& mesh) {
  std::vector<WallSample> samples;
  for (const Face& f : mesh.faces) {
    const Vec3 cross = face_cross(mesh, f);
    const double length = cross.norm(), flat = cross.head<2>().norm();
    if (flat <= 0 || std::abs(cross.z()) > kSteepFace * length) continue;
    const Vec3 c = (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3;
    samples.push_back({c.head<2>(), cross.head<2>() / flat, 0.5 * length});
  }
  return samples;
}

/// What is neither ground nor wall.
std::vector<char> roof_cells(const Field& f, const Ground& g) {
  std::vector<char> is_roof(f.size(), 0);
  for (int i = 0; i < f.size(); ++i) is_roof[i] = f.has(i) && !f.is_steep[i] && !g.is_ground[i];
  return is_roof;
}

/// Root mean square of the patches, as half of their area has it.
double patch_noise(const std::vector<Patch>& patches) {
  std::vector<std::pair<double, double>> by_residual;
  double total = 0, passed = 0;
  for (const Patch& p : patches) by_residual.emplace_back(p.residual, p.area), total += p.area;
  std::sort(by_residual.begin(), by_residual.end());
  for (const auto& [residual, area] : by_residual)
    if ((passed += area) >= 0.5 * total) return residual;
  return 0;
}

Plan draw_plan(const Mesh& mesh, const Melting& melting, bool has_ground = true) {
  const double edge = melting.edge;
  const RayScene rays(mesh);
  Plan plan;
  plan.field = make_field(mesh, rays, edge, melting.raster);
  plan.ground = find_ground(plan.field, mesh, has_ground);
  const double span = std::max(kLeastSpan, edge);
  plan.noise = std::clamp(std::max(roof_noise(plan.field), melting.bulge), kLeastNoise, kMostNoise);
  const std::vector<char> is_roof = roof_cells(plan.field, plan.ground);
  Patches patches = find_patches(plan.field, is_roof, plan.noise, span);
  plan.noise = std::clamp(patch_noise(patches.patches), plan.noise, kMostNoise);
  patches = find_patches(plan.field, is_roof, plan.noise, span);
  plan.tolerance = std::clamp(std::max(kToleranceEdge * edge, kToleranceNoise * plan.noise),
                              kLeastTolerance, kMostTolerance);
  const Scales scales{
      .noise = plan.noise, .span = span, .tolerance = plan.tolerance, .raster = melting.raster};
  plan.labels = label_field(plan.field, plan.ground, std::move(patches), scales);
  plan.direction = find_direction(plan.field, plan.labels, plan.tolerance);
  regular_roofs(plan.field, plan.direction, plan.noise, plan.labels);
  raise_blocks(plan.field, scales, plan.labels);
  plan.labels = square_labels(plan.field, plan.ground, std::move(plan.labels), scales);
  plan.borders =
      find_borders(plan.field, plan.labels, wall_samples(mesh), plan.direction, plan.tolerance);
  return plan;
}

std::vector<Relief::Part> roofs_of(const Plan& plan) {
  std::vector<Relief::Part> roofs(plan.labels.patches.size());
  for (std::size_t p = 0; p < roofs.size(); ++p) {
    const Patch& patch = plan.labels.patches[p];
    roofs[p].normal = Vec3(-patch.slope.x(), -patch.slope.y(), 1).normalized();
    const Vec2& o = plan.field.origin;
    roofs[p].offset = roofs[p].normal.dot(Vec3(o.x(), o.y(), patch.level));
  }
  return roofs;
}

/// A piece under which the higher roof steps down, from left to right; none: a crease.
std::optional<Piece> step_at(const Plan& plan, Piece piece) {
  const auto step = [&](const Vec2& p) {
    return plan.raised(p, piece.left).z() - plan.raised(p, piece.right).z();
  };
  double first = step(piece.from), last = step(piece.to);
  const double least = std::max(kLeastStep, kStepNoise * plan.noise);
  const double mean = std::abs(first + last) / 2;
  const bool is_tapered = first * last < 0 || std::min(std::abs(first), std::abs(last)) < least / 2;
  if (mean < (is_tapered ? 2 * least : least)) return std::nullopt;
  if (first + last < 0) {
    std::swap(piece.from, piece.to), std::swap(piece.left, piece.right);
    std::swap(first, last), first = -first, last = -last;
  }
  const Vec2 along = piece.to - piece.from;
  if (first < 0) piece.from += first / (first - last) * along;
  if (last < 0) piece.to -= last / (last - first) * along;
  return piece;
}

/// All steps of one line that look one way are one wall.
std::vector<Relief::Part> walls_of(const Plan& plan, std::vector<std::vector<Piece>>& pieces) {
  std::map<std::pair<int, bool>, int> known;
  std::vector<Relief::Part> walls;
  for (const Piece& border : plan.borders.pieces) {
    const std::optional<Piece> step = step_at(plan, border);
    if (!step || step->length() < 1e-3) continue;
    const Line& line = plan.borders.lines[step->line];
    const Vec2 along = step->to - step->from;
    const bool is_along = line.normal.dot(Vec2(along.y(), -along.x())) > 0;
    const auto [at, is_new] = known.try_emplace({step->line, is_along}, walls.size());
    if (is_new) {
      const Vec2 n = is_along ? line.normal : Vec2(-line.normal);
      walls.push_back({{n.x(), n.y(), 0}, is_along ? line.offset : -line.offset, true, {}, {}});
      pieces.emplace_back();
    }
    const auto onto = [&](const Vec2& p) -> Vec2 {
      return p + (line.offset - line.normal.dot(p)) * line.normal;
    };
    const Vec2 a = onto(step->from), b = onto(step->to);
    walls[at->second].rings.push_back({plan.raised(a, step->right), plan.raised(b, step->right),
                                       plan.raised(b, step->left), plan.raised(a, step->left)});
    pieces[at->second].push_back(*step);
  }
  return walls;
}

/// The loops of pieces with the label on their left, raised onto its roof.
std::vector<std::vector<Vec3>> rings_of(const Plan& plan, int label) {
  std::vector<std::vector<Vec3>> rings;
  for (const Piece& p : plan.borders.pieces) {
    if (p.left == label) rings.push_back({plan.raised(p.from, label), plan.raised(p.to, label)});
    if (p.right == label) rings.push_back({plan.raised(p.to, label), plan.raised(p.from, label)});
  }
  return rings;
}

/// Metres in plan between p and a step, where p is neither above nor below its wall.
double off_step(const Plan& plan, const Piece& step, const Vec3& p) {
  const Vec2 along = step.to - step.from, q = p.head<2>();
  const double t =
      std::clamp((q - step.from).dot(along) / std::max(along.squaredNorm(), 1e-12), 0.0, 1.0);
  const Vec2 near = step.from + t * along;
  if (p.z() > plan.raised(near, step.left).z() + kRoofReach ||
      p.z() < plan.raised(near, step.right).z() - kRoofReach)
    return std::numeric_limits<double>::infinity();
  return (q - near).norm();
}

int nearest_wall(const Plan& plan, const std::vector<std::vector<Piece>>& steps, const Vec3& p) {
  double nearest = kWallReach;
  int wall = -1;
  for (std::size_t w = 0; w < steps.size(); ++w)
    for (const Piece& step : steps[w])
      if (const double off = off_step(plan, step, p); off < nearest)
        nearest = off, wall = static_cast<int>(w);
  return wall;
}

/// A cell of the building near what is not of it.
bool is_beside_outside(const Plan& plan, int cell) {
  const Field& f = plan.field;
  const int reach = static_cast<int>(std::ceil(kBeside / f.cell));
  const int column = cell % f.columns, row = cell / f.columns;
  for (int r = row - reach; r <= row + reach; ++r)
    for (int c = column - reach; c <= column + reach; ++c)
      if (r < 0 || c < 0 || r >= f.rows || c >= f.columns ||
          plan.labels.of_cell[r * f.columns + c] == kOutside)
        return true;
  return false;
}

/// Each face to its wall or roof; out goes what lies outside, or hangs over from there.
void share_out(const Mesh& mesh, const Plan& plan, const std::vector<std::vector<Piece>>& pieces,
               Relief& relief) {
  const int roofs = static_cast<int>(plan.labels.patches.size());
  relief.is_left_out.assign(mesh.faces.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face& t = mesh.faces[f];
    const Vec3 c = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
    const Vec3 n = face_cross(mesh, t).normalized();
    const int cell = plan.field.at(c.head<2>());
    const int label = cell < 0 ? kOutside : plan.labels.of_cell[cell];
    const int wall = std::abs(n.z()) < kSteepFace ? nearest_wall(plan, pieces, c) : -1;
    const double above = label == kOutside ? 0 : c.z() - plan.raised(c.head<2>(), label).z();
    if (wall >= 0)
      relief.parts[roofs + wall].faces.push_back(static_cast<int>(f));
    else if (label == kOutside || (above > kRoofReach && is_beside_outside(plan, cell)))
      relief.is_left_out[f] = 1;
    else if (std::abs(above) < kRoofReach)
      relief.parts[label].faces.push_back(static_cast<int>(f));
  }
}

/// 0..1 of the area that was kept: within `reach` of its part.
double explained_share(const Mesh& mesh, const Relief& relief, double reach) {
  double total = 0, near = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    total += relief.is_left_out[f] ? 0 : face_area(mesh, mesh.faces[f]);
  for (const Relief::Part& part : relief.parts)
    for (const int f : part.faces) {
      const Face& t = mesh.faces[f];
      const Vec3 c = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
      if (std::abs(part.normal.dot(c) - part.offset) < reach) near += face_area(mesh, t);
    }
  return total > 0 ? near / total : 0;
}

/// 0..1 of the walls that are drawn: steep faces of the mesh over their area. Terrain has none.
double supported_share(const Mesh& mesh, const Relief& relief) {
  double drawn = 0, seen = 0;
  for (const Relief::Part& part : relief.parts) {
    if (!part.is_wall) continue;
    for (const int f : part.faces) seen += face_area(mesh, mesh.faces[f]);
    for (const std::vector<Vec3>& q : part.rings)
      drawn += 0.5 * (q[2] - q[0]).cross(q[3] - q[1]).norm();
  }
  return drawn > 0 ? seen / drawn : 0;
}

/// 0..1 of what is seen from above that is roof.
double roof_share(const Plan& plan) {
  int seen = 0, roofs = 0;
  for (int i = 0; i < plan.field.size(); ++i)
    if (plan.field.has(i)) ++seen, roofs += plan.labels.of_cell[i] >= 0;
  return seen > 0 ? static_cast<double>(roofs) / seen : 0;
}

/// The mesh about the z axis.
Mesh turned(Mesh mesh, double angle) {
  const Eigen::AngleAxisd turn(angle, Vec3::UnitZ());
  for (Vec3& v : mesh.vertices) v = turn * v;
  return mesh;
}

void turn(Relief& relief, double angle) {
  const Eigen::AngleAxisd turn(angle, Vec3::UnitZ());
  for (Relief::Part& part : relief.parts) {
    part.normal = turn * part.normal;
    for (std::vector<Vec3>& ring : part.rings)
      for (Vec3& v : ring) v = turn * v;
  }
}

bool has_roof(const Relief& relief) {
  return std::any_of(relief.parts.begin(), relief.parts.end(),
                     [](const Relief::Part& p) { return !p.is_wall && !p.rings.empty(); });
}

std::optional<Relief> read_relief(const Mesh& mesh, const Melting& melting) {
  Plan plan = draw_plan(mesh, melting);
  if (roof_share(plan) < kLeastRoof) plan = draw_plan(mesh, melting, false);
  Relief relief;
  relief.foot = plan.ground.foot;
  relief.noise = plan.noise;
  relief.parts = roofs_of(plan);
  for (std::size_t p = 0; p < relief.parts.size(); ++p)
    relief.parts[p].rings = rings_of(plan, static_cast<int>(p));
  std::vector<std::vector<Piece>> pieces;
  for (Relief::Part& wall : walls_of(plan, pieces)) relief.parts.push_back(std::move(wall));
  share_out(mesh, plan, pieces, relief);
  const double explained = melting.raster > 0 ? 0 : melting.is_wide() ? kWideExplained : kExplained;
  if (!has_roof(relief) || supported_share(mesh, relief) < kLeastSupport ||
      explained_share(mesh, relief, melting.reach()) < explained)
    return std::nullopt;
  return relief;
}

}  // namespace

std::optional<Relief> find_relief(const Mesh& mesh) {
  const Melting melting = measure_melting(mesh);
  if (melting.raster == 0 && !melting.is_melted()) return std::nullopt;
  const double yaw = draw_plan(mesh, melting).direction;
  std::optional<Relief> relief = read_relief(turned(mesh, -yaw), melting);
  if (relief) turn(*relief, yaw);
  return relief;
}

}  // namespace colod
